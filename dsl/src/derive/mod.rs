//! Exact derivatives of scalar expressions.
//!
//! `rules.rs` has the rules of every operator; `forward.rs` and `reverse.rs` apply the chain rule in the two orders, `second.rs` twice;
//! `symmetry.rs` decides whether a matrix of expressions is symmetric. Conditions of `Select` are held fixed: derivatives are those of the active arm.
mod forward;
mod reverse;
mod rules;
mod second;
mod symmetry;

pub use forward::{along, derivative, tangent};
pub use reverse::gradient;
pub use rules::{partial, second_partial};
pub use second::hessian;
pub use symmetry::{Symmetry, is_symmetric};

#[cfg(test)]
mod tests;
