//! Polynomial degree of an expression, as far as quadrature needs it: exact for polynomials, a rule of thumb for the rest.

use super::{Binary, Id, Node, Pool, Sweep, Symbol, Unary, reachable};

/// What a function that is no polynomial adds to the degree of its argument.
const CURVED: u32 = 2;

/// Estimated degree of the root in the variables in which each symbol has the given degree (0: constant over the cell).
///
/// Sums and choices take the largest degree, products and quotients add, `x^n` multiplies for `0 <= n <= 16`; any other function or
/// power of a non-constant argument counts as the degree of its arguments plus 2. An over-estimate for rational functions that cancel.
pub fn degree(pool: &Pool, root: Id, symbol: &dyn Fn(Symbol) -> u32) -> u32 {
    let mut degrees = Sweep::new(&[root], 0);
    for id in reachable(pool, &[root]) {
        let degree = node_degree(&pool.node(id), |x| degrees.get(x), symbol);
        degrees.set(id, degree);
    }
    degrees.get(root)
}

fn node_degree(node: &Node, of: impl Fn(Id) -> u32, symbol: &dyn Fn(Symbol) -> u32) -> u32 {
    match *node {
        Node::Const(_) => 0,
        Node::Input(s) => symbol(s),
        Node::Unary(Unary::Neg | Unary::Abs, x) => of(x),
        Node::Unary(_, x) | Node::Power(x, _) => curved(of(x)),
        Node::Binary(op, x, y) => match op {
            Binary::Add | Binary::Sub | Binary::Min | Binary::Max => of(x).max(of(y)),
            Binary::Mul | Binary::Div => of(x).saturating_add(of(y)),
            Binary::Pow | Binary::Atan2 => curved(of(x).max(of(y))),
        },
        Node::Select { then, otherwise, .. } => of(then).max(of(otherwise)),
    }
}

fn curved(degree: u32) -> u32 {
    if degree == 0 { 0 } else { degree.saturating_add(CURVED) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Rational;

    /// Degree when every symbol `s` has degree `s`.
    fn of(build: impl FnOnce(&mut Pool, Id, Id) -> Id) -> u32 {
        let mut pool = Pool::new();
        let (x, y) = (pool.input(Symbol(1)), pool.input(Symbol(2)));
        let root = build(&mut pool, x, y);
        degree(&pool, root, &|s| s.0)
    }

    #[test]
    fn polynomials_are_exact() {
        assert_eq!(of(|p, x, y| p.add(x, y)), 2);
        assert_eq!(of(|p, x, y| p.mul(x, y)), 3);
        assert_eq!(of(|p, _, y| p.power(y, Rational::integer(3))), 6);
    }

    #[test]
    fn quotients_add_both_degrees() {
        assert_eq!(of(|p, x, y| p.div(x, y)), 3);
    }

    #[test]
    fn other_functions_add_two_unless_constant() {
        assert_eq!(of(|p, _, y| p.sqrt(y)), 4);
        let mut pool = Pool::new();
        let k = pool.input(Symbol(0));
        let root = pool.unary(Unary::Exp, k);
        assert_eq!(degree(&pool, root, &|_| 0), 0);
    }

    #[test]
    fn choices_take_the_larger_degree() {
        assert_eq!(of(|p, x, y| p.max(x, y)), 2);
    }
}
