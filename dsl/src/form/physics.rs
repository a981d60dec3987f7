//! The statements of the physics blocks.

use super::balance::{Balances, state_slopes};
use super::pair::{Contact, GapEnergy, PairLoad, gap_energy, pair_load};
use super::vary::{Origin, Term, Variation, linearise};
use super::{Builder, Coupling, Hold, TieOn, plane};
use crate::derive;
use crate::lower::{Lowered, Lowering, Region, SymbolKind, Value, internal, is_gradient, unsupported};
use crate::model::{BlockId, Domain, Expr, FieldId, PairId, Piece, Shape, Sides, Statement, StatementKind};
use crate::scalar::{Id, symbols_of};
use crate::source::Span;
use std::collections::BTreeSet;

/// What the blocks say.
#[derive(Default)]
pub(super) struct Physics {
    pub(super) terms: Vec<Term>,
    pub(super) holds: Vec<Hold>,
    pub(super) ties: Vec<TieOn>,
    pub(super) gap_energies: Vec<GapEnergy>,
    pub(super) pair_loads: Vec<PairLoad>,
    pub(super) couplings: Vec<Coupling>,
    /// Left minus right side of each equation, then the balances of states without one.
    pub(super) differences: Vec<(Id, Span)>,
    balances: Balances,
}

impl<'m> Builder<'m> {
    /// Lowers and varies all statements.
    pub(super) fn physics(&mut self) -> Physics {
        let mut physics = Physics { balances: Balances::new(self.lowering.model), ..Physics::default() };
        for (b, block) in self.lowering.model.blocks.iter().enumerate() {
            for statement in &block.statements {
                self.lowering.name_after(&block.name);
                self.attempt(|lowering| physics.statement(lowering, BlockId(b), statement));
            }
        }
        physics.differences.extend(std::mem::take(&mut physics.balances).finish());
        physics
    }
}

