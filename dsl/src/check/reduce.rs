//! Functionals: `mean(e on D)` and the like, measures of domains, and resultants of physics blocks.

use super::domain::{Kind, kind};
use super::{Checked, Checker, Env, Reported};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Domain, Expr, ExprKind, Piece, Reduction, Shape, Type};
use crate::resolve::scope::{Symbol, Word};
use crate::source::Span;
use crate::syntax::ast::{self, ExprKind as Syntax, On};
use ansatz_units::Dimension;

impl Checker<'_> {
    /// `mean(e on D)`, `max(e on run)`, `min(e on 30 s .. 70 s)`.
    pub(super) fn reduce(
        &mut self,
        name: &ast::Ident,
        arg: &ast::Arg,
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let reduction = match name.text.as_str() {
            "min" => Reduction::Min,
            "max" => Reduction::Max,
            "mean" => Reduction::Mean,
            _ => Reduction::Integral,
        };
        let value = self.settled(&arg.value, env);
        let times = match &arg.on {
            Some(On::Domain(domain)) if !self.is_word(domain, Word::Run, env) => {
                if let Syntax::Call { callee, .. } = &domain.kind
                    && self.is_word(callee, Word::Run, env)
                {
                    return self.expr(domain, env);
                }
                let domain = self.integrated(domain, env);
                return self.reduce_domain(reduction, value?, domain?, span);
            }
            Some(On::Domain(_)) => None,
            Some(On::Times(range)) => {
                let low = self.typed(&range.low, &Type::TIME, "a stretch of time", env);
                let high = self.typed(&range.high, &Type::TIME, "a stretch of time", env);
                Some((Box::new(low?), Box::new(high?)))
            }
            None => {
                let help = format!("write `{}(e on D)`", name.text);
                let message = format!("`{}` needs a domain", name.text);
                return Err(self.report(Diagnostic::error(Code::MissingArgument, span, message).help(help)));
            }
        };
        let value = value?;
        let dimension = self.scalar(&value, "what is followed over the run")?;
        let dimension =
            if reduction == Reduction::Integral { dimension * Dimension::TIME } else { dimension };
        let kind = ExprKind::ReduceRun(reduction, Box::new(value), times);
        Ok(Expr { kind, ty: Type::Value(Shape::Scalar, dimension), span })
    }

    fn reduce_domain(
        &mut self,
        reduction: Reduction,
        value: Expr,
        domain: Domain,
        span: Span,
    ) -> Checked<Expr> {
        let (shape, dimension) = self.operand(&value)?;
        if domain.pieces.contains(&Piece::Axis) {
            return Err(self.no_measure(domain.span));
        }
        if matches!(reduction, Reduction::Min | Reduction::Max) && shape != Shape::Scalar {
            return Err(self.need_scalar(&value, "the smallest and the largest are defined for scalars"));
        }
        let dimension =
            if reduction == Reduction::Integral { dimension * kind(&domain).measure() } else { dimension };
        let kind = ExprKind::Reduce(reduction, Box::new(value), domain);
        Ok(Expr { kind, ty: Type::Value(shape, dimension), span })
    }

    fn no_measure(&mut self, span: Span) -> Reported {
        self.report(Diagnostic::error(Code::NotOnDomain, span, "the axis has no area"))
    }

    /// `area(D)`, `volume(D)`; `length(D)` is the length of a path in its plane.
    pub(super) fn measure(
        &mut self,
        name: &ast::Ident,
        e: &ast::Expr,
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let domain = self.integrated(e, env)?;
        if domain.pieces.contains(&Piece::Axis) {
            return Err(self.no_measure(domain.span));
        }
        let of = kind(&domain);
        if domain.current && of == Kind::Edges {
            let message = "this is the area before anything moves; the current one changes";
            let help = format!("write `integral(1 on {})`", self.sources.slice(e.span));
            return Err(self.report(Diagnostic::error(Code::NotOnDomain, span, message).help(help)));
        }
        if of == Kind::Contact {
            let message = "a contact pair has no measure of its own";
            return Err(self.report(Diagnostic::error(Code::NotOnDomain, span, message).help(format!(
                "the area that faces the other surface is `integral(1 on {})`",
                self.sources.slice(e.span)
            ))));
        }
        let fits = match name.text.as_str() {
            "area" => of != Kind::Cells,
            "volume" => of == Kind::Cells,
            _ => false,
        };
        if fits {
            return Ok(Expr {
                kind: ExprKind::Measure(domain),
                ty: Type::Value(Shape::Scalar, of.measure()),
                span,
            });
        }
        let proper = if of == Kind::Cells { "volume" } else { "area" };
        let message = format!("the measure of this domain is its {proper}");
        Err(self.report(
            Diagnostic::error(Code::NotOnDomain, span, message)
                .label(e.span, of.words())
                .help(format!("write `{proper}({})`", self.sources.slice(e.span)))
                .help("paths stand for surfaces and regions for volumes; plane models count per unit depth"),
        ))
    }

    /// `normal(D)`: the unit normal out of regions, on the paths that bound them, or to the right of paths.
    pub(super) fn normal(&mut self, e: &ast::Expr, span: Span, env: &Env) -> Checked<Expr> {
        let domain = self.domain(e, env)?;
        if kind(&domain) == Kind::Contact {
            let message = "a normal points out of a region, or to the right of a path";
            let diagnostic = Diagnostic::error(Code::NotOnDomain, span, message);
            return Err(self.report(diagnostic.label(e.span, kind(&domain).words())));
        }
        Ok(Expr { kind: ExprKind::Normal(domain), ty: Type::Value(Shape::Vector, Dimension::NUMBER), span })
    }

    /// `force(block, D)`: the resultant that a block puts on a surface.
    pub(super) fn force(
        &mut self,
        block: &ast::Expr,
        on: &ast::Expr,
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let domain = self.domain(on, env);
        let symbol = block.as_name().and_then(|name| self.symbol(&name.text, env));
        let id = match symbol {
            Some(Symbol::Block(id)) => id,
            Some(Symbol::Broken) => return Err(Reported),
            _ => {
                let name = block.as_name().map_or(String::new(), |name| name.text);
                let blocks = self.names_of(|symbol| matches!(symbol, Symbol::Block(_)));
                let diagnostic = Diagnostic::error(
                    Code::WrongKind,
                    block.span,
                    "the name of a physics block is needed here",
                )
                .help_did_you_mean(&name, blocks.iter().copied())
                .help(format!("the blocks are `{}`", blocks.join("`, `")));
                let diagnostic = self.was_dropped(&name, diagnostic);
                return Err(self.report(diagnostic));
            }
        };
        let dimension = Dimension::named("Force").unwrap_or(Dimension::NUMBER);
        let kind = ExprKind::Force(id, domain?);
        Ok(Expr { kind, ty: Type::Value(Shape::Vector, dimension), span })
    }
}
