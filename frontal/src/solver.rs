//! A direct solver for matrices of any scale: equilibration, factorisation and checked solutions.

use crate::analysis::Analysis;
use crate::error::Error;
use crate::factors::Factors;
use crate::pattern::{Kind, Pattern};
use crate::pivot::Pivots;
use crate::refinement::{SolveReport, System};
use crate::scaling::Scaling;
use std::convert::Infallible;

/// Direct solver for matrices that share one pattern.
pub struct Solver {
    kind: Kind,
    starts: Vec<u32>,
    rows: Vec<u32>,
    weak: Vec<u32>,
    scaling: Scaling,
    values: Vec<f64>,
    norm: f64,
    factors: Factors,
    work: [Vec<f64>; 3],
}

impl Solver {
    /// Analyses a pattern; `weak` as for [`Analysis::new`].
    ///
    /// # Errors
    /// As [`Analysis::new`].
    pub fn new(pattern: Pattern<'_>, weak: &[u32]) -> Result<Self, Error> {
        Self::with_threads(pattern, weak, 1)
    }

    /// As [`Self::new`], for factorisations on several threads.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_threads(pattern: Pattern<'_>, weak: &[u32], threads: usize) -> Result<Self, Error> {
        Ok(Self {
            kind: pattern.kind,
            starts: pattern.starts.to_vec(),
            rows: pattern.rows.to_vec(),
            weak: weak.to_vec(),
            scaling: Scaling::new(pattern.size()),
            values: vec![0.0; pattern.rows.len()],
            norm: 0.0,
            factors: Factors::with_threads(Analysis::new(pattern, weak)?, threads)?,
            work: [const { Vec::new() }; 3],
        })
    }

    /// The factors.
    pub fn factors(&self) -> &Factors {
        &self.factors
    }

    /// Scales and factors the matrix with `entries` at the positions of the pattern.
    ///
    /// # Errors
    /// Empty rows and columns; for Cholesky, matrices that are not positive definite.
    pub fn factor(&mut self, entries: &[f64]) -> Result<Pivots, Error> {
        let pattern = Pattern { kind: self.kind, starts: &self.starts, rows: &self.rows };
        self.scaling.fit(pattern, entries)?;
        self.values.copy_from_slice(entries);
        self.norm = self.scaling.apply(pattern, &mut self.values);
        self.factors.reorder(pattern, &self.weak)?;
        self.factors.factor(&self.values)
    }

    /// Solves in place for one or several right-hand sides, with refinement.
    pub fn solve(&mut self, rhs: &mut [f64]) -> SolveReport {
        let pattern = Pattern { kind: self.kind, starts: &self.starts, rows: &self.rows };
        let system = System { pattern, values: &self.values, norm: self.norm };
        let [b, x, residual] = &mut self.work;
        for buffer in [&mut *b, &mut *x, &mut *residual] {
            buffer.resize(rhs.len(), 0.0);
        }
        let size = pattern.size();
        for (b, rhs) in b.chunks_exact_mut(size).zip(rhs.chunks_exact(size)) {
            for ((b, value), factor) in b.iter_mut().zip(rhs).zip(&self.scaling.rows) {
                *b = value * factor;
            }
        }
        let Ok(report) = system.refine::<Infallible>(b, x, residual, |x| {
            self.factors.solve(x);
            Ok(())
        });
        for (x, rhs) in x.chunks_exact(size).zip(rhs.chunks_exact_mut(size)) {
            for ((x, value), factor) in x.iter().zip(rhs).zip(&self.scaling.columns) {
                *value = x * factor;
            }
        }
        report
    }
}
