//! How large a unit is in SI, held exactly, and the conversion of values between units.

use std::f64::consts::PI;
use std::ops::{Div, Mul};

use crate::Rational;

/// A positive factor `2^a 3^b 5^c pi^d` with exact exponents; every unit of the language is such a factor times the SI
/// unit. Scales are multiplied and divided with `*` and `/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Scale {
    two: Rational,
    three: Rational,
    five: Rational,
    pi: Rational,
}

impl Scale {
    /// The factor 1: the SI unit itself.
    pub const ONE: Scale = Scale::new(0, 0, 0, 0);

    /// The factor `2^two 3^three 5^five pi^pi`.
    pub const fn new(two: i32, three: i32, five: i32, pi: i32) -> Scale {
        Scale {
            two: Rational::integer(two),
            three: Rational::integer(three),
            five: Rational::integer(five),
            pi: Rational::integer(pi),
        }
    }

    /// The factor `10^exponent`.
    pub const fn ten(exponent: i32) -> Scale {
        Scale::new(exponent, 0, exponent, 0)
    }

    /// The scale raised to a power.
    pub fn pow(self, exponent: impl Into<Rational>) -> Scale {
        let e = exponent.into();
        Scale { two: self.two * e, three: self.three * e, five: self.five * e, pi: self.pi * e }
    }

    /// The factor as a number; 0 or infinite where it is beyond the range of `f64`.
    pub fn value(self) -> f64 {
        self.apply(1.0)
    }

    /// `value` times the factor.
    fn apply(self, value: f64) -> f64 {
        if self == Scale::ONE || value == 0.0 || !value.is_finite() {
            return value;
        }
        let rational = Scale { pi: Rational::ZERO, ..self };
        let scaled = rational.apply_exactly(value).unwrap_or_else(|| value * rational.approximate());
        if self.pi.is_zero() { scaled } else { scaled * PI.powf(self.pi.to_f64()) }
    }

    /// The rational part of the factor in floating point.
    fn approximate(self) -> f64 {
        2f64.powf(self.two.to_f64()) * 3f64.powf(self.three.to_f64()) * 5f64.powf(self.five.to_f64())
    }

    /// The number nearest to the shortest decimal that denotes `value`, times the rational part of the factor. `None`
    /// where that part is irrational or too large for the integers used.
    fn apply_exactly(self, value: f64) -> Option<f64> {
        let tens = self.five.as_integer()?;
        let twos = self.two.as_integer()?.checked_sub(tens)?;
        let threes = self.three.as_integer()?;
        let (numerator, denominator) = fraction(twos, threes)?;
        let (digits, exponent) = decimal(value.abs())?;
        let (digits, exponent) = divide(
            u128::from(digits) * u128::from(numerator),
            u128::from(denominator),
            i64::from(exponent) + i64::from(tens),
        );
        let magnitude: f64 = format!("{digits}e{exponent}").parse().ok()?;
        Some(magnitude.copysign(value))
    }
}

impl Mul for Scale {
    type Output = Scale;
    fn mul(self, other: Scale) -> Scale {
        Scale {
            two: self.two + other.two,
            three: self.three + other.three,
            five: self.five + other.five,
            pi: self.pi + other.pi,
        }
    }
}

impl Div for Scale {
    type Output = Scale;
    fn div(self, other: Scale) -> Scale {
        self * other.pow(-1)
    }
}

/// The measure in units of scale `to` of what measures `value` in units of scale `from`.
///
/// The value is taken as the shortest decimal that denotes it, and the result is the nearest double: what is short in
/// both units is exact in both (130 nm, 1.3e-7 m and 0.13 um convert into each other). The number pi, which enters
/// with degrees, and irrational factors, which fractional powers bring, are multiplied in floating point.
pub fn convert(value: f64, from: Scale, to: Scale) -> f64 {
    (from / to).apply(value)
}

