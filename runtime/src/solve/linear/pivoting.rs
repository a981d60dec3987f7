//! Factors of any regular matrix: sparse LU that looks for pivots in whole columns.
//!
//! It is slow and large, and there for matrices that defeat pivoting inside fronts. The pivots are not accessible, so
//! singularity is recognised by solving for a known solution.

use super::error::LinearError;
use super::storage::{Scratch, symbolic_matrix};
use crate::solve::sparse::SparsePattern;
use ansatz_frontal::System;
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{LuRef, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par};

/// A matrix counts as singular when a known solution comes back with a larger relative error.
const LARGEST_ERROR: f64 = 1e-2;

/// Storage for the factors of matrices with one pattern.
pub struct PivotingFactor {
    symbolic: SymbolicLu<u32>,
    numeric: NumericLu<u32, f64>,
    pattern: SymbolicSparseColMat<u32>,
    ones: Vec<f64>,
    probe: Vec<f64>,
    scratch: Scratch,
}

impl PivotingFactor {
    /// Analyses a pattern in which every entry is stored.
    ///
    /// # Errors
    /// [`LinearError::TooLarge`].
    pub fn new(pattern: &SparsePattern) -> Result<Self, LinearError> {
        let size = pattern.size();
        let pattern = symbolic_matrix(pattern);
        let symbolic =
            factorize_symbolic_lu(pattern.as_ref(), Default::default()).map_err(|_| LinearError::TooLarge)?;
        let scratch = Scratch::new(&[
            symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ])?;
        Ok(Self {
            numeric: NumericLu::new(),
            ones: vec![1.0; size],
            probe: vec![0.0; size],
            scratch,
            pattern,
            symbolic,
        })
    }

    /// Factors the matrix of a scaled system.
    ///
    /// # Errors
    /// [`LinearError::Singular`], [`LinearError::TooLarge`].
    pub fn factor(&mut self, system: System<'_>) -> Result<(), LinearError> {
        self.symbolic
            .factorize_numeric_lu(
                &mut self.numeric,
                SparseColMatRef::new(self.pattern.as_ref(), system.values),
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
        self.check_against_known_solution(system)
    }

    /// Solves for a solution of minus ones.
    fn check_against_known_solution(&mut self, system: System<'_>) -> Result<(), LinearError> {
        let mut probe = std::mem::take(&mut self.probe);
        probe.fill(0.0);
        system.pattern.subtract_product(system.values, &self.ones, &mut probe);
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

    /// Solves in place for the columns of `x`, as many numbers each as there are equations.
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
