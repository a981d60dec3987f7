//! The rule of variation: an integral becomes fluxes against test functions, and their derivatives by the unknowns.
//!
//! At a point, a field enters through scalars p: its components and their derivatives ([`FieldInput`]). The virtual work of a term is
//! `integral of sum_i f_i delta p_i`, with the flux `f_i = dW/dp_i` of an energy, `-f . dq/dp_i` of a load, `dR/d(test p_i)` of a
//! residual. Its tangent is `D_ij = df_i/dp_j + alpha df_i/d(rate p_j)`.

use std::collections::BTreeSet;

use super::balance::state_slopes;
use super::degree::quadrature_degree;
use crate::derive::{self, Symmetry, is_symmetric};
use crate::lower::{FieldInput, Lowering, Region, SymbolKind};
use crate::model::{BlockId, FieldId, StateId};
use crate::scalar::{Id, Symbol, substitute, symbols_of};
use crate::source::Span;

/// An integral over cells or edges with its variation and tangent, in scalars at a point. The measure's weight is not in it.
#[derive(Clone, Debug)]
pub struct Term {
    /// Such as `elasticity energy`.
    pub name: String,
    /// Physics block it stands in; `None` for means and integrals.
    pub block: Option<BlockId>,
    /// Where it stands.
    pub span: Span,
    /// Where it is integrated.
    pub region: Region,
    /// Fields whose unknowns it uses, ascending.
    pub uses: Vec<FieldId>,
    /// The integrand, where it is an energy or a functional.
    pub value: Option<Id>,
    /// What is varied, ascending.
    pub tests: Vec<FieldInput>,
    /// Flux of each test.
    pub flux: Vec<Id>,
    /// What the fluxes depend on, ascending.
    pub trials: Vec<FieldInput>,
    /// `tangent[i][j]`: derivative of flux i by trial j.
    pub tangent: Vec<Vec<Id>>,
    /// Whether `tangent` is a symmetric matrix over the same tests and trials.
    pub symmetric: bool,
    /// Derivative of the fluxes by states and quantities.
    pub globals: Vec<(SymbolKind, Vec<Id>)>,
    /// Polynomial degree that the quadrature integrates exactly.
    pub degree: usize,
}

/// The fluxes of a term before it is differentiated again.
#[derive(Clone, Debug, Default)]
pub(super) struct Variation {
    pub(super) value: Option<Id>,
    /// Whether the flux is the whole gradient of the value, so that the tangent is its Hessian.
    is_gradient: bool,
    pub(super) tests: Vec<FieldInput>,
    pub(super) flux: Vec<Id>,
    /// Density of the derivative by each state.
    pub(super) states: Vec<(StateId, Id)>,
}

impl Variation {
    /// Of an energy or functional density.
    pub(super) fn of_density(lowering: &mut Lowering<'_>, density: Id) -> Variation {
        let (tests, symbols) = inputs(lowering, &[density], |kind| match kind {
            SymbolKind::Field(input) => Some(input),
            _ => None,
        });
        let flux = derive::gradient(&mut lowering.pool, density, &symbols);
        let is_gradient = !symbols_of(&lowering.pool, &[density]).into_iter().any(|symbol| {
            matches!(lowering.symbols.kind(symbol), SymbolKind::Frozen(_) | SymbolKind::FieldRate(_))
        });
        let states = state_slopes(lowering, &[density])
            .into_iter()
            .map(|(state, slopes)| (state, slopes[0]))
            .collect();
        Variation { value: Some(density), is_gradient, tests, flux, states }.cleaned(lowering)
    }

    /// Of the virtual work `-f . delta q`. Time derivatives in `q` are varied like what they are derivatives of (virtual power).
    pub(super) fn of_load(lowering: &mut Lowering<'_>, quantity: &[Id], load: &[Id]) -> Variation {
        let mut variation = Variation::default();
        for make in [SymbolKind::Field, SymbolKind::FieldRate] {
            let (tests, symbols) = inputs(lowering, quantity, |kind| match kind {
                SymbolKind::Field(input) | SymbolKind::FieldRate(input) if kind == make(input) => Some(input),
                _ => None,
            });
            for (test, symbol) in tests.into_iter().zip(symbols) {
                let slopes = derive::derivative(&mut lowering.pool, quantity, symbol);
                let work = lowering.pool.dot(load, &slopes);
                let flux = lowering.pool.neg(work);
                variation.add(lowering, test, flux);
            }
        }
        for (state, slopes) in state_slopes(lowering, quantity) {
            let work = lowering.pool.dot(load, &slopes);
            variation.states.push((state, lowering.pool.neg(work)));
        }
        variation.cleaned(lowering)
    }

