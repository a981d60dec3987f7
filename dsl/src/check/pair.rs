//! Contact pairs: `let touch = pair(a, b, search: d);`, its sides, its gap and its normals.

use super::domain::{Kind, kind};
use super::shape::settle;
use super::{Checked, Checker, Env, Meaning, Reported};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Domain, Expr, ExprKind, Pair, PairId, Piece, Shape, Sides, Type};
use crate::resolve::scope::Symbol;
use crate::source::Span;
use crate::syntax::ast::{self, ExprKind as Syntax};
use ansatz_units::Dimension;

impl Checker<'_> {
    /// The pair that a name stands for, if it does.
    pub(super) fn pair_named(&mut self, e: &ast::Expr, env: &Env) -> Checked<Option<PairId>> {
        let Syntax::Name(name) = &e.kind else { return Ok(None) };
        if env.locals.iter().any(|(known, _)| known == name) {
            return Ok(None);
        }
        match self.symbol(name, env) {
            Some(Symbol::Let(at)) if is_pair(&self.lets[at].ast.value) => match self.meaning(at, e.span)? {
                Meaning::Pair(id) => Ok(Some(id)),
                _ => Ok(None),
            },
            _ => Ok(None),
        }
    }

    pub(super) fn side(&mut self, pair: PairId, side: &ast::Ident) -> Checked<Piece> {
        match side.text.as_str() {
            "first" => Ok(Piece::Pair(pair, Sides::First)),
            "second" => Ok(Piece::Pair(pair, Sides::Second)),
            _ => {
                let message = format!("a pair has no side `{}`", side.text);
                Err(self.report(
                    Diagnostic::error(Code::UnknownMember, side.span, message)
                        .help_did_you_mean(&side.text, ["first", "second"]),
                ))
            }
        }
    }

    /// `touch.gap` as a value.
    pub(super) fn pair_member(&mut self, pair: PairId, member: &ast::Ident, span: Span) -> Checked<Expr> {
        match member.text.as_str() {
            "gap" => Ok(Expr { kind: ExprKind::Gap(pair), ty: Type::LENGTH, span }),
            "normal" => {
                let ty = Type::Value(Shape::Vector, Dimension::NUMBER);
                Ok(Expr { kind: ExprKind::PairNormal(pair), ty, span })
            }
            "other" => {
                let message = format!("`.{}` of a pair is not supported", member.text);
                Err(self.report(Diagnostic::error(Code::Unsupported, member.span, message)))
            }
            "first" | "second" => {
                let message = format!("`.{}` is a side of the pair, not a value", member.text);
                Err(self.report(Diagnostic::error(Code::WrongKind, span, message)))
            }
            _ => {
                let message = format!("a pair has no member `{}`", member.text);
                let diagnostic = Diagnostic::error(Code::UnknownMember, member.span, message)
                    .help_did_you_mean(&member.text, ["gap", "normal", "first", "second"]);
                let help = "it has `.gap`, `.normal` and the sides `.first` and `.second`";
                Err(self.report(diagnostic.help(help)))
            }
        }
    }

    /// `pair(a, b, search: d)` as the value of a `let`.
    pub(super) fn pair(&mut self, name: &ast::Ident, args: &[ast::Arg], span: Span) -> Checked<PairId> {
        let env = Env::default();
        let [first, second, search] = args else {
            return Err(self.pair_form(span));
        };
        if first.name.is_some()
            || second.name.is_some()
            || search.name.as_ref().is_none_or(|name| name.text != "search")
        {
            return Err(self.pair_form(span));
        }
        let (a, b) = (self.surface(&first.value, &env), self.surface(&second.value, &env));
        let distance = self.typed(&search.value, &Type::LENGTH, "the search distance", &env);
        let (a, b, distance) = (a?, b?, distance?);
        if let Some(shared) =
            a.pieces.iter().find(|piece| b.pieces.iter().any(|other| overlap(**piece, *other)))
        {
            let words = self.piece_words(*shared);
            return Err(self.report(
                Diagnostic::error(Code::BadPair, span, "a surface cannot touch itself")
                    .label(a.span, format!("{words} is on this side"))
                    .label(b.span, "and on this one")
                    .help("name two surfaces without common parts"),
            ));
        }
        self.pairs.push(Pair {
            name: name.text.clone(),
            first: a,
            second: b,
            search: settle(distance),
            span,
        });
        Ok(PairId(self.pairs.len() - 1))
    }

    fn pair_form(&mut self, span: Span) -> Reported {
        self.report(
            Diagnostic::error(Code::MissingArgument, span, "a pair is two surfaces and a search distance")
                .help("write `pair(nucleus, endo + cavity, search: 1.5 um)`"),
        )
    }

    /// A domain of edges.
    fn surface(&mut self, e: &ast::Expr, env: &Env) -> Checked<Domain> {
        let domain = self.domain(e, env)?;
        if kind(&domain) == Kind::Edges && !domain.pieces.contains(&Piece::Axis) {
            return Ok(domain);
        }
        Err(self.report(Diagnostic::error(Code::BadPair, e.span, "a contact surface is made of paths")))
    }
}

/// Whether the value of a `let` is a contact pair.
pub(super) fn is_pair(e: &ast::Expr) -> bool {
    matches!(&e.kind, Syntax::Call { callee, .. } if callee.as_name().is_some_and(|name| name.text == "pair"))
}

/// Whether two pieces of edges share an edge.
fn overlap(a: Piece, b: Piece) -> bool {
    match (a, b) {
        (Piece::Path(p), Piece::Segment(q, _)) | (Piece::Segment(q, _), Piece::Path(p)) => p == q,
        _ => a == b,
    }
}
