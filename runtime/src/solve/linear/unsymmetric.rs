//! Factors of an unsymmetric matrix: multifrontal LU, and LU with unrestricted pivoting where that is not enough.
//!
//! It also serves symmetric matrices whose zero diagonal defeats pivoting inside supernodes. Pivots that are no more than
//! rounding errors are replaced and leave a doubt, which a known solution settles: the matrix may be regular and refinement
//! restores the accuracy, it may be singular, or it may need pivots from outside a front.

use super::error::LinearError;
use super::matrix::ScaledMatrix;
use super::pivoting::PivotingFactor;
use crate::solve::sparse::SparsePattern;
use ansatz_frontal::{Analysis, Factors, Pivots, SolveReport, System};

/// Backward error that a solution must not exceed after refinement.
pub const ACCEPTABLE: f64 = 1e-12;
/// Smallest pivot, relative to the entries of the scaled matrix, that leaves no doubt.
const SMALLEST_PIVOT: f64 = 1e-10;
/// Growth of the entries that leaves no doubt.
const LARGEST_PIVOT: f64 = 1e8;
/// A matrix counts as singular when a known solution comes back with a larger relative error.
const LARGEST_ERROR: f64 = 1e-2;

/// Storage for the factors of matrices with one pattern.
pub struct UnsymmetricFactor {
    /// Every entry of the matrix.
    pattern: SparsePattern,
    /// Position among the stored entries of every entry.
    sources: Vec<u32>,
    values: Vec<f64>,
    norm: f64,
    /// Whether the diagonal entry of an unknown was ever zero: it is eliminated late.
    weak: Vec<bool>,
    /// Threads that eliminate fronts.
    threads: usize,
    fronts: Option<Factors>,
    pivoting: Option<PivotingFactor>,
    /// Which factors hold the matrix.
    pivoted: bool,
    perturbed: bool,
}

impl UnsymmetricFactor {
    /// Takes over a pattern of either kind; a symmetric one is expanded.
    ///
    /// # Errors
    /// [`LinearError::NoEquations`].
    pub fn new(pattern: &SparsePattern) -> Result<Self, LinearError> {
        if pattern.size() == 0 {
            return Err(LinearError::NoEquations);
        }
        let (pattern, sources) = pattern.expanded();
        Ok(Self {
            values: vec![0.0; sources.len()],
            weak: vec![false; pattern.size()],
            pattern,
            sources,
            norm: 0.0,
            threads: 1,
            fronts: None,
            pivoting: None,
            pivoted: false,
            perturbed: false,
        })
    }

    /// Factors on some threads from now on; LU with unrestricted pivoting takes one.
    ///
    /// # Errors
    /// [`LinearError::TooLarge`].
    pub fn use_threads(&mut self, threads: usize) -> Result<(), LinearError> {
        self.threads = threads;
        self.fronts = self.fronts.take().map(|fronts| fronts.on_threads(threads)).transpose()?;
        Ok(())
    }

    /// Whether pivots were looked for in whole columns.
    pub fn is_pivoted(&self) -> bool {
        self.pivoted
    }

    /// Whether solutions are inaccurate without refinement.
    pub fn is_perturbed(&self) -> bool {
        self.perturbed
    }

    /// Factors a matrix.
    ///
    /// # Errors
    /// [`LinearError::Singular`], [`LinearError::TooLarge`].
    pub fn factor(&mut self, matrix: &ScaledMatrix) -> Result<(), LinearError> {
        self.load(matrix);
        let mut fronts = match self.fronts.take() {
            Some(mut fronts) => {
                fronts.reorder(self.pattern.view(), &self.weak_unknowns())?;
                fronts
            }
            None => {
                let analysis = Analysis::new(self.pattern.view(), &self.weak_unknowns())?;
                Factors::with_threads(analysis, self.threads)?
            }
        };
        let pivots = fronts.factor(&self.values)?;
        self.perturbed = pivots.perturbed > 0;
        let doubtful = pivots.smallest < SMALLEST_PIVOT || pivots.largest > LARGEST_PIVOT || self.perturbed;
        let verdict = if doubtful { self.settle(&mut fronts, pivots) } else { Verdict::Regular };
        self.fronts = Some(fronts);
        match verdict {
            Verdict::Regular => Ok(()),
            Verdict::Singular { equation } => Err(LinearError::Singular { equation }),
            Verdict::Inaccurate => self.factor_pivoting(),
        }
    }

    /// Takes over the values. Unknowns that lose their diagonal entry ask for another order of elimination.
    fn load(&mut self, matrix: &ScaledMatrix) {
        for (value, &source) in self.values.iter_mut().zip(&self.sources) {
            *value = matrix.system().values[source as usize];
        }
        self.norm = matrix.system().norm;
        self.pivoted = false;
        for (equation, weak) in self.weak.iter_mut().enumerate() {
            let diagonal = self.pattern.position(equation as u32, equation as u32);
            if !*weak && diagonal.is_none_or(|position| self.values[position] == 0.0) {
                *weak = true;
                self.fronts = None;
            }
        }
    }

    fn weak_unknowns(&self) -> Vec<u32> {
        (0..self.weak.len() as u32).filter(|&k| self.weak[k as usize]).collect()
    }

    /// Solves for a known solution of ones.
    fn settle(&self, fronts: &mut Factors, pivots: Pivots) -> Verdict {
        let size = self.pattern.size();
        let [mut b, mut x, mut residual] = [(); 3].map(|()| vec![0.0; size]);
        self.pattern.subtract_product(&self.values, &vec![-1.0; size], &mut b);
        let report: Result<SolveReport, LinearError> = self.system().refine(&b, &mut x, &mut residual, |x| {
            fronts.solve(x);
            Ok(())
        });
        let accurate = report.is_ok_and(|report| report.backward_error <= ACCEPTABLE);
        let error = x.iter().fold(0.0, |largest: f64, x| largest.max((x - 1.0).abs()));
        match (accurate, error <= LARGEST_ERROR) {
            (true, true) => Verdict::Regular,
            (true, false) => Verdict::Singular { equation: fronts.analysis().order()[pivots.turn] as usize },
            (false, _) => Verdict::Inaccurate,
        }
    }

    fn system(&self) -> System<'_> {
        System { pattern: self.pattern.view(), values: &self.values, norm: self.norm }
    }

    /// Factors the same matrix again, with pivots from whole columns.
    ///
    /// # Errors
    /// As [`Self::factor`].
    pub fn factor_pivoting(&mut self) -> Result<(), LinearError> {
        let mut factor = match self.pivoting.take() {
            Some(factor) => factor,
            None => PivotingFactor::new(&self.pattern)?,
        };
        let result = factor.factor(self.system());
        self.pivoting = Some(factor);
        (self.pivoted, self.perturbed) = (true, false);
        result
    }

    /// Solves in place for the columns of `x`, as many numbers each as there are equations.
    ///
    /// # Errors
    /// [`LinearError::TooLarge`] when there is no memory for so many columns; [`LinearError::NotFactored`].
    pub fn solve(&mut self, x: &mut [f64]) -> Result<(), LinearError> {
        match (self.pivoted, &mut self.pivoting, &mut self.fronts) {
            (true, Some(factor), _) => factor.solve(x),
            (false, _, Some(fronts)) => {
                fronts.solve(x);
                Ok(())
            }
            _ => Err(LinearError::NotFactored),
        }
    }
}

/// What a known solution says about a factorisation.
enum Verdict {
    Regular,
    Singular { equation: usize },
    Inaccurate,
}
