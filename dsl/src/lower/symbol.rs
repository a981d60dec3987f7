//! What the opaque symbols of the scalar stage stand for, and how emitted code calls them.

use std::collections::BTreeMap;

use crate::model::{FieldId, PairId, ParamId, StateId};
use crate::scalar::Symbol;

/// One scalar that a field offers at a point: a component, or its derivative by an in-plane coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub struct FieldInput {
    pub field: FieldId,
    /// Stored component: in-plane direction 0 or 1 of a vector, 0 of a scalar.
    pub component: usize,
    /// Which derivative; `None` for the value.
    pub derivative: Option<Derivative>,
}

/// By what a field is differentiated in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Derivative {
    /// By in-plane coordinate 0 or 1.
    Coordinate(usize),
    /// By the arc length of the reference path, in its direction.
    Along,
}

/// Meaning of a symbol. The order is the order in which code reads them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SymbolKind {
    /// A parameter.
    Parameter(ParamId),
    /// Reference measure of a domain, index into [`Lowering::measures`](super::Lowering::measures).
    Measure(usize),
    /// A number that depends on the region of the point, index into [`Lowering::tables`](super::Lowering::tables).
    Table(usize),
    /// Time.
    Time,
    /// A state.
    State(StateId),
    /// Its time derivative.
    StateRate(StateId),
    /// A scalar made from fields, index into [`Lowering::quantities`](super::Lowering::quantities).
    Quantity(usize),
    /// Its time derivative.
    QuantityRate(usize),
    /// In-plane coordinate of the reference point.
    Coordinate(usize),
    /// In-plane component of the unit tangent of the reference path.
    Tangent(usize),
    /// In-plane component of its curvature vector, the derivative of the tangent by the arc length.
    Curvature(usize),
    /// A field at the point.
    Field(FieldInput),
    /// Its time derivative.
    FieldRate(FieldInput),
    /// A field under `frozen`: held in the variation.
    Frozen(FieldInput),
    /// The test function of a field.
    Test(FieldInput),
    /// In-plane component (second number) of the unit normal out of regions: an index into [`Lowering::sides`](super::Lowering::sides).
    Normal(usize, usize),
    /// Gap of a contact pair at a surface point.
    Gap(PairId),
    /// In-plane component of the unit normal of the surface of a contact pair that the point is on.
    PairNormal(PairId, usize),
    /// Factor d rate / d value of the time integrator.
    Alpha,
    /// Quadrature weight times the measure at the point, `2 pi r` included.
    Weight,
    /// Truth of a comparison, 1 or 0, decided outside.
    Switch(usize),
    /// A value of a finished run, index into [`Lowering::run_values`](super::Lowering::run_values).
    Run(usize),
    /// A variable of a derivative or of a test's loop.
    Bound(usize),
    /// Time derivative of a bound variable.
    BoundRate(usize),
}

/// The table of symbols: each meaning has one symbol.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    kinds: Vec<SymbolKind>,
    symbols: BTreeMap<SymbolKind, Symbol>,
}

impl Symbols {
    /// The symbol with this meaning.
    pub fn symbol(&mut self, kind: SymbolKind) -> Symbol {
        *self.symbols.entry(kind).or_insert_with(|| {
            self.kinds.push(kind);
            Symbol(self.kinds.len() as u32 - 1)
        })
    }

    /// The symbol with this meaning, if it ever occurred.
    pub fn find(&self, kind: SymbolKind) -> Option<Symbol> {
        self.symbols.get(&kind).copied()
    }

    /// The meaning of a symbol of this table.
    pub fn kind(&self, symbol: Symbol) -> SymbolKind {
        self.kinds[symbol.0 as usize]
    }
}
