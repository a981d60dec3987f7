//! Constants that types depend on: exponents, and bounds that are plain numbers. Values that need parameters are none of this file's business.

use crate::model::{Arithmetic, Expr, ExprKind, LetId};
use ansatz_units::Rational;

/// The value of an expression of literals and constant `let`s as an exact fraction, such as -5/3; `None` if it is none.
pub(super) fn exponent<'m>(e: &'m Expr, value_of: &dyn Fn(LetId) -> Option<&'m Expr>) -> Option<Rational> {
    match &e.kind {
        ExprKind::Number(value) => Rational::from_f64(*value),
        ExprKind::Let(id) => exponent(value_of(*id)?, value_of),
        ExprKind::Negate(a) => Some(-exponent(a, value_of)?),
        ExprKind::Arithmetic(op, a, b) => {
            let (a, b) = (exponent(a, value_of)?, exponent(b, value_of)?);
            match op {
                Arithmetic::Add => Some(a + b),
                Arithmetic::Sub => Some(a - b),
                Arithmetic::Mul => Some(a * b),
                Arithmetic::Div => (!b.is_zero()).then(|| a / b),
                Arithmetic::Pow => None,
            }
        }
        _ => None,
    }
}

/// The value of an expression of literals only, in coherent units.
pub(super) fn literal(e: &Expr) -> Option<f64> {
    match &e.kind {
        ExprKind::Number(value) => Some(*value),
        ExprKind::Negate(a) => Some(-literal(a)?),
        ExprKind::Arithmetic(op, a, b) => {
            let (a, b) = (literal(a)?, literal(b)?);
            Some(match op {
                Arithmetic::Add => a + b,
                Arithmetic::Sub => a - b,
                Arithmetic::Mul => a * b,
                Arithmetic::Div => a / b,
                Arithmetic::Pow => a.powf(b),
            })
        }
        _ => None,
    }
}