/// `2^twos 3^threes` as a fraction.
fn fraction(twos: i32, threes: i32) -> Option<(u64, u64)> {
    let power = |exponent: i32, base: u64| base.checked_pow(exponent.max(0) as u32);
    let numerator = power(twos, 2)?.checked_mul(power(threes, 3)?)?;
    let denominator = power(twos.checked_neg()?, 2)?.checked_mul(power(threes.checked_neg()?, 3)?)?;
    Some((numerator, denominator))
}

/// Digits and exponent of the shortest decimal `digits * 10^exponent` that denotes a positive finite `value`.
fn decimal(value: f64) -> Option<(u64, i32)> {
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let places = i32::try_from(decimals.len()).ok()?;
    Some((format!("{whole}{decimals}").parse().ok()?, exponent.parse::<i32>().ok()? - places))
}

/// Decimal digits and exponent of `dividend / divisor * 10^exponent`, at least 20 digits where it does not terminate.
/// A digit 1 after those stands for the rest, so that rounding to a double goes the right way.
fn divide(dividend: u128, divisor: u128, mut exponent: i64) -> (String, i64) {
    let (mut quotient, mut rest) = (dividend / divisor, dividend % divisor);
    while rest != 0 && quotient < 10u128.pow(19) {
        (quotient, rest) = (quotient * 10 + rest * 10 / divisor, rest * 10 % divisor);
        exponent -= 1;
    }
    if rest == 0 { (quotient.to_string(), exponent) } else { (format!("{quotient}1"), exponent - 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MINUTE: Scale = Scale::new(2, 1, 1, 0);
    const DEGREE: Scale = Scale::new(-2, -2, -1, 1);

    #[test]
    fn decimal_conversions_have_no_rounding_noise() {
        for tenths in 1..2000 {
            let text = format!("{}.{}", tenths / 10, tenths % 10);
            let value: f64 = text.parse().unwrap();
            for exponent in [-21, -9, -3, 1, 15, 24] {
                let shifted: f64 = format!("{text}e{exponent}").parse().unwrap();
                assert_eq!(convert(value, Scale::ten(exponent), Scale::ONE), shifted);
                assert_eq!(convert(shifted, Scale::ONE, Scale::ten(exponent)), value);
            }
        }
    }

    #[test]
    fn whole_factors_that_are_not_decimal_are_exact_too() {
        for tenths in 1..2000 {
            let minutes: f64 = format!("{}.{}", tenths / 10, tenths % 10).parse().unwrap();
            let seconds = f64::from(tenths * 6);
            assert_eq!(convert(minutes, MINUTE, Scale::ONE), seconds);
            assert_eq!(convert(seconds, Scale::ONE, MINUTE), minutes);
        }
        assert_eq!(convert(20.0, Scale::ONE, MINUTE), 1.0 / 3.0);
        assert_eq!(convert(90.0, DEGREE, Scale::ONE), std::f64::consts::FRAC_PI_2);
        assert_eq!(DEGREE.value(), 1f64.to_radians());
    }

    #[test]
    fn fractional_powers_combine_exactly() {
        let root = Scale::ten(-12).pow(Rational::new(1, 2).unwrap());
        assert_eq!(root, Scale::ten(-6));
        let irrational = Scale::ten(3).pow(Rational::new(1, 2).unwrap());
        assert!((irrational.value() - 1000f64.sqrt()).abs() < 1e-13);
        assert_eq!((irrational * irrational).value(), 1000.0);
    }

    #[test]
    fn special_values_pass_and_extreme_scales_saturate() {
        assert!(convert(f64::NAN, MINUTE, Scale::ONE).is_nan());
        assert_eq!(convert(f64::NEG_INFINITY, MINUTE, Scale::ONE), f64::NEG_INFINITY);
        assert!(convert(-0.0, MINUTE, Scale::ONE).is_sign_negative());
        assert_eq!(convert(-2.0, MINUTE, Scale::ONE), -120.0);
        assert_eq!(Scale::ten(400).value(), f64::INFINITY);
        assert_eq!(Scale::ten(i32::MIN).value(), 0.0);
        assert_eq!(Scale::new(0, 200, 0, 0).value(), 3f64.powi(200));
    }
}
