//! SIMD lanes for generated element kernels.
//!
//! A kernel treats [`BATCH`] elements at once in structure-of-arrays layout: each scalar quantity is a [`Row`], one
//! number per element. A [`Lane`] holds as many consecutive numbers of a row as fit one register of
//! the instruction set `S`; [`vectorize!`](crate::vectorize) picks the instruction set at run time and walks a kernel
//! over the registers of the batch, so that a kernel is written once, for "one register of elements at offset `o`".

use pulp::bytemuck;
pub use pulp::{Arch, Simd, WithSimd};
use std::ops::{Add, AddAssign, Deref, DerefMut, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// Number of elements that one kernel call treats.
pub const BATCH: usize = 8;

/// One number for each element of a batch, on one cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub struct Row(pub [f64; BATCH]);

impl Row {
    /// A row of zeros.
    pub const ZERO: Self = Self([0.0; BATCH]);

    /// The row with `number(lane)` in each lane.
    #[inline(always)]
    pub fn from_fn(number: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(number))
    }
}

impl Deref for Row {
    type Target = [f64; BATCH];
    #[inline(always)]
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl DerefMut for Row {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

/// The first `N` of some rows, where a kernel knows how many the runtime hands it.
///
/// # Panics
/// If there are fewer.
#[inline(always)]
pub fn rows<const N: usize>(rows: &[Row]) -> &[Row; N] {
    // Which rows an integral reads and writes follows from its uses, for the kernel as for the runtime.
    rows.first_chunk().expect("as many rows as the integral has local unknowns")
}

/// The first `N` of some rows, to be written.
///
/// # Panics
/// If there are fewer.
#[inline(always)]
pub fn rows_mut<const N: usize>(rows: &mut [Row]) -> &mut [Row; N] {
    // As for `rows`.
    rows.first_chunk_mut().expect("as many rows as the kernel writes")
}

/// Calls a kernel for all registers of one batch, with the best instruction set of the machine.
///
/// `vectorize!(kernel_lanes(batch: &Batch<'_>, out: &mut [f64]))`, with variables `batch` and `out` in scope, calls
/// `kernel_lanes(s, o, batch, out)` for `o = 0, S::F64_LANES, ..`, where
/// `fn kernel_lanes<S: Simd>(s: S, o: usize, batch: &Batch<'_>, out: &mut [f64])` must be `#[inline(always)]`: only then
/// is it compiled for the chosen instruction set. Arguments have their types written out.
///
/// A program compiled with `--cfg ansatz_lanes="avx512"` or `"avx2"` has its kernels for that set and for any machine, and none between: half the
/// work for the compiler where it is known where the program will run.
#[macro_export]
macro_rules! vectorize {
    ($lanes:ident($($name:ident: $type:ty),* $(,)?)) => {{
        struct Kernel<T>(T);
        impl $crate::lane::WithSimd for Kernel<($($type,)*)> {
            type Output = ();
            #[inline(always)]
            fn with_simd<S: $crate::lane::Simd>(self, s: S) {
                let ($($name,)*) = self.0;
                for o in (0..$crate::lane::BATCH).step_by(S::F64_LANES) {
                    $lanes(s, o, $($name),*);
                }
            }
        }
        let kernel = Kernel(($($name,)*));
        #[allow(unexpected_cfgs)] // set by whoever compiles the program
        {
            #[cfg(ansatz_lanes = "avx512")]
            $crate::lane::with_avx512(kernel);
            #[cfg(ansatz_lanes = "avx2")]
            $crate::lane::with_avx2(kernel);
            #[cfg(not(any(ansatz_lanes = "avx512", ansatz_lanes = "avx2")))]
            $crate::lane::Arch::new().dispatch(kernel);
        }
    }};
}

/// Runs a kernel with AVX-512, or one number at a time where the machine has none.
#[inline(always)]
pub fn with_avx512<K: WithSimd<Output = ()>>(kernel: K) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V4::try_new() {
        return Simd::vectorize(simd, kernel);
    }
    pulp::Scalar.vectorize(kernel)
}

/// Runs a kernel with AVX2, or one number at a time where the machine has none.
#[inline(always)]
pub fn with_avx2<K: WithSimd<Output = ()>>(kernel: K) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return Simd::vectorize(simd, kernel);
    }
    pulp::Scalar.vectorize(kernel)
}

/// One register of numbers, one per element; arithmetic acts on each number.
#[derive(Clone, Copy, Debug)]
pub struct Lane<S: Simd> {
    simd: S,
    register: S::f64s,
}

