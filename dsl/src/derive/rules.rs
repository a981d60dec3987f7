//! First and second derivatives of every operator.

use crate::scalar::{Binary, Id, Node, Pool, Rational, Relation, Unary};

/// Derivative of the node `id` with respect to its argument in `place` (from 0), the other arguments fixed.
///
/// `abs` has derivative 0 at 0, `min` and `max` take the first argument's side at a tie, and the two sides of a condition have none.
/// Places the node does not have give 0.
pub fn partial(pool: &mut Pool, id: Id, place: usize) -> Id {
    match pool.node(id) {
        Node::Const(_) | Node::Input(_) => pool.zero(),
        Node::Unary(op, x) => unary(pool, op, id, x),
        Node::Binary(op, x, y) => binary(pool, op, id, [x, y], place),
        Node::Power(x, p) => {
            let factor = pool.constant(p.to_f64());
            let less = power_below(pool, id, x, p);
            pool.mul(factor, less)
        }
        Node::Select { relation, lhs, rhs, .. } => {
            let (zero, one) = (pool.zero(), pool.one());
            match place {
                2 => pool.select(relation, lhs, rhs, one, zero),
                3 => pool.select(relation, lhs, rhs, zero, one),
                _ => zero,
            }
        }
    }
}

/// `x^(p - 1)` where `value` is `x^p`: from the value and the shared `1/x`, except that for `p > 1` it must be finite at 0.
fn power_below(pool: &mut Pool, value: Id, x: Id, p: Rational) -> Id {
    match p.decrement() {
        Some(less) if less.numerator() > 0 => pool.power(x, less),
        _ => pool.div(value, x),
    }
}

/// Second derivative of the node `id` with respect to its arguments in places `i` and `j` (from 0), the others fixed.
///
/// Zero across the kinks of `abs`, `min`, `max` and `Select`.
pub fn second_partial(pool: &mut Pool, id: Id, i: usize, j: usize) -> Id {
    match pool.node(id) {
        Node::Unary(op, x) => unary_second(pool, op, id, x),
        Node::Binary(op, x, y) => binary_second(pool, op, id, [x, y], i + j),
        Node::Power(x, p) => {
            let below = power_below(pool, id, x, p);
            let below = match p.decrement() {
                Some(less) => power_below(pool, below, x, less),
                None => pool.div(below, x),
            };
            let factor = pool.constant(p.to_f64() * (p.to_f64() - 1.0));
            pool.mul(factor, below)
        }
        Node::Const(_) | Node::Input(_) | Node::Select { .. } => pool.zero(),
    }
}

/// Derivatives of the node `id` with respect to its distinct arguments, those outside `active` (ascending) left out.
pub(super) fn slopes(pool: &mut Pool, id: Id, active: &[Id]) -> Vec<(Id, Id)> {
    let mut slopes: Vec<(Id, Id)> = Vec::new();
    for (place, x) in pool.node(id).arguments().enumerate() {
        if active.binary_search(&x).is_err() {
            continue;
        }
        let slope = partial(pool, id, place);
        match slopes.iter_mut().find(|(y, _)| *y == x) {
            Some((_, total)) => *total = pool.add(*total, slope),
            None => slopes.push((x, slope)),
        }
    }
    slopes
}

/// `slope rate` with a constant factor of the slope moved onto the rate: `(2 x) r = x (2 r)`, since a rate goes to several places.
pub(super) fn carry(pool: &mut Pool, slope: Id, rate: Id) -> Id {
    match pool.split_constant(slope) {
        Some((constant, rest)) => {
            let scaled = pool.mul(constant, rate);
            pool.mul(rest, scaled)
        }
        None => pool.mul(slope, rate),
    }
}

/// `f'(x)` where `value` is `f(x)`.
fn unary(pool: &mut Pool, op: Unary, value: Id, x: Id) -> Id {
    let one = pool.one();
    match op {
        Unary::Neg => pool.constant(-1.0),
        Unary::Sqrt => {
            let half = pool.constant(0.5);
            pool.div(half, value)
        }
        Unary::Exp => value,
        Unary::Ln => pool.recip(x),
        Unary::Sin => pool.unary(Unary::Cos, x),
        Unary::Cos => {
            let sin = pool.unary(Unary::Sin, x);
            pool.neg(sin)
        }
        Unary::Tan => {
            let square = pool.square(value);
            pool.add(one, square)
        }
        Unary::Asin => inverse_of_arc(pool, x),
        Unary::Acos => {
            let asin = inverse_of_arc(pool, x);
            pool.neg(asin)
        }
        Unary::Atan => {
            let square = pool.square(x);
            let sum = pool.add(one, square);
            pool.recip(sum)
        }
        Unary::Sinh => pool.unary(Unary::Cosh, x),
        Unary::Cosh => pool.unary(Unary::Sinh, x),
        Unary::Tanh => {
            let square = pool.square(value);
            pool.sub(one, square)
        }
        Unary::Abs => sign(pool, x),
    }
}

