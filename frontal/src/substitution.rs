//! Forward and back substitution, for several right-hand sides in one walk over the factors.
//!
//! The numbers of one equation lie side by side: what is read of the factors is multiplied with all of them.

use crate::analysis::Front;
use crate::factors::Factors;
use crate::kernel::{Products, Update};
use crate::pattern::Kind;

/// Right-hand sides that are treated together at most.
const TOGETHER: usize = 8;

impl Factors {
    /// Solves in place for the columns of `x`, as many numbers each as there are equations.
    pub fn solve(&mut self, x: &mut [f64]) {
        let size = self.analysis.size();
        let mut ordered = std::mem::take(&mut self.work);
        for columns in x.chunks_mut(TOGETHER * size) {
            let count = columns.len() / size;
            ordered.resize(columns.len(), 0.0);
            for (row, &equation) in ordered.chunks_exact_mut(count).zip(&self.analysis.order) {
                let numbers = columns[equation as usize..].iter().step_by(size);
                row.iter_mut().zip(numbers).for_each(|(value, number)| *value = *number);
            }
            self.solve_ordered(&mut ordered, count);
            for (row, &equation) in ordered.chunks_exact(count).zip(&self.analysis.order) {
                let numbers = columns[equation as usize..].iter_mut().step_by(size);
                row.iter().zip(numbers).for_each(|(value, number)| *number = *value);
            }
        }
        self.work = ordered;
    }

    /// Solves in place for `count` right-hand sides, equations in the order of elimination.
    fn solve_ordered(&self, x: &mut [f64], count: usize) {
        let mut below = Vec::new();
        for front in &self.analysis.fronts {
            self.forward(front, x, count, &mut below);
        }
        for front in self.analysis.fronts.iter().rev() {
            self.back(front, x, count, &mut below);
        }
    }

    fn forward(&self, front: &Front, x: &mut [f64], count: usize, work: &mut Vec<f64>) {
        let (square, below, _) = self.blocks(front);
        let own = &mut x[front.first * count..][..front.width * count];
        if self.analysis.kind == Kind::Unsymmetric {
            let exchanges = &self.exchanges[front.first..][..front.width];
            for (column, &row) in exchanges.iter().enumerate() {
                (0..count).for_each(|k| own.swap(column * count + k, row as usize * count + k));
            }
        }
        solve_lower(square, self.analysis.kind, own, count);
        let rows = front.padded();
        work.resize(rows * count, 0.0);
        Update {
            c: work,
            a: below,
            b: own,
            rows,
            columns: count,
            depth: front.width,
            stride: count,
            replace: true,
            lower: false,
        }
        .run();
        for (i, &row) in self.analysis.rows[front.rows.clone()].iter().enumerate() {
            let updates = work[i..].iter().step_by(rows);
            let values = x[row as usize * count..][..count].iter_mut();
            values.zip(updates).for_each(|(value, update)| *value += update);
        }
    }

    fn back(&self, front: &Front, x: &mut [f64], count: usize, work: &mut Vec<f64>) {
        let (square, _, right) = self.blocks(front);
        let rows = front.padded();
        work.clear();
        work.resize(rows * count, 0.0);
        for (i, &row) in self.analysis.rows[front.rows.clone()].iter().enumerate() {
            let values = &x[row as usize * count..][..count];
            work[i..].iter_mut().step_by(rows).zip(values).for_each(|(number, value)| *number = -value);
        }
        let own = &mut x[front.first * count..][..front.width * count];
        Products { y: own, a: right, x: work, rows, columns: front.width, count }.run();
        match self.analysis.kind {
            Kind::Unsymmetric => solve_upper(square, own, count),
            Kind::Symmetric => solve_lower_transposed(square, own, count),
        }
    }
}

/// `x = L^-1 x`, with ones on the diagonal for LU.
fn solve_lower(square: &[f64], kind: Kind, x: &mut [f64], count: usize) {
    let width = x.len() / count;
    for (k, column) in square.chunks_exact(width).enumerate() {
        let (solved, rest) = x.split_at_mut((k + 1) * count);
        let solved = &mut solved[k * count..];
        if kind == Kind::Symmetric {
            solved.iter_mut().for_each(|value| *value /= column[k]);
        }
        subtract(rest, &column[k + 1..], solved);
    }
}

/// `x = U^-1 x`.
fn solve_upper(square: &[f64], x: &mut [f64], count: usize) {
    let width = x.len() / count;
    for (k, column) in square.chunks_exact(width).enumerate().rev() {
        let (rest, solved) = x.split_at_mut(k * count);
        let solved = &mut solved[..count];
        solved.iter_mut().for_each(|value| *value /= column[k]);
        subtract(rest, &column[..k], solved);
    }
}

/// `x = L^-T x`.
fn solve_lower_transposed(square: &[f64], x: &mut [f64], count: usize) {
    let width = x.len() / count;
    for (k, column) in square.chunks_exact(width).enumerate().rev() {
        let (own, solved) = x.split_at_mut((k + 1) * count);
        for (j, value) in own[k * count..].iter_mut().enumerate() {
            let values = solved[j.min(solved.len())..].iter().step_by(count);
            let dot: f64 = column[k + 1..].iter().zip(values).map(|(entry, value)| entry * value).sum();
            *value = (*value - dot) / column[k];
        }
    }
}

/// Takes the product of a column with the numbers of one equation out of those of others.
fn subtract(x: &mut [f64], column: &[f64], solved: &[f64]) {
    match solved {
        [solved] => x.iter_mut().zip(column).for_each(|(value, entry)| *value -= entry * solved),
        _ => {
            for (row, entry) in x.chunks_exact_mut(solved.len()).zip(column) {
                row.iter_mut().zip(solved).for_each(|(value, solved)| *value -= entry * solved);
            }
        }
    }
}
