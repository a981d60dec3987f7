//! Numbers at compile time: parameters at their defaults, and whatever depends on them alone.

use crate::lower::{Condition, Lowered, Lowering, SymbolKind, Value};
use crate::model::Expr;
use crate::scalar::{Id, eval};

/// Default of each parameter, in order; NaN where it has none.
pub fn defaults(lowering: &mut Lowering<'_>) -> Vec<f64> {
    let model = lowering.model;
    let mut values = Vec::new();
    for param in &model.params {
        let value = number(lowering, &param.default, &values).unwrap_or(f64::NAN);
        values.push(value);
    }
    values
}

/// Value of a scalar expression of the first `parameters.len()` parameters.
///
/// # Errors
/// If it cannot be lowered.
pub fn number<'m>(lowering: &mut Lowering<'m>, expr: &'m Expr, parameters: &[f64]) -> Lowered<f64> {
    let id = lowering.global_scalar(expr)?;
    Ok(values_of(lowering, &[id], parameters)[0])
}

/// Values of scalars; NaN for symbols other than the given parameters.
pub fn values_of(lowering: &Lowering<'_>, roots: &[Id], parameters: &[f64]) -> Vec<f64> {
    eval(&lowering.pool, roots, &|symbol| match lowering.symbols.kind(symbol) {
        SymbolKind::Parameter(param) => parameters.get(param.0).copied().unwrap_or(f64::NAN),
        _ => f64::NAN,
    })
}

/// Truth of a condition on parameters.
pub fn truth(lowering: &Lowering<'_>, condition: &Condition, parameters: &[f64]) -> bool {
    condition.truth(&|id| values_of(lowering, &[id], parameters)[0])
}

/// Components of a value as numbers.
pub fn components(lowering: &mut Lowering<'_>, value: &Value, parameters: &[f64]) -> Vec<f64> {
    let ids = value.components(&mut lowering.pool);
    values_of(lowering, &ids, parameters)
}
