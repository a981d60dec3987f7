//! One derivative rule per operator.

use crate::scalar::{Binary, Id, Node, Pool, Relation, Unary};

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
            let less = match p.decrement() {
                Some(less) => pool.power(x, less),
                None => pool.div(id, x),
            };
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