    /// Of a weak form, linear in test functions.
    pub(super) fn of_residual(lowering: &mut Lowering<'_>, residual: Id) -> Variation {
        let (tests, symbols) = inputs(lowering, &[residual], |kind| match kind {
            SymbolKind::Test(input) => Some(input),
            _ => None,
        });
        let flux = derive::gradient(&mut lowering.pool, residual, &symbols);
        Variation { tests, flux, ..Variation::default() }.cleaned(lowering)
    }

    /// Whether nothing is left of it.
    pub(super) fn is_zero(&self) -> bool {
        self.tests.is_empty() && self.value.is_none() && self.states.is_empty()
    }

    fn add(&mut self, lowering: &mut Lowering<'_>, test: FieldInput, flux: Id) {
        match self.tests.binary_search(&test) {
            Ok(i) => self.flux[i] = lowering.pool.add(self.flux[i], flux),
            Err(i) => {
                self.tests.insert(i, test);
                self.flux.insert(i, flux);
            }
        }
    }

    /// Thaws what was frozen and drops what is zero.
    fn cleaned(mut self, lowering: &mut Lowering<'_>) -> Variation {
        self.value = self.value.map(|value| thaw(lowering, &[value])[0]);
        let flux = thaw(lowering, &self.flux);
        let kept: Vec<(FieldInput, Id)> = self
            .tests
            .into_iter()
            .zip(flux)
            .filter(|(_, flux)| lowering.pool.as_constant(*flux) != Some(0.0))
            .collect();
        (self.tests, self.flux) = kept.into_iter().unzip();
        self.value = self.value.filter(|value| lowering.pool.as_constant(*value) != Some(0.0));
        self
    }
}

/// What a term is called and where it stands.
pub(super) struct Origin {
    pub(super) name: String,
    pub(super) block: Option<BlockId>,
    pub(super) span: Span,
}

/// Differentiates a variation by fields, states and quantities.
pub(super) fn linearise(
    lowering: &mut Lowering<'_>,
    origin: Origin,
    region: Region,
    variation: Variation,
) -> Term {
    let Variation { value, is_gradient, tests, flux, .. } = variation;
    let (trials, tangent) = match value.filter(|_| is_gradient) {
        Some(value) => hessian(lowering, value, &tests),
        None => tangent(lowering, &flux),
    };
    let roots: Vec<Id> = flux.iter().copied().chain(value).collect();
    let uses: BTreeSet<FieldId> = symbols_of(&lowering.pool, &roots)
        .into_iter()
        .filter_map(|symbol| match lowering.symbols.kind(symbol) {
            SymbolKind::Field(input) | SymbolKind::FieldRate(input) => Some(input.field),
            _ => None,
        })
        .chain(tests.iter().map(|test| test.field))
        .collect();
    let entries: Vec<Id> = tangent.iter().flatten().copied().collect();
    let symmetric = tests == trials && is_symmetric(&lowering.pool, &entries) != Symmetry::None;
    let globals = global_derivatives(lowering, &flux);
    let Origin { name, block, span } = origin;
    let is_energy = value.is_some() && block.is_some();
    let degree = quadrature_degree(lowering, &region, (value, is_energy), &tests, &flux);
    let uses = uses.into_iter().collect();
    Term { name, block, span, region, uses, value, tests, flux, trials, tangent, symmetric, globals, degree }
}

