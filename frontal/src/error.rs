//! What can go wrong.

use std::fmt;

/// A failed analysis or factorisation; equations as the caller numbers them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// The system has no equations.
    NoEquations,
    /// The factors need more memory, or larger indices, than there are.
    TooLarge,
    /// Every entry in the row of an equation is zero.
    EmptyRow {
        /// The equation.
        equation: usize,
    },
    /// Every entry in the column of an unknown is zero.
    EmptyColumn {
        /// The unknown.
        equation: usize,
    },
    /// A pivot of Cholesky is not positive.
    NotPositive {
        /// Equation of the pivot.
        equation: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoEquations => write!(f, "the system has no equations"),
            Self::TooLarge => write!(f, "the factors of the matrix do not fit in memory"),
            Self::EmptyRow { equation } => write!(f, "nothing acts on equation {equation}"),
            Self::EmptyColumn { equation } => write!(f, "unknown {equation} acts on nothing"),
            Self::NotPositive { equation } => {
                write!(f, "the matrix is not positive definite: equation {equation}")
            }
        }
    }
}

impl std::error::Error for Error {}