/// Outcome of a comparison of two lanes.
#[derive(Clone, Copy, Debug)]
pub struct Mask<S: Simd> {
    simd: S,
    register: S::m64s,
}

impl<S: Simd> Lane<S> {
    #[inline(always)]
    fn new(simd: S, register: S::f64s) -> Self {
        Self { simd, register }
    }

    /// The same number for all elements.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self::new(simd, simd.splat_f64s(value))
    }

    /// Numbers `o .. o + S::F64_LANES` of a row; `o` is a multiple of `S::F64_LANES` below [`BATCH`].
    #[inline(always)]
    pub fn load(simd: S, row: &[f64; BATCH], o: usize) -> Self {
        let registers = S::as_simd_f64s(row).0;
        Self::new(simd, registers[o % BATCH / S::F64_LANES])
    }

    /// Writes the numbers to `o .. o + S::F64_LANES` of a row; `o` as for [`load`](Self::load).
    #[inline(always)]
    pub fn store(self, row: &mut [f64; BATCH], o: usize) {
        let registers = S::as_mut_simd_f64s(row).0;
        registers[o % BATCH / S::F64_LANES] = self.register;
    }

    /// Adds the numbers to `o .. o + S::F64_LANES` of a row; `o` as for [`load`](Self::load).
    #[inline(always)]
    pub fn accumulate(self, row: &mut [f64; BATCH], o: usize) {
        (Self::load(self.simd, row, o) + self).store(row, o);
    }

    /// `self * a + b`, in one rounding where the machine can.
    #[inline(always)]
    pub fn mul_add(self, a: Self, b: Self) -> Self {
        Self::new(self.simd, self.simd.mul_add_e_f64s(self.register, a.register, b.register))
    }

    /// Square root; NaN below zero.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self::new(self.simd, self.simd.sqrt_f64s(self.register))
    }

    /// Lesser of two numbers.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self::new(self.simd, self.simd.min_f64s(self.register, other.register))
    }

    /// Greater of two numbers.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self::new(self.simd, self.simd.max_f64s(self.register, other.register))
    }

    /// Absolute value.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self::new(self.simd, self.simd.abs_f64s(self.register))
    }

    /// Where `self < other`.
    #[inline(always)]
    pub fn less(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, register: self.simd.less_than_f64s(self.register, other.register) }
    }

    /// Where `self <= other`.
    #[inline(always)]
    pub fn less_equal(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, register: self.simd.less_than_or_equal_f64s(self.register, other.register) }
    }

    /// Applies a scalar function to each number in turn.
    #[inline(always)]
    pub fn map(self, function: impl Fn(f64) -> f64) -> Self {
        let mut register = self.register;
        for x in bytemuck::cast_slice_mut(std::slice::from_mut(&mut register)) {
            *x = function(*x);
        }
        Self::new(self.simd, register)
    }

    /// Applies a scalar function of two numbers to each pair in turn.
    #[inline(always)]
    pub fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        let mut register = self.register;
        let others: &[f64] = bytemuck::cast_slice(std::slice::from_ref(&other.register));
        for (x, y) in bytemuck::cast_slice_mut(std::slice::from_mut(&mut register)).iter_mut().zip(others) {
            *x = function(*x, *y);
        }
        Self::new(self.simd, register)
    }

    /// `self` to the power of a whole number, by repeated squaring.
    #[inline(always)]
    pub fn powi(self, exponent: i32) -> Self {
        let mut power = Self::splat(self.simd, 1.0);
        let (mut square, mut bits) = (self, exponent.unsigned_abs());
        while bits != 0 {
            if bits & 1 == 1 {
                power *= square;
            }
            bits >>= 1;
            if bits != 0 {
                square *= square;
            }
        }
        if exponent < 0 { Self::splat(self.simd, 1.0) / power } else { power }
    }

    /// `self^(numerator / denominator)` for constant arguments, `denominator > 0`.
    ///
    /// Whole powers are products; thirds and halves come from vectorised roots (a few units in the last place), others
    /// from the scalar power. A power that is not whole is NaN unless `self` is positive (and not subnormal), so that an
    /// inverted element shows.
    #[inline(always)]
    pub fn rational_power(self, numerator: i32, denominator: i32) -> Self {
        if numerator % denominator == 0 {
            return self.powi(numerator / denominator);
        }
        let power = match denominator {
            2 => self.powi(numerator.div_euclid(2)) * self.sqrt(),
            3 => {
                let whole = -(-numerator).div_euclid(3);
                self.powi(whole) * self.reciprocal_cube_root().powi(3 * whole - numerator)
            }
            _ => self.map(|x| x.powf(f64::from(numerator) / f64::from(denominator))),
        };
        let least = Self::splat(self.simd, f64::MIN_POSITIVE);
        least.less_equal(self).select(power, Self::splat(self.simd, f64::NAN))
    }

    /// `self^(-1/3)` for positive normal numbers; anything for others.
    ///
    /// The bits of a number are close to its scaled and shifted logarithm, so that minus a third of them gives the root
    /// to 3.5 %; two steps of the fourth-order iteration y (1 + r/3 + 2 r^2/9 + 14 r^3/81), r = 1 - x y^3, take that to
    /// 2e-5 and to full accuracy.
    #[inline(always)]
    fn reciprocal_cube_root(self) -> Self {
        let constant = |value| Self::splat(self.simd, value);
        let mut y = self.map(|x| {
            let third = ((x.to_bits() >> 32) * 0x5555_5556) >> 32;
            f64::from_bits(0x553e_f0ff_289d_d796_u64.wrapping_sub(third << 32))
        });
        for _ in 0..2 {
            let r = (-(self * y)).mul_add(y * y, constant(1.0));
            let series =
                r.mul_add(constant(14.0 / 81.0), constant(2.0 / 9.0)).mul_add(r, constant(1.0 / 3.0));
            y = (y * r).mul_add(series, y);
        }
        y
    }

    /// `self` to a real power, number by number.
    #[inline(always)]
    pub fn powf(self, exponent: Self) -> Self {
        self.zip(exponent, f64::powf)
    }

    /// Angle of the point (`x`, `self`) in radians.
    #[inline(always)]
    pub fn atan2(self, x: Self) -> Self {
        self.zip(x, f64::atan2)
    }
}

