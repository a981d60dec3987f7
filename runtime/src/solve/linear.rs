//! Sparse linear systems: analyse a pattern once, factor many matrices, solve for many right-hand sides.
//!
//! This module and its submodules are the only ones that know the linear algebra library. Matrices
//! are scaled before they are factored, every solution is checked against the matrix
//! and refined where needed, and all storage is kept between factorisations.

mod error;
mod matrix;
mod pivoting;
mod storage;
mod sweep;
mod symmetric;
#[cfg(test)]
mod tests;
mod unsymmetric;

use super::sparse::{MatrixKind, SparsePattern};
pub use ansatz_frontal::SolveReport;
pub(super) use ansatz_frontal::{BACKWARD_ERROR, REFINEMENTS};
pub use error::LinearError;
use matrix::ScaledMatrix;
use symmetric::{Analysis, Pivots, SymmetricFactor};
use unsymmetric::{ACCEPTABLE, UnsymmetricFactor};

/// Pivots of the scaled matrix below this are rounding errors: the matrix is singular.
const SMALLEST_PIVOT: f64 = 64.0 * f64::EPSILON;

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
    /// LU with pivots from inside the fronts.
    Lu,
    /// LU with pivots from whole columns: slow, and the last resort.
    PivotingLu,
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
    /// The residual of every solution is computed with the matrix itself; steps of iterative refinement follow where the
    /// backward error is more than rounding. LU that stays inaccurate is replaced by LU with unrestricted pivoting.
    ///
    /// # Errors
    /// [`LinearError::NotFactored`], right-hand sides or solutions that are not finite.
    pub fn solve(&mut self, rhs: &mut [f64]) -> Result<SolveReport, LinearError> {
        self.load(rhs)?;
        let mut report = self.refine()?;
        let accurate = report.backward_error <= ACCEPTABLE;
        if let (false, Some(Method::Lu), Some(factor)) = (accurate, self.factored, &mut self.unsymmetric) {
            self.factored = None;
            factor.factor_pivoting().map_err(|error| self.matrix.in_original_numbers(error))?;
            self.factored = Some(Method::PivotingLu);
            report = self.refine()?;
        }
        self.unload(rhs)?;
        Ok(report)
    }

    /// As [`Self::solve`], leaving the check of the residual to the caller.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub(super) fn solve_unchecked(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        let perturbed = self.unsymmetric.as_ref().is_some_and(UnsymmetricFactor::is_perturbed);
        if perturbed && self.factored == Some(Method::Lu) {
            return self.solve(rhs).map(drop);
        }
        self.load(rhs)?;
        self.solution.copy_from_slice(&self.rhs);
        apply(self.factored, &mut self.symmetric, &mut self.unsymmetric, &mut self.solution)?;
        self.unload(rhs)
    }

    /// Takes over right-hand sides.
    fn load(&mut self, rhs: &[f64]) -> Result<(), LinearError> {
        self.resize(rhs.len());
        let size = self.size();
        for (original, scaled) in rhs.chunks_exact(size).zip(self.rhs.chunks_exact_mut(size)) {
            self.matrix.load_rhs(original, scaled)?;
        }
        Ok(())
    }

    /// Hands out the solutions.
    fn unload(&self, solutions: &mut [f64]) -> Result<(), LinearError> {
        let size = self.size();
        let mut columns = self.solution.chunks_exact(size).zip(solutions.chunks_exact_mut(size));
        columns.try_for_each(|(scaled, original)| self.matrix.unload_solution(scaled, original))
    }

    /// Solves for the right-hand sides, with refinement.
    fn refine(&mut self) -> Result<SolveReport, LinearError> {
        let Self { matrix, symmetric, unsymmetric, factored, rhs, solution, residual } = self;
        matrix.system().refine(rhs, solution, residual, |x| apply(*factored, symmetric, unsymmetric, x))
    }

    /// Replaces a right-hand side `b` by the residual `b - A x` of any `x`, and says how large it is.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn residual(&mut self, x: &[f64], b: &mut [f64]) -> Result<SolveReport, LinearError> {
        self.resize(b.len());
        self.matrix.load_rhs(b, &mut self.rhs)?;
        self.matrix.load_solution(x, &mut self.solution);
        let report = self.matrix.system().residual(&self.solution, &self.rhs, &mut self.residual);
        self.matrix.unload_residual(&self.residual, b);
        Ok(report)
    }

    fn resize(&mut self, length: usize) {
        for buffer in [&mut self.rhs, &mut self.solution, &mut self.residual] {
            buffer.resize(length, 0.0);
        }
    }
}

/// Solves in place with whatever holds the factors, for the columns of `x` in elimination order.
fn apply(
    factored: Option<Method>,
    symmetric: &mut Option<SymmetricFactor>,
    unsymmetric: &mut Option<UnsymmetricFactor>,
    x: &mut [f64],
) -> Result<(), LinearError> {
    match (factored, symmetric, unsymmetric) {
        (Some(Method::Llt | Method::Lblt), Some(factor), _) => {
            factor.solve(x);
            Ok(())
        }
        (Some(Method::Lu | Method::PivotingLu), _, Some(factor)) => factor.solve(x),
        _ => Err(LinearError::NotFactored),
    }
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
    let method = if factor.is_pivoted() { Method::PivotingLu } else { Method::Lu };
    Ok(FactorReport { method, negative_pivots: None, smallest_pivot: None })
}
