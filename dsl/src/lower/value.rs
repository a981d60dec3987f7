//! What an expression lowers to: components in the scalar pool, conditions, laws and records.

use crate::model::{FunctionId, Relation};
use crate::scalar::{Id, Pool};

/// A lowered expression. Tensors are stored row by row.
#[derive(Clone, Debug)]
pub enum Value {
    /// One component.
    Scalar(Id),
    /// Three components.
    Vector([Id; 3]),
    /// Nine components.
    Tensor([Id; 9]),
    /// A literal 0 of any shape.
    Zero,
    /// Truth value.
    Condition(Condition),
    /// A function with some arguments fixed.
    Law(FunctionId, Vec<Option<Value>>),
    /// Values in declaration order.
    Record(Vec<Value>),
}

/// A truth value made of comparisons.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// Known at compile time.
    Constant(bool),
    /// A comparison of two scalars.
    Compare(Relation, Id, Id),
    /// Both hold.
    And(Box<Condition>, Box<Condition>),
    /// One of them holds.
    Or(Box<Condition>, Box<Condition>),
    /// It does not hold.
    Not(Box<Condition>),
}

impl Value {
    /// The components of a scalar, vector or tensor; one zero for a literal 0, nothing for the rest.
    pub fn components(&self, pool: &mut Pool) -> Vec<Id> {
        match self {
            Value::Scalar(x) => vec![*x],
            Value::Vector(v) => v.to_vec(),
            Value::Tensor(a) => a.to_vec(),
            Value::Zero => vec![pool.zero()],
            Value::Condition(_) | Value::Law(..) | Value::Record(_) => Vec::new(),
        }
    }

    /// A scalar, vector or tensor from 1, 3 or 9 components; a literal 0 for any other number.
    pub fn from_components(components: &[Id]) -> Value {
        match *components {
            [x] => Value::Scalar(x),
            [x, y, z] => Value::Vector([x, y, z]),
            _ => components.try_into().map_or(Value::Zero, Value::Tensor),
        }
    }

    /// Every component changed alike; conditions and laws stay, records change member by member.
    pub fn map(&self, pool: &mut Pool, f: &mut dyn FnMut(&mut Pool, Id) -> Id) -> Value {
        match self {
            Value::Scalar(x) => Value::Scalar(f(pool, *x)),
            Value::Vector(v) => Value::Vector(v.map(|x| f(pool, x))),
            Value::Tensor(a) => Value::Tensor(a.map(|x| f(pool, x))),
            Value::Record(members) => Value::Record(members.iter().map(|m| m.map(pool, f)).collect()),
            Value::Zero | Value::Condition(_) | Value::Law(..) => self.clone(),
        }
    }
}

/// A tensor from its entries.
pub(super) fn tensor(mut entry: impl FnMut(usize, usize) -> Id) -> [Id; 9] {
    std::array::from_fn(|k| entry(k / 3, k % 3))
}
