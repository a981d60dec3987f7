//! Forward and back substitution for eight right-hand sides in one walk over the factors.
//!
//! The numbers of one equation lie side by side in a row, so that every entry of the factors, which is read from memory once,
//! is multiplied with a whole register of them.

use crate::analysis::Front;
use crate::factors::Factors;
use crate::pattern::Kind;
use crate::walk::Entry;
use pulp::{Arch, Simd, WithSimd};

/// Right-hand sides that are treated together.
pub(crate) const LANES: usize = 8;

/// One number for each right-hand side.
pub(crate) type Row = [f64; LANES];

/// Columns that are treated together.
const PANEL: usize = 4;

impl Entry for Row {
    const ZERO: Self = [0.0; LANES];

    fn add(&mut self, other: &Self) {
        self.iter_mut().zip(other).for_each(|(x, y)| *x += y);
    }

    fn forward(factors: &Factors, fronts: &[u32], x: &mut [Self]) {
        Arch::new().dispatch(Sweep { factors, fronts, x, back: false });
    }

    fn back(factors: &Factors, fronts: &[u32], x: &mut [Self]) {
        Arch::new().dispatch(Sweep { factors, fronts, x, back: true });
    }
}

struct Sweep<'a> {
    factors: &'a Factors,
    fronts: &'a [u32],
    x: &'a mut [Row],
    /// Back substitution, else forward.
    back: bool,
}

impl WithSimd for Sweep<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, s: S) {
        let all = &self.factors.analysis.fronts;
        let fronts = self.fronts.iter().map(|&front| &all[front as usize]);
        let (mut own, mut below) = (Vec::new(), Vec::new());
        for register in 0..LANES / S::F64_LANES {
            if self.back {
                for front in fronts.clone().rev() {
                    self.back(s, register, front, &mut own, &mut below);
                }
            } else {
                for front in fronts.clone() {
                    self.forward(s, register, front, &mut own, &mut below);
                }
            }
        }
    }
}