impl Physics {
    fn statement<'m>(
        &mut self,
        lowering: &mut Lowering<'m>,
        block: BlockId,
        statement: &'m Statement,
    ) -> Lowered<()> {
        let span = statement.span;
        match &statement.kind {
            StatementKind::Energy(density, Some(domain)) if let Some((pair, sides)) = surfaces(domain) => {
                if domain.current {
                    let what = "an energy of the gap is per reference area; write a load for a force per area as it has moved";
                    return Err(unsupported(domain.span, what));
                }
                let name = format!("{} energy", lowering.model.blocks[block.0].name);
                let contact = Contact { name, block, pair, sides, span };
                self.gap_energies.push(gap_energy(lowering, contact, density)?);
                Ok(())
            }
            StatementKind::Load(of, with, Some(domain)) if let Some((pair, sides)) = surfaces(domain) => {
                let name = format!("{} load", lowering.model.blocks[block.0].name);
                let contact = Contact { name, block, pair, sides, span };
                self.pair_loads.push(pair_load(lowering, contact, domain.current, (of, with))?);
                Ok(())
            }
            StatementKind::Energy(density, Some(domain)) => {
                self.integral(lowering, (block, "energy", span), domain, |lowering| {
                    let value = lowering.scalar_here(density)?;
                    let value = lowering.measured(value, domain.span)?;
                    let variation = Variation::of_density(lowering, value);
                    plane::integrand(lowering, density, variation.is_zero())?;
                    Ok(variation)
                })
            }
            StatementKind::Energy(energy, None) => self.lumped_energy(lowering, block, energy, span),
            StatementKind::Residual(residual, domain) => {
                self.integral(lowering, (block, "residual", span), domain, |lowering| {
                    let value = lowering.scalar_here(residual)?;
                    let value = lowering.measured(value, domain.span)?;
                    let variation = Variation::of_residual(lowering, value);
                    plane::integrand(lowering, residual, variation.is_zero())?;
                    Ok(variation)
                })
            }
            StatementKind::Load(of, with, Some(domain)) => {
                self.integral(lowering, (block, "load", span), domain, |lowering| {
                    let (quantity, force) = (lowering.components_here(of)?, lowering.components_here(with)?);
                    plane::load(lowering, (of, &quantity), (with, &force))?;
                    let force: Vec<Id> = force
                        .into_iter()
                        .map(|with| lowering.measured(with, domain.span))
                        .collect::<Lowered<_>>()?;
                    Ok(Variation::of_load(lowering, &quantity, &force))
                })
            }
            StatementKind::Load(of, with, None) => self.lumped_load(lowering, block, of, with, span),
            StatementKind::Hold(field, component, value, domain) => {
                self.hold(lowering, *field, *component, value, domain, span)
            }
            &StatementKind::Tie(tie, ref domain) => {
                let region =
                    Region::of(domain).ok_or_else(|| internal(domain.span, "`tie` on a contact pair"))?;
                self.ties.push(TieOn { tie, region, span });
                Ok(())
            }
            StatementKind::Equation(left, right) => {
                let (left_id, right_id) = (lowering.global_scalar(left)?, lowering.global_scalar(right)?);
                self.differences.push((lowering.pool.sub(left_id, right_id), span));
                Ok(())
            }
        }
    }

    /// A statement on cells or edges.
    fn integral<'m>(
        &mut self,
        lowering: &mut Lowering<'m>,
        (block, kind, span): (BlockId, &str, Span),
        domain: &Domain,
        vary: impl FnMut(&mut Lowering<'m>) -> Lowered<Variation>,
    ) -> Lowered<()> {
        if domain.pieces.iter().any(|piece| matches!(piece, Piece::Pair(..))) {
            let what = "only energies of the gap and loads can stand on a contact pair, one pair at a time";
            return Err(unsupported(domain.span, what));
        }
        for (region, variation) in lowering.in_configuration(domain, vary)? {
            if variation.is_zero() {
                continue;
            }
            for &(state, density) in &variation.states {
                self.balances.add_density(lowering, state, (&region, density), span);
            }
            let name = format!("{} {kind}", lowering.model.blocks[block.0].name);
            let term = linearise(lowering, Origin { name, block: Some(block), span }, region, variation);
            check(lowering, &term)?;
            if !term.tests.is_empty() {
                self.terms.push(term);
            }
        }
        Ok(())
    }

    fn lumped_energy<'m>(
        &mut self,
        lowering: &mut Lowering<'m>,
        block: BlockId,
        energy: &'m Expr,
        span: Span,
    ) -> Lowered<()> {
        let energy = lowering.global_scalar(energy)?;
        for (quantity, slopes) in quantity_slopes(lowering, &[energy]) {
            self.couplings.push(Coupling { block, quantity, coefficient: slopes[0], span });
        }
        for (state, slopes) in state_slopes(lowering, &[energy]) {
            self.balances.add(lowering, state, slopes[0]);
        }
        Ok(())
    }

    fn lumped_load<'m>(
        &mut self,
        lowering: &mut Lowering<'m>,
        block: BlockId,
        of: &'m Expr,
        with: &'m Expr,
        span: Span,
    ) -> Lowered<()> {
        let (quantity, force) = (lowering.global(of)?, lowering.global(with)?);
        let (quantity, force) =
            (quantity.components(&mut lowering.pool), force.components(&mut lowering.pool));
        plane::load(lowering, (of, &quantity), (with, &force))?;
        let (of, with) = (quantity, force);
        for (quantity, slopes) in quantity_slopes(lowering, &of) {
            let work = lowering.pool.dot(&with, &slopes);
            let coefficient = lowering.pool.neg(work);
            self.couplings.push(Coupling { block, quantity, coefficient, span });
        }
        for (state, slopes) in state_slopes(lowering, &of) {
            let work = lowering.pool.dot(&with, &slopes);
            let slope = lowering.pool.neg(work);
            self.balances.add(lowering, state, slope);
        }
        Ok(())
    }

    fn hold<'m>(
        &mut self,
        lowering: &mut Lowering<'m>,
        field: FieldId,
        component: Option<usize>,
        value: &'m Expr,
        domain: &Domain,
        span: Span,
    ) -> Lowered<()> {
        let region = Region::of(domain).ok_or_else(|| internal(domain.span, "`hold` on a contact pair"))?;
        let model = lowering.model;
        let parts = lowering.on_parts(&region, |lowering| lowering.components_here(value))?;
        let stored = match model.fields[field.0].shape {
            Shape::Scalar => vec![(0, 0)],
            _ => model.coordinates.frame.axes().into_iter().enumerate().collect(),
        };
        for (region, values) in parts {
            plane::field(lowering, (field, component), &values, span)?;
            for &(stored, axis) in &stored {
                let value = match (component, values.as_slice()) {
                    (Some(wanted), _) if wanted != axis => continue,
                    (_, [one]) => *one,
                    (_, many) => many[axis],
                };
                if symbols_of(&lowering.pool, &[value])
                    .iter()
                    .any(|&s| follows_fields(lowering.symbols.kind(s)))
                {
                    return Err(unsupported(
                        span,
                        "a held value cannot depend on fields or on means of fields",
                    ));
                }
                self.holds.push(Hold { field, component: stored, region: region.clone(), value, span });
            }
        }
        Ok(())
    }
}

