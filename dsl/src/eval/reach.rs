//! Whether laws on contact pairs vanish at the search distance, judged by numbers: what is left there is a jump, where points come into reach.
//!
//! The force of each law is taken at the search distance and at smaller gaps, with the parameters at their defaults and everything else 1.

use super::number;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::form::{Contact, Forms};
use crate::lower::{Lowering, SymbolKind};
use crate::scalar::{Id, eval};
use ansatz_units::Dimension;

/// Part of the largest force that may be left at the search distance.
const LEFT: f64 = 1e-3;
/// How often the search distance is halved.
const HALVINGS: i32 = 10;
/// A unit normal in no special direction.
const NORMAL: [f64; 2] = [0.6, 0.8];

/// Warns of laws that do not vanish at the search distance.
pub(super) fn check(forms: &mut Forms<'_>, parameters: &[f64], sink: &mut Sink) {
    let energies = forms.gap_energies.iter().map(|energy| (energy.contact.clone(), vec![energy.law[1]]));
    let loads = forms.pair_loads.iter().map(|load| (load.contact.clone(), load.flux.to_vec()));
    for (contact, force) in energies.chain(loads).collect::<Vec<_>>() {
        check_law(&mut forms.lowering, parameters, &contact, &force, sink);
    }
}

fn check_law(
    lowering: &mut Lowering<'_>,
    parameters: &[f64],
    contact: &Contact,
    force: &[Id],
    sink: &mut Sink,
) {
    let pair = &lowering.model.pairs[contact.pair.0];
    let Ok(search) = number(lowering, &pair.search, parameters) else { return };
    let left = magnitude(lowering, parameters, force, search);
    let closer = (1..=HALVINGS).map(|k| search * 0.5_f64.powi(k));
    let largest = closer.map(|gap| magnitude(lowering, parameters, force, gap)).fold(left, f64::max);
    // Also where a law cannot be evaluated.
    if left.partial_cmp(&(LEFT * largest)).is_none_or(std::cmp::Ordering::is_le) {
        return;
    }
    let pressure = Dimension::named("Pressure").unwrap_or(Dimension::NUMBER);
    let unit = lowering.model.units.unit_of(pressure);
    let message = format!("this force does not vanish at the search distance: {left:.2e} {unit} are left");
    sink.push(
        Diagnostic::warning(Code::JumpAtSearch, contact.span, message)
            .here(format!("up to {largest:.2e} {unit} at smaller gaps, with the default parameters"))
            .label(pair.span, format!("`{}` ends there", pair.name))
            .help("points that come into reach feel a jump: let the law decay, or search further"),
    );
}

/// Size of a force at a gap.
fn magnitude(lowering: &Lowering<'_>, parameters: &[f64], force: &[Id], gap: f64) -> f64 {
    let values = eval(&lowering.pool, force, &|symbol| match lowering.symbols.kind(symbol) {
        SymbolKind::Parameter(param) => parameters.get(param.0).copied().unwrap_or(f64::NAN),
        SymbolKind::Gap(_) => gap,
        SymbolKind::PairNormal(_, axis) => NORMAL[axis],
        _ => 1.0,
    });
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
