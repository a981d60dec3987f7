//! Solving the equations of a step: sparse patterns, direct linear solvers, borders.

pub mod border;
pub(crate) mod dense;
pub mod linear;
pub mod sparse;