/// Whether a symbol changes with the unknowns of the mesh.
fn follows_fields(kind: SymbolKind) -> bool {
    use SymbolKind as K;
    matches!(
        kind,
        K::Field(_)
            | K::FieldRate(_)
            | K::Frozen(_)
            | K::Quantity(_)
            | K::QuantityRate(_)
            | K::Gap(_)
            | K::PairNormal(..)
            | K::Table(_)
    )
}

/// The pair and the sides of it that a domain names, if it does.
fn surfaces(domain: &Domain) -> Option<(PairId, Sides)> {
    match domain.pieces.as_slice() {
        &[Piece::Pair(pair, sides)] => Some((pair, sides)),
        _ => None,
    }
}

/// Derivative of the roots by each quantity in them; time derivatives are varied like what they are derivatives of.
fn quantity_slopes(lowering: &mut Lowering<'_>, roots: &[Id]) -> Vec<(usize, Vec<Id>)> {
    let mut quantities: Vec<usize> = symbols_of(&lowering.pool, roots)
        .into_iter()
        .filter_map(|symbol| match lowering.symbols.kind(symbol) {
            SymbolKind::Quantity(k) | SymbolKind::QuantityRate(k) => Some(k),
            _ => None,
        })
        .collect();
    quantities.sort_unstable();
    quantities.dedup();
    quantities
        .into_iter()
        .map(|k| {
            let symbols = [SymbolKind::Quantity(k), SymbolKind::QuantityRate(k)]
                .map(|kind| lowering.symbols.symbol(kind));
            let one = lowering.pool.one();
            let rates: Vec<_> = symbols.into_iter().map(|symbol| (symbol, one)).collect();
            (k, derive::tangent(&mut lowering.pool, roots, &rates))
        })
        .collect()
}

/// Refuses what kernels cannot do.
pub(super) fn check(lowering: &Lowering<'_>, term: &Term) -> Lowered<()> {
    let symbols =
        symbols_of(&lowering.pool, &term.flux.iter().copied().chain(term.value).collect::<Vec<_>>());
    let kinds: Vec<SymbolKind> = symbols.into_iter().map(|symbol| lowering.symbols.kind(symbol)).collect();
    let gradient = |kind: &SymbolKind| match kind {
        SymbolKind::Normal(..) => true,
        SymbolKind::Field(input) | SymbolKind::FieldRate(input) => is_gradient(*input),
        _ => false,
    };
    let on_edges = matches!(term.region, Region::Edges(_));
    if on_edges && (kinds.iter().any(gradient) || term.tests.iter().any(|test| is_gradient(*test))) {
        return Err(unsupported(
            term.span,
            "gradients and normals out of regions in statements on paths are not supported; the derivative along the path is `along(e)`",
        ));
    }
    let homes: BTreeSet<_> = term.uses.iter().map(|&field| lowering.model.moving_home(field)).collect();
    if on_edges && homes.len() > 1 {
        let problem = "fields of a moving region and of bodies in one statement on a path are not supported";
        return Err(Box::new(
            unsupported(term.span, problem).help("`tie` the fields of the region to those of the bodies"),
        ));
    }
    let energy_of_quantity = term.block.is_some()
        && term.value.is_some()
        && kinds.iter().any(|kind| matches!(kind, SymbolKind::Quantity(_)));
    if energy_of_quantity {
        return Err(unsupported(
            term.span,
            "an energy density cannot contain a mean or an integral; use a `load`, or `frozen`",
        ));
    }
    Ok(())
}

impl<'m> Lowering<'m> {
    /// Components of a value at the current place, a literal 0 in the shape of its type.
    pub(super) fn components_here(&mut self, expr: &'m Expr) -> Lowered<Vec<Id>> {
        let value: Value = self.here(expr)?;
        Ok(value.components(&mut self.pool))
    }
}
