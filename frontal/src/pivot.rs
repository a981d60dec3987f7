//! Factors of the square block of a front: LU with exchanges of its rows, or Cholesky.
//!
//! Pivots are looked for among the rows of the block only. One that is no more than a rounding error of the matrix is replaced
//! by a small number and recorded; refinement repairs the solution.

use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place};
use faer::{Accum, MatMut, Par};
use pulp::Arch;
use std::ops::Range;

/// Columns up to which a block is eliminated column by column.
const PANEL: usize = 16;

/// What the pivots of a factorisation were like; magnitudes relative to a scaled matrix whose entries are near one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivots {
    /// Pivots that were replaced.
    pub perturbed: usize,
    /// Smallest magnitude before replacements.
    pub smallest: f64,
    /// Largest magnitude: the growth of the entries during elimination.
    pub largest: f64,
    /// Turn of the smallest pivot; of the first that was replaced, if any was.
    pub turn: usize,
}

impl Pivots {
    /// No pivots yet.
    pub(crate) const NONE: Self = Self { perturbed: 0, smallest: f64::INFINITY, largest: 0.0, turn: 0 };

    fn add(&mut self, turn: usize, magnitude: f64, perturbed: bool) {
        if self.perturbed == 0 && (perturbed || magnitude < self.smallest) {
            self.turn = turn;
        }
        self.smallest = self.smallest.min(magnitude);
        self.largest = self.largest.max(magnitude);
        self.perturbed += usize::from(perturbed);
    }

    /// Pivots of two parts of a matrix, the earlier part first.
    pub(crate) fn and(mut self, later: Self) -> Self {
        let moves = match (self.perturbed, later.perturbed) {
            (0, 0) => later.smallest < self.smallest,
            (0, _) => true,
            _ => false,
        };
        if moves {
            self.turn = later.turn;
        }
        self.perturbed += later.perturbed;
        self.smallest = self.smallest.min(later.smallest);
        self.largest = self.largest.max(later.largest);
        self
    }
}

/// Sizes of pivots that are taken for zero, and of what replaces them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Threshold {
    pub zero: f64,
    pub substitute: f64,
}

/// Square block, column after column, whose first column is eliminated at some turn.
pub(crate) struct Block<'a> {
    pub values: &'a mut [f64],
    pub width: usize,
    pub turn: usize,
}

