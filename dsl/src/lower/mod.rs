//! Stage 4 of 6: typed expressions become scalar expressions. Input: the checked [`Model`]. Output: [`Id`]s of one [`Pool`], whose symbols
//! are parameters, states, field values and gradients, coordinates. Knows no variation and no Rust.
//!
//! This is abstract interpretation: calls and lets are followed with components for values, so that every function is inlined and the
//! pool's sharing takes out what repeats. What a name means depends on the [`Place`]: at a point of cells a field is a symbol, in an
//! equation of states it can only occur inside a mean or an integral, which makes a [`Quantity`].

mod algebra;
mod condition;
mod configuration;
mod derivative;
mod expr;
mod names;
mod quantity;
mod reduce;
mod side;
mod symbol;
mod value;

use std::collections::BTreeMap;

use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Expr, FieldId, LetId, LocalId, Model, PairId, RegionId};
use crate::scalar::{Id, Pool};
use crate::source::Span;

pub use names::{input_name, names_for, piece_name, region_names, symbol_name};
pub use quantity::{Part, Quantity, QuantityKind, Region};
pub use reduce::RunValue;
pub(crate) use side::is_gradient;
pub use symbol::{Derivative, FieldInput, SymbolKind, Symbols};
pub use value::{Condition, Value};

/// What a lowering gives: a value, or what the compiler cannot do.
pub type Lowered<T> = Result<T, Box<Diagnostic>>;

/// Where an expression is evaluated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Nowhere in space: equations of states, parameters, outputs.
    Global,
    /// At a point of the cells of these regions.
    Cells(Vec<RegionId>),
    /// At a point of edges that bound these regions.
    Edges(Vec<RegionId>),
    /// At a surface point of a contact pair.
    Pair(PairId),
}

/// A number that depends on the region of a point: one value for each region of the domain.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Table {
    pub name: String,
    pub values: Vec<Id>,
}

/// Local names of the function or test that is being lowered.
#[derive(Clone, Debug, Default)]
struct Frame<'m> {
    values: BTreeMap<LocalId, Value>,
    lets: BTreeMap<LocalId, &'m Expr>,
    known: BTreeMap<(LocalId, u32), Value>,
}

/// The state of lowering: the pool with its symbols, and everything that expressions gave rise to.
#[derive(Debug)]
pub struct Lowering<'m> {
    /// The model.
    pub model: &'m Model,
    /// All scalar expressions.
    pub pool: Pool,
    /// Meaning of their symbols.
    pub symbols: Symbols,
    /// Scalars made from fields.
    pub quantities: Vec<Quantity>,
    /// Domains whose measure is used.
    pub measures: Vec<Region>,
    /// Regions out of which normals point, ascending.
    pub sides: Vec<Vec<RegionId>>,
    /// Numbers by region.
    pub tables: Vec<Table>,
    /// Values of finished runs that tests read.
    pub run_values: Vec<RunValue>,
    /// Names of scalars after what the model calls them: `det_F`, `C_rr`. For readers of emitted code.
    pub hints: BTreeMap<Id, String>,
    place: Place,
    /// The displacement of the current configuration in which one integrates; none in the reference configuration.
    moved_by: Option<FieldId>,
    frame: Frame<'m>,
    overrides: BTreeMap<LetId, Value>,
    known_lets: BTreeMap<(LetId, u32), Value>,
    frozen: bool,
    /// Number of the current place and overrides: what is known was found out in one epoch.
    epoch: u32,
    epochs: u32,
    bound: usize,
    /// Innermost named thing, to name quantities after.
    naming: String,
    split: bool,
}

impl<'m> Lowering<'m> {
    /// Starts with an empty pool, at no place.
    pub fn new(model: &'m Model) -> Self {
        Lowering {
            model,
            pool: Pool::new(),
            symbols: Symbols::default(),
            quantities: Vec::new(),
            measures: Vec::new(),
            sides: Vec::new(),
            tables: Vec::new(),
            run_values: Vec::new(),
            hints: BTreeMap::new(),
            place: Place::Global,
            moved_by: None,
            frame: Frame::default(),
            overrides: BTreeMap::new(),
            known_lets: BTreeMap::new(),
            frozen: false,
            epoch: 0,
            epochs: 0,
            bound: 0,
            naming: String::from("value"),
            split: false,
        }
    }

    /// Lowers an expression that is the same at all points of space.
    pub fn global(&mut self, expr: &'m Expr) -> Lowered<Value> {
        self.at(Place::Global, |lowering| lowering.expr(expr))
    }

    /// Lowers a scalar that is the same at all points of space.
    pub fn global_scalar(&mut self, expr: &'m Expr) -> Lowered<Id> {
        let value = self.global(expr)?;
        self.scalar(&value, expr.span)
    }

