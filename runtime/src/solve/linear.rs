//! Sparse linear systems: analyse a pattern once, factor many matrices, solve for many right-hand sides.
//!
//! This module and its submodules are the only ones that know the linear algebra library. Matrices
//! are scaled before they are factored, every solution is checked against the matrix
//! and refined where needed, and all storage is kept between factorisations.

mod error;
mod indefinite;
mod matrix;
mod pivoting;
mod storage;
mod sweep;
#[cfg(test)]
mod tests;
mod unsymmetric;

use super::sparse::{MatrixKind, SparsePattern};
pub use ansatz_frontal::SolveReport;
use ansatz_frontal::{Analysis, Error, Factors};
pub(super) use ansatz_frontal::{BACKWARD_ERROR, REFINEMENTS};
pub use error::LinearError;
use indefinite::IndefiniteFactor;
use matrix::ScaledMatrix;

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
    factors: AllFactors,
    factored: Option<Method>,
    rhs: Vec<f64>,
    solution: Vec<f64>,
    residual: Vec<f64>,
}

/// Storage for the factors of every method, allocated when first needed.
struct AllFactors {
    /// Threads of Cholesky and LU.
    threads: usize,
    definite: Option<Factors>,
    indefinite: Option<IndefiniteFactor>,
    unsymmetric: Option<UnsymmetricFactor>,
}

impl LinearSolver {
    /// Chooses an elimination order and allocates the factors.
    ///
    /// # Errors
    /// [`LinearError::NoEquations`], [`LinearError::TooLarge`].
    pub fn new(pattern: &SparsePattern) -> Result<Self, LinearError> {
        let mut factors = AllFactors { threads: 1, definite: None, indefinite: None, unsymmetric: None };
        match pattern.kind() {
            MatrixKind::Symmetric => {
                factors.definite = Some(Factors::new(Analysis::new(pattern.view(), &[])?)?);
            }
            MatrixKind::Unsymmetric => factors.unsymmetric = Some(UnsymmetricFactor::new(pattern)?),
        }
        let [rhs, solution, residual] = [(); 3].map(|()| vec![0.0; pattern.size()]);
        Ok(Self { matrix: ScaledMatrix::new(pattern), factors, factored: None, rhs, solution, residual })
    }

    /// Uses some threads from now on for Cholesky and LU; Bunch-Kaufman and LU with pivots from whole columns take one. The
    /// next matrix is to be factored anew.
    ///
    /// # Errors
    /// [`LinearError::TooLarge`].
    pub fn use_threads(&mut self, threads: usize) -> Result<(), LinearError> {
        self.factored = None;
        self.factors.use_threads(threads)
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
        let report = self.factors.factor(&self.matrix, expected)?;
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
        let lu = &mut self.factors.unsymmetric;
        if let (false, Some(Method::Lu), Some(factor)) = (accurate, self.factored, lu) {
            self.factored = None;
            factor.factor_pivoting()?;
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
        let perturbed = self.factors.unsymmetric.as_ref().is_some_and(UnsymmetricFactor::is_perturbed);
        if perturbed && self.factored == Some(Method::Lu) {
            return self.solve(rhs).map(drop);
        }
        self.load(rhs)?;
        self.solution.copy_from_slice(&self.rhs);
        self.factors.solve(self.factored, &mut self.solution)?;
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
        let Self { matrix, factors, factored, rhs, solution, residual } = self;
        matrix.system().refine(rhs, solution, residual, |x| factors.solve(*factored, x))
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

impl AllFactors {
    fn use_threads(&mut self, threads: usize) -> Result<(), LinearError> {
        self.threads = threads;
        self.definite = self.definite.take().map(|factor| factor.on_threads(threads)).transpose()?;
        self.unsymmetric.as_mut().map_or(Ok(()), |factor| factor.use_threads(threads))
    }

    /// Cholesky if it may and does succeed, else Bunch-Kaufman, else LU.
    fn factor(&mut self, matrix: &ScaledMatrix, expected: Definiteness) -> Result<FactorReport, LinearError> {
        if matrix.pattern().kind() == MatrixKind::Symmetric {
            let attempt = expected == Definiteness::Positive && matrix.has_positive_diagonal();
            if attempt && let Some(report) = self.cholesky(matrix)? {
                return Ok(report);
            }
            if let Some(report) = self.bunch_kaufman(matrix)? {
                return Ok(report);
            }
        }
        self.lu(matrix)
    }

    /// Cholesky, or `None` when a pivot is not positive.
    fn cholesky(&mut self, matrix: &ScaledMatrix) -> Result<Option<FactorReport>, LinearError> {
        let Some(factor) = &mut self.definite else { return Ok(None) };
        factor.reorder(matrix.pattern().view(), &[])?;
        match factor.factor(matrix.values()) {
            Err(Error::NotPositive { .. }) => Ok(None),
            Err(error) => Err(error.into()),
            Ok(pivots) if pivots.smallest < SMALLEST_PIVOT => {
                let equation = factor.analysis().order()[pivots.turn] as usize;
                Err(LinearError::Singular { equation })
            }
            Ok(pivots) => Ok(Some(FactorReport {
                method: Method::Llt,
                negative_pivots: Some(0),
                smallest_pivot: Some(pivots.smallest),
            })),
        }
    }

    /// Bunch-Kaufman, or `None` when the pivots cannot be trusted.
    fn bunch_kaufman(&mut self, matrix: &ScaledMatrix) -> Result<Option<FactorReport>, LinearError> {
        let factor = match &mut self.indefinite {
            Some(factor) => factor,
            None => self.indefinite.insert(IndefiniteFactor::new(matrix.pattern())?),
        };
        let pivots = factor.factor(matrix);
        Ok((pivots.smallest >= SMALLEST_PIVOT).then_some(FactorReport {
            method: Method::Lblt,
            negative_pivots: Some(pivots.negative),
            smallest_pivot: Some(pivots.smallest),
        }))
    }

    /// LU, of either kind.
    fn lu(&mut self, matrix: &ScaledMatrix) -> Result<FactorReport, LinearError> {
        let factor = match &mut self.unsymmetric {
            Some(factor) => factor,
            None => {
                let factor = self.unsymmetric.insert(UnsymmetricFactor::new(matrix.pattern())?);
                factor.use_threads(self.threads)?;
                factor
            }
        };
        factor.factor(matrix)?;
        let method = if factor.is_pivoted() { Method::PivotingLu } else { Method::Lu };
        Ok(FactorReport { method, negative_pivots: None, smallest_pivot: None })
    }

    /// Solves in place with the factors of a method.
    fn solve(&mut self, factored: Option<Method>, x: &mut [f64]) -> Result<(), LinearError> {
        match (factored, self) {
            (Some(Method::Llt), Self { definite: Some(factor), .. }) => factor.solve(x),
            (Some(Method::Lblt), Self { indefinite: Some(factor), .. }) => factor.solve(x),
            (Some(Method::Lu | Method::PivotingLu), Self { unsymmetric: Some(factor), .. }) => {
                return factor.solve(x);
            }
            _ => return Err(LinearError::NotFactored),
        }
        Ok(())
    }
}
