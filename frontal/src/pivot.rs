//! Factors of the square block of a front: LU with exchanges of its rows, or Cholesky.
//!
//! Pivots are looked for among the rows of the block only. One that is no more than a rounding error of the matrix is replaced
//! by a small number and recorded; refinement repairs the solution.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, MatMut, Par};
use pulp::Arch;

/// Columns that are eliminated together in larger blocks.
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
        if (magnitude < self.smallest && self.perturbed == 0) || (perturbed && self.perturbed == 0) {
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
    pub fn lu(self, exchanges: &mut [u32], threshold: Threshold, pivots: &mut Pivots) {
        Arch::new().dispatch(
            #[inline(always)]
            || {
                for begin in (0..self.width).step_by(PANEL) {
                    let end = (begin + PANEL).min(self.width);
                    let single = self.width <= 2 * PANEL;
                    if single && begin > 0 {
                        break;
                    }
                    let end = if single { self.width } else { end };
                    panel(self.values, self.width, begin..end, exchanges, self.turn, threshold, pivots);
                    if end < self.width {
                        update_right(self.values, self.width, begin, end);
                    }
                }
            },
        );
    }

    /// Cholesky, of and into the lower triangle; the turn of a pivot that is not positive otherwise.
    pub fn cholesky(self, pivots: &mut Pivots) -> Result<(), usize> {
        let (width, turn) = (self.width, self.turn);
        Arch::new().dispatch(
            #[inline(always)]
            || {
                for k in 0..width {
                    let (solved, rest) = self.values.split_at_mut((k + 1) * width);
                    let column = &mut solved[k * width..];
                    let pivot = column[k];
                    if pivot.is_nan() || pivot <= 0.0 {
                        return Err(turn + k);
                    }
                    pivots.add(turn + k, pivot, false);
                    let root = pivot.sqrt();
                    column[k] = root;
                    let reciprocal = root.recip();
                    column[k + 1..].iter_mut().for_each(|entry| *entry *= reciprocal);
                    for (j, target) in (k + 1..width).zip(rest.chunks_exact_mut(width)) {
                        let factor = column[j];
                        let entries = target[j..].iter_mut().zip(&column[j..]);
                        entries.for_each(|(entry, own)| *entry -= own * factor);
                    }
                }
                Ok(())
            },
        )
    }
}

/// Eliminates some columns without touching those behind, except for the exchange of rows.
#[inline(always)]
fn panel(
    values: &mut [f64],
    width: usize,
    columns: std::ops::Range<usize>,
    exchanges: &mut [u32],
    turn: usize,
    threshold: Threshold,
    pivots: &mut Pivots,
) {
    for k in columns.clone() {
        let mut row = k;
        let mut largest = 0.0;
        for (i, entry) in values[k * width + k..(k + 1) * width].iter().enumerate() {
            if entry.abs() > largest {
                (row, largest) = (k + i, entry.abs());
            }
        }
        exchanges[k] = row as u32;
        if row != k {
            values.chunks_exact_mut(width).for_each(|column| column.swap(k, row));
        }
        let perturbed = largest <= threshold.zero;
        pivots.add(turn + k, largest, perturbed);
        let (solved, rest) = values.split_at_mut((k + 1) * width);
        let column = &mut solved[k * width..];
        if perturbed {
            column[k] = threshold.substitute.copysign(column[k]);
        }
        let reciprocal = column[k].recip();
        column[k + 1..].iter_mut().for_each(|entry| *entry *= reciprocal);
        for target in rest.chunks_exact_mut(width).take(columns.end - k - 1) {
            let factor = target[k];
            let entries = target[k + 1..].iter_mut().zip(&column[k + 1..]);
            entries.for_each(|(entry, own)| *entry -= own * factor);
        }
    }
}

/// Takes eliminated columns out of those on their right.
fn update_right(values: &mut [f64], width: usize, begin: usize, end: usize) {
    let block = MatMut::from_column_major_slice_mut(values, width, width);
    let (left, mut right) = block.split_at_col_mut(end);
    let left = left.as_ref().subcols(begin, end - begin);
    let (upper, lower) = right.as_mut().subrows_mut(begin, width - begin).split_at_row_mut(end - begin);
    let mut upper = upper;
    solve_unit_lower_triangular_in_place(left.subrows(begin, end - begin), upper.as_mut(), Par::Seq);
    matmul(lower, Accum::Add, left.subrows(end, width - end), upper.as_ref(), -1.0, Par::Seq);
}
