//! The matrix as it is factored: scaled so that its entries are near one.
//!
//! Everything between loading the assembled values and handing back a solution happens in these terms.

use super::error::LinearError;
use crate::solve::sparse::SparsePattern;
use ansatz_frontal::{Scaling, System};

/// Scaled copy `R A C` of an assembled matrix `A`.
#[derive(Debug)]
pub struct ScaledMatrix {
    pattern: SparsePattern,
    values: Vec<f64>,
    scaling: Scaling,
    norm: f64,
}

impl ScaledMatrix {
    /// Prepares to load matrices with `pattern`.
    pub fn new(pattern: &SparsePattern) -> Self {
        Self {
            values: vec![0.0; pattern.entries()],
            scaling: Scaling::new(pattern.size()),
            pattern: pattern.clone(),
            norm: 0.0,
        }
    }

    /// Number of equations.
    pub fn size(&self) -> usize {
        self.pattern.size()
    }

    /// Pattern of the stored entries.
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

    /// Takes over assembled values and scales them.
    ///
    /// # Errors
    /// Entries that are not finite; rows and columns without a non-zero entry.
    pub fn load(&mut self, assembled: &[f64]) -> Result<(), LinearError> {
        if !assembled.iter().all(|value| value.is_finite()) {
            return Err(self.non_finite_entry(assembled));
        }
        self.values.copy_from_slice(assembled);
        self.scaling.fit(self.pattern.view(), &self.values)?;
        self.norm = self.scaling.apply(self.pattern.view(), &mut self.values);
        Ok(())
    }

    /// Scales a right-hand side.
    ///
    /// # Errors
    /// [`LinearError::NonFiniteRightHandSide`].
    pub fn load_rhs(&self, original: &[f64], scaled: &mut [f64]) -> Result<(), LinearError> {
        for ((scaled, value), factor) in scaled.iter_mut().zip(original).zip(&self.scaling.rows) {
            *scaled = value * factor;
        }
        match original.iter().position(|value| !value.is_finite()) {
            Some(equation) => Err(LinearError::NonFiniteRightHandSide { equation }),
            None => Ok(()),
        }
    }

    /// Undoes the scaling of a solution.
    ///
    /// # Errors
    /// [`LinearError::NonFiniteSolution`].
    pub fn unload_solution(&self, scaled: &[f64], original: &mut [f64]) -> Result<(), LinearError> {
        for ((value, scaled), factor) in original.iter_mut().zip(scaled).zip(&self.scaling.columns) {
            *value = scaled * factor;
        }
        match original.iter().position(|value| !value.is_finite()) {
            Some(equation) => Err(LinearError::NonFiniteSolution { equation }),
            None => Ok(()),
        }
    }

    /// Scales a solution: the inverse of [`Self::unload_solution`].
    pub fn load_solution(&self, original: &[f64], scaled: &mut [f64]) {
        for ((scaled, value), factor) in scaled.iter_mut().zip(original).zip(&self.scaling.columns) {
            *scaled = value / factor;
        }
    }

    /// Undoes the scaling of a residual.
    pub fn unload_residual(&self, scaled: &[f64], original: &mut [f64]) {
        for ((value, scaled), factor) in original.iter_mut().zip(scaled).zip(&self.scaling.rows) {
            *value = scaled / factor;
        }
    }

    /// The last entry that is not finite.
    fn non_finite_entry(&self, assembled: &[f64]) -> LinearError {
        let mut found = LinearError::NoEquations;
        self.pattern.for_each(|position, row, column| {
            if !assembled[position].is_finite() {
                found = LinearError::NonFiniteEntry { row, column };
            }
        });
        found
    }
}