impl Sweep<'_> {
    /// One register of the numbers of an equation.
    #[inline(always)]
    fn load<S: Simd>(&self, register: usize, row: usize) -> S::f64s {
        S::as_simd_f64s(&self.x[row]).0[register]
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, register: usize, row: usize, value: S::f64s) {
        S::as_mut_simd_f64s(&mut self.x[row]).0[register] = value;
    }

    /// Registers of the columns of a front and of the rows below.
    #[inline(always)]
    fn gather<S: Simd>(
        &self,
        register: usize,
        front: &Front,
        own: &mut Vec<S::f64s>,
        below: &mut Vec<S::f64s>,
    ) {
        own.clear();
        for row in front.first..front.first + front.width {
            own.push(self.load::<S>(register, row));
        }
        below.clear();
        for &row in &self.factors.analysis.rows[front.rows.clone()] {
            below.push(self.load::<S>(register, row as usize));
        }
    }

    #[inline(always)]
    fn forward<S: Simd>(
        &mut self,
        s: S,
        register: usize,
        front: &Front,
        own: &mut Vec<S::f64s>,
        below: &mut Vec<S::f64s>,
    ) {
        let factors = self.factors;
        let (square, lower, _) = factors.blocks(front);
        let definite = factors.analysis.kind == Kind::Symmetric;
        self.gather::<S>(register, front, own, below);
        if !definite {
            for (column, &row) in factors.exchanges[front.first..][..front.width].iter().enumerate() {
                own.swap(column, row as usize);
            }
        }
        for (k, column) in square.chunks_exact(front.width).enumerate() {
            if definite {
                own[k] = s.mul_f64s(own[k], s.splat_f64s(column[k].recip()));
            }
            let solved = s.neg_f64s(own[k]);
            for (x, &entry) in own[k + 1..].iter_mut().zip(&column[k + 1..]) {
                *x = s.mul_add_f64s(solved, s.splat_f64s(entry), *x);
            }
        }
        for (k, &value) in own.iter().enumerate() {
            self.store::<S>(register, front.first + k, value);
        }
        if below.is_empty() {
            return;
        }
        let height = front.padded();
        for (columns, solved) in lower.chunks(PANEL * height).zip(own.chunks(PANEL)) {
            if let [p, q, r, t] = *solved {
                let [p, q, r, t] = [p, q, r, t].map(|x| s.neg_f64s(x));
                let [a, b, c, d] = split(columns, height);
                for ((((x, a), b), c), d) in below.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                    let partial = s.mul_add_f64s(p, s.splat_f64s(*a), *x);
                    let other = s.mul_f64s(q, s.splat_f64s(*b));
                    let partial = s.mul_add_f64s(r, s.splat_f64s(*c), partial);
                    *x = s.add_f64s(partial, s.mul_add_f64s(t, s.splat_f64s(*d), other));
                }
            } else {
                for (column, &solved) in columns.chunks_exact(height).zip(solved) {
                    for (x, entry) in below.iter_mut().zip(column) {
                        *x = s.mul_add_f64s(solved, s.splat_f64s(-entry), *x);
                    }
                }
            }
        }
        for (&row, &value) in factors.analysis.rows[front.rows.clone()].iter().zip(&*below) {
            self.store::<S>(register, row as usize, value);
        }
    }

    #[inline(always)]
    fn back<S: Simd>(
        &mut self,
        s: S,
        register: usize,
        front: &Front,
        own: &mut Vec<S::f64s>,
        below: &mut Vec<S::f64s>,
    ) {
        let factors = self.factors;
        let (square, _, right) = factors.blocks(front);
        self.gather::<S>(register, front, own, below);
        let height = front.padded().max(1);
        for (columns, own) in right.chunks(PANEL * height).zip(own.chunks_mut(PANEL)) {
            if let [p, q, r, t] = own {
                let [a, b, c, d] = split(columns, height);
                let mut sums = [s.splat_f64s(0.0); PANEL];
                for ((((&x, a), b), c), d) in below.iter().zip(a).zip(b).zip(c).zip(d) {
                    sums[0] = s.mul_add_f64s(x, s.splat_f64s(*a), sums[0]);
                    sums[1] = s.mul_add_f64s(x, s.splat_f64s(*b), sums[1]);
                    sums[2] = s.mul_add_f64s(x, s.splat_f64s(*c), sums[2]);
                    sums[3] = s.mul_add_f64s(x, s.splat_f64s(*d), sums[3]);
                }
                for (own, sum) in [p, q, r, t].into_iter().zip(sums) {
                    *own = s.sub_f64s(*own, sum);
                }
            } else {
                for (column, own) in columns.chunks_exact(height).zip(own) {
                    for (&x, entry) in below.iter().zip(column) {
                        *own = s.mul_add_f64s(x, s.splat_f64s(-entry), *own);
                    }
                }
            }
        }
        for (k, column) in square.chunks_exact(front.width).enumerate().rev() {
            let reciprocal = s.splat_f64s(column[k].recip());
            if factors.analysis.kind == Kind::Unsymmetric {
                own[k] = s.mul_f64s(own[k], reciprocal);
                let solved = own[k];
                for (x, entry) in own[..k].iter_mut().zip(column) {
                    *x = s.mul_add_f64s(solved, s.splat_f64s(-entry), *x);
                }
            } else {
                let mut value = own[k];
                for (&x, entry) in own[k + 1..].iter().zip(&column[k + 1..]) {
                    value = s.mul_add_f64s(x, s.splat_f64s(-entry), value);
                }
                own[k] = s.mul_f64s(value, reciprocal);
            }
        }
        for (k, &value) in own.iter().enumerate() {
            self.store::<S>(register, front.first + k, value);
        }
    }
}

/// The columns of a full panel.
#[inline(always)]
fn split(columns: &[f64], height: usize) -> [&[f64]; PANEL] {
    std::array::from_fn(|k| &columns[k * height..][..height])
}
