//! Vector and tensor algebra written out in components. `None` where shapes do not fit, which checked models exclude.

use super::value::{Value, tensor};
use crate::model::{Arithmetic, Builtin, ScalarFunction};
use crate::scalar::{Binary, Id, Pool, Unary};

/// A scalar; a literal 0 is one.
pub(super) fn scalar(pool: &mut Pool, value: &Value) -> Option<Id> {
    match value {
        Value::Scalar(x) => Some(*x),
        Value::Zero => Some(pool.zero()),
        _ => None,
    }
}

/// A vector; a literal 0 is one.
pub(super) fn vector(pool: &mut Pool, value: &Value) -> Option<[Id; 3]> {
    match value {
        Value::Vector(v) => Some(*v),
        Value::Zero => Some([pool.zero(); 3]),
        _ => None,
    }
}

/// A tensor; a literal 0 is one.
pub(super) fn tensor_of(pool: &mut Pool, value: &Value) -> Option<[Id; 9]> {
    match value {
        Value::Tensor(a) => Some(*a),
        Value::Zero => Some([pool.zero(); 9]),
        _ => None,
    }
}

/// The identity tensor.
pub(super) fn identity(pool: &mut Pool) -> [Id; 9] {
    let (zero, one) = (pool.zero(), pool.one());
    tensor(|i, j| if i == j { one } else { zero })
}

/// `a op b`.
pub(super) fn arithmetic(pool: &mut Pool, op: Arithmetic, a: &Value, b: &Value) -> Option<Value> {
    match op {
        Arithmetic::Add => sum(pool, Binary::Add, a, b),
        Arithmetic::Sub => sum(pool, Binary::Sub, a, b),
        Arithmetic::Mul => product(pool, a, b),
        Arithmetic::Div => {
            let divisor = scalar(pool, b)?;
            Some(a.map(pool, &mut |pool, x| pool.div(x, divisor)))
        }
        Arithmetic::Pow => {
            let (base, exponent) = (scalar(pool, a)?, scalar(pool, b)?);
            Some(Value::Scalar(pool.pow(base, exponent)))
        }
    }
}

/// `-a`.
pub(super) fn negate(pool: &mut Pool, a: &Value) -> Value {
    a.map(pool, &mut |pool, x| pool.neg(x))
}

fn sum(pool: &mut Pool, op: Binary, a: &Value, b: &Value) -> Option<Value> {
    match (a, b) {
        (_, Value::Zero) => Some(a.clone()),
        (Value::Zero, _) if op == Binary::Add => Some(b.clone()),
        (Value::Zero, _) => Some(negate(pool, b)),
        _ => {
            let (x, y) = (a.components(pool), b.components(pool));
            let components: Vec<Id> = x.iter().zip(&y).map(|(&x, &y)| pool.binary(op, x, y)).collect();
            (x.len() == y.len() && !x.is_empty()).then(|| Value::from_components(&components))
        }
    }
}

fn product(pool: &mut Pool, a: &Value, b: &Value) -> Option<Value> {
    match (a, b) {
        (Value::Zero, _) | (_, Value::Zero) => Some(Value::Zero),
        (Value::Scalar(s), other) | (other, Value::Scalar(s)) => {
            Some(other.map(pool, &mut |pool, x| pool.mul(*s, x)))
        }
        (Value::Tensor(a), Value::Tensor(b)) => Some(Value::Tensor(tensor(|i, j| {
            pool.dot(&[a[3 * i], a[3 * i + 1], a[3 * i + 2]], &[b[j], b[3 + j], b[6 + j]])
        }))),
        (Value::Tensor(a), Value::Vector(v)) => {
            Some(Value::Vector(std::array::from_fn(|i| pool.dot(&a[3 * i..3 * i + 3], v))))
        }
        (Value::Vector(v), Value::Tensor(a)) => {
            Some(Value::Vector(std::array::from_fn(|j| pool.dot(v, &[a[j], a[3 + j], a[6 + j]]))))
        }
        _ => None,
    }
}