impl Block<'_> {
    /// LU with row exchanges: row `k` changed places with `exchanges[k]` when column `k` was eliminated.
    pub fn lu(&mut self, exchanges: &mut [u32], threshold: Threshold, pivots: &mut Pivots) {
        self.lu_of(0..self.width, exchanges, threshold, pivots);
    }

    /// LU of the rows from the first of `columns` on, half of the columns at a time.
    fn lu_of(
        &mut self,
        columns: Range<usize>,
        exchanges: &mut [u32],
        threshold: Threshold,
        pivots: &mut Pivots,
    ) {
        if columns.len() <= PANEL {
            return Arch::new().dispatch(
                #[inline(always)]
                || self.lu_panel(columns, exchanges, threshold, pivots),
            );
        }
        let (begin, middle, end) = halves(columns);
        self.lu_of(begin..middle, exchanges, threshold, pivots);
        let (left, right) = self.matrix().get_mut(begin.., begin..end).split_at_col_mut(middle - begin);
        let (l11, l21) = left.as_ref().split_at_row(middle - begin);
        let (mut upper, lower) = right.split_at_row_mut(middle - begin);
        solve_unit_lower_triangular_in_place(l11, upper.as_mut(), Par::Seq);
        matmul(lower, Accum::Add, l21, upper.as_ref(), -1.0, Par::Seq);
        self.lu_of(middle..end, exchanges, threshold, pivots);
    }

    /// Eliminates some columns without touching those behind, except for the exchange of rows.
    #[inline(always)]
    fn lu_panel(
        &mut self,
        columns: Range<usize>,
        exchanges: &mut [u32],
        threshold: Threshold,
        pivots: &mut Pivots,
    ) {
        let (values, width) = (&mut *self.values, self.width);
        for k in columns.clone() {
            let (row, largest) = largest_from(k, &values[k * width..(k + 1) * width]);
            exchanges[k] = row as u32;
            if row != k {
                values.chunks_exact_mut(width).for_each(|column| column.swap(k, row));
            }
            let perturbed = largest <= threshold.zero;
            pivots.add(self.turn + k, largest, perturbed);
            let (solved, rest) = values.split_at_mut((k + 1) * width);
            let column = &mut solved[k * width..];
            if perturbed {
                column[k] = threshold.substitute.copysign(column[k]);
            }
            let reciprocal = column[k].recip();
            column[k + 1..].iter_mut().for_each(|entry| *entry *= reciprocal);
            for target in rest.chunks_exact_mut(width).take(columns.end - k - 1) {
                let factor = target[k];
                subtract_multiple(&mut target[k + 1..], &column[k + 1..], factor);
            }
        }
    }

    /// Cholesky, of and into the lower triangle; the turn of a pivot that is not positive otherwise.
    pub fn cholesky(&mut self, pivots: &mut Pivots) -> Result<(), usize> {
        self.cholesky_of(0..self.width, pivots)
    }

    /// Cholesky of a block on the diagonal, half of its columns at a time.
    fn cholesky_of(&mut self, columns: Range<usize>, pivots: &mut Pivots) -> Result<(), usize> {
        if columns.len() <= PANEL {
            return Arch::new().dispatch(
                #[inline(always)]
                || self.cholesky_panel(columns, pivots),
            );
        }
        let (begin, middle, end) = halves(columns);
        self.cholesky_of(begin..middle, pivots)?;
        let (left, right) = self.matrix().get_mut(begin..end, begin..end).split_at_col_mut(middle - begin);
        let (l11, mut l21) = left.split_at_row_mut(middle - begin);
        solve_lower_triangular_in_place(l11.as_ref(), l21.as_mut().transpose_mut(), Par::Seq);
        let (_, rest) = right.split_at_row_mut(middle - begin);
        let l21 = l21.as_ref();
        let (a, b) = (BlockStructure::Rectangular, BlockStructure::TriangularLower);
        triangular::matmul(rest, b, Accum::Add, l21, a, l21.transpose(), a, -1.0, Par::Seq);
        self.cholesky_of(middle..end, pivots)
    }

    /// Cholesky of a small block on the diagonal.
    #[inline(always)]
    fn cholesky_panel(&mut self, columns: Range<usize>, pivots: &mut Pivots) -> Result<(), usize> {
        let (width, end) = (self.width, columns.end);
        for k in columns {
            let (solved, rest) = self.values.split_at_mut((k + 1) * width);
            let column = &mut solved[k * width..][..end];
            let pivot = column[k];
            if pivot.is_nan() || pivot <= 0.0 {
                return Err(self.turn + k);
            }
            pivots.add(self.turn + k, pivot, false);
            column[k] = pivot.sqrt();
            let reciprocal = column[k].recip();
            column[k + 1..].iter_mut().for_each(|entry| *entry *= reciprocal);
            for (j, target) in (k + 1..end).zip(rest.chunks_exact_mut(width)) {
                subtract_multiple(&mut target[j..end], &column[j..], column[j]);
            }
        }
        Ok(())
    }

    fn matrix(&mut self) -> MatMut<'_, f64> {
        MatMut::from_column_major_slice_mut(self.values, self.width, self.width)
    }
}

/// Begin, middle and end of a range; the first half is a multiple of the panel.
fn halves(range: Range<usize>) -> (usize, usize, usize) {
    let half = (range.len() / 2).next_multiple_of(PANEL);
    (range.start, range.start + half, range.end)
}

/// Row and magnitude of the largest entry of a column from some row on.
#[inline(always)]
fn largest_from(row: usize, column: &[f64]) -> (usize, f64) {
    let mut found = (row, 0.0);
    for (i, entry) in column.iter().enumerate().skip(row) {
        if entry.abs() > found.1 {
            found = (i, entry.abs());
        }
    }
    found
}

/// `y -= factor x`.
#[inline(always)]
fn subtract_multiple(y: &mut [f64], x: &[f64], factor: f64) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y -= x * factor);
}
