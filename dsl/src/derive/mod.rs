//! Exact derivatives of scalar expressions.
//!
//! [`rules`] has one rule per operator; [`forward`] and [`reverse`] apply the chain rule in the two orders; [`symmetry`] decides
//! whether a matrix of expressions is symmetric. Conditions of `Select` are held fixed: derivatives are those of the active arm.
mod forward;
mod reverse;
mod rules;
mod symmetry;

pub use forward::{along, derivative, tangent};
pub use reverse::{gradient, hessian};
pub use rules::partial;
pub use symmetry::{Symmetry, is_symmetric};
