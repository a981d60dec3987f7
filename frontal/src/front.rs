//! The work of one front: assemble it, eliminate its columns, leave a remainder.

use crate::analysis::{Analysis, Front, PADDING};
use crate::kernel::{RightSolve, Update};
use crate::pattern::Kind;
use crate::pivot::{Block, Pivots, Threshold};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par};

/// Columns from which triangular solves are left to the library.
const WIDE: usize = 48;
/// Columns, and operations, from which products are left to the library.
const DEEP: usize = 24;
const LARGE: usize = 1 << 20;
/// Operations from which threads share a front.
const SHARED: usize = 1 << 23;

/// The numbers of a front: the square block, the rows below, and for LU the columns on the right, transposed.
pub(crate) struct Blocks<'a> {
    pub square: &'a mut [f64],
    pub below: &'a mut [f64],
    pub right: &'a mut [f64],
}

impl<'a> Blocks<'a> {
    /// Parts of the values of a front.
    pub fn of(front: &Front, kind: Kind, values: &'a mut [f64]) -> Self {
        let (square, rest) = values.split_at_mut(front.width * front.width);
        let panel = front.width * front.padded();
        let (below, rest) = rest.split_at_mut(panel);
        let right = if kind == Kind::Unsymmetric { &mut rest[..panel] } else { &mut rest[..0] };
        Self { square, below, right }
    }
}

