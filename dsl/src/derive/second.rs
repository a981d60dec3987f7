//! Second derivatives of one root by edge pushing: one backward sweep that carries a sparse symmetric matrix.
//!
//! At any moment the root is a function of the nodes not yet visited; `curvature` holds its second derivatives with respect to them.
//! Visiting a node replaces it by its arguments. What reaches the inputs only through a few scalars (invariants, a determinant) is
//! thus differentiated with respect to those first, and symmetry halves the work throughout.
//!
//! R. M. Gower, M. P. Mello: A new framework for the computation of Hessians, Optim. Methods Softw. 27 (2012) 251-273.

use std::collections::BTreeMap;

use crate::scalar::{Id, Pool, Symbol};

use super::reverse::dependent;
use super::rules::{carry, second_partial, slopes};

/// Second derivatives of the root: the lower triangle by rows, `H[i][j]` with `j <= i` at position `i (i + 1)/2 + j`.
pub fn hessian(pool: &mut Pool, root: Id, symbols: &[Symbol]) -> Vec<Id> {
    let inputs: Vec<Id> = symbols.iter().map(|&symbol| pool.input(symbol)).collect();
    let active = dependent(pool, root, &inputs);
    let mut sweep = Push::default();
    sweep.adjoint.insert(root, pool.one());
    for &id in active.iter().rev().filter(|id| !inputs.contains(id)) {
        sweep.replace(pool, id, &active);
    }
    let zero = pool.zero();
    let entry =
        |(i, j): (usize, usize)| sweep.curvature.get(&pair(inputs[i], inputs[j])).copied().unwrap_or(zero);
    (0..symbols.len()).flat_map(|i| (0..=i).map(move |j| (i, j))).map(entry).collect()
}

/// First and second derivatives of the root with respect to the nodes not yet visited; what is absent is 0.
#[derive(Default)]
struct Push {
    adjoint: BTreeMap<Id, Id>,
    /// By ordered pairs, older node first.
    curvature: BTreeMap<(Id, Id), Id>,
    /// The nodes each node has a curvature with.
    neighbours: BTreeMap<Id, Vec<Id>>,
}

impl Push {
    /// Passes the derivatives with respect to `id` on to its arguments.
    fn replace(&mut self, pool: &mut Pool, id: Id, active: &[Id]) {
        let slopes = slopes(pool, id, active);
        self.push_curvature(pool, id, &slopes);
        let Some(adjoint) = self.adjoint.remove(&id) else { return };
        for (pair, second) in seconds(pool, id, active) {
            let term = carry(pool, second, adjoint);
            self.bend(pool, pair, term);
        }
        for (x, slope) in slopes {
            let term = carry(pool, slope, adjoint);
            add_to(pool, &mut self.adjoint, x, term);
        }
    }

    /// `H[n][x] += slope_x H[n][id]`, and for `H[id][id]` on both sides.
    fn push_curvature(&mut self, pool: &mut Pool, id: Id, slopes: &[(Id, Id)]) {
        for neighbour in self.neighbours.remove(&id).unwrap_or_default() {
            let Some(value) = self.curvature.remove(&pair(id, neighbour)) else { continue };
            for (n, &(x, slope)) in slopes.iter().enumerate() {
                let term = carry(pool, slope, value);
                if neighbour != id {
                    let both = if x == neighbour { pool.add(term, term) } else { term };
                    self.bend(pool, pair(x, neighbour), both);
                    continue;
                }
                for &(y, other) in &slopes[..=n] {
                    let term = carry(pool, other, term);
                    self.bend(pool, pair(x, y), term);
                }
            }
        }
    }

    /// Adds to the entry of a pair.
    fn bend(&mut self, pool: &mut Pool, (x, y): (Id, Id), term: Id) {
        if term == pool.zero() {
            return;
        }
        add_to(pool, &mut self.curvature, (x, y), term);
        for (a, b) in [(x, y), (y, x)] {
            let list = self.neighbours.entry(a).or_default();
            if !list.contains(&b) {
                list.push(b);
            }
        }
    }
}

/// Second derivatives of the node with respect to the pairs of its distinct active arguments.
fn seconds(pool: &mut Pool, id: Id, active: &[Id]) -> BTreeMap<(Id, Id), Id> {
    let arguments: Vec<Id> = pool.node(id).arguments().collect();
    let is_active = |k: &usize| active.binary_search(&arguments[*k]).is_ok();
    let places: Vec<usize> = (0..arguments.len()).filter(is_active).collect();
    let mut totals = BTreeMap::new();
    for (n, &i) in places.iter().enumerate() {
        for &j in &places[..=n] {
            let second = second_partial(pool, id, i, j);
            let (x, y) = (arguments[i], arguments[j]);
            let both = if x == y && i != j { pool.add(second, second) } else { second };
            add_to(pool, &mut totals, pair(x, y), both);
        }
    }
    totals
}

fn pair(x: Id, y: Id) -> (Id, Id) {
    (x.min(y), x.max(y))
}

fn add_to<K: Ord>(pool: &mut Pool, totals: &mut BTreeMap<K, Id>, key: K, term: Id) {
    let zero = pool.zero();
    let total = totals.entry(key).or_insert(zero);
    *total = pool.add(*total, term);
}
