//! Forward and back substitution for one or two right-hand sides in one walk over the factors, and the way in for any number of them.

use crate::analysis::Front;
use crate::factors::Factors;
use crate::kernel::{Products, Update};
use crate::pattern::Kind;
use crate::sweep::LANES;
use crate::walk::Entry;

impl Factors {
    /// Solves in place for the columns of `x`, as many numbers each as there are equations.
    pub fn solve(&mut self, x: &mut [f64]) {
        let size = self.analysis.size();
        for columns in x.chunks_mut(LANES * size) {
            match columns.len() / size {
                1 => self.solve_together::<1>(columns),
                2 => self.solve_together::<2>(columns),
                _ => self.solve_together::<LANES>(columns),
            }
        }
    }

    /// Solves for at most N columns in one walk over the factors.
    fn solve_together<const N: usize>(&mut self, x: &mut [f64])
    where
        [f64; N]: Entry,
    {
        let size = self.analysis.size();
        let mut work = std::mem::take(&mut self.work);
        work.resize(N * size, 0.0);
        let (rows, _) = work.as_chunks_mut();
        rows.fill([0.0; N]);
        for (n, column) in x.chunks_exact(size).enumerate() {
            for (row, &equation) in rows.iter_mut().zip(&self.analysis.order) {
                row[n] = column[equation as usize];
            }
        }
        self.walk::<[f64; N]>(rows);
        for (n, column) in x.chunks_exact_mut(size).enumerate() {
            for (row, &equation) in rows.iter().zip(&self.analysis.order) {
                column[equation as usize] = row[n];
            }
        }
        self.work = work;
    }

    fn forward<const N: usize>(&self, front: &Front, x: &mut [[f64; N]], work: &mut Vec<f64>) {
        let (square, below, _) = self.blocks(front);
        let own = &mut x[front.first..][..front.width];
        if self.analysis.kind == Kind::Unsymmetric {
            let exchanges = &self.exchanges[front.first..][..front.width];
            exchanges.iter().enumerate().for_each(|(column, &row)| own.swap(column, row as usize));
        }
        solve_lower(square, self.analysis.kind, own);
        let (rows, depth) = (front.padded(), front.width);
        work.resize(N * rows, 0.0);
        let b = own.as_flattened();
        Update { c: work, a: below, b, rows, columns: N, depth, stride: N, replace: true, lower: false }
            .run();
        for (n, work) in work.chunks_exact(rows.max(1)).enumerate() {
            for (&row, update) in self.analysis.rows[front.rows.clone()].iter().zip(work) {
                x[row as usize][n] += update;
            }
        }
    }

    fn back<const N: usize>(
        &self,
        front: &Front,
        x: &mut [[f64; N]],
        (own, work): (&mut Vec<f64>, &mut Vec<f64>),
    ) {
        let (square, _, right) = self.blocks(front);
        let rows = front.padded();
        for n in 0..N {
            work.clear();
            work.extend(self.analysis.rows[front.rows.clone()].iter().map(|&row| -x[row as usize][n]));
            work.resize(rows, 0.0);
            let unknowns = x[front.first..][..front.width].iter();
            own.clear();
            own.extend(unknowns.map(|x| x[n]));
            Products { y: own, a: right, x: work, rows }.run();
            match self.analysis.kind {
                Kind::Unsymmetric => solve_upper(square, own),
                Kind::Symmetric => solve_lower_transposed(square, own),
            }
            let unknowns = x[front.first..][..front.width].iter_mut();
            unknowns.zip(&*own).for_each(|(x, own)| x[n] = *own);
        }
    }
}

macro_rules! few {
    ($($count:literal)*) => {$(
        impl Entry for [f64; $count] {
            const ZERO: Self = [0.0; $count];

            fn add(&mut self, other: &Self) {
                self.iter_mut().zip(other).for_each(|(x, y)| *x += y);
            }

            fn forward(factors: &Factors, fronts: &[u32], x: &mut [Self]) {
                let mut work = Vec::new();
                for &front in fronts {
                    factors.forward(&factors.analysis.fronts[front as usize], x, &mut work);
                }
            }

            fn back(factors: &Factors, fronts: &[u32], x: &mut [Self]) {
                let (mut own, mut work) = (Vec::new(), Vec::new());
                for &front in fronts.iter().rev() {
                    factors.back(&factors.analysis.fronts[front as usize], x, (&mut own, &mut work));
                }
            }
        }
    )*};
}

few!(1 2);

/// `x = L^-1 x`, with ones on the diagonal for LU.
fn solve_lower<const N: usize>(square: &[f64], kind: Kind, x: &mut [[f64; N]]) {
    for (k, column) in square.chunks_exact(x.len()).enumerate() {
        if kind == Kind::Symmetric {
            x[k] = x[k].map(|x| x / column[k]);
        }
        let solved = x[k];
        for (x, entry) in x[k + 1..].iter_mut().zip(&column[k + 1..]) {
            x.iter_mut().zip(solved).for_each(|(x, solved)| *x -= entry * solved);
        }
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
