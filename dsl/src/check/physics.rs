//! Physics blocks: energies, residuals, loads, constraints and equations, each with the dimension that its integral must have.

use super::shape::settle;
use super::{Binding, Checked, Checker, Env, Reported, domain};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{BlockId, Domain, Expr, ExprKind, FieldId, Shape, Statement, StatementKind, Type};
use crate::source::Span;
use crate::syntax::ast;
use ansatz_units::Dimension;

impl Checker<'_> {
    /// Elaborates the statements of a block; its `let`s are seen by those after them.
    pub(super) fn physics(&mut self, id: BlockId, ast: &ast::Physics) {
        let mut env = Env::default();
        for statement in &ast.statements {
            if let ast::StatementKind::Let(item) = &statement.kind {
                let binding = match self.let_value_of(item, &env) {
                    Ok(value) => Binding::Let(self.value(&item.name, "", value)),
                    Err(Reported) => Binding::Broken,
                };
                env.bind(&item.name, binding);
            } else if let Ok(kind) = self.statement(&statement.kind, statement.span, &env) {
                self.blocks[id.0].statements.push(Statement { kind, span: statement.span });
            }
        }
    }

    fn statement(&mut self, kind: &ast::StatementKind, span: Span, env: &Env) -> Checked<StatementKind> {
        match kind {
            ast::StatementKind::Energy { density, domain } => self.energy(density, domain.as_ref(), env),
            ast::StatementKind::Residual { form, domain } => self.residual(form, domain.as_ref(), span, env),
            ast::StatementKind::Load { quantity, force, domain } => {
                self.load(quantity, force, domain.as_ref(), env)
            }
            ast::StatementKind::Hold { quantity, value, domain } => {
                self.hold(quantity, value, domain.as_ref(), span, env)
            }
            ast::StatementKind::Equation(equation) => self.equation(equation, env),
            ast::StatementKind::Tie { equation, domain } => self.tie(equation, domain.as_ref(), span, env),
            ast::StatementKind::Let(_) => Err(Reported),
        }
    }

    /// The domain of a statement; `Ok(None)` if it has none.
    fn on(&mut self, domain: Option<&ast::Expr>, env: &Env) -> Checked<Option<Domain>> {
        domain.map(|domain| self.integrated(domain, env)).transpose()
    }

    fn energy(
        &mut self,
        density: &ast::Expr,
        domain: Option<&ast::Expr>,
        env: &Env,
    ) -> Checked<StatementKind> {
        let (density, domain) = (self.settled(density, env), self.on(domain, env));
        let (density, domain) = (density?, domain?);
        let have = self.scalar(&density, "an energy")?;
        let want = per_measure(energy(), domain.as_ref());
        if have == want {
            return Ok(StatementKind::Energy(density, domain));
        }
        let (words, want_words) = (self.words(&density.ty), self.dimension_words(want));
        let mut diagnostic =
            Diagnostic::error(Code::EnergyDimension, density.span, "the integral of this term is no energy")
                .here(format!("this is {words}, but {want_words} is needed"));
        diagnostic = match &domain {
            Some(domain) => diagnostic.label(domain.span, measured_words(domain)),
            None => diagnostic.help("without `on` the term is an energy by itself"),
        };
        Err(self.report(diagnostic))
    }

    fn dimension_words(&self, dimension: Dimension) -> String {
        self.words(&Type::Value(Shape::Scalar, dimension))
    }

    fn residual(
        &mut self,
        form: &ast::Expr,
        domain: Option<&ast::Expr>,
        span: Span,
        env: &Env,
    ) -> Checked<StatementKind> {
        let (form, domain) = (self.settled(form, env), self.on(domain, env));
        let form = form?;
        self.scalar(&form, "a residual")?;
        match domain? {
            Some(domain) => Ok(StatementKind::Residual(form, domain)),
            None => Err(self.report(
                Diagnostic::error(Code::MissingArgument, span, "a residual is integrated over a domain")
                    .help("write `residual .. on D;`; equations between states are written `a == b;`"),
            )),
        }
    }

    fn load(
        &mut self,
        quantity: &ast::Expr,
        force: &ast::Expr,
        domain: Option<&ast::Expr>,
        env: &Env,
    ) -> Checked<StatementKind> {
        let (quantity, force_value) = (self.settled(quantity, env), self.expr(force, env));
        let domain = self.on(domain, env);
        let (quantity, mut force_value, domain) = (quantity?, force_value?, domain?);
        super::shape::coerce(&mut force_value, &quantity.ty);
        let ((s, _), (t, _)) = (self.operand(&quantity)?, self.operand(&force_value)?);
        if s != t {
            return Err(self.report(
                Diagnostic::error(
                    Code::ShapeMismatch,
                    force_value.span,
                    "a load has the shape of the quantity on which it works",
                )
                .here(format!("this is {}", self.words(&force_value.ty)))
                .label(quantity.span, format!("this is {}", self.words(&quantity.ty))),
            ));
        }
        // Whether it is virtual work or virtual power follows from the other statements: `work` compares them.
        Ok(StatementKind::Load(quantity, force_value, domain))
    }

    fn hold(
        &mut self,
        quantity: &ast::Expr,
        held: &ast::Expr,
        domain: Option<&ast::Expr>,
        span: Span,
        env: &Env,
    ) -> Checked<StatementKind> {
        let (quantity, held) = (self.settled(quantity, env), self.expr(held, env));
        let domain = domain.map(|domain| self.places(domain, env)).transpose();
        let quantity = quantity?;
        let (field, component) = self.held_field(&quantity)?;
        let held = self.expect(held?, &quantity.ty, "the held value")?;
        match domain? {
            Some(domain) if domain::kind(&domain) == domain::Kind::Contact => Err(self.report(
                Diagnostic::error(Code::Misplaced, domain.span, "a field is held on paths and regions")
                    .here(domain::Kind::Contact.words())
                    .help("name the surfaces of the pair"),
            )),
            Some(domain) => Ok(StatementKind::Hold(field, component, held, domain)),
            None => Err(self.report(
                Diagnostic::error(Code::MissingArgument, span, "a field is held on a domain")
                    .help("write `hold u = 0 on D;`; a state is set by an equation `a == b;`"),
            )),
        }
    }

    /// The field, or its component, that a `hold` prescribes.
    fn held_field(&mut self, quantity: &Expr) -> Checked<(FieldId, Option<usize>)> {
        match &quantity.kind {
            ExprKind::Field(field) => return Ok((*field, None)),
            ExprKind::Component(inner, i) => {
                if let ExprKind::Field(field) = inner.kind {
                    return Ok((field, Some(*i)));
                }
            }
            _ => {}
        }
        Err(self.report(
            Diagnostic::error(
                Code::WrongKind,
                quantity.span,
                "only a field or one of its components can be held",
            )
            .help("an equation between states is written `a == b;`"),
        ))
    }

    fn equation(&mut self, equation: &ast::Equation, env: &Env) -> Checked<StatementKind> {
        let (a, b) = (self.expr(&equation.left, env), self.expr(&equation.right, env));
        let (mut a, mut b) = (a?, b?);
        self.same(&mut a, &mut b, equation.span, "equate")?;
        let (a, b) = (settle(a), settle(b));
        self.scalar(&a, "an equation between states")?;
        Ok(StatementKind::Equation(a, b))
    }
}

/// The dimension of energies.
pub(super) fn energy() -> Dimension {
    Dimension::named("Energy").unwrap_or(Dimension::NUMBER)
}

/// `total` per measure of a domain; `total` itself without one.
pub(super) fn per_measure(total: Dimension, domain: Option<&Domain>) -> Dimension {
    domain.map_or(total, |domain| total / domain::kind(domain).measure())
}

pub(super) fn measured_words(domain: &Domain) -> &'static str {
    match domain::kind(domain) {
        domain::Kind::Cells => "integrated over a volume",
        domain::Kind::Edges | domain::Kind::Contact => "integrated over an area",
        domain::Kind::Ends => "at points",
    }
}
