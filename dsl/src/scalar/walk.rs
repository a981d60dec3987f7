//! Linear sweeps over the nodes under some roots: evaluation, substitution, dependence.

use std::collections::BTreeSet;

use super::{Id, Node, Pool, Symbol};

/// Every node under the roots, the roots included, once each, in ascending order: arguments before their users.
pub fn reachable(pool: &Pool, roots: &[Id]) -> Vec<Id> {
    let size = roots.iter().map(|id| id.index() + 1).max().unwrap_or(0);
    let mut found = vec![false; size];
    let mut ids = Vec::new();
    let mut pending = roots.to_vec();
    while let Some(id) = pending.pop() {
        if !std::mem::replace(&mut found[id.index()], true) {
            ids.push(id);
            pending.extend(pool.node(id).arguments());
        }
    }
    ids.sort_unstable();
    ids
}

/// The symbols under the roots.
pub fn symbols_of(pool: &Pool, roots: &[Id]) -> BTreeSet<Symbol> {
    let symbol = |id| match pool.node(id) {
        Node::Input(symbol) => Some(symbol),
        _ => None,
    };
    reachable(pool, roots).into_iter().filter_map(symbol).collect()
}

/// Whether the value of `root` mentions the symbol.
pub fn depends_on(pool: &Pool, root: Id, symbol: Symbol) -> bool {
    symbols_of(pool, &[root]).contains(&symbol)
}

/// Values of the roots, in their order, from the values of the symbols. NaN where an operator leaves its domain.
pub fn eval(pool: &Pool, roots: &[Id], symbol: &dyn Fn(Symbol) -> f64) -> Vec<f64> {
    let mut values = Sweep::new(roots, f64::NAN);
    for id in reachable(pool, roots) {
        let value = pool.node(id).value(|x| values.get(x), symbol);
        values.set(id, value);
    }
    roots.iter().map(|&root| values.get(root)).collect()
}

/// The roots, in their order, with every symbol for which `map` has an expression replaced by it. The expressions put in are not
/// themselves searched for symbols.
pub fn substitute(pool: &mut Pool, roots: &[Id], map: &dyn Fn(Symbol) -> Option<Id>) -> Vec<Id> {
    let ids = reachable(pool, roots);
    let Some(&first) = ids.first() else { return Vec::new() };
    let mut images = Sweep::new(roots, first);
    for id in ids {
        let image = match pool.node(id) {
            Node::Input(symbol) => map(symbol).unwrap_or(id),
            node => rebuild(pool, node, &|x| images.get(x)),
        };
        images.set(id, image);
    }
    roots.iter().map(|&root| images.get(root)).collect()
}

/// The node with its arguments exchanged for their images, simplified.
pub(super) fn rebuild(pool: &mut Pool, node: Node, image: &dyn Fn(Id) -> Id) -> Id {
    match node {
        Node::Const(c) => pool.constant(c),
        Node::Input(symbol) => pool.input(symbol),
        Node::Unary(op, x) => pool.unary(op, image(x)),
        Node::Binary(op, x, y) => pool.binary(op, image(x), image(y)),
        Node::Power(x, p) => pool.power(image(x), p),
        Node::Select { relation, lhs, rhs, then, otherwise } => {
            pool.select(relation, image(lhs), image(rhs), image(then), image(otherwise))
        }
    }
}

/// One value per node up to the youngest root.
#[derive(Clone, Debug)]
pub(crate) struct Sweep<T> {
    values: Vec<T>,
}

impl<T: Copy> Sweep<T> {
    /// The initial value everywhere.
    pub(crate) fn new(roots: &[Id], initial: T) -> Sweep<T> {
        let size = roots.iter().map(|id| id.index() + 1).max().unwrap_or(0);
        Sweep { values: vec![initial; size] }
    }

    pub(crate) fn get(&self, id: Id) -> T {
        self.values[id.index()]
    }

    pub(crate) fn set(&mut self, id: Id, value: T) {
        self.values[id.index()] = value;
    }
}
