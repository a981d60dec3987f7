//! The chain rule from the inputs to the roots: all roots, one direction.

use crate::scalar::{Id, Node, Pool, Symbol, reachable};

use super::rules::partial;

/// Derivatives of the roots, in their order, when each symbol moves at the given rate; symbols not listed rest.
///
/// A symbol listed twice moves at its first rate.
pub fn tangent(pool: &mut Pool, roots: &[Id], rates: &[(Symbol, Id)]) -> Vec<Id> {
    let zero = pool.zero();
    let size = roots.iter().map(|id| id.index() + 1).max().unwrap_or(0);
    let mut moves = vec![zero; size];
    for id in reachable(pool, roots) {
        let node = pool.node(id);
        moves[id.index()] = match node {
            Node::Input(symbol) => rates.iter().find(|(s, _)| *s == symbol).map_or(zero, |&(_, rate)| rate),
            _ => chain(pool, id, &node, |x| moves[x.index()], zero),
        };
    }
    roots.iter().map(|root| moves[root.index()]).collect()
}

/// `sum_k (d node / d argument_k) rate(argument_k)`
fn chain(pool: &mut Pool, id: Id, node: &Node, rate: impl Fn(Id) -> Id, zero: Id) -> Id {
    let mut total = zero;
    for (place, argument) in node.arguments().enumerate() {
        let rate = rate(argument);
        if rate != zero {
            let slope = partial(pool, id, place);
            let term = pool.mul(slope, rate);
            total = pool.add(total, term);
        }
    }
    total
}

/// Derivatives of the roots, in their order, with respect to one symbol.
pub fn derivative(pool: &mut Pool, roots: &[Id], symbol: Symbol) -> Vec<Id> {
    let one = pool.one();
    tangent(pool, roots, &[(symbol, one)])
}

/// Directional derivative of one root: `sum_i (d root / d symbol_i) direction_i`.
pub fn along(pool: &mut Pool, root: Id, direction: &[(Symbol, Id)]) -> Id {
    tangent(pool, &[root], direction)[0]
}
