//! Numbers at compile time: parameters at their defaults, and what can be judged from them alone.
//!
//! - [`check`]: defaults in their ranges, the geometry that they give, laws that meet at their breakpoints and end within their reach;
//! - [`law_tests`]: the tests of the model that need no run.

mod geometry;
mod laws;
mod reach;
mod settings;
mod test;

use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::form::Forms;
use crate::form::settings::Bounds;
use crate::lower::{Lowered, Lowering, SymbolKind};
use crate::model::{self, Expr};
use crate::scalar::{Id, Symbol, eval};

pub use test::{LawTests, law_tests};

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
    Ok(values_of(lowering, &[id], parameters, &[])[0])
}

/// Values of scalars from parameters and variables; NaN for other symbols.
fn values_of(
    lowering: &Lowering<'_>,
    roots: &[Id],
    parameters: &[f64],
    variables: &[(Symbol, f64)],
) -> Vec<f64> {
    eval(&lowering.pool, roots, &|symbol| match lowering.symbols.kind(symbol) {
        SymbolKind::Parameter(param) => parameters.get(param.0).copied().unwrap_or(f64::NAN),
        _ => variables.iter().find(|(s, _)| *s == symbol).map_or(f64::NAN, |(_, value)| *value),
    })
}

/// Judges defaults, geometry and laws.
pub fn check(forms: &mut Forms<'_>, sink: &mut Sink) {
    let parameters = defaults(&mut forms.lowering);
    check_bounds(forms, &parameters, sink);
    settings::check(forms, &parameters, sink);
    geometry::check(forms, &parameters, sink);
    laws::check(&mut forms.lowering, &parameters, sink);
    reach::check(forms, &parameters, sink);
}

fn check_bounds(forms: &Forms<'_>, parameters: &[f64], sink: &mut Sink) {
    let model = forms.lowering.model;
    for ((param, setting), &value) in model.params.iter().zip(&forms.settings.parameters).zip(parameters) {
        let numbers = |ids: &[Id]| values_of(&forms.lowering, ids, parameters, &[]);
        if let (Bounds::Range(ends), Some(model::Bounds::Range(low, high))) = (&setting.bounds, &param.bounds)
            && let [start, end] = numbers(ends)[..]
            && start > end
        {
            let message = format!("the range of `{}` is empty: it ends below its start", param.name);
            sink.push(
                Diagnostic::error(Code::BadRange, high.span, message)
                    .label(low.span, "it starts here")
                    .help("write the smaller bound first: `in 1 .. 2`"),
            );
            continue;
        }
        let inside = match &setting.bounds {
            Bounds::Any => value.is_finite(),
            Bounds::Range(ends) => {
                let ends = numbers(ends);
                let slack = 1e-12 * ends[0].abs().max(ends[1].abs());
                (ends[0] - slack..=ends[1] + slack).contains(&value)
            }
            Bounds::Set(set) => {
                numbers(set).iter().any(|allowed| (allowed - value).abs() <= 1e-12 * allowed.abs())
            }
        };
        if !inside {
            let message =
                format!("the default of `{}` is {value}, which its range does not allow", param.name);
            sink.push(
                Diagnostic::error(Code::BadRange, param.span, message)
                    .help("change the default or the range"),
            );
        }
    }
}
