//! How exactly an integral is integrated.
//!
//! Polynomials of moderate degree (masses, linear terms, quadratic convection) are integrated exactly on straight cells. Anything else
//! (`det(F)^(-2/3)`, `u_r/r`) would ask for ever more points without a gain over the discretisation error: with elements of order k it
//! gets a rule of degree 2k, which keeps the order of convergence; P2 hyperelasticity has 6 points. Edges are short and often curved:
//! they get degree 5, 3 points, which is exact for two quadratic functions and the weight r. Energies of derivatives along a path get degree 3, 2
//! points. There the derivatives of quadratic fields are most accurate, and a quadratic edge can be bent without being stretched, so that
//! thin shells do not lock (Zienkiewicz, Taylor, Too 1971); each of the strains still has a value at as many points as the rank asks for.

use crate::lower::{Derivative, FieldInput, Lowering, Region, SymbolKind};
use crate::model::{FieldId, Frame, Space};
use crate::scalar::degree::degree;
use crate::scalar::{Id, symbols_of};

/// Degree on edges.
const EDGE_DEGREE: usize = 5;
/// Degree on edges of energies with derivatives along them.
const CURVE_ENERGY_DEGREE: usize = 3;

/// Degree of the rule for an integrand `value`, which may be an energy, and fluxes against test functions.
pub(super) fn quadrature_degree(
    lowering: &Lowering<'_>,
    region: &Region,
    (value, is_energy): (Option<Id>, bool),
    tests: &[FieldInput],
    flux: &[Id],
) -> usize {
    if matches!(region, Region::Edges(_)) {
        let along = tests.iter().any(|test| test.derivative == Some(Derivative::Along));
        return if is_energy && along { CURVE_ENERGY_DEGREE } else { EDGE_DEGREE };
    }
    let of =
        |root| degree(&lowering.pool, root, &|symbol| symbol_degree(lowering, lowering.symbols.kind(symbol)));
    let works = flux.iter().zip(tests).map(|(&flux, &test)| of(flux) + input_degree(lowering, test));
    let integrand = if tests.is_empty() { value.map_or(0, of) } else { works.max().unwrap_or(0) };
    let weight = u32::from(lowering.model.coordinates.frame == Frame::Axisymmetric);
    let estimate = (integrand + weight) as usize;
    let roots: Vec<Id> = flux.iter().copied().chain(value).collect();
    let order = 2 * highest_order(lowering, tests, &roots);
    if estimate <= order + 2 { estimate } else { order.max(1) }
}

fn highest_order(lowering: &Lowering<'_>, tests: &[FieldInput], roots: &[Id]) -> usize {
    symbols_of(&lowering.pool, roots)
        .into_iter()
        .filter_map(|symbol| match lowering.symbols.kind(symbol) {
            SymbolKind::Field(input) | SymbolKind::FieldRate(input) => Some(input.field),
            _ => None,
        })
        .chain(tests.iter().map(|test| test.field))
        .map(|field| order_of(lowering, field))
        .max()
        .unwrap_or(1)
}

fn order_of(lowering: &Lowering<'_>, field: FieldId) -> usize {
    match lowering.model.fields[field.0].space {
        Space::P1 => 1,
        Space::P2 => 2,
    }
}

fn input_degree(lowering: &Lowering<'_>, input: FieldInput) -> u32 {
    (order_of(lowering, input.field) - usize::from(input.derivative.is_some())) as u32
}

fn symbol_degree(lowering: &Lowering<'_>, kind: SymbolKind) -> u32 {
    match kind {
        SymbolKind::Field(input) | SymbolKind::FieldRate(input) | SymbolKind::Frozen(input) => {
            input_degree(lowering, input)
        }
        SymbolKind::Coordinate(_) => 1,
        _ => 0,
    }
}
