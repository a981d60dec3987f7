//! Factors of an unsymmetric matrix: sparse LU with partial pivoting.
//!
//! It also serves symmetric matrices whose zero diagonal defeats pivoting inside supernodes. The
//! pivots are not accessible, so singularity is recognised by solving for a known solution.

use super::error::LinearError;
use super::matrix::ScaledMatrix;
use super::storage::{Scratch, symbolic_matrix, zeros};
use crate::solve::sparse::SparsePattern;
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{LuRef, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par};

/// A matrix counts as singular when a known solution comes back with a larger relative error.
const LARGEST_ERROR: f64 = 1e-2;

/// Storage for the factors of matrices with one pattern.
pub struct UnsymmetricFactor {
    symbolic: SymbolicLu<u32>,
    numeric: NumericLu<u32, f64>,
    pattern: SymbolicSparseColMat<u32>,
    /// Position among the stored entries of every entry of the whole matrix.
    sources: Vec<u32>,
    values: Vec<f64>,
    ones: Vec<f64>,
    probe: Vec<f64>,
    scratch: Scratch,
}

impl UnsymmetricFactor {
    /// Analyses a pattern of either kind; a symmetric one is expanded.
    ///
    /// # Errors
    /// [`LinearError::NoEquations`], [`LinearError::TooLarge`].
    pub fn new(pattern: &SparsePattern) -> Result<Self, LinearError> {
        if pattern.size() == 0 {
            return Err(LinearError::NoEquations);
        }
        let (expanded, sources) = pattern.expanded();
        let pattern = symbolic_matrix(&expanded);
        let symbolic =
            factorize_symbolic_lu(pattern.as_ref(), Default::default()).map_err(|_| LinearError::TooLarge)?;
        let scratch = Scratch::new(&[
            symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ])?;
        Ok(Self {
            numeric: NumericLu::new(),
            values: zeros(sources.len())?,
            ones: vec![1.0; expanded.size()],
            probe: vec![0.0; expanded.size()],
            scratch,
            pattern,
            sources,
            symbolic,
        })
    }

    /// Factors a matrix.
    ///
    /// # Errors
    /// [`LinearError::Singular`] with the equation in elimination order; [`LinearError::TooLarge`].
    pub fn factor(&mut self, matrix: &ScaledMatrix) -> Result<(), LinearError> {
        for (value, &source) in self.values.iter_mut().zip(&self.sources) {
            *value = matrix.values()[source as usize];
        }
        self.symbolic
            .factorize_numeric_lu(
                &mut self.numeric,
                SparseColMatRef::new(self.pattern.as_ref(), &self.values),
                Par::Seq,
                self.scratch.stack(),
                Default::default(),
            )
            .map_err(|error| match error {
                LuError::SymbolicSingular { index } => {
                    LinearError::Singular { equation: self.symbolic.col_perm().arrays().0[index] as usize }
                }
                LuError::Generic(_) => LinearError::TooLarge,
            })?;
        self.check_against_known_solution(matrix)
    }

    /// Solves for a solution of minus ones.
    fn check_against_known_solution(&mut self, matrix: &ScaledMatrix) -> Result<(), LinearError> {
        let mut probe = std::mem::take(&mut self.probe);
        probe.fill(0.0);
        matrix.pattern().subtract_product(matrix.values(), &self.ones, &mut probe);
        let solved = self.solve(&mut probe);
        let wrong = self.wrong_unknown(&probe);
        self.probe = probe;
        solved?;
        wrong.map_or(Ok(()), |equation| Err(LinearError::Singular { equation }))
    }

    /// The unknown of a known solution, minus one everywhere, that tells of a vanishing pivot.
    ///
    /// Back substitution spoils everything eliminated before a pivot of exactly zero, so the last
    /// spoilt unknown is its own; a small pivot brings out the null vector instead.
    fn wrong_unknown(&self, probe: &[f64]) -> Option<usize> {
        let elimination = self.symbolic.col_perm().arrays().0;
        let spoilt = elimination.iter().rev().map(|&k| k as usize).find(|&k| !probe[k].is_finite());
        spoilt.or_else(|| {
            let error = |k: &usize| (probe[*k] + 1.0).abs();
            let worst = (0..probe.len()).max_by(|a, b| error(a).total_cmp(&error(b)))?;
            (error(&worst) > LARGEST_ERROR).then_some(worst)
        })
    }

    /// Solves in place for the columns of `x`, in elimination order, `size` numbers each.
    ///
    /// # Errors
    /// [`LinearError::TooLarge`] when there is no memory for so many columns.
    pub fn solve(&mut self, x: &mut [f64]) -> Result<(), LinearError> {
        let size = self.symbolic.nrows();
        let columns = x.len() / size;
        let stack = self.scratch.stack_for(self.symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq))?;
        let unknowns = MatMut::from_column_major_slice_mut(x, size, columns);
        let factor = LuRef::new_unchecked(&self.symbolic, &self.numeric);
        factor.solve_in_place_with_conj(Conj::No, unknowns, Par::Seq, stack);
        Ok(())
    }
}
