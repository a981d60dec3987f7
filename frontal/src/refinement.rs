//! Iterative refinement: every solution is checked against the matrix and corrected where it is not accurate to rounding.

use crate::pattern::Pattern;

/// Backward error above which a solution is refined.
pub const BACKWARD_ERROR: f64 = 1e-13;
/// Refinement steps at most.
pub const REFINEMENTS: usize = 4;

/// How well solutions satisfy a system, the worst over the right-hand sides, in maximum norms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// Normwise backward error `|b - A x| / (|A| |x| + |b|)`.
    pub backward_error: f64,
    /// Residual relative to the right-hand side, `|b - A x| / |b|`.
    pub relative_residual: f64,
    /// Refinement steps taken.
    pub refinements: usize,
}

/// A system of equations whose solutions are checked.
#[derive(Clone, Copy, Debug)]
pub struct System<'a> {
    /// Pattern of the matrix.
    pub pattern: Pattern<'a>,
    /// Its entries.
    pub values: &'a [f64],
    /// Its norm: the largest sum of magnitudes in a row.
    pub norm: f64,
}

impl System<'_> {
    /// Writes `b - A x` for every column and says how large it is.
    pub fn residual(&self, x: &[f64], b: &[f64], residual: &mut [f64]) -> SolveReport {
        let size = self.pattern.size();
        let mut report = SolveReport::default();
        residual.copy_from_slice(b);
        let columns = residual.chunks_exact_mut(size).zip(x.chunks_exact(size)).zip(b.chunks_exact(size));
        for ((residual, x), b) in columns {
            self.pattern.subtract_product(self.values, x, residual);
            let (error, rhs) = (max_norm(residual), max_norm(b));
            if error.is_nan() {
                return SolveReport { backward_error: f64::NAN, relative_residual: f64::NAN, refinements: 0 };
            }
            if error > 0.0 {
                let backward = error / (self.norm * max_norm(x) + rhs);
                report.backward_error = report.backward_error.max(backward);
                report.relative_residual = report.relative_residual.max(error / rhs);
            }
        }
        report
    }

    /// Solves `A x = b` by an approximate `solve`, which works in place, and corrections until the backward error is a
    /// matter of rounding or shrinks no more. `residual` is left behind.
    ///
    /// # Errors
    /// Those of `solve`.
    pub fn refine<E>(
        &self,
        b: &[f64],
        x: &mut [f64],
        residual: &mut [f64],
        mut solve: impl FnMut(&mut [f64]) -> Result<(), E>,
    ) -> Result<SolveReport, E> {
        x.copy_from_slice(b);
        solve(x)?;
        let mut report = self.residual(x, b, residual);
        while report.backward_error > BACKWARD_ERROR && report.refinements < REFINEMENTS {
            solve(residual)?;
            x.iter_mut().zip(&*residual).for_each(|(x, correction)| *x += correction);
            let after = self.residual(x, b, residual);
            let converges = after.backward_error <= 0.5 * report.backward_error;
            report = SolveReport { refinements: report.refinements + 1, ..after };
            if !converges {
                break;
            }
        }
        Ok(report)
    }
}

/// Largest magnitude, or what is not a number.
fn max_norm(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |largest, value| if value.abs() <= largest { largest } else { value.abs() })
}