/// Functions that go number by number through their scalar version.
macro_rules! scalar_functions {
    ($($name:ident: $doc:literal),*) => {
        impl<S: Simd> Lane<S> {
            $(#[doc = $doc]
            #[inline(always)]
            pub fn $name(self) -> Self {
                self.map(f64::$name)
            })*
        }
    };
}

scalar_functions!(
    exp: "Exponential.",
    ln: "Natural logarithm.",
    sin: "Sine (radians).",
    cos: "Cosine (radians).",
    tan: "Tangent (radians).",
    asin: "Inverse sine (radians).",
    acos: "Inverse cosine (radians).",
    atan: "Inverse tangent (radians).",
    sinh: "Hyperbolic sine.",
    cosh: "Hyperbolic cosine.",
    tanh: "Hyperbolic tangent.",
    cbrt: "Cube root, odd in its argument."
);

impl<S: Simd> Mask<S> {
    /// `x` where the comparison holds, `y` elsewhere.
    #[inline(always)]
    pub fn select(self, x: Lane<S>, y: Lane<S>) -> Lane<S> {
        Lane::new(self.simd, self.simd.select_f64s(self.register, x.register, y.register))
    }
}

/// Binary operators of lanes.
macro_rules! operators {
    ($($trait:ident $method:ident $simd:ident),*) => {
        $(impl<S: Simd> $trait for Lane<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::new(self.simd, self.simd.$simd(self.register, other.register))
            }
        })*
    };
}

operators!(Add add add_f64s, Sub sub sub_f64s, Mul mul mul_f64s, Div div div_f64s);

/// Assigning operators of lanes.
macro_rules! assigning_operators {
    ($($trait:ident $method:ident $operator:tt),*) => {
        $(impl<S: Simd> $trait for Lane<S> {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        })*
    };
}

assigning_operators!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *);

