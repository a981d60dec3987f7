//! The chain rule from one root to all inputs.

use crate::scalar::{Id, Pool, Symbol, reachable};

use super::rules::{carry, slopes};

/// Derivatives of the root with respect to each symbol, in their order, sharing one backward sweep.
pub fn gradient(pool: &mut Pool, root: Id, symbols: &[Symbol]) -> Vec<Id> {
    let inputs: Vec<Id> = symbols.iter().map(|&symbol| pool.input(symbol)).collect();
    let (zero, one) = (pool.zero(), pool.one());
    let youngest = inputs.iter().copied().fold(root, Id::max);
    let mut adjoints = vec![zero; youngest.index() + 1];
    adjoints[root.index()] = one;
    let active = dependent(pool, root, &inputs);
    for &id in active.iter().rev() {
        let adjoint = adjoints[id.index()];
        if adjoint == zero {
            continue;
        }
        for (argument, slope) in slopes(pool, id, &active) {
            let term = carry(pool, slope, adjoint);
            adjoints[argument.index()] = pool.add(adjoints[argument.index()], term);
        }
    }
    inputs.iter().map(|input| adjoints[input.index()]).collect()
}

/// The nodes under `root` that depend on one of the inputs, ascending.
pub(super) fn dependent(pool: &Pool, root: Id, inputs: &[Id]) -> Vec<Id> {
    let mut depends = vec![false; root.index() + 1];
    let mut ids = reachable(pool, &[root]);
    ids.retain(|&id| {
        let above = pool.node(id).arguments().any(|x| depends[x.index()]);
        depends[id.index()] = above || inputs.contains(&id);
        depends[id.index()]
    });
    ids
}
