//! Powers as code computes them. Applied once, after all differentiation.

use super::walk::{Sweep, rebuild};
use super::{Id, Node, Pool, Rational, reachable};

/// The roots, in their order, with every fractional power split as `x^p = x^floor(p) x^f`, so that `x^(-2/3)` and `1/x` together need
/// one division and one cube root. What stays a `Power` is `x^(1/3)`, exponents in `0 .. 1` that are no multiple of 1/2 or 1/3, and
/// exponents beyond 16.
pub fn lower_powers(pool: &mut Pool, roots: &[Id]) -> Vec<Id> {
    let ids = reachable(pool, roots);
    let Some(&first) = ids.first() else { return Vec::new() };
    let mut images = Sweep::new(roots, first);
    for id in ids {
        let image = match pool.node(id) {
            Node::Power(x, p) if p.as_integer().is_none() => split(pool, images.get(x), p),
            node => rebuild(pool, node, &|x| images.get(x)),
        };
        images.set(id, image);
    }
    roots.iter().map(|&root| images.get(root)).collect()
}

fn split(pool: &mut Pool, x: Id, p: Rational) -> Id {
    let integer = pool.power(x, Rational::integer(p.floor()));
    let root = match (p.fraction().numerator(), p.fraction().denominator()) {
        (2, 3) => {
            let cube_root = pool.power(x, Rational::THIRD);
            pool.square(cube_root)
        }
        _ => pool.power(x, p.fraction()),
    };
    pool.mul(integer, root)
}