impl<S: Simd> Neg for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(self.simd, self.simd.neg_f64s(self.register))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::{Scalar, Scalar128b, Scalar512b};

    const ROW: [f64; BATCH] = [0.1, 0.5, 0.9, 1.0, 1.1, 2.0, 27.0, 1e3];

    /// Applies a function of one lane to a row, for one instruction set.
    fn apply<S: Simd>(s: S, row: &[f64; BATCH], function: impl Fn(Lane<S>) -> Lane<S>) -> [f64; BATCH] {
        let mut out = [0.0; BATCH];
        for o in (0..BATCH).step_by(S::F64_LANES) {
            function(Lane::load(s, row, o)).store(&mut out, o);
        }
        out
    }

    #[inline(always)]
    fn squares_lanes<S: Simd>(s: S, o: usize, row: &[f64; BATCH], out: &mut [[f64; BATCH]]) {
        let x = Lane::load(s, row, o);
        (x * x).accumulate(&mut out[0], o);
    }

    fn squares(row: &[f64; BATCH], out: &mut [[f64; BATCH]]) {
        vectorize!(squares_lanes(row: &[f64; BATCH], out: &mut [[f64; BATCH]]));
    }

    #[test]
    fn a_kernel_visits_each_element_once() {
        let mut out = [[1.0; BATCH]];
        squares(&ROW, &mut out);
        assert_eq!(out[0], ROW.map(|x| 1.0 + x * x));
    }

    /// Counts the numbers of a batch that one call treats register by register.
    struct Count<'a>(&'a mut usize);

    impl WithSimd for Count<'_> {
        type Output = ();
        fn with_simd<S: Simd>(self, _: S) {
            *self.0 += BATCH / S::F64_LANES * S::F64_LANES;
        }
    }

    #[test]
    fn kernels_for_one_instruction_set_run_on_every_machine() {
        let mut visited = [0; 2];
        with_avx512(Count(&mut visited[0]));
        with_avx2(Count(&mut visited[1]));
        assert_eq!(visited, [BATCH; 2]);
    }

    fn operators_match<S: Simd>(s: S) {
        let c = |value| Lane::splat(s, value);
        assert_eq!(apply(s, &ROW, |x| (x + c(1.0)) / x - -x * c(2.0)), ROW.map(|x| (x + 1.0) / x - -x * 2.0));
        assert_eq!(apply(s, &ROW, |x| x.min(c(0.5)).max(c(0.2))), ROW.map(|x| x.clamp(0.2, 0.5)));
        assert_eq!(apply(s, &ROW, |x| (-x).abs().sqrt()), ROW.map(f64::sqrt));
        assert_eq!(apply(s, &ROW, |x| x.mul_add(c(2.0), c(0.5))), ROW.map(|x| x * 2.0 + 0.5));
        assert_eq!(apply(s, &ROW, |x| x.powf(c(0.3)).atan2(x)), ROW.map(|x| x.powf(0.3).atan2(x)));
        assert_eq!(
            apply(s, &ROW, |x| x.less(c(1.0)).select(x, c(7.0))),
            ROW.map(|x| if x < 1.0 { x } else { 7.0 })
        );
        let at_most_one = |x: f64| if x <= 1.0 { x } else { 7.0 };
        assert_eq!(apply(s, &ROW, |x| x.less_equal(c(1.0)).select(x, c(7.0))), ROW.map(at_most_one));
    }

    #[test]
    fn lanes_compute_what_numbers_do() {
        operators_match(Scalar);
        operators_match(Scalar128b);
        operators_match(Scalar512b);
    }

    /// Greatest relative error of a rational power against products of scalar roots, over many magnitudes.
    fn power_error<S: Simd>(s: S, numerator: i32, denominator: i32) -> f64 {
        let root = |x: f64| if denominator == 2 { x.sqrt() } else { x.cbrt() };
        let mut greatest = 0.0_f64;
        for k in -300..300 {
            let row = std::array::from_fn(|i| (1.0 + 0.125 * i as f64 + 1e-3 * f64::from(k)) * 2f64.powi(k));
            let power = apply(s, &row, |x| x.rational_power(numerator, denominator));
            for (x, y) in row.iter().zip(power) {
                greatest = greatest.max((y / root(*x).powi(numerator) - 1.0).abs());
            }
        }
        greatest
    }

    #[test]
    fn thirds_and_halves_are_accurate() {
        for (numerator, denominator) in [(-1, 3), (-2, 3), (1, 3), (2, 3), (-4, 3), (1, 2), (-3, 2), (3, 2)] {
            // A few roundings each in the power and in the reference.
            let error = power_error(Scalar, numerator, denominator);
            assert!(error < 8.0 * f64::EPSILON, "{numerator}/{denominator}: {error:e}");
        }
        let cube =
            |y: [f64; BATCH]| y.iter().zip(ROW).map(|(y, x)| (x * y * y * y - 1.0).abs()).fold(0.0, f64::max);
        assert!(cube(apply(Scalar128b, &ROW, |x| x.rational_power(-1, 3))) < 4.0 * f64::EPSILON);
    }

    #[test]
    fn a_power_that_is_not_whole_is_nan_unless_positive() {
        let row = [-1.0, -0.0, 0.0, -27.0, f64::NAN, f64::NEG_INFINITY, -1e-300, 4.0];
        for (numerator, denominator) in [(-1, 3), (2, 3), (1, 2), (1, 5)] {
            let power = apply(Scalar512b, &row, |x| x.rational_power(numerator, denominator));
            assert!(power[..7].iter().all(|y| y.is_nan()) && power[7] > 0.0, "{power:?}");
        }
        assert_eq!(apply(Scalar, &row, |x| x.rational_power(2, 1))[3], 729.0);
    }
}
