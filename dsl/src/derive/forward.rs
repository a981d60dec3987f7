//! The chain rule from the inputs to the roots: all roots, one direction.

use crate::scalar::{Id, Node, Pool, Sweep, Symbol, reachable};

use super::rules::{carry, slopes};

/// Derivatives of the roots, in their order, when each symbol moves at the given rate; symbols not listed rest.
///
/// A symbol listed twice moves at its first rate.
pub fn tangent(pool: &mut Pool, roots: &[Id], rates: &[(Symbol, Id)]) -> Vec<Id> {
    let zero = pool.zero();
    let mut moves = Sweep::new(roots, zero);
    let mut moving = Vec::new();
    for id in reachable(pool, roots) {
        let rate = match pool.node(id) {
            Node::Input(symbol) => rates.iter().find(|(s, _)| *s == symbol).map_or(zero, |&(_, rate)| rate),
            _ => chain(pool, id, &moving, |x| moves.get(x)),
        };
        if rate != zero {
            moves.set(id, rate);
            moving.push(id);
        }
    }
    roots.iter().map(|&root| moves.get(root)).collect()
}

/// `sum_k (d node / d argument_k) rate(argument_k)`
fn chain(pool: &mut Pool, id: Id, moving: &[Id], rate: impl Fn(Id) -> Id) -> Id {
    let zero = pool.zero();
    slopes(pool, id, moving).into_iter().fold(zero, |total, (x, slope)| {
        let term = carry(pool, slope, rate(x));
        pool.add(total, term)
    })
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