    /// Lowers an expression at the current place; a literal 0 gets the shape of its type.
    pub fn here(&mut self, expr: &'m Expr) -> Lowered<Value> {
        let value = self.expr(expr)?;
        Ok(self.shaped(value, &expr.ty))
    }

    /// Lowers a scalar at the current place.
    pub fn scalar_here(&mut self, expr: &'m Expr) -> Lowered<Id> {
        self.scalar_expr(expr)
    }

    /// Lowers a scalar at the surface points of a pair.
    pub fn scalar_on_pair(&mut self, expr: &'m Expr, pair: PairId) -> Lowered<Id> {
        self.at(Place::Pair(pair), |lowering| lowering.scalar_expr(expr))
    }

    /// Components of a value at the surface points of a pair, a literal 0 in the shape of its type.
    pub fn components_on_pair(&mut self, expr: &'m Expr, pair: PairId) -> Lowered<Vec<Id>> {
        let value = self.at(Place::Pair(pair), |lowering| lowering.here(expr))?;
        Ok(value.components(&mut self.pool))
    }

    /// Time derivative of a scalar.
    pub fn rate_of_scalar(&mut self, of: Id, span: Span) -> Lowered<Id> {
        let rate = self.rate(&Value::Scalar(of), span)?;
        self.scalar(&rate, span)
    }

    /// Lowers expressions at the points of a domain, once if regions differ in numbers only, else once for each region.
    pub fn on_parts<T>(
        &mut self,
        region: &Region,
        mut lower: impl FnMut(&mut Self) -> Lowered<T>,
    ) -> Lowered<Vec<(Region, T)>> {
        let outer = std::mem::replace(&mut self.split, false);
        let whole = self.at(self.place_of(region), &mut lower);
        let split = std::mem::replace(&mut self.split, outer);
        match region {
            Region::Cells(regions) if split => regions
                .iter()
                .map(|&one| Ok((Region::Cells(vec![one]), self.at(Place::Cells(vec![one]), &mut lower)?)))
                .collect(),
            _ => Ok(vec![(region.clone(), whole?)]),
        }
    }

    /// Names the quantities found from here on after `name`.
    pub fn name_after(&mut self, name: &str) {
        self.naming = name.to_owned();
    }

    /// What quantities are named after.
    fn naming(&self) -> &str {
        &self.naming
    }

    /// The value of a symbol with this meaning.
    pub fn input(&mut self, kind: SymbolKind) -> Id {
        let symbol = self.symbols.symbol(kind);
        self.pool.input(symbol)
    }

    /// The scalar behind a value.
    ///
    /// # Errors
    /// An internal error at `span` if it is none.
    pub fn scalar(&mut self, value: &Value, span: Span) -> Lowered<Id> {
        algebra::scalar(&mut self.pool, value).ok_or_else(|| internal(span, "a scalar was expected"))
    }

    /// Gives a local name a value, as loops of tests do.
    pub fn set_local(&mut self, local: LocalId, value: Value) {
        self.frame.values.insert(local, value);
        self.epoch = self.next_epoch();
    }

    /// Gives a local name an expression, as lets of tests do.
    pub fn set_local_let(&mut self, local: LocalId, expr: &'m Expr) {
        self.frame.lets.insert(local, expr);
    }

    /// A fresh variable.
    pub fn fresh(&mut self) -> Id {
        self.bound += 1;
        self.input(SymbolKind::Bound(self.bound - 1))
    }

    /// Runs `lower` at another place, and comes back.
    fn at<T>(&mut self, place: Place, lower: impl FnOnce(&mut Self) -> T) -> T {
        if place == self.place {
            return lower(self);
        }
        let epoch = self.next_epoch();
        let outer = (std::mem::replace(&mut self.place, place), std::mem::replace(&mut self.epoch, epoch));
        let result = lower(self);
        (self.place, self.epoch) = outer;
        result
    }

    fn next_epoch(&mut self) -> u32 {
        self.epochs += 1;
        self.epochs
    }

    /// The place that the points of a domain are at.
    fn place_of(&self, region: &Region) -> Place {
        match region {
            Region::Cells(regions) => Place::Cells(regions.clone()),
            Region::Edges(pieces) | Region::Ends(pieces) => Place::Edges(self.bounded_by(pieces)),
        }
    }
}

/// A state that a checked model excludes.
pub(crate) fn internal(span: Span, what: &str) -> Box<Diagnostic> {
    Box::new(Diagnostic::error(Code::Internal, span, format!("internal error while lowering: {what}")))
}

/// A construct that is valid and cannot be compiled.
pub(crate) fn unsupported(span: Span, what: impl Into<String>) -> Box<Diagnostic> {
    Box::new(Diagnostic::error(Code::Unsupported, span, what))
}
