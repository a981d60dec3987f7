//! States that no equation owns: each has the balance of the energies and loads in which it occurs.
//!
//! The variation of a state s gives the equation `sum of dW/ds - f . dq/ds = 0`. Densities contribute through their integral, which so
//! becomes a functional.

use std::collections::{BTreeMap, BTreeSet};

use crate::check::dae::{Owner, owners};
use crate::derive;
use crate::lower::{Lowering, Part, QuantityKind, Region, SymbolKind};
use crate::model::{Model, StateId};
use crate::scalar::{Id, symbols_of};
use crate::source::Span;
use ansatz_units::Dimension;

/// Energy in the order of base dimensions.
const ENERGY: Dimension = Dimension::of([2, 1, -2, 0, 0, 0]);

/// The balances in the making, of the states that no equation owns.
#[derive(Debug, Default)]
pub(super) struct Balances {
    sums: BTreeMap<StateId, (Option<Id>, Span)>,
}

impl Balances {
    /// Empty balances of a model.
    pub(super) fn new(model: &Model) -> Balances {
        let owned = owners(model).into_iter().enumerate();
        let sums = owned
            .filter(|(_, owner)| *owner == Owner::Energy)
            .map(|(state, _)| (StateId(state), (None, model.states[state].span)));
        Balances { sums: sums.collect() }
    }

    /// Adds the derivative of an energy or load by a state, if the state has a balance.
    pub(super) fn add(&mut self, lowering: &mut Lowering<'_>, state: StateId, slope: Id) {
        if let Some((sum, _)) = self.sums.get_mut(&state) {
            *sum = Some(sum.map_or(slope, |sum| lowering.pool.add(sum, slope)));
        }
    }

    /// Adds the integral of a density of such a derivative.
    pub(super) fn add_density(
        &mut self,
        lowering: &mut Lowering<'_>,
        state: StateId,
        (region, density): (&Region, Id),
        span: Span,
    ) {
        if self.sums.contains_key(&state) && lowering.pool.as_constant(density) != Some(0.0) {
            let definition = &lowering.model.states[state.0];
            lowering.name_after(&format!("balance_{}", definition.name));
            let kind = QuantityKind::Integral(vec![Part { region: region.clone(), density }]);
            let integral = lowering.share_quantity(kind, ENERGY / definition.dimension, span);
            self.add(lowering, state, integral);
        }
    }

    /// The balances as differences that are zero.
    pub(super) fn finish(self) -> Vec<(Id, Span)> {
        self.sums.into_values().filter_map(|(sum, span)| sum.map(|sum| (sum, span))).collect()
    }
}

/// Derivative of the roots by each state in them; time derivatives are varied like what they are derivatives of.
pub(super) fn state_slopes(lowering: &mut Lowering<'_>, roots: &[Id]) -> Vec<(StateId, Vec<Id>)> {
    let states: BTreeSet<StateId> = symbols_of(&lowering.pool, roots)
        .into_iter()
        .filter_map(|symbol| match lowering.symbols.kind(symbol) {
            SymbolKind::State(state) | SymbolKind::StateRate(state) => Some(state),
            _ => None,
        })
        .collect();
    let slopes = states.into_iter().map(|state| {
        let one = lowering.pool.one();
        let moving = [SymbolKind::State(state), SymbolKind::StateRate(state)]
            .map(|kind| (lowering.symbols.symbol(kind), one));
        (state, derive::tangent(&mut lowering.pool, roots, &moving))
    });
    slopes.collect()
}
