//! What can go wrong with a linear system, in terms of equation numbers.
//!
//! Whoever drives the solver turns these into errors in the terms of the model.

use std::fmt;

/// A failed analysis, factorisation or solve.
///
/// Equations are numbered as the caller numbers the free equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinearError {
    /// The system has no equations.
    NoEquations,
    /// The factors need more memory, or larger indices, than there are.
    TooLarge,
    /// An assembled entry is infinite or not a number.
    NonFiniteEntry {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// A right-hand side is infinite or not a number.
    NonFiniteRightHandSide {
        /// Equation it belongs to.
        equation: usize,
    },
    /// A solution is infinite or not a number.
    NonFiniteSolution {
        /// First unknown affected.
        equation: usize,
    },
    /// Every entry in the row of an equation is zero: nothing acts on it.
    EmptyRow {
        /// The equation.
        equation: usize,
    },
    /// Every entry in the column of an unknown is zero: it acts on nothing.
    EmptyColumn {
        /// The unknown.
        equation: usize,
    },
    /// The matrix is singular to working precision.
    Singular {
        /// An equation that depends on those eliminated before it.
        equation: usize,
    },
    /// The border is singular to working precision once the sparse equations are eliminated.
    SingularBorder {
        /// Number of the border equation, counted from the first border.
        border: usize,
    },
    /// A solve was asked for before a successful factorisation.
    NotFactored,
}

impl fmt::Display for LinearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoEquations => write!(f, "the system has no equations"),
            Self::TooLarge => write!(f, "the factors of the matrix do not fit in memory"),
            Self::NonFiniteEntry { row, column } => {
                write!(f, "the matrix entry in row {row}, column {column} is not finite")
            }
            Self::NonFiniteRightHandSide { equation } => {
                write!(f, "the right-hand side of equation {equation} is not finite")
            }
            Self::NonFiniteSolution { equation } => {
                write!(f, "the solution for unknown {equation} is not finite")
            }
            Self::EmptyRow { equation } => write!(f, "nothing acts on equation {equation}"),
            Self::EmptyColumn { equation } => write!(f, "unknown {equation} acts on nothing"),
            Self::Singular { equation } => {
                write!(f, "the matrix is singular: equation {equation} depends on the others")
            }
            Self::SingularBorder { border } => {
                write!(f, "the bordered matrix is singular: border {border} depends on the others")
            }
            Self::NotFactored => write!(f, "the matrix has not been factored"),
        }
    }
}

impl std::error::Error for LinearError {}

impl From<ansatz_frontal::Error> for LinearError {
    fn from(error: ansatz_frontal::Error) -> Self {
        use ansatz_frontal::Error;
        match error {
            Error::NoEquations => Self::NoEquations,
            Error::TooLarge => Self::TooLarge,
            Error::EmptyRow { equation } => Self::EmptyRow { equation },
            Error::EmptyColumn { equation } => Self::EmptyColumn { equation },
            Error::NotPositive { equation } => Self::Singular { equation },
        }
    }
}