/// `f''(x)` where `value` is `f(x)`, from `f` and `f'`.
fn unary_second(pool: &mut Pool, op: Unary, value: Id, x: Id) -> Id {
    let slope = unary(pool, op, value, x);
    let (factor, factors) = match op {
        Unary::Neg | Unary::Abs => return pool.zero(),
        Unary::Exp | Unary::Sinh | Unary::Cosh => return value,
        Unary::Sin | Unary::Cos => return pool.neg(value),
        Unary::Sqrt => (-0.5, [slope, pool.recip(x), pool.one()]),
        Unary::Ln => (-1.0, [slope, slope, pool.one()]),
        Unary::Tan => (2.0, [value, slope, pool.one()]),
        Unary::Tanh => (-2.0, [value, slope, pool.one()]),
        Unary::Atan => (-2.0, [x, slope, slope]),
        Unary::Asin | Unary::Acos => {
            let square = pool.square(slope);
            (1.0, [x, slope, square])
        }
    };
    let product = pool.product(factors);
    let factor = pool.constant(factor);
    pool.mul(factor, product)
}

/// `1/sqrt(1 - x^2)`
fn inverse_of_arc(pool: &mut Pool, x: Id) -> Id {
    let one = pool.one();
    let square = pool.square(x);
    let rest = pool.sub(one, square);
    let root = pool.sqrt(rest);
    pool.recip(root)
}

/// -1, 0 or 1.
fn sign(pool: &mut Pool, x: Id) -> Id {
    let (minus, zero, one) = (pool.constant(-1.0), pool.zero(), pool.one());
    let negative = pool.select(Relation::Less, x, zero, minus, zero);
    pool.select(Relation::Less, zero, x, one, negative)
}

fn binary(pool: &mut Pool, op: Binary, value: Id, [x, y]: [Id; 2], place: usize) -> Id {
    let (zero, one) = (pool.zero(), pool.one());
    match (op, place) {
        (_, 2..) => zero,
        (Binary::Add, _) | (Binary::Sub, 0) => one,
        (Binary::Sub, _) => pool.constant(-1.0),
        (Binary::Mul, 0) => y,
        (Binary::Mul, _) => x,
        (Binary::Div, 0) => pool.recip(y),
        (Binary::Div, _) => {
            let reciprocal = pool.recip(y);
            let product = pool.mul(value, reciprocal);
            pool.neg(product)
        }
        (Binary::Pow, 0) => {
            let less = pool.sub(y, one);
            let power = pool.pow(x, less);
            pool.mul(y, power)
        }
        (Binary::Pow, _) => {
            let logarithm = pool.unary(Unary::Ln, x);
            pool.mul(value, logarithm)
        }
        (Binary::Min, 0) => pool.select(Relation::LessEqual, x, y, one, zero),
        (Binary::Min, _) => pool.select(Relation::LessEqual, x, y, zero, one),
        (Binary::Max, 0) => pool.select(Relation::LessEqual, y, x, one, zero),
        (Binary::Max, _) => pool.select(Relation::LessEqual, y, x, zero, one),
        (Binary::Atan2, _) => {
            let squares = pool.dot(&[x, y], &[x, y]);
            let reciprocal = pool.recip(squares);
            let other = if place == 0 { y } else { pool.neg(x) };
            pool.mul(other, reciprocal)
        }
    }
}

/// Second derivatives: `place` is 0 for `xx`, 1 for `xy` and 2 for `yy`.
fn binary_second(pool: &mut Pool, op: Binary, value: Id, [x, y]: [Id; 2], place: usize) -> Id {
    match (op, place) {
        (Binary::Add | Binary::Sub | Binary::Min | Binary::Max, _) => pool.zero(),
        (Binary::Mul, 1) => pool.one(),
        (Binary::Mul, _) | (Binary::Div, 0) => pool.zero(),
        (Binary::Div, _) => {
            let reciprocal = pool.recip(y);
            let square = pool.square(reciprocal);
            let (factor, numerator) = if place == 1 { (-1.0, pool.one()) } else { (2.0, value) };
            let factor = pool.constant(factor);
            pool.product([factor, numerator, square])
        }
        (Binary::Pow, _) => pow_second(pool, value, [x, y], place),
        (Binary::Atan2, _) => atan2_second(pool, [x, y], place),
    }
}

/// `y (y - 1) x^(y - 2)`, `x^(y - 1) (1 + y ln x)`, `x^y ln(x)^2`
fn pow_second(pool: &mut Pool, value: Id, [x, y]: [Id; 2], place: usize) -> Id {
    let (one, two) = (pool.one(), pool.constant(2.0));
    let less = pool.sub(y, one);
    let below = pool.pow(x, less);
    match place {
        0 => {
            let least = pool.sub(y, two);
            let power = pool.pow(x, least);
            pool.product([y, less, power])
        }
        1 => {
            let logarithm = pool.unary(Unary::Ln, x);
            let product = pool.mul(y, logarithm);
            let sum = pool.add(one, product);
            pool.mul(below, sum)
        }
        _ => {
            let logarithm = pool.unary(Unary::Ln, x);
            pool.product([value, logarithm, logarithm])
        }
    }
}

/// `-2 x y`, `x^2 - y^2`, `2 x y`, each over `(x^2 + y^2)^2`
fn atan2_second(pool: &mut Pool, [x, y]: [Id; 2], place: usize) -> Id {
    let (xx, yy) = (pool.square(x), pool.square(y));
    let squares = pool.add(xx, yy);
    let reciprocal = pool.recip(squares);
    let weight = pool.square(reciprocal);
    let numerator = match place {
        1 => pool.sub(xx, yy),
        _ => {
            let factor = pool.constant(if place == 0 { -2.0 } else { 2.0 });
            pool.product([factor, x, y])
        }
    };
    pool.mul(numerator, weight)
}
