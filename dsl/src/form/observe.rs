//! Which scalars made from fields are rows of the system, and which are only looked at.
//!
//! A quantity that an equation, a load or an integral of the balance reads is a *functional*: its exact derivative takes part in every
//! Newton step. All others are *observables*, evaluated after a step. The rate of a functional is known to the time integrator; the rate
//! of an observable is the observable of the rate.

use std::collections::BTreeSet;

use super::output::PointForm;
use super::physics::{Physics, check};
use super::vary::{Origin, Term, Variation, linearise};
use super::{Builder, vary};
use crate::lower::{Lowered, Lowering, Part, QuantityKind, SymbolKind, unsupported};
use crate::scalar::{Id, substitute, symbols_of};

/// A quantity that is a row of the system.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Functional {
    /// Index into [`Lowering::quantities`].
    pub quantity: usize,
    pub kind: FunctionalKind,
}

/// How a functional is evaluated.
#[derive(Clone, Debug)]
pub enum FunctionalKind {
    /// Sum of integrals.
    Integral(Vec<Term>),
    /// At a point: the value, then its derivative by each input.
    Point([Id; 2], PointForm),
}

impl<'m> Builder<'m> {
    /// The quantities that the balance and the equations read, varied.
    pub(super) fn functionals(&mut self, physics: &Physics) -> Vec<Functional> {
        let mut roots: Vec<Id> = physics.differences.iter().map(|(difference, _)| *difference).collect();
        roots.extend(physics.couplings.iter().map(|coupling| coupling.coefficient));
        roots.extend(physics.pair_loads.iter().flat_map(|load| load.flux));
        roots.extend(physics.terms.iter().flat_map(|term| term.flux.iter().copied().chain(term.value)));
        let mut rows = quantities_in(&self.lowering, &roots);
        rows.extend(physics.couplings.iter().map(|coupling| coupling.quantity));
        rows.into_iter()
            .filter_map(|quantity| self.attempt(|lowering| functional(lowering, quantity)))
            .collect()
    }

    /// Quantities under the roots that are no functionals, with those that they read themselves, ascending: a quantity has a higher number
    /// than those it reads.
    pub(super) fn observables(&mut self, rows: &[usize], roots: &[Id]) -> Vec<usize> {
        let mut found = BTreeSet::new();
        let mut pending: Vec<usize> = quantities_in(&self.lowering, roots).into_iter().collect();
        while let Some(quantity) = pending.pop() {
            if !rows.contains(&quantity) && found.insert(quantity) {
                let densities = self.lowering.quantities[quantity].kind.densities();
                pending.extend(quantities_in(&self.lowering, &densities));
            }
        }
        found.into_iter().collect()
    }
}

/// Exchanges rates of observables for observables of rates.
pub(super) fn observed(lowering: &mut Lowering<'_>, rows: &[usize], root: Id) -> Lowered<Id> {
    let mut images = Vec::new();
    for symbol in symbols_of(&lowering.pool, &[root]) {
        match lowering.symbols.kind(symbol) {
            SymbolKind::QuantityRate(quantity) if !rows.contains(&quantity) => {
                images.push((symbol, rate_of_quantity(lowering, quantity)?));
            }
            _ => {}
        }
    }
    let image = |symbol| images.iter().find(|(s, _)| *s == symbol).map(|(_, id)| *id);
    Ok(substitute(&mut lowering.pool, &[root], &image)[0])
}

fn rate_of_quantity(lowering: &mut Lowering<'_>, quantity: usize) -> Lowered<Id> {
    let of = lowering.quantities[quantity].clone();
    let kind = match of.kind {
        QuantityKind::Integral(parts) => {
            let rated: Lowered<Vec<Part>> = parts
                .into_iter()
                .map(|part| Ok(Part { density: lowering.rate_of_scalar(part.density, of.span)?, ..part }))
                .collect();
            QuantityKind::Integral(rated?)
        }
        QuantityKind::Side(pieces, regions, value) => {
            QuantityKind::Side(pieces, regions, lowering.rate_of_scalar(value, of.span)?)
        }
        QuantityKind::Point(at, region, values) => {
            let rated: Lowered<Vec<Id>> =
                values.into_iter().map(|value| lowering.rate_of_scalar(value, of.span)).collect();
            QuantityKind::Point(at, region, rated?)
        }
        _ => {
            return Err(unsupported(
                of.span,
                "the rate of an extreme value or of a resultant is not supported",
            ));
        }
    };
    lowering.name_after(&format!("dt_{}", of.name));
    Ok(lowering.share_quantity(kind, of.dimension, of.span))
}

fn functional(lowering: &mut Lowering<'_>, quantity: usize) -> Lowered<Functional> {
    let of = lowering.quantities[quantity].clone();
    for symbol in symbols_of(&lowering.pool, &of.kind.densities()) {
        use SymbolKind as K;
        match lowering.symbols.kind(symbol) {
            K::FieldRate(_) => {
                return Err(unsupported(
                    of.span,
                    "an equation reads this; write the rate outside: `dt(mean(..))`",
                ));
            }
            K::State(_) | K::StateRate(_) | K::Quantity(_) | K::QuantityRate(_) | K::Time => {
                return Err(unsupported(
                    of.span,
                    "an equation reads this, so it may depend on fields and parameters only",
                ));
            }
            _ => {}
        }
    }
    let kind = match of.kind {
        QuantityKind::Integral(parts) => {
            let mut terms = Vec::new();
            for part in parts {
                let variation = Variation::of_density(lowering, part.density);
                let origin = Origin { name: of.name.clone(), block: None, span: of.span };
                let term = linearise(lowering, origin, part.region, variation);
                check(lowering, &term)?;
                terms.push(term);
            }
            FunctionalKind::Integral(terms)
        }
        QuantityKind::Point(at, region, values) => {
            let form =
                PointForm::new(lowering, &region, values.into_iter().map(|value| vec![value]).collect());
            FunctionalKind::Point(at, form.with_derivatives(lowering))
        }
        QuantityKind::Side(..) => {
            return Err(unsupported(of.span, "an equation cannot read gradients or normals on paths"));
        }
        QuantityKind::PairIntegral(..) => {
            return Err(unsupported(of.span, "an equation cannot read an integral over a contact pair"));
        }
        QuantityKind::Extreme(..) | QuantityKind::PairExtreme(..) | QuantityKind::Force(..) => {
            return Err(unsupported(of.span, "an equation cannot read an extreme value or a resultant"));
        }
    };
    Ok(Functional { quantity, kind })
}

fn quantities_in(lowering: &Lowering<'_>, roots: &[Id]) -> BTreeSet<usize> {
    vary::global_unknowns(lowering, roots)
        .into_iter()
        .filter_map(|kind| if let SymbolKind::Quantity(quantity) = kind { Some(quantity) } else { None })
        .collect()
}
