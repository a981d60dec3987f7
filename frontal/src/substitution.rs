//! Forward and back substitution for one right-hand side.

use crate::analysis::Front;
use crate::factors::Factors;
use crate::kernel::{Products, Update};
use crate::pattern::Kind;

impl Factors {
    /// Solves in place for one column, in the order of elimination.
    pub(crate) fn solve_ordered(&self, x: &mut [f64]) {
        let mut below = Vec::new();
        for front in &self.analysis.fronts {
            self.forward(front, x, &mut below);
        }
        for front in self.analysis.fronts.iter().rev() {
            self.back(front, x, &mut below);
        }
    }

    fn forward(&self, front: &Front, x: &mut [f64], work: &mut Vec<f64>) {
        let width = front.width;
        let (square, below, _) = self.blocks(front);
        let own = &mut x[front.first..front.first + width];
        if self.analysis.kind == Kind::Unsymmetric {
            let exchanges = &self.exchanges[front.first..front.first + width];
            exchanges.iter().enumerate().for_each(|(column, &row)| own.swap(column, row as usize));
        }
        let divide = self.analysis.kind == Kind::Symmetric;
        for (k, column) in square.chunks_exact(width).enumerate() {
            own[k] /= if divide { column[k] } else { 1.0 };
            let solved = own[k];
            let rest = own[k + 1..].iter_mut().zip(&column[k + 1..]);
            rest.for_each(|(value, entry)| *value -= entry * solved);
        }
        let rows = front.padded();
        work.resize(rows, 0.0);
        Update {
            c: work,
            a: below,
            b: own,
            rows,
            columns: 1,
            depth: width,
            stride: 1,
            replace: true,
            lower: false,
        }
        .run();
        for (&row, value) in self.analysis.rows[front.rows.clone()].iter().zip(&*work) {
            x[row as usize] += value;
        }
    }

    fn back(&self, front: &Front, x: &mut [f64], work: &mut Vec<f64>) {
        let width = front.width;
        let (square, _, right) = self.blocks(front);
        let rows = front.padded();
        work.clear();
        work.extend(self.analysis.rows[front.rows.clone()].iter().map(|&row| -x[row as usize]));
        work.resize(rows, 0.0);
        let own = &mut x[front.first..front.first + width];
        Products { y: own, a: right, x: work, rows }.run();
        match self.analysis.kind {
            Kind::Unsymmetric => {
                for (k, column) in square.chunks_exact(width).enumerate().rev() {
                    own[k] /= column[k];
                    let solved = own[k];
                    let rest = own[..k].iter_mut().zip(column);
                    rest.for_each(|(value, entry)| *value -= entry * solved);
                }
            }
            Kind::Symmetric => {
                for (k, column) in square.chunks_exact(width).enumerate().rev() {
                    let entries = column[k + 1..].iter().zip(&own[k + 1..]);
                    let dot: f64 = entries.map(|(entry, value)| entry * value).sum();
                    own[k] = (own[k] - dot) / column[k];
                }
            }
        }
    }
}