/// A built-in function that needs nothing but its arguments' components; `None` also for those that need more.
pub(super) fn builtin(pool: &mut Pool, builtin: Builtin, arguments: &[Value]) -> Option<Value> {
    use Builtin as B;
    let first = arguments.first()?;
    Some(match builtin {
        B::Scalar(function) => {
            let x = scalar(pool, first)?;
            Value::Scalar(pool.unary(unary(function), x))
        }
        B::Min => Value::Scalar(fold(pool, Binary::Min, arguments)?),
        B::Max => Value::Scalar(fold(pool, Binary::Max, arguments)?),
        B::Atan2 => Value::Scalar(fold(pool, Binary::Atan2, arguments)?),
        B::Diag => {
            let entries: Option<Vec<Id>> = arguments.iter().map(|a| scalar(pool, a)).collect();
            let (entries, zero) = (entries?, pool.zero());
            Value::Tensor(tensor(|i, j| if i == j { entries.get(i).copied().unwrap_or(zero) } else { zero }))
        }
        B::Dot => {
            let (a, b) = (vector(pool, first)?, vector(pool, arguments.get(1)?)?);
            Value::Scalar(pool.dot(&a, &b))
        }
        B::Inner => {
            let (a, b) = (tensor_of(pool, first)?, tensor_of(pool, arguments.get(1)?)?);
            Value::Scalar(pool.dot(&a, &b))
        }
        B::Outer => {
            let (a, b) = (vector(pool, first)?, vector(pool, arguments.get(1)?)?);
            Value::Tensor(tensor(|i, j| pool.mul(a[i], b[j])))
        }
        B::Cross => {
            let (a, b) = (vector(pool, first)?, vector(pool, arguments.get(1)?)?);
            Value::Vector(std::array::from_fn(|i| {
                minor(pool, [a[(i + 1) % 3], a[(i + 2) % 3]], [b[(i + 1) % 3], b[(i + 2) % 3]])
            }))
        }
        B::Norm => {
            let components = first.components(pool);
            let square = pool.dot(&components, &components);
            Value::Scalar(pool.sqrt(square))
        }
        B::Det | B::Trace | B::Transpose | B::Inverse | B::Sym | B::Dev => {
            let a = tensor_of(pool, first)?;
            of_tensor(pool, builtin, &a)
        }
        B::Grad | B::Div | B::Along | B::Hoop | B::Perp | B::Polar => return None,
    })
}

fn of_tensor(pool: &mut Pool, builtin: Builtin, a: &[Id; 9]) -> Value {
    match builtin {
        Builtin::Trace => Value::Scalar(trace(pool, a)),
        Builtin::Transpose => Value::Tensor(tensor(|i, j| a[3 * j + i])),
        Builtin::Inverse => Value::Tensor(inverse(pool, a)),
        Builtin::Sym => Value::Tensor(tensor(|i, j| {
            let twice = pool.add(a[3 * i + j], a[3 * j + i]);
            let half = pool.constant(0.5);
            if i == j { a[3 * i + j] } else { pool.mul(half, twice) }
        })),
        Builtin::Dev => {
            let (trace, third) = (trace(pool, a), pool.constant(1.0 / 3.0));
            let mean = pool.mul(third, trace);
            Value::Tensor(tensor(|i, j| if i == j { pool.sub(a[3 * i + j], mean) } else { a[3 * i + j] }))
        }
        _ => Value::Scalar(determinant(pool, a)),
    }
}

fn fold(pool: &mut Pool, op: Binary, arguments: &[Value]) -> Option<Id> {
    let mut scalars = arguments.iter();
    let mut result = scalar(pool, scalars.next()?)?;
    for argument in scalars {
        let next = scalar(pool, argument)?;
        result = pool.binary(op, result, next);
    }
    Some(result)
}

/// Trace of a tensor.
pub(super) fn trace(pool: &mut Pool, a: &[Id; 9]) -> Id {
    pool.sum([a[0], a[4], a[8]])
}

/// `a0 b1 - a1 b0`.
fn minor(pool: &mut Pool, a: [Id; 2], b: [Id; 2]) -> Id {
    let (plus, minus) = (pool.mul(a[0], b[1]), pool.mul(a[1], b[0]));
    pool.sub(plus, minus)
}

/// Cofactors: `cof(A)_ij = d det(A) / d A_ij`.
fn cofactors(pool: &mut Pool, a: &[Id; 9]) -> [Id; 9] {
    tensor(|i, j| {
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        minor(pool, [a[3 * i1 + j1], a[3 * i1 + j2]], [a[3 * i2 + j1], a[3 * i2 + j2]])
    })
}

/// Determinant, expanded along the row with the most zeros: plane and axisymmetric tensors then keep their block form.
fn determinant(pool: &mut Pool, a: &[Id; 9]) -> Id {
    let cofactors = cofactors(pool, a);
    let zeros =
        |row: &usize| a[3 * row..3 * row + 3].iter().filter(|&&x| pool.as_constant(x) == Some(0.0)).count();
    let row = (0..3).rev().max_by_key(zeros).unwrap_or(0);
    pool.dot(&a[3 * row..3 * row + 3], &cofactors[3 * row..3 * row + 3])
}

fn inverse(pool: &mut Pool, a: &[Id; 9]) -> [Id; 9] {
    let (cofactors, determinant) = (cofactors(pool, a), determinant(pool, a));
    let reciprocal = pool.recip(determinant);
    tensor(|i, j| pool.mul(cofactors[3 * j + i], reciprocal))
}

fn unary(function: ScalarFunction) -> Unary {
    use ScalarFunction as F;
    match function {
        F::Sqrt => Unary::Sqrt,
        F::Exp => Unary::Exp,
        F::Ln => Unary::Ln,
        F::Sin => Unary::Sin,
        F::Cos => Unary::Cos,
        F::Tan => Unary::Tan,
        F::Asin => Unary::Asin,
        F::Acos => Unary::Acos,
        F::Atan => Unary::Atan,
        F::Sinh => Unary::Sinh,
        F::Cosh => Unary::Cosh,
        F::Tanh => Unary::Tanh,
        F::Abs => Unary::Abs,
    }
}
