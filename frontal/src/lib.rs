//! Multifrontal factorisation of sparse matrices from finite elements.
//!
//! A matrix with a symmetric pattern is eliminated front by front: dense blocks of columns that share their structure, each of
//! which adds what remains of its elimination to the next (Duff and Reid 1983, *The multifrontal solution of indefinite sparse
//! symmetric linear equations*, ACM Trans. Math. Softw. 9). Two kinds share all of it but the arithmetic of a front:
//! LU for unsymmetric values, with pivots looked for inside a front, and Cholesky for positive definite matrices.
//!
//! [`Solver`] is the whole of it: analyse, scale, factor, solve, refine. [`Analysis`], [`Factors`], [`Scaling`] and [`System`]
//! are its parts, for callers that scale and check for themselves.
//!
//! On one thread the same matrix gives the same bits; on several, factors and solutions differ from those by no more than the order of sums.

mod analysis;
mod dissection;
mod error;
mod factors;
mod front;
mod kernel;
mod ordering;
mod pattern;
mod pivot;
mod quotient;
mod refinement;
mod scaling;
mod schedule;
mod separator;
mod solver;
mod substitution;
mod supernodes;
mod sweep;
mod tree;
mod walk;

pub use analysis::Analysis;
pub use error::Error;
pub use factors::Factors;
pub use pattern::{Kind, Pattern};
pub use pivot::Pivots;
pub use refinement::{BACKWARD_ERROR, REFINEMENTS, SolveReport, System};
pub use scaling::Scaling;
pub use solver::Solver;
