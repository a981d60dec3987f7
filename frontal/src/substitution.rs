//! Forward and back substitution for one right-hand side, and the way in for several.

use crate::analysis::Front;
use crate::factors::Factors;
use crate::kernel::{Products, Update};
use crate::pattern::Kind;
use crate::sweep::{LANES, Row};
use crate::walk::Entry;

/// Fewer right-hand sides than this are solved one by one.
const FEW: usize = 3;

impl Factors {
    /// Solves in place for the columns of `x`, as many numbers each as there are equations.
    pub fn solve(&mut self, x: &mut [f64]) {
        let size = self.analysis.size();
        for columns in x.chunks_mut(LANES * size) {
            if columns.len() < FEW * size {
                columns.chunks_exact_mut(size).for_each(|column| self.solve_one(column));
            } else {
                self.solve_batch(columns);
            }
        }
    }

    /// Solves for one column.
    fn solve_one(&mut self, x: &mut [f64]) {
        let mut ordered = std::mem::take(&mut self.work);
        ordered.clear();
        ordered.extend(self.analysis.order.iter().map(|&equation| x[equation as usize]));
        self.walk(&mut ordered);
        for (value, &equation) in ordered.iter().zip(&self.analysis.order) {
            x[equation as usize] = *value;
        }
        self.work = ordered;
    }

    /// Solves for at most [`LANES`] columns.
    fn solve_batch(&mut self, x: &mut [f64]) {
        let size = self.analysis.size();
        let mut rows = std::mem::take(&mut self.rows);
        rows.clear();
        rows.extend(self.analysis.order.iter().map(|&equation| {
            let mut row: Row = [0.0; LANES];
            let numbers = x[equation as usize..].iter().step_by(size);
            row.iter_mut().zip(numbers).for_each(|(value, number)| *value = *number);
            row
        }));
        self.walk(&mut rows);
        for (row, &equation) in rows.iter().zip(&self.analysis.order) {
            let numbers = x[equation as usize..].iter_mut().step_by(size);
            numbers.zip(row).for_each(|(number, value)| *number = *value);
        }
        self.rows = rows;
    }

    fn forward(&self, front: &Front, x: &mut [f64], work: &mut Vec<f64>) {
        let (square, below, _) = self.blocks(front);
        let own = &mut x[front.first..][..front.width];
        if self.analysis.kind == Kind::Unsymmetric {
            let exchanges = &self.exchanges[front.first..][..front.width];
            exchanges.iter().enumerate().for_each(|(column, &row)| own.swap(column, row as usize));
        }
        solve_lower(square, self.analysis.kind, own);
        let (rows, depth) = (front.padded(), front.width);
        work.resize(rows, 0.0);
        Update { c: work, a: below, b: own, rows, columns: 1, depth, stride: 1, replace: true, lower: false }
            .run();
        for (&row, update) in self.analysis.rows[front.rows.clone()].iter().zip(&*work) {
            x[row as usize] += update;
        }
    }

    fn back(&self, front: &Front, x: &mut [f64], work: &mut Vec<f64>) {
        let (square, _, right) = self.blocks(front);
        let rows = front.padded();
        work.clear();
        work.extend(self.analysis.rows[front.rows.clone()].iter().map(|&row| -x[row as usize]));
        work.resize(rows, 0.0);
        let own = &mut x[front.first..][..front.width];
        Products { y: own, a: right, x: work, rows }.run();
        match self.analysis.kind {
            Kind::Unsymmetric => solve_upper(square, own),
            Kind::Symmetric => solve_lower_transposed(square, own),
        }
    }
}

impl Entry for f64 {
    const ZERO: Self = 0.0;

    fn add(&mut self, other: &Self) {
        *self += other;
    }

    fn forward(factors: &Factors, fronts: &[u32], x: &mut [Self]) {
        let mut below = Vec::new();
        for &front in fronts {
            factors.forward(&factors.analysis.fronts[front as usize], x, &mut below);
        }
    }

    fn back(factors: &Factors, fronts: &[u32], x: &mut [Self]) {
        let mut below = Vec::new();
        for &front in fronts.iter().rev() {
            factors.back(&factors.analysis.fronts[front as usize], x, &mut below);
        }
    }
}

/// `x = L^-1 x`, with ones on the diagonal for LU.
fn solve_lower(square: &[f64], kind: Kind, x: &mut [f64]) {
    for (k, column) in square.chunks_exact(x.len()).enumerate() {
        if kind == Kind::Symmetric {
            x[k] /= column[k];
        }
        let solved = x[k];
        x[k + 1..].iter_mut().zip(&column[k + 1..]).for_each(|(x, entry)| *x -= entry * solved);
    }
}

/// `x = U^-1 x`.
fn solve_upper(square: &[f64], x: &mut [f64]) {
    for (k, column) in square.chunks_exact(x.len()).enumerate().rev() {
        x[k] /= column[k];
        let solved = x[k];
        x[..k].iter_mut().zip(column).for_each(|(x, entry)| *x -= entry * solved);
    }
}

/// `x = L^-T x`.
fn solve_lower_transposed(square: &[f64], x: &mut [f64]) {
    for (k, column) in square.chunks_exact(x.len()).enumerate().rev() {
        let products = column[k + 1..].iter().zip(&x[k + 1..]).map(|(entry, x)| entry * x);
        x[k] = (x[k] - products.sum::<f64>()) / column[k];
    }
}
