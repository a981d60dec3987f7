//! The arena of scalar expressions: every distinct node exists once and refers to older nodes only.
//!
//! Constructors that simplify are in `build.rs`; this file only stores.

use std::collections::HashMap;
use std::hash::{Hash, Hasher};

use super::{Binary, Rational, Relation, Unary};

/// A node of a [`Pool`]. Ids grow in order of creation, so a node's id exceeds those of its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Id(u32);

impl Id {
    /// Position in the pool.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An input; the caller gives it meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Symbol(pub u32);

/// One operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Node {
    /// A number.
    Const(f64),
    /// The value of a symbol.
    Input(Symbol),
    /// A function of one argument.
    Unary(Unary, Id),
    /// A function of two arguments.
    Binary(Binary, Id, Id),
    /// A constant power; NaN for a negative base unless the exponent is an integer.
    Power(Id, Rational),
    /// `then` where `lhs relation rhs` holds, `otherwise` elsewhere.
    #[allow(missing_docs)]
    Select { relation: Relation, lhs: Id, rhs: Id, then: Id, otherwise: Id },
}

impl Node {
    /// Arguments, in order.
    pub fn arguments(&self) -> impl DoubleEndedIterator<Item = Id> + use<> {
        let list = match *self {
            Node::Const(_) | Node::Input(_) => [None; 4],
            Node::Unary(_, x) | Node::Power(x, _) => [Some(x), None, None, None],
            Node::Binary(_, x, y) => [Some(x), Some(y), None, None],
            Node::Select { lhs, rhs, then, otherwise, .. } => {
                [Some(lhs), Some(rhs), Some(then), Some(otherwise)]
            }
        };
        list.into_iter().flatten()
    }

    /// Value of the node from the values of its arguments and of the symbols.
    pub fn value(&self, argument: impl Fn(Id) -> f64, symbol: impl Fn(Symbol) -> f64) -> f64 {
        match *self {
            Node::Const(c) => c,
            Node::Input(s) => symbol(s),
            Node::Unary(op, x) => op.value(argument(x)),
            Node::Binary(op, x, y) => op.value(argument(x), argument(y)),
            Node::Power(x, p) => p.power(argument(x)),
            Node::Select { relation, lhs, rhs, then, otherwise } => {
                let holds = relation.holds(argument(lhs), argument(rhs));
                argument(if holds { then } else { otherwise })
            }
        }
    }

    /// Cost in additions.
    pub fn cost(&self) -> u32 {
        match self {
            Node::Const(_) | Node::Input(_) => 0,
            Node::Unary(op, _) => op.cost(),
            Node::Binary(op, ..) => op.cost(),
            Node::Power(_, p) => p.cost(),
            Node::Select { .. } => 2,
        }
    }
}

// A NaN constant differs from itself and so is never shared; every other node obeys `Eq`.
impl Eq for Node {}

impl Hash for Node {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::mem::discriminant(self).hash(state);
        match self {
            Node::Const(c) => c.to_bits().hash(state),
            Node::Input(s) => s.hash(state),
            Node::Unary(op, x) => (op, x).hash(state),
            Node::Binary(op, x, y) => (op, x, y).hash(state),
            Node::Power(x, p) => (x, p).hash(state),
            Node::Select { relation, lhs, rhs, then, otherwise } => {
                (relation, lhs, rhs, then, otherwise).hash(state)
            }
        }
    }
}

/// Hash-consed scalar expressions: equal nodes have equal ids.
///
/// The same calls in the same order give the same ids, in every process.
#[derive(Clone, Debug, Default)]
pub struct Pool {
    nodes: Vec<Node>,
    ids: HashMap<Node, Id>,
}

impl Pool {
    /// An empty pool.
    pub fn new() -> Pool {
        Pool::default()
    }

    /// The node behind `id`, which must be of this pool.
    pub fn node(&self, id: Id) -> Node {
        self.nodes[id.index()]
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no node yet.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The value of a constant node.
    pub fn as_constant(&self, id: Id) -> Option<f64> {
        match self.node(id) {
            Node::Const(c) => Some(c),
            _ => None,
        }
    }

    /// The id of exactly this node, without simplification.
    pub(super) fn intern(&mut self, node: Node) -> Id {
        let next = Id(self.nodes.len() as u32);
        let id = *self.ids.entry(node).or_insert(next);
        if id == next {
            self.nodes.push(node);
        }
        id
    }
}
