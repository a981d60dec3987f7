//! `match`: piecewise laws over a value and choices by region.

use super::shape::settle;
use super::{Checked, Checker, Env, Reported, constant};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Arm, Expr, ExprKind, Piece, RegionId, Smoothness};
use crate::resolve::scope::Word;
use crate::source::Span;
use crate::syntax::ast::{self, ExprKind as Syntax, Pattern};

impl Checker<'_> {
    /// Either kind of `match`.
    pub(super) fn match_expr(&mut self, m: &ast::Match, span: Span, env: &Env) -> Checked<Expr> {
        let values: Vec<Checked<Expr>> = m.arms.iter().map(|arm| self.expr(&arm.value, env)).collect();
        if self.is_word(&m.scrutinee, Word::Region, env) {
            self.match_region(m, values, span, env)
        } else {
            self.match_value(m, values, span, env)
        }
    }

    fn match_value(
        &mut self,
        m: &ast::Match,
        values: Vec<Checked<Expr>>,
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let scrutinee = self.settled(&m.scrutinee, env);
        let bounds: Vec<Checked<Option<(bool, Expr)>>> =
            m.arms.iter().map(|arm| self.bound_of(arm, env)).collect();
        let mut scrutinee = scrutinee?;
        self.scalar(&scrutinee, "what a `match` looks at")?;
        let mut arms = Vec::new();
        let mut otherwise = None;
        for ((arm, bound), value) in m.arms.iter().zip(bounds).zip(values) {
            if otherwise.is_some() {
                return Err(self.incomplete(
                    arm.span,
                    "nothing comes after `else`",
                    "remove this arm or put it first",
                ));
            }
            let value = value?;
            match bound? {
                Some((inclusive, mut bound)) => {
                    self.same(&mut scrutinee, &mut bound, arm.span, "compare")?;
                    arms.push(Arm { inclusive, bound: settle(bound), value });
                }
                None => otherwise = Some(value),
            }
        }
        let Some(otherwise) = otherwise else {
            return Err(self.incomplete(
                span,
                "this `match` says nothing about large values",
                "end it with `else => ..`",
            ));
        };
        self.ascending(&arms)?;
        let mut all: Vec<Expr> = arms.iter().map(|arm| arm.value.clone()).chain([otherwise]).collect();
        let ty = self.all_same(&mut all, span, "join arms of")?;
        let otherwise = all.pop().ok_or(Reported)?;
        for (arm, value) in arms.iter_mut().zip(all) {
            arm.value = value;
        }
        let smoothness = match m.smoothness {
            ast::Smoothness::C0 => Smoothness::C0,
            ast::Smoothness::C1 => Smoothness::C1,
            ast::Smoothness::Jumps => Smoothness::Jumps,
        };
        let kind = ExprKind::MatchValue {
            scrutinee: Box::new(scrutinee),
            arms,
            otherwise: Box::new(otherwise),
            smoothness,
        };
        Ok(Expr { kind, ty, span })
    }

    fn incomplete(&mut self, span: Span, message: &str, help: &str) -> Reported {
        self.report(Diagnostic::error(Code::IncompleteMatch, span, message).help(help))
    }

    /// The bound of an arm; `None` for `else`.
    fn bound_of(&mut self, arm: &ast::Arm, env: &Env) -> Checked<Option<(bool, Expr)>> {
        match &arm.pattern {
            Pattern::Less(bound) => Ok(Some((false, self.expr(bound, env)?))),
            Pattern::LessEqual(bound) => Ok(Some((true, self.expr(bound, env)?))),
            Pattern::Else(_) => Ok(None),
            Pattern::Region(name) => {
                let help = format!("write `< {0}` or `<= {0}`", name.text());
                Err(self.incomplete(name.span, "an arm of a piecewise law starts with a bound", &help))
            }
        }
    }

    /// Bounds that are plain numbers must ascend; others are compared with the default parameters, once those are numbers.
    fn ascending(&mut self, arms: &[Arm]) -> Checked<()> {
        for pair in arms.windows(2) {
            let (Some(low), Some(high)) =
                (constant::literal(&pair[0].bound), constant::literal(&pair[1].bound))
            else {
                continue;
            };
            if low > high {
                return Err(self.report(
                    Diagnostic::error(
                        Code::IncompleteMatch,
                        pair[1].bound.span,
                        "the bounds of a `match` ascend",
                    )
                    .label(pair[0].bound.span, "this one is larger"),
                ));
            }
        }
        Ok(())
    }

    fn match_region(
        &mut self,
        m: &ast::Match,
        values: Vec<Checked<Expr>>,
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let mut arms: Vec<(RegionId, Expr)> = Vec::new();
        let mut otherwise = None;
        for (arm, value) in m.arms.iter().zip(values) {
            match &arm.pattern {
                Pattern::Region(name) => {
                    let regions = self.regions_named(name, env)?;
                    let value = value?;
                    for region in regions {
                        if arms.iter().any(|(known, _)| *known == region) {
                            let message =
                                format!("`{}` has an arm already", self.geometry.regions[region.0].name);
                            return Err(self.incomplete(name.span, &message, "give every region one arm"));
                        }
                        arms.push((region, value.clone()));
                    }
                }
                Pattern::Else(_) => otherwise = Some(value?),
                Pattern::Less(bound) | Pattern::LessEqual(bound) => {
                    return Err(self.incomplete(
                        bound.span,
                        "an arm of a choice by region starts with a region",
                        "write `core => ..`",
                    ));
                }
            }
        }
        let count = arms.len();
        let mut all: Vec<Expr> = arms.iter().map(|(_, value)| value.clone()).chain(otherwise).collect();
        let ty = self.all_same(&mut all, span, "join arms of")?;
        let otherwise = if all.len() > count { all.pop().map(Box::new) } else { None };
        for ((_, slot), value) in arms.iter_mut().zip(all) {
            *slot = value;
        }
        Ok(Expr { kind: ExprKind::MatchRegion(arms, otherwise), ty, span })
    }

    /// The regions of a pattern: a region or a `let` of regions.
    fn regions_named(&mut self, name: &ast::Dotted, env: &Env) -> Checked<Vec<RegionId>> {
        let Some(first) = name.parts.first() else { return Err(Reported) };
        let e = ast::Expr { kind: Syntax::Name(first.text.clone()), span: name.span };
        let domain = self.domain(&e, env)?;
        let regions = domain.pieces.iter().map(|piece| match piece {
            Piece::Region(id) => Some(*id),
            _ => None,
        });
        regions.collect::<Option<Vec<_>>>().ok_or_else(|| {
            let message = format!("`{}` is no region", name.text());
            self.report(Diagnostic::error(Code::WrongKind, name.span, message))
        })
    }
}
