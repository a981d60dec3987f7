//! Statements on contact pairs: energies of the gap, whose law is differentiated twice by it, and loads on the points of the surfaces, whose
//! force is differentiated by all that it reads.

use super::plane;
use super::vary::{Variation, global_unknowns, rate_of, with_rate};
use crate::derive;
use crate::lower::{Lowered, Lowering, SymbolKind, unsupported};
use crate::model::{BlockId, Expr, FieldId, PairId, Sides};
use crate::scalar::{Id, symbols_of};
use crate::source::Span;

/// Where a statement on a pair stands, and on what.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Contact {
    pub name: String,
    pub block: BlockId,
    pub pair: PairId,
    pub sides: Sides,
    pub span: Span,
}

/// An energy of the gap of a pair, per reference area.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct GapEnergy {
    pub contact: Contact,
    /// The energy and its first and second derivative by the gap.
    pub law: [Id; 3],
}

/// Virtual work at the points of the surfaces of a pair, with the components of the displacement.
#[derive(Clone, Debug)]
pub struct PairLoad {
    /// Where it stands.
    pub contact: Contact,
    /// Per area as it has moved, else per reference area.
    pub current: bool,
    /// Flux against each component of the displacement.
    pub flux: [Id; 2],
    /// Its derivative by the gap.
    pub by_gap: [Id; 2],
    /// Its derivative by each component of the normal.
    pub by_normal: [[Id; 2]; 2],
    /// Its derivative by states and quantities, rates included.
    pub globals: Vec<(SymbolKind, [Id; 2])>,
}

/// The energy of a gap with its derivatives.
pub(super) fn gap_energy<'m>(
    lowering: &mut Lowering<'m>,
    contact: Contact,
    density: &'m Expr,
) -> Lowered<GapEnergy> {
    let energy = lowering.scalar_on_pair(density, contact.pair)?;
    lowering.without_fields(&[energy], density.span)?;
    for symbol in symbols_of(&lowering.pool, &[energy]) {
        use SymbolKind as K;
        match lowering.symbols.kind(symbol) {
            K::State(_) | K::StateRate(_) | K::Quantity(_) | K::QuantityRate(_) => {
                let what = "an energy of the gap cannot depend on states or functionals; write it as a load";
                return Err(unsupported(density.span, what));
            }
            K::PairNormal(..) => {
                let what = "an energy on a pair depends on the gap, not on the normal; write it as a load";
                return Err(unsupported(density.span, what));
            }
            _ => {}
        }
    }
    let gap = lowering.symbols.symbol(SymbolKind::Gap(contact.pair));
    let force = derive::derivative(&mut lowering.pool, &[energy], gap)[0];
    let stiffness = derive::derivative(&mut lowering.pool, &[force], gap)[0];
    Ok(GapEnergy { contact, law: [energy, force, stiffness] })
}

/// A load on the displacement at the points of a pair, with its derivatives.
pub(super) fn pair_load<'m>(
    lowering: &mut Lowering<'m>,
    contact: Contact,
    current: bool,
    (of, with): (&'m Expr, &'m Expr),
) -> Lowered<PairLoad> {
    let displacement = lowering.displacement_of(contact.pair)?;
    let quantity = lowering.components_on_pair(of, contact.pair)?;
    let force = lowering.components_on_pair(with, contact.pair)?;
    plane::load(lowering, (of, &quantity), (with, &force))?;
    let variation = Variation::of_load(lowering, &quantity, &force);
    let flux = flux_on(lowering, displacement, &variation, of.span)?;
    lowering.without_fields(&flux, with.span)?;
    let pair = contact.pair;
    let mut by = |kind: SymbolKind| {
        let symbol = lowering.symbols.symbol(kind);
        both(derive::derivative(&mut lowering.pool, &flux, symbol))
    };
    let by_gap = by(SymbolKind::Gap(pair));
    let by_normal = [0, 1].map(|axis| by(SymbolKind::PairNormal(pair, axis)));
    let globals = global_unknowns(lowering, &flux)
        .into_iter()
        .map(|kind| (kind, both(with_rate(lowering, &flux, kind, rate_of(kind)))))
        .collect();
    Ok(PairLoad { contact, current, flux, by_gap, by_normal, globals })
}

/// The flux against the components of the displacement, on nothing else.
fn flux_on(
    lowering: &mut Lowering<'_>,
    displacement: FieldId,
    variation: &Variation,
    span: Span,
) -> Lowered<[Id; 2]> {
    let mut flux = [lowering.pool.zero(); 2];
    let works = |test: &crate::lower::FieldInput| test.field == displacement && test.derivative.is_none();
    if !variation.states.is_empty() || !variation.tests.iter().all(works) {
        let name = &lowering.model.fields[displacement.0].name;
        let what = format!("a load on a contact pair works on `{name}`, which moves its surfaces, only");
        return Err(unsupported(span, what));
    }
    for (test, &of) in variation.tests.iter().zip(&variation.flux) {
        flux[test.component] = of;
    }
    Ok(flux)
}

fn both(values: Vec<Id>) -> [Id; 2] {
    [values[0], values[1]]
}
