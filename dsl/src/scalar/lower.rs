//! Powers as code computes them. Applied once, after all differentiation.

use super::walk::{Sweep, rebuild};
use super::{Id, Node, Pool, Rational, reachable};

/// The roots, in their order, with half and negative third powers taken apart so that those of one base share a root:
/// `x^(n/2) = x^k s` and `x^(-n/2) = x^(-k) / s` with `s = sqrt(x)`, and `x^(-n/3) = x^(-k) q^m` with `q = x^(-1/3)`, `m` 1 or 2.
///
/// Positive third powers stay whole, for they are finite at 0; so do other denominators and integer exponents beyond 16.
pub fn lower_powers(pool: &mut Pool, roots: &[Id]) -> Vec<Id> {
    let ids = reachable(pool, roots);
    let Some(&first) = ids.first() else { return Vec::new() };
    let mut images = Sweep::new(roots, first);
    for id in ids {
        let image = match pool.node(id) {
            Node::Power(x, p) => split(pool, images.get(x), p),
            node => rebuild(pool, node, &|x| images.get(x)),
        };
        images.set(id, image);
    }
    roots.iter().map(|&root| images.get(root)).collect()
}

fn split(pool: &mut Pool, x: Id, p: Rational) -> Id {
    let (n, d) = (p.numerator(), p.denominator());
    let root = match d {
        2 => pool.sqrt(x),
        3 if n < 0 => pool.power(x, Rational::MINUS_THIRD),
        _ => return pool.power(x, p),
    };
    let power = match (d, n) {
        (2, ..0) => pool.recip(root),
        (3, _) if n % d == -2 => pool.square(root),
        _ => root,
    };
    let integer = pool.power(x, Rational::integer(n / d));
    pool.mul(integer, power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{Symbol, eval};

    #[test]
    fn powers_of_one_base_share_one_root() {
        let mut pool = Pool::new();
        let x = pool.input(Symbol(0));
        let exponents =
            [(-1, 3), (-2, 3), (-4, 3), (-5, 3), (1, 2), (-1, 2), (3, 2), (-3, 2), (4, 3), (1, 5)];
        let exponents = exponents.map(|(n, d)| Rational::new(n, d).unwrap());
        let powers = exponents.map(|p| pool.power(x, p));
        let lowered = lower_powers(&mut pool, &powers);
        let kept = |&id: &Id| matches!(pool.node(id), Node::Power(..));
        assert_eq!(reachable(&pool, &lowered).iter().filter(|id| kept(id)).count(), 3); // -1/3, 4/3 and 1/5
        for (value, p) in eval(&pool, &lowered, &|_| 1.7).into_iter().zip(exponents) {
            let expected = 1.7_f64.powf(p.to_f64());
            assert!((value - expected).abs() < 1e-14 * expected, "{p}"); // a few roundings
        }
    }
}
