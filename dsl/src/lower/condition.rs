//! Lowering of conditions.

use super::{Condition, Lowered, Lowering, RunValue, SymbolKind, Value, internal, unsupported};
use crate::model::{Expr, ExprKind, Relation};
use crate::scalar::{Id, Pool};

impl<'m> Lowering<'m> {
    /// Lowers a truth value at the current place.
    pub(super) fn condition(&mut self, expr: &'m Expr) -> Lowered<Condition> {
        let both = |lowering: &mut Self, a, b| -> Lowered<_> {
            Ok((Box::new(lowering.condition(a)?), Box::new(lowering.condition(b)?)))
        };
        match &expr.kind {
            ExprKind::Compare(relation, a, b) => {
                let (a, b) = (self.scalar_expr(a)?, self.scalar_expr(b)?);
                Ok(compare(&self.pool, *relation, a, b))
            }
            ExprKind::And(a, b) => both(self, a, b).map(|(a, b)| Condition::And(a, b)),
            ExprKind::Or(a, b) => both(self, a, b).map(|(a, b)| Condition::Or(a, b)),
            ExprKind::Not(a) => Ok(Condition::Not(Box::new(self.condition(a)?))),
            ExprKind::OutcomeIs(event) => {
                let outcome = self.run_symbol(RunValue::Outcome(*event));
                let half = self.pool.constant(0.5);
                Ok(Condition::Compare(Relation::Greater, outcome, half))
            }
            ExprKind::Held(..) => {
                Err(unsupported(expr.span, "`for` stands only in the condition of an event"))
            }
            _ => match self.expr(expr)? {
                Value::Condition(condition) => Ok(condition),
                _ => Err(internal(expr.span, "a condition was expected")),
            },
        }
    }

    /// Lowers a condition that is the same at all points of space.
    pub fn global_condition(&mut self, expr: &'m Expr) -> Lowered<Condition> {
        match self.global(expr)? {
            Value::Condition(condition) => Ok(condition),
            _ => Err(internal(expr.span, "a condition was expected")),
        }
    }

    /// The symbol of a value of a finished run.
    pub(super) fn run_symbol(&mut self, value: RunValue) -> Id {
        let position = self.run_values.iter().position(|v| *v == value).unwrap_or_else(|| {
            self.run_values.push(value);
            self.run_values.len() - 1
        });
        self.input(SymbolKind::Run(position))
    }
}

fn compare(pool: &Pool, relation: Relation, a: Id, b: Id) -> Condition {
    match (pool.as_constant(a), pool.as_constant(b)) {
        (Some(x), Some(y)) => Condition::Constant(holds(relation, x, y)),
        _ => Condition::Compare(relation, a, b),
    }
}

/// Whether `x relation y`.
pub fn holds(relation: Relation, x: f64, y: f64) -> bool {
    match relation {
        Relation::Less => x < y,
        Relation::LessEqual => x <= y,
        Relation::Greater => x > y,
        Relation::GreaterEqual => x >= y,
        Relation::Equal => x == y,
    }
}

impl Condition {
    /// Truth from the values of scalars.
    pub fn truth(&self, value: &dyn Fn(Id) -> f64) -> bool {
        match self {
            Condition::Constant(truth) => *truth,
            Condition::Compare(relation, a, b) => holds(*relation, value(*a), value(*b)),
            Condition::And(a, b) => a.truth(value) && b.truth(value),
            Condition::Or(a, b) => a.truth(value) || b.truth(value),
            Condition::Not(a) => !a.truth(value),
        }
    }

    /// The scalars that it compares.
    pub fn scalars(&self) -> Vec<Id> {
        match self {
            Condition::Constant(_) => Vec::new(),
            Condition::Compare(_, a, b) => vec![*a, *b],
            Condition::And(a, b) | Condition::Or(a, b) => [a.scalars(), b.scalars()].concat(),
            Condition::Not(a) => a.scalars(),
        }
    }

    /// A scalar that is positive where the condition holds and changes its sign, continuously where its sides do, where it turns.
    /// `None` for an equality, which no sign can tell.
    pub fn margin(&self, pool: &mut Pool) -> Option<Id> {
        Some(match self {
            Condition::Constant(truth) => pool.constant(if *truth { 1.0 } else { -1.0 }),
            Condition::Compare(Relation::Less | Relation::LessEqual, a, b) => pool.sub(*b, *a),
            Condition::Compare(Relation::Greater | Relation::GreaterEqual, a, b) => pool.sub(*a, *b),
            Condition::Compare(Relation::Equal, ..) => return None,
            Condition::And(a, b) => {
                let (a, b) = (a.margin(pool)?, b.margin(pool)?);
                pool.min(a, b)
            }
            Condition::Or(a, b) => {
                let (a, b) = (a.margin(pool)?, b.margin(pool)?);
                pool.max(a, b)
            }
            Condition::Not(a) => {
                let margin = a.margin(pool)?;
                pool.neg(margin)
            }
        })
    }
}
