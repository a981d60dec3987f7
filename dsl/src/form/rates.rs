//! Which fields have a history: those whose rates the equations read. The others follow from them at every instant.

use std::collections::BTreeSet;

use super::Forms;
use super::observe::FunctionalKind;
use super::vary::Term;
use crate::lower::{Lowering, SymbolKind};
use crate::model::FieldId;
use crate::scalar::{Id, symbols_of};

impl Forms<'_> {
    /// Fields whose rates occur: in integrals, in equations of states as the rate of a functional, or as what another field is tied to.
    pub fn differential_fields(&self) -> BTreeSet<FieldId> {
        let of_functionals = self.functionals.iter().flat_map(|functional| match &functional.kind {
            FunctionalKind::Integral(terms) => terms.as_slice(),
            FunctionalKind::Point(..) => &[],
        });
        let mut roots: Vec<Id> = self.terms.iter().chain(of_functionals).flat_map(read_by).collect();
        roots.extend(self.couplings.iter().map(|coupling| coupling.coefficient));
        roots.extend(self.pair_loads.iter().flat_map(|load| load.flux));
        roots.extend(self.states.residuals());
        let mut found = fields_with_rates(&self.lowering, &roots);
        found.extend(self.ties.iter().filter(|on| on.tie.rate).map(|on| on.tie.partner));
        found
    }
}

fn read_by(term: &Term) -> impl Iterator<Item = Id> + '_ {
    term.flux.iter().copied().chain(term.value)
}

fn fields_with_rates(lowering: &Lowering<'_>, roots: &[Id]) -> BTreeSet<FieldId> {
    let mut found = BTreeSet::new();
    for symbol in symbols_of(&lowering.pool, roots) {
        match lowering.symbols.kind(symbol) {
            SymbolKind::FieldRate(input) => drop(found.insert(input.field)),
            SymbolKind::QuantityRate(quantity) => {
                let densities = lowering.quantities[quantity].kind.densities();
                found.extend(symbols_of(&lowering.pool, &densities).into_iter().filter_map(|symbol| {
                    match lowering.symbols.kind(symbol) {
                        SymbolKind::Field(input) => Some(input.field),
                        _ => None,
                    }
                }));
            }
            _ => {}
        }
    }
    found
}
