//! The equations of the states: residuals with their branches held from outside, and how large a residual is large.

use std::collections::BTreeMap;

use super::vary::{global_unknowns, rate_of};
use crate::derive;
use crate::eval::{defaults, number};
use crate::lower::{Lowering, SymbolKind};
use crate::model::{Expr, Model, Start, StateId};
use crate::scalar::{Binary, Id, Node, Relation, Symbol, Unary, eval, reachable, symbols_of};
use crate::source::Span;
use ansatz_units::Dimension;

/// `a == b`, as `(a - b)/size == 0`.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The residual, with [`SymbolKind::Switch`] for every comparison.
    pub residual: Id,
    /// Where it stands.
    pub span: Span,
}

/// The equations of the states.
#[derive(Clone, Debug, Default)]
pub struct StateSystem {
    /// As many as states.
    pub equations: Vec<Equation>,
    /// The comparison behind each switch.
    pub switches: Vec<(Relation, Id, Id)>,
}

impl StateSystem {
    /// From the differences of both sides.
    pub(super) fn new(lowering: &mut Lowering<'_>, differences: &[(Id, Span)]) -> StateSystem {
        let mut switches = Vec::new();
        let mut equations = Vec::new();
        for &(difference, span) in differences {
            let scale = 1.0 / characteristic_size(lowering, difference);
            let switched = held(lowering, difference, &mut switches);
            let scale = lowering.pool.constant(scale);
            equations.push(Equation { residual: lowering.pool.mul(scale, switched), span });
        }
        StateSystem { equations, switches }
    }

    /// The residuals.
    pub fn residuals(&self) -> Vec<Id> {
        self.equations.iter().map(|equation| equation.residual).collect()
    }

    /// Whether the rate of a state occurs.
    pub fn is_differential(&self, lowering: &Lowering<'_>, state: StateId) -> bool {
        let symbol = lowering.symbols.find(SymbolKind::StateRate(state));
        symbol.is_some_and(|symbol| symbols_of(&lowering.pool, &self.residuals()).contains(&symbol))
    }
}

/// Rebuilds an expression with a switch for every comparison, those of `min`, `max` and `abs` included.
fn held(lowering: &mut Lowering<'_>, root: Id, switches: &mut Vec<(Relation, Id, Id)>) -> Id {
    let mut images: BTreeMap<Id, Id> = BTreeMap::new();
    for id in reachable(&lowering.pool, &[root]) {
        let at = |x: Id| images.get(&x).copied().unwrap_or(x);
        let image = match lowering.pool.node(id) {
            Node::Const(_) | Node::Input(_) => id,
            Node::Unary(Unary::Abs, x) => {
                let (zero, y) = (lowering.pool.zero(), at(x));
                let negative = lowering.pool.neg(y);
                choose(lowering, switches, (Relation::LessEqual, zero, x), y, negative)
            }
            Node::Unary(op, x) => lowering.pool.unary(op, at(x)),
            Node::Binary(Binary::Min, x, y) => {
                choose(lowering, switches, (Relation::LessEqual, x, y), at(x), at(y))
            }
            Node::Binary(Binary::Max, x, y) => {
                choose(lowering, switches, (Relation::LessEqual, y, x), at(x), at(y))
            }
            Node::Binary(op, x, y) => lowering.pool.binary(op, at(x), at(y)),
            Node::Power(x, p) => lowering.pool.power(at(x), p),
            Node::Select { relation, lhs, rhs, then, otherwise } => {
                choose(lowering, switches, (relation, lhs, rhs), at(then), at(otherwise))
            }
        };
        images.insert(id, image);
    }
    images.get(&root).copied().unwrap_or(root)
}

/// `then` where the switch of the comparison is on: the comparison stays as it was written, without switches.
fn choose(
    lowering: &mut Lowering<'_>,
    switches: &mut Vec<(Relation, Id, Id)>,
    comparison: (Relation, Id, Id),
    then: Id,
    otherwise: Id,
) -> Id {
    let number = switches.iter().position(|known| *known == comparison).unwrap_or_else(|| {
        switches.push(comparison);
        switches.len() - 1
    });
    let (half, switch) = (lowering.pool.constant(0.5), lowering.input(SymbolKind::Switch(number)));
    lowering.pool.select(Relation::Less, half, switch, then, otherwise)
}