/// Adds the remainder of a child to the blocks and the remainder of its parent.
pub(crate) fn assemble(
    analysis: &Analysis,
    (front, blocks, remainder): (&Front, &mut Blocks<'_>, &mut [f64]),
    (child, source): (&Front, &[f64]),
) {
    let (width, padded) = (front.width, front.padded());
    let targets = &analysis.targets[child.rows.clone()];
    let (own, below) = targets.split_at(child.passed);
    let symmetric = analysis.kind == Kind::Symmetric;
    let height = child.padded();
    for (j, (&target, column)) in targets.iter().zip(source.chunks_exact(height)).enumerate() {
        let target = target as usize;
        let (upper, lower) = column[..targets.len()].split_at(child.passed);
        if j < child.passed {
            let skip = if symmetric { j } else { 0 };
            scatter(&mut blocks.square[target * width..][..width], &own[skip..], &upper[skip..]);
            scatter(&mut blocks.below[target * padded..][..padded], below, lower);
        } else {
            if !symmetric {
                for (&row, value) in own.iter().zip(upper) {
                    blocks.right[row as usize * padded + target] += value;
                }
            }
            let skip = if symmetric { j - child.passed } else { 0 };
            scatter(&mut remainder[target * padded..][..padded], &below[skip..], &lower[skip..]);
        }
    }
}

#[inline]
fn scatter(target: &mut [f64], places: &[u32], values: &[f64]) {
    for (&place, value) in places.iter().zip(values) {
        target[place as usize] += value;
    }
}

/// Working memory of one thread.
#[derive(Default)]
pub(crate) struct Scratch {
    triangle: Vec<f64>,
    reciprocals: Vec<f64>,
}

/// Eliminates the columns of an assembled front; `fresh` when nothing was assembled into the remainder.
///
/// # Errors
/// The turn of a pivot of Cholesky that is not positive.
pub(crate) fn eliminate(
    front: &Front,
    kind: Kind,
    blocks: Blocks<'_>,
    (remainder, fresh): (&mut [f64], bool),
    (exchanges, threshold): (&mut [u32], Threshold),
    scratch: &mut Scratch,
    threads: usize,
) -> Result<Pivots, usize> {
    let (width, padded) = (front.width, front.padded());
    let mut pivots = Pivots::NONE;
    let Blocks { square, below, right } = blocks;
    let mut block = Block { values: square, width, turn: front.first };
    match kind {
        Kind::Symmetric => block.cholesky(&mut pivots)?,
        Kind::Unsymmetric => {
            block.lu(exchanges, threshold, &mut pivots);
            for (column, &row) in exchanges.iter().enumerate() {
                swap_columns(right, padded, column, row as usize);
            }
        }
    }
    if padded == 0 {
        return Ok(pivots);
    }
    let square = &*square;
    let threads = if width * padded * padded < SHARED { 1 } else { threads };
    scratch.reciprocals.clear();
    scratch.reciprocals.extend((0..width).map(|k| square[k * (width + 1)].recip()));
    match kind {
        Kind::Symmetric => solve_lower(square, below, padded, &scratch.reciprocals, threads),
        Kind::Unsymmetric => {
            solve_upper(square, below, padded, scratch, threads);
            scratch.reciprocals.fill(1.0);
            solve_unit_lower(square, right, padded, &scratch.reciprocals, threads);
        }
    }
    let lower = kind == Kind::Symmetric;
    let b = if lower { &*below } else { &*right };
    update(front, remainder, below, b, fresh, lower, threads);
    Ok(pivots)
}

fn swap_columns(values: &mut [f64], height: usize, a: usize, b: usize) {
    if a != b {
        let (left, right) = values.split_at_mut(a.max(b) * height);
        left[a.min(b) * height..][..height].swap_with_slice(&mut right[..height]);
    }
}

/// `X = X L^-T` for Cholesky.
fn solve_lower(square: &[f64], x: &mut [f64], rows: usize, reciprocals: &[f64], threads: usize) {
    let width = reciprocals.len();
    if width < WIDE {
        return RightSolve { x, t: square, reciprocals, rows, width }.run();
    }
    let square = MatRef::from_column_major_slice(square, width, width);
    let solve = |x: MatMut<'_, f64>| solve_lower_triangular_in_place(square, x, Par::Seq);
    over_columns(MatMut::from_column_major_slice_mut(x, rows, width).transpose_mut(), threads, &solve);
}

/// `X = X L^-T` with ones on the diagonal.
fn solve_unit_lower(square: &[f64], x: &mut [f64], rows: usize, ones: &[f64], threads: usize) {
    let width = ones.len();
    if width < WIDE {
        return RightSolve { x, t: square, reciprocals: ones, rows, width }.run();
    }
    let square = MatRef::from_column_major_slice(square, width, width);
    let solve = |x: MatMut<'_, f64>| solve_unit_lower_triangular_in_place(square, x, Par::Seq);
    over_columns(MatMut::from_column_major_slice_mut(x, rows, width).transpose_mut(), threads, &solve);
}

/// `X = X U^-1`.
fn solve_upper(square: &[f64], x: &mut [f64], rows: usize, scratch: &mut Scratch, threads: usize) {
    let width = scratch.reciprocals.len();
    if width < WIDE {
        let t = &mut scratch.triangle;
        t.resize(width * width, 0.0);
        for (j, column) in square.chunks_exact(width).enumerate() {
            column[..j].iter().enumerate().for_each(|(k, &entry)| t[k * width + j] = entry);
        }
        return RightSolve { x, t, reciprocals: &scratch.reciprocals, rows, width }.run();
    }
    let square = MatRef::from_column_major_slice(square, width, width).transpose();
    let solve = |x: MatMut<'_, f64>| solve_lower_triangular_in_place(square, x, Par::Seq);
    over_columns(MatMut::from_column_major_slice_mut(x, rows, width).transpose_mut(), threads, &solve);
}

/// Remainder, or its lower triangle: `C -= A B^T`.
fn update(front: &Front, c: &mut [f64], a: &[f64], b: &[f64], fresh: bool, lower: bool, threads: usize) {
    let (rows, columns, depth) = (front.padded(), front.below(), front.width);
    if depth < DEEP || rows * columns * depth < LARGE {
        return Update { c, a, b, rows, columns, depth, stride: rows, replace: fresh, lower }.run();
    }
    let c = MatMut::from_column_major_slice_mut(c, rows, columns).subrows_mut(0, columns);
    let a = MatRef::from_column_major_slice(a, rows, depth).subrows(0, columns);
    let b = MatRef::from_column_major_slice(b, rows, depth).subrows(0, columns).transpose();
    let sum = if fresh { Accum::Replace } else { Accum::Add };
    if lower { lower_product(c, sum, a, b, threads) } else { product(c, sum, a, b, threads) }
}

/// `C -= A B`, columns shared among threads.
fn product(c: MatMut<'_, f64>, sum: Accum, a: MatRef<'_, f64>, b: MatRef<'_, f64>, threads: usize) {
    if threads < 2 {
        return matmul(c, sum, a, b, -1.0, Par::Seq);
    }
    let middle = share(c.ncols(), threads);
    let (left, right) = c.split_at_col_mut(middle);
    let (b_left, b_right) = b.split_at_col(middle);
    std::thread::scope(|scope| {
        scope.spawn(move || product(left, sum, a, b_left, threads / 2));
        product(right, sum, a, b_right, threads - threads / 2);
    });
}

/// Lower triangle of `C -= A B`, the square below the first half of the columns on other threads.
fn lower_product(c: MatMut<'_, f64>, sum: Accum, a: MatRef<'_, f64>, b: MatRef<'_, f64>, threads: usize) {
    if threads < 2 {
        let (whole, lower) = (BlockStructure::Rectangular, BlockStructure::TriangularLower);
        return triangular::matmul(c, lower, sum, a, whole, b, whole, -1.0, Par::Seq);
    }
    let middle = c.ncols() / 2;
    let (left, right) = c.split_at_col_mut(middle);
    let (upper, below) = left.split_at_row_mut(middle);
    let (_, corner) = right.split_at_row_mut(middle);
    let ((a_upper, a_lower), (b_left, b_right)) = (a.split_at_row(middle), b.split_at_col(middle));
    std::thread::scope(|scope| {
        scope.spawn(move || product(below, sum, a_lower, b_left, threads / 2));
        lower_product(upper, sum, a_upper, b_left, threads - threads / 2);
        lower_product(corner, sum, a_lower, b_right, threads - threads / 2);
    });
}

/// Applies an operation to groups of columns on some threads.
fn over_columns(x: MatMut<'_, f64>, threads: usize, operation: &(impl Fn(MatMut<'_, f64>) + Sync)) {
    if threads < 2 {
        return operation(x);
    }
    let middle = share(x.ncols(), threads);
    let (left, right) = x.split_at_col_mut(middle);
    std::thread::scope(|scope| {
        scope.spawn(move || over_columns(left, threads / 2, operation));
        over_columns(right, threads - threads / 2, operation);
    });
}

/// Columns for half of the threads, a multiple of what fits registers.
fn share(columns: usize, threads: usize) -> usize {
    (columns * (threads / 2) / threads).next_multiple_of(PADDING).min(columns)
}