/// Trials and second derivatives of an energy; no trials where all are zero.
fn hessian(lowering: &mut Lowering<'_>, energy: Id, tests: &[FieldInput]) -> (Vec<FieldInput>, Vec<Vec<Id>>) {
    let symbols: Vec<Symbol> =
        tests.iter().map(|&test| lowering.symbols.symbol(SymbolKind::Field(test))).collect();
    let triangle = derive::hessian(&mut lowering.pool, energy, &symbols);
    if triangle.iter().all(|&entry| lowering.pool.as_constant(entry) == Some(0.0)) {
        return (Vec::new(), vec![Vec::new(); tests.len()]);
    }
    let at = |i: usize, j: usize| triangle[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
    let rows = (0..tests.len()).map(|i| (0..tests.len()).map(|j| at(i, j)).collect()).collect();
    (tests.to_vec(), rows)
}

/// Trials, and the derivative of each flux by each of them; trials on which nothing depends are left out.
fn tangent(lowering: &mut Lowering<'_>, flux: &[Id]) -> (Vec<FieldInput>, Vec<Vec<Id>>) {
    let used: BTreeSet<FieldInput> = symbols_of(&lowering.pool, flux)
        .into_iter()
        .filter_map(|symbol| match lowering.symbols.kind(symbol) {
            SymbolKind::Field(input) | SymbolKind::FieldRate(input) => Some(input),
            _ => None,
        })
        .collect();
    let mut trials = Vec::new();
    let mut columns = Vec::new();
    for input in used {
        let column = with_rate(lowering, flux, SymbolKind::Field(input), SymbolKind::FieldRate(input));
        if column.iter().any(|&entry| lowering.pool.as_constant(entry) != Some(0.0)) {
            trials.push(input);
            columns.push(column);
        }
    }
    let rows = (0..flux.len()).map(|i| columns.iter().map(|column| column[i]).collect()).collect();
    (trials, rows)
}

/// An integral that nobody varies.
pub(super) fn plain(lowering: &mut Lowering<'_>, origin: Origin, region: Region, density: Id) -> Term {
    let density = thaw(lowering, &[density])[0];
    let variation = Variation { value: Some(density), ..Variation::default() };
    linearise(lowering, origin, region, variation)
}

/// `d root / d value + alpha d root / d rate` of every root.
pub(super) fn with_rate(
    lowering: &mut Lowering<'_>,
    roots: &[Id],
    value: SymbolKind,
    rate: SymbolKind,
) -> Vec<Id> {
    let (value, rate) = (lowering.symbols.symbol(value), lowering.symbols.symbol(rate));
    let alpha = lowering.input(SymbolKind::Alpha);
    let by_value = derive::derivative(&mut lowering.pool, roots, value);
    let by_rate = derive::derivative(&mut lowering.pool, roots, rate);
    by_value
        .into_iter()
        .zip(by_rate)
        .map(|(a, b)| {
            let b = lowering.pool.mul(alpha, b);
            lowering.pool.add(a, b)
        })
        .collect()
}

/// States and quantities on which the roots depend (also through a rate), ascending.
pub(super) fn global_unknowns(lowering: &Lowering<'_>, roots: &[Id]) -> BTreeSet<SymbolKind> {
    symbols_of(&lowering.pool, roots)
        .into_iter()
        .filter_map(|symbol| match lowering.symbols.kind(symbol) {
            kind @ (SymbolKind::State(_) | SymbolKind::Quantity(_)) => Some(kind),
            SymbolKind::StateRate(state) => Some(SymbolKind::State(state)),
            SymbolKind::QuantityRate(quantity) => Some(SymbolKind::Quantity(quantity)),
            _ => None,
        })
        .collect()
}

/// The meaning of the time derivative of a state or quantity.
pub(super) fn rate_of(kind: SymbolKind) -> SymbolKind {
    match kind {
        SymbolKind::State(state) => SymbolKind::StateRate(state),
        SymbolKind::Quantity(quantity) => SymbolKind::QuantityRate(quantity),
        other => other,
    }
}

fn global_derivatives(lowering: &mut Lowering<'_>, flux: &[Id]) -> Vec<(SymbolKind, Vec<Id>)> {
    global_unknowns(lowering, flux)
        .into_iter()
        .map(|kind| (kind, with_rate(lowering, flux, kind, rate_of(kind))))
        .collect()
}

/// The field inputs under the roots that `select` picks, ascending, with their symbols.
fn inputs(
    lowering: &Lowering<'_>,
    roots: &[Id],
    select: impl Fn(SymbolKind) -> Option<FieldInput>,
) -> (Vec<FieldInput>, Vec<Symbol>) {
    let mut found: Vec<(FieldInput, Symbol)> = symbols_of(&lowering.pool, roots)
        .into_iter()
        .filter_map(|symbol| select(lowering.symbols.kind(symbol)).map(|input| (input, symbol)))
        .collect();
    found.sort_unstable();
    found.into_iter().unzip()
}

/// Puts fields in the place of their frozen twins.
pub(super) fn thaw(lowering: &mut Lowering<'_>, roots: &[Id]) -> Vec<Id> {
    let frozen: Vec<(Symbol, Id)> = symbols_of(&lowering.pool, roots)
        .into_iter()
        .filter_map(|symbol| match lowering.symbols.kind(symbol) {
            SymbolKind::Frozen(input) => Some((symbol, lowering.input(SymbolKind::Field(input)))),
            _ => None,
        })
        .collect();
    let image = |symbol| frozen.iter().find(|(s, _)| *s == symbol).map(|(_, id)| *id);
    substitute(&mut lowering.pool, roots, &image)
}
