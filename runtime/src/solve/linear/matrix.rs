//! The matrix as it is factored: scaled, and its equations in elimination order.
//!
//! Everything between loading the assembled values and handing back a solution happens in these
//! terms; original equation numbers reappear only in results and errors.

use super::error::LinearError;
use crate::solve::sparse::SparsePattern;
use ansatz_frontal::{Scaling, System};

/// Scaled and reordered copy `P R A C P^T` of an assembled matrix `A`.
#[derive(Debug)]
pub struct ScaledMatrix {
    pattern: SparsePattern,
    values: Vec<f64>,
    /// Position in the assembled values of every entry.
    sources: Vec<u32>,
    /// Original number of every equation.
    order: Vec<u32>,
    scaling: Scaling,
    norm: f64,
}

impl ScaledMatrix {
    /// Prepares to load matrices with `pattern`, eliminating `order[0]` first.
    pub fn new(pattern: &SparsePattern, order: Vec<u32>) -> Self {
        let size = pattern.size();
        let (pattern, sources) = pattern.reordered(&order);
        Self {
            values: vec![0.0; pattern.entries()],
            pattern,
            sources,
            order,
            scaling: Scaling::new(size),
            norm: 0.0,
        }
    }

    /// Number of equations.
    pub fn size(&self) -> usize {
        self.order.len()
    }

    /// Pattern in elimination order.
    pub fn pattern(&self) -> &SparsePattern {
        &self.pattern
    }

    /// Scaled entries.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The scaled system, whose solutions can be checked.
    pub fn system(&self) -> System<'_> {
        System { pattern: self.pattern.view(), values: &self.values, norm: self.norm }
    }

    /// Whether every diagonal entry is positive, without which the matrix is not positive definite.
    ///
    /// For symmetric patterns, whose columns start with the diagonal.
    pub fn has_positive_diagonal(&self) -> bool {
        (0..self.size()).all(|column| self.values[self.pattern.column(column).start] > 0.0)
    }

    /// Original number of the equation that is eliminated `k`-th.
    pub fn equation(&self, k: usize) -> usize {
        self.order[k] as usize
    }

    /// Takes over assembled values and scales them.
    ///
    /// # Errors
    /// Entries that are not finite; rows and columns without a non-zero entry.
    pub fn load(&mut self, assembled: &[f64]) -> Result<(), LinearError> {
        let mut finite = true;
        for (value, &source) in self.values.iter_mut().zip(&self.sources) {
            *value = assembled[source as usize];
            finite &= value.is_finite();
        }
        if !finite {
            return Err(self.non_finite_entry());
        }
        let pattern = self.pattern.view();
        let fitted = self.scaling.fit(pattern, &self.values).map_err(LinearError::from);
        fitted.map_err(|error| self.in_original_numbers(error))?;
        self.norm = self.scaling.apply(pattern, &mut self.values);
        Ok(())
    }

    /// Replaces a pivot position by the original equation number.
    pub fn in_original_numbers(&self, error: LinearError) -> LinearError {
        use LinearError::{EmptyColumn, EmptyRow, Singular};
        match error {
            EmptyRow { equation } => EmptyRow { equation: self.equation(equation) },
            EmptyColumn { equation } => EmptyColumn { equation: self.equation(equation) },
            Singular { equation } => Singular { equation: self.equation(equation) },
            other => other,
        }
    }

    /// Scales and reorders a right-hand side.
    ///
    /// # Errors
    /// [`LinearError::NonFiniteRightHandSide`].
    pub fn load_rhs(&self, original: &[f64], scaled: &mut [f64]) -> Result<(), LinearError> {
        for ((value, &equation), factor) in scaled.iter_mut().zip(&self.order).zip(&self.scaling.rows) {
            *value = original[equation as usize] * factor;
        }
        match original.iter().position(|value| !value.is_finite()) {
            Some(equation) => Err(LinearError::NonFiniteRightHandSide { equation }),
            None => Ok(()),
        }
    }

    /// Undoes scaling and order of a solution.
    ///
    /// # Errors
    /// [`LinearError::NonFiniteSolution`].
    pub fn unload_solution(&self, scaled: &[f64], original: &mut [f64]) -> Result<(), LinearError> {
        for ((value, &equation), factor) in scaled.iter().zip(&self.order).zip(&self.scaling.columns) {
            original[equation as usize] = value * factor;
        }
        match original.iter().position(|value| !value.is_finite()) {
            Some(equation) => Err(LinearError::NonFiniteSolution { equation }),
            None => Ok(()),
        }
    }

    /// Scales and reorders a solution: the inverse of [`Self::unload_solution`].
    pub fn load_solution(&self, original: &[f64], scaled: &mut [f64]) {
        for ((value, &equation), factor) in scaled.iter_mut().zip(&self.order).zip(&self.scaling.columns) {
            *value = original[equation as usize] / factor;
        }
    }

    /// Undoes scaling and order of a residual.
    pub fn unload_residual(&self, scaled: &[f64], original: &mut [f64]) {
        for ((value, &equation), factor) in scaled.iter().zip(&self.order).zip(&self.scaling.rows) {
            original[equation as usize] = value / factor;
        }
    }

    /// The last entry that is not finite.
    fn non_finite_entry(&self) -> LinearError {
        let mut found = LinearError::NoEquations;
        self.pattern.for_each(|position, row, column| {
            if !self.values[position].is_finite() {
                found =
                    LinearError::NonFiniteEntry { row: self.equation(row), column: self.equation(column) };
            }
        });
        found
    }
}
