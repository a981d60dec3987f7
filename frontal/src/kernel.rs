//! Dense operations on small blocks, for fronts on which calls of a library cost more than they compute.
//!
//! Blocks are stored column after column. Rows come in multiples of [`PADDING`], so vectors run down the columns without
//! remainder, and the second factor of a product is stored transposed, so that its numbers are read in a row.

use crate::analysis::PADDING;
use pulp::{Arch, Simd, WithSimd};

/// `C -= A B^T`, or `C = -A B^T`.
pub(crate) struct Update<'a> {
    /// `rows x columns`, with as many rows from one column to the next.
    pub c: &'a mut [f64],
    /// `rows x depth`.
    pub a: &'a [f64],
    /// `columns x depth`, [`Self::stride`] numbers from one column to the next.
    pub b: &'a [f64],
    /// Multiple of [`PADDING`].
    pub rows: usize,
    pub columns: usize,
    pub depth: usize,
    pub stride: usize,
    /// Whether `C` is overwritten.
    pub replace: bool,
    /// Whether only the lower triangle of a square `C` is wanted; what lies above is arbitrary.
    pub lower: bool,
}

impl Update<'_> {
    /// Computes the product.
    pub fn run(self) {
        Arch::new().dispatch(self);
    }

    /// Columns `j .. j + N` for the rows of `R` registers from `i`.
    #[inline(always)]
    fn tile<S: Simd, const R: usize, const N: usize>(&mut self, s: S, i: usize, j: usize) {
        let (rows, height) = (self.rows, R * S::F64_LANES);
        let mut sums = [[s.splat_f64s(0.0); R]; N];
        for k in 0..self.depth {
            let a: [S::f64s; R] = load(s, &self.a[k * rows + i..][..height]);
            let b = &self.b[k * self.stride + j..][..N];
            for n in 0..N {
                let factor = s.splat_f64s(b[n]);
                for r in 0..R {
                    sums[n][r] = s.mul_add_f64s(a[r], factor, sums[n][r]);
                }
            }
        }
        for (n, sums) in sums.iter().enumerate() {
            let (c, _) = S::as_mut_simd_f64s(&mut self.c[(j + n) * rows + i..][..height]);
            for r in 0..R {
                let before = if self.replace { s.splat_f64s(0.0) } else { c[r] };
                c[r] = s.sub_f64s(before, sums[r]);
            }
        }
    }

    #[inline(always)]
    fn strip<S: Simd, const R: usize>(&mut self, s: S, i: usize) {
        let end = if self.lower { self.columns.min(i + R * S::F64_LANES) } else { self.columns };
        let mut j = 0;
        if S::REGISTER_COUNT >= 32 {
            while j + 8 <= end {
                self.tile::<S, R, 8>(s, i, j);
                j += 8;
            }
        }
        while j + 4 <= end {
            self.tile::<S, R, 4>(s, i, j);
            j += 4;
        }
        if j + 2 <= end {
            self.tile::<S, R, 2>(s, i, j);
            j += 2;
        }
        if j < end {
            self.tile::<S, R, 1>(s, i, j);
        }
    }
}

impl WithSimd for Update<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, s: S) {
        let mut i = 0;
        while i + 3 * S::F64_LANES <= self.rows {
            self.strip::<S, 3>(s, i);
            i += 3 * S::F64_LANES;
        }
        while i + 2 * S::F64_LANES <= self.rows {
            self.strip::<S, 2>(s, i);
            i += 2 * S::F64_LANES;
        }
        while i < self.rows {
            self.strip::<S, 1>(s, i);
            i += S::F64_LANES;
        }
    }
}

/// `X = X T^-1` with an upper triangle `T`.
pub(crate) struct RightSolve<'a> {
    /// `rows x width`.
    pub x: &'a mut [f64],
    /// Rows of `T`, each `width` long; the diagonal and what lies below are not read.
    pub t: &'a [f64],
    /// Reciprocals of the diagonal of `T`.
    pub reciprocals: &'a [f64],
    /// Multiple of [`PADDING`].
    pub rows: usize,
    pub width: usize,
}

