//! Factors of matrices with one pattern: storage that is kept, and the walk over the fronts that fills it.

use crate::analysis::{Analysis, Front};
use crate::error::Error;
use crate::front::{Blocks, Scratch, assemble, eliminate};
use crate::pattern::Kind;
use crate::pivot::{Pivots, Threshold};

/// Pivots of a scaled matrix below this are rounding errors.
const ZERO_PIVOT: f64 = 1e-13;
/// What replaces them.
const SUBSTITUTE: f64 = 1e-8;

/// Factors of a matrix.
pub struct Factors {
    pub(crate) analysis: Analysis,
    pub(crate) values: Vec<f64>,
    /// Row that every column changed places with, counted from the first of its front.
    pub(crate) exchanges: Vec<u32>,
    stacks: [Vec<f64>; 2],
    scratch: Scratch,
    pub(crate) work: Vec<f64>,
}

impl Factors {
    /// Allocates all memory that factorisations and solves with one right-hand side need.
    ///
    /// # Errors
    /// [`Error::TooLarge`].
    pub fn new(analysis: Analysis) -> Result<Self, Error> {
        let [first, second] = analysis.stacks;
        Ok(Self {
            values: zeros(analysis.values)?,
            exchanges: vec![0; analysis.size()],
            stacks: [zeros(first)?, zeros(second)?],
            scratch: Scratch::default(),
            work: Vec::new(),
            analysis,
        })
    }

    /// Structure of the factors.
    pub fn analysis(&self) -> &Analysis {
        &self.analysis
    }

    /// Factors the matrix with `entries` at the positions of the pattern, the largest near one.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for Cholesky.
    pub fn factor(&mut self, entries: &[f64]) -> Result<Pivots, Error> {
        let largest = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
        let threshold = Threshold { zero: ZERO_PIVOT * largest, substitute: SUBSTITUTE * largest };
        let mut pivots = Pivots::NONE;
        let analysis = &self.analysis;
        for front in &analysis.fronts {
            let [even, odd] = &mut self.stacks;
            let (own, others) = if front.stack == 0 { (even, odd) } else { (odd, even) };
            let remainder = &mut own[front.offset..][..front.remainder()];
            let values = &mut self.values[front.values.clone()];
            values.fill(0.0);
            for &(source, target) in &analysis.entries[front.entries.clone()] {
                values[target as usize] += entries[source as usize];
            }
            let mut blocks = Blocks::of(front, analysis.kind, values);
            let fresh = front.children.is_empty();
            if !fresh {
                remainder.fill(0.0);
            }
            for &child in &analysis.children[front.children.clone()] {
                let child = &analysis.fronts[child as usize];
                let source = &others[child.offset..][..child.remainder()];
                assemble(analysis, (front, &mut blocks, remainder), (child, source));
            }
            let exchanges = &mut self.exchanges[front.first..][..front.width];
            let eliminated = eliminate(
                front,
                analysis.kind,
                blocks,
                (remainder, fresh),
                (exchanges, threshold),
                &mut self.scratch,
            );
            match eliminated {
                Ok(own) => pivots = pivots.and(own),
                Err(turn) => return Err(Error::NotPositive { equation: analysis.order[turn] as usize }),
            }
        }
        Ok(pivots)
    }

    /// Solves in place for the columns of `x`, as many numbers each as there are equations.
    pub fn solve(&mut self, x: &mut [f64]) {
        let size = self.analysis.size();
        let mut permuted = std::mem::take(&mut self.work);
        permuted.resize(size, 0.0);
        for column in x.chunks_exact_mut(size) {
            for (value, &equation) in permuted.iter_mut().zip(&self.analysis.order) {
                *value = column[equation as usize];
            }
            self.solve_ordered(&mut permuted);
            for (value, &equation) in permuted.iter().zip(&self.analysis.order) {
                column[equation as usize] = *value;
            }
        }
        self.work = permuted;
    }

    /// Blocks of a front.
    pub(crate) fn blocks(&self, front: &Front) -> (&[f64], &[f64], &[f64]) {
        let (square, rest) = self.values[front.values.clone()].split_at(front.width * front.width);
        let (below, rest) = rest.split_at(front.width * front.padded());
        let right = if self.analysis.kind == Kind::Unsymmetric { rest } else { below };
        (square, below, &right[..below.len()])
    }
}

/// Zeros, or an error instead of an abort when memory does not suffice.
fn zeros(length: usize) -> Result<Vec<f64>, Error> {
    let mut values = Vec::new();
    values.try_reserve_exact(length).map_err(|_| Error::TooLarge)?;
    values.resize(length, 0.0);
    Ok(values)
}
