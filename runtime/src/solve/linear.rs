//! Sparse linear systems: analyse a pattern once, factor many matrices, solve for many right-hand sides.
//!
//! This module and its submodules are the only ones that know the linear algebra library. Matrices
//! are scaled before they are factored, every solution is checked against the matrix
//! and refined where needed, and all storage is kept between factorisations.

mod error;
mod matrix;
mod scaling;
mod storage;
mod sweep;
mod symmetric;
#[cfg(test)]
mod tests;
mod unsymmetric;

use super::sparse::{MatrixKind, SparsePattern};
pub use error::LinearError;
use matrix::ScaledMatrix;
use symmetric::{Analysis, Pivots, SymmetricFactor};
use unsymmetric::UnsymmetricFactor;

/// Pivots of the scaled matrix below this are rounding errors: the matrix is singular.
const SMALLEST_PIVOT: f64 = 64.0 * f64::EPSILON;
/// Backward error above which a solution is refined.
pub(super) const BACKWARD_ERROR: f64 = 1e-13;
/// Refinement steps at most.
pub(super) const REFINEMENTS: usize = 2;

/// What a symmetric matrix is expected to be; a wrong guess costs time and nothing else.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Definiteness {
    /// All eigenvalues positive: try Cholesky first.
    #[default]
    Positive,
    /// Eigenvalues of both signs: start with Bunch-Kaufman.
    Indefinite,
}

/// How a matrix was factored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Cholesky: the matrix is symmetric and positive definite.
    Llt,
    /// Bunch-Kaufman: the matrix is symmetric.
    Lblt,
    /// LU with partial pivoting.
    Lu,
}

/// Outcome of a factorisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorReport {
    /// How the matrix was factored.
    pub method: Method,
    /// Number of negative eigenvalues; `None` when LU, which does not tell, had to be used.
    pub negative_pivots: Option<usize>,
    /// Smallest pivot of the scaled matrix, whose diagonal is near one; `None` for LU.
    pub smallest_pivot: Option<f64>,
}

impl FactorReport {
    /// What to expect of the next matrix of a sequence in which changes are gradual.
    pub fn definiteness(&self) -> Definiteness {
        match self.negative_pivots {
            Some(0) => Definiteness::Positive,
            _ => Definiteness::Indefinite,
        }
    }
}

/// Outcome of a solve, the worst over the right-hand sides, in maximum norms of the scaled system.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// Normwise backward error `|b - A x| / (|A| |x| + |b|)`.
    pub backward_error: f64,
    /// Residual relative to the right-hand side, `|b - A x| / |b|`.
    pub relative_residual: f64,
    /// Refinement steps taken.
    pub refinements: usize,
}

/// Direct solver for matrices that share one pattern.
pub struct LinearSolver {
    matrix: ScaledMatrix,
    /// Present for symmetric patterns.
    symmetric: Option<SymmetricFactor>,
    /// Present for unsymmetric patterns, and once a symmetric matrix has needed it.
    unsymmetric: Option<UnsymmetricFactor>,
    factored: Option<Method>,
    rhs: Vec<f64>,
    solution: Vec<f64>,
    residual: Vec<f64>,
}

impl LinearSolver {
    /// Chooses an elimination order and allocates the factors.
    ///
    /// # Errors
    /// [`LinearError::NoEquations`], [`LinearError::TooLarge`].
    pub fn new(pattern: &SparsePattern) -> Result<Self, LinearError> {
        let (matrix, symmetric, unsymmetric) = match pattern.kind() {
            MatrixKind::Symmetric => {
                let analysis = Analysis::new(pattern)?;
                let matrix = ScaledMatrix::new(pattern, analysis.order());
                let factor = SymmetricFactor::new(analysis, matrix.pattern())?;
                (matrix, Some(factor), None)
            }
            MatrixKind::Unsymmetric => {
                let factor = UnsymmetricFactor::new(pattern)?;
                let matrix = ScaledMatrix::new(pattern, (0..pattern.size() as u32).collect());
                (matrix, None, Some(factor))
            }
        };
        let [rhs, solution, residual] = [(); 3].map(|()| vec![0.0; pattern.size()]);
        Ok(Self { matrix, symmetric, unsymmetric, factored: None, rhs, solution, residual })
    }

    /// Number of equations.
    pub fn size(&self) -> usize {
        self.matrix.size()
    }

    /// Factors a matrix given by the values at the positions of the pattern.
    ///
    /// A symmetric matrix expected to be positive definite is factored by Cholesky; when that
    /// fails, or is not expected to succeed, by Bunch-Kaufman, and by LU if that breaks down.
    ///
    /// # Errors
    /// Entries that are not finite, empty rows or columns, singular matrices, want of memory.
    pub fn factor(&mut self, values: &[f64], expected: Definiteness) -> Result<FactorReport, LinearError> {
        self.factored = None;
        self.matrix.load(values)?;
        let report = match &mut self.symmetric {
            Some(factor) => factor_symmetric(factor, &self.matrix, expected),
            None => Ok(None),
        };
        let report = match report {
            Ok(Some(report)) => Ok(report),
            Ok(None) => factor_unsymmetric(&mut self.unsymmetric, &self.matrix),
            Err(error) => Err(error),
        };
        let report = report.map_err(|error| self.matrix.in_original_numbers(error))?;
        self.factored = Some(report.method);
        Ok(report)
    }