impl RightSolve<'_> {
    /// Solves.
    pub fn run(self) {
        debug_assert!(self.rows.is_multiple_of(PADDING));
        Arch::new().dispatch(self);
    }

    /// Columns `j .. j + N` for the rows of `R` registers from `i`; earlier columns are solved.
    #[inline(always)]
    fn tile<S: Simd, const R: usize, const N: usize>(&mut self, s: S, i: usize, j: usize) {
        let (rows, height) = (self.rows, R * S::F64_LANES);
        let mut x: [[S::f64s; R]; N] =
            std::array::from_fn(|n| load(s, &self.x[(j + n) * rows + i..][..height]));
        for k in 0..j {
            let solved: [S::f64s; R] = load(s, &self.x[k * rows + i..][..height]);
            let t = &self.t[k * self.width + j..][..N];
            for n in 0..N {
                let factor = s.splat_f64s(-t[n]);
                for r in 0..R {
                    x[n][r] = s.mul_add_f64s(solved[r], factor, x[n][r]);
                }
            }
        }
        for k in 0..N {
            let t = &self.t[(j + k) * self.width + j..][..N];
            let reciprocal = s.splat_f64s(self.reciprocals[j + k]);
            x[k] = x[k].map(|x| s.mul_f64s(x, reciprocal));
            let solved = x[k];
            for n in k + 1..N {
                let factor = s.splat_f64s(-t[n]);
                for (x, solved) in x[n].iter_mut().zip(solved) {
                    *x = s.mul_add_f64s(solved, factor, *x);
                }
            }
        }
        for (n, x) in x.iter().enumerate() {
            let (column, _) = S::as_mut_simd_f64s(&mut self.x[(j + n) * rows + i..][..height]);
            column[..R].copy_from_slice(x);
        }
    }

    #[inline(always)]
    fn strip<S: Simd, const R: usize>(&mut self, s: S, i: usize) {
        let mut j = 0;
        while j + 4 <= self.width {
            self.tile::<S, R, 4>(s, i, j);
            j += 4;
        }
        if j + 2 <= self.width {
            self.tile::<S, R, 2>(s, i, j);
            j += 2;
        }
        if j < self.width {
            self.tile::<S, R, 1>(s, i, j);
        }
    }
}

impl WithSimd for RightSolve<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, s: S) {
        let mut i = 0;
        while i + 3 * S::F64_LANES <= self.rows {
            self.strip::<S, 3>(s, i);
            i += 3 * S::F64_LANES;
        }
        while i < self.rows {
            self.strip::<S, 1>(s, i);
            i += S::F64_LANES;
        }
    }
}

/// `y += A^T x`: products of the columns of `A` with a vector.
pub(crate) struct Products<'a> {
    /// One number per column.
    pub y: &'a mut [f64],
    /// `rows x y.len()`.
    pub a: &'a [f64],
    /// `rows` numbers.
    pub x: &'a [f64],
    /// Multiple of [`PADDING`].
    pub rows: usize,
}

impl Products<'_> {
    /// Adds the products.
    pub fn run(self) {
        Arch::new().dispatch(self);
    }

    #[inline(always)]
    fn tile<S: Simd, const N: usize>(&mut self, s: S, j: usize) {
        let mut sums = [s.splat_f64s(0.0); N];
        let (x, _) = S::as_simd_f64s(&self.x[..self.rows]);
        let columns: [&[S::f64s]; N] =
            std::array::from_fn(|n| S::as_simd_f64s(&self.a[(j + n) * self.rows..][..self.rows]).0);
        for (k, &x) in x.iter().enumerate() {
            for n in 0..N {
                sums[n] = s.mul_add_f64s(columns[n][k], x, sums[n]);
            }
        }
        for (y, sum) in self.y[j..j + N].iter_mut().zip(sums) {
            *y += s.reduce_sum_f64s(sum);
        }
    }
}

impl WithSimd for Products<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, s: S) {
        let (mut j, width) = (0, self.y.len());
        while j + 4 <= width {
            self.tile::<S, 4>(s, j);
            j += 4;
        }
        while j < width {
            self.tile::<S, 1>(s, j);
            j += 1;
        }
    }
}

#[inline(always)]
fn load<S: Simd, const R: usize>(_: S, numbers: &[f64]) -> [S::f64s; R] {
    let (registers, _) = S::as_simd_f64s(numbers);
    std::array::from_fn(|r| registers[r])
}