/// How large the terms of an equation are: the sum of `|d residual / d unknown|` times the size of each state and of each rate over the
/// run, with the default parameters, at the start of the states. 1 if that is no positive number.
fn characteristic_size(lowering: &mut Lowering<'_>, difference: Id) -> f64 {
    let values = Typical::new(lowering);
    let states = global_unknowns(lowering, &[difference])
        .into_iter()
        .filter(|kind| matches!(kind, SymbolKind::State(_)));
    let kinds: Vec<SymbolKind> = states.flat_map(|kind| [kind, rate_of(kind)]).collect();
    let symbols: Vec<Symbol> = kinds.iter().map(|&kind| lowering.symbols.symbol(kind)).collect();
    let slopes = derive::gradient(&mut lowering.pool, difference, &symbols);
    let slopes = eval(&lowering.pool, &slopes, &|symbol| values.of(lowering.symbols.kind(symbol)));
    let contribution = |(kind, slope): (&SymbolKind, f64)| match kind {
        SymbolKind::State(state) => slope.abs() * values.sizes[state.0],
        SymbolKind::StateRate(state) => slope.abs() * values.sizes[state.0] / values.duration,
        _ => 0.0,
    };
    let size: f64 = kinds.iter().zip(slopes).map(contribution).filter(|size| size.is_finite()).sum();
    if size > 0.0 { size } else { 1.0 }
}

/// Numbers to judge equations by.
struct Typical {
    parameters: Vec<f64>,
    starts: Vec<f64>,
    sizes: Vec<f64>,
    duration: f64,
}

impl Typical {
    fn new(lowering: &mut Lowering<'_>) -> Typical {
        let (parameters, model) = (defaults(lowering), lowering.model);
        let mut typical =
            Typical { parameters, starts: Vec::new(), sizes: Vec::new(), duration: f64::INFINITY };
        for state in &model.states {
            let (low, high) = match &state.bounds {
                Some((low, high)) => (typical.number(lowering, low), typical.number(lowering, high)),
                None => (f64::NAN, f64::NAN),
            };
            let start = match &state.start {
                Start::Value(value) | Start::Guess(value) => typical.number(lowering, value),
                Start::Solved => 0.5 * (low + high),
            };
            typical.starts.push(if start.is_finite() { start } else { 0.0 });
            let width = (high - low).abs();
            typical.sizes.push(if width.is_finite() {
                width
            } else {
                size_of_kind(model, state.dimension, &typical.parameters)
            });
        }
        if let Some((from, to)) = &model.solve.time {
            typical.duration = typical.number(lowering, to) - typical.number(lowering, from);
        }
        typical
    }

    fn number<'m>(&self, lowering: &mut Lowering<'m>, expr: &'m Expr) -> f64 {
        number(lowering, expr, &self.parameters).unwrap_or(f64::NAN)
    }

    fn of(&self, kind: SymbolKind) -> f64 {
        match kind {
            SymbolKind::Parameter(param) => self.parameters[param.0],
            SymbolKind::State(state) => self.starts[state.0],
            SymbolKind::Measure(_) => 1.0,
            _ => 0.0,
        }
    }
}

/// 1 for pure numbers, else the geometric mean of the parameters of this dimension.
pub fn size_of_kind(model: &Model, dimension: Dimension, parameters: &[f64]) -> f64 {
    if dimension.is_number() {
        return 1.0;
    }
    let alike = model.params.iter().zip(parameters).filter(|(param, _)| param.dimension == dimension);
    let logarithms: Vec<f64> = alike.map(|(_, value)| value.abs().ln()).filter(|l| l.is_finite()).collect();
    if logarithms.is_empty() { 1.0 } else { (logarithms.iter().sum::<f64>() / logarithms.len() as f64).exp() }
}