    /// Solves in place for one or several right-hand sides, [`Self::size`] numbers each.
    ///
    /// The residual of every solution is computed with the matrix itself; up to two steps of
    /// iterative refinement follow where the backward error is more than rounding.
    ///
    /// # Errors
    /// [`LinearError::NotFactored`], right-hand sides or solutions that are not finite.
    pub fn solve(&mut self, rhs: &mut [f64]) -> Result<SolveReport, LinearError> {
        self.load(rhs)?;
        self.apply_factor(Target::Solution)?;
        let mut report = self.check();
        while report.backward_error > BACKWARD_ERROR && report.refinements < REFINEMENTS {
            let before = report;
            report = self.refine(before)?;
            if report.backward_error > 0.5 * before.backward_error {
                break;
            }
        }
        self.unload(rhs)?;
        Ok(report)
    }

    /// As [`Self::solve`], leaving the check of the residual to the caller.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub(super) fn solve_unchecked(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        self.load(rhs)?;
        self.apply_factor(Target::Solution)?;
        self.unload(rhs)
    }

    /// Takes over right-hand sides, with which a solution starts.
    fn load(&mut self, rhs: &[f64]) -> Result<(), LinearError> {
        self.resize(rhs.len());
        let size = self.size();
        for (original, scaled) in rhs.chunks_exact(size).zip(self.rhs.chunks_exact_mut(size)) {
            self.matrix.load_rhs(original, scaled)?;
        }
        self.solution.copy_from_slice(&self.rhs);
        Ok(())
    }

    /// Hands out the solutions.
    fn unload(&self, solutions: &mut [f64]) -> Result<(), LinearError> {
        let size = self.size();
        let mut columns = self.solution.chunks_exact(size).zip(solutions.chunks_exact_mut(size));
        columns.try_for_each(|(scaled, original)| self.matrix.unload_solution(scaled, original))
    }

    /// Adds the correction that the residual asks for.
    fn refine(&mut self, before: SolveReport) -> Result<SolveReport, LinearError> {
        self.apply_factor(Target::Residual)?;
        self.solution.iter_mut().zip(&self.residual).for_each(|(x, correction)| *x += correction);
        Ok(SolveReport { refinements: before.refinements + 1, ..self.check() })
    }

    fn apply_factor(&mut self, target: Target) -> Result<(), LinearError> {
        let x = match target {
            Target::Solution => &mut self.solution,
            Target::Residual => &mut self.residual,
        };
        match (self.factored, &mut self.symmetric, &mut self.unsymmetric) {
            (Some(Method::Llt | Method::Lblt), Some(factor), _) => {
                factor.solve(x);
                Ok(())
            }
            (Some(Method::Lu), _, Some(factor)) => factor.solve(x),
            _ => Err(LinearError::NotFactored),
        }
    }

    /// Replaces a right-hand side `b` by the residual `b - A x` of any `x`, and says how large it is.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn residual(&mut self, x: &[f64], b: &mut [f64]) -> Result<SolveReport, LinearError> {
        self.resize(b.len());
        self.matrix.load_rhs(b, &mut self.rhs)?;
        self.matrix.load_solution(x, &mut self.solution);
        let report = self.check();
        self.matrix.unload_residual(&self.residual, b);
        Ok(report)
    }

    fn resize(&mut self, length: usize) {
        for buffer in [&mut self.rhs, &mut self.solution, &mut self.residual] {
            buffer.resize(length, 0.0);
        }
    }

    /// Residuals of all columns, and how large they are.
    fn check(&mut self) -> SolveReport {
        let size = self.size();
        let mut report = SolveReport::default();
        self.residual.copy_from_slice(&self.rhs);
        for (column, residual) in self.residual.chunks_exact_mut(size).enumerate() {
            let range = column * size..(column + 1) * size;
            let (x, b) = (&self.solution[range.clone()], &self.rhs[range]);
            self.matrix.pattern().subtract_product(self.matrix.values(), x, residual);
            let (error, rhs) = (max_norm(residual), max_norm(b));
            if error > 0.0 {
                let backward = error / (self.matrix.norm() * max_norm(x) + rhs);
                report.backward_error = report.backward_error.max(backward);
                report.relative_residual = report.relative_residual.max(error / rhs);
            }
        }
        report
    }
}

/// The vector that a factorisation is applied to.
#[derive(Clone, Copy)]
enum Target {
    Solution,
    Residual,
}

/// Cholesky if it may and does succeed, else Bunch-Kaufman; `None` when neither can be trusted.
fn factor_symmetric(
    factor: &mut SymmetricFactor,
    matrix: &ScaledMatrix,
    expected: Definiteness,
) -> Result<Option<FactorReport>, LinearError> {
    let report = |method, pivots: Pivots| FactorReport {
        method,
        negative_pivots: Some(pivots.negative),
        smallest_pivot: Some(pivots.smallest),
    };
    let attempt = expected == Definiteness::Positive && matrix.has_positive_diagonal();
    if let Some(pivots) = attempt.then(|| factor.llt(matrix)).flatten() {
        return match pivots.smallest >= SMALLEST_PIVOT {
            true => Ok(Some(report(Method::Llt, pivots))),
            false => Err(LinearError::Singular { equation: pivots.equation }),
        };
    }
    let pivots = factor.lblt(matrix);
    Ok((pivots.smallest >= SMALLEST_PIVOT).then(|| report(Method::Lblt, pivots)))
}

/// LU, analysed when first needed.
fn factor_unsymmetric(
    factor: &mut Option<UnsymmetricFactor>,
    matrix: &ScaledMatrix,
) -> Result<FactorReport, LinearError> {
    let factor = match factor {
        Some(factor) => factor,
        None => factor.insert(UnsymmetricFactor::new(matrix.pattern())?),
    };
    factor.factor(matrix)?;
    Ok(FactorReport { method: Method::Lu, negative_pivots: None, smallest_pivot: None })
}

/// Largest magnitude.
fn max_norm(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}
