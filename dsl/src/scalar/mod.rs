//! Scalar expressions: what is left of the typed expressions once tensors have become components.
//!
//! All of them live in one hash-consed [`Pool`]; differentiation (`crate::derive`), simplification, evaluation, quadrature degrees
//! and code emission work on its [`Id`]s. Knows no tensors, units, meshes or names: inputs are opaque [`Symbol`]s.
mod build;
pub mod degree;
mod lower;
pub mod op;
mod pool;
pub mod print;
mod rational;
pub mod schedule;
mod walk;

pub use lower::lower_powers;
pub use op::{Binary, Relation, Unary};
pub use pool::{Id, Node, Pool, Symbol};
pub use rational::Rational;
pub(crate) use walk::Sweep;
pub use walk::{depends_on, eval, reachable, substitute, symbols_of};

#[cfg(test)]
mod tests;
