//! Constant exponents: fractions of small integers.

use std::fmt;

use super::op::{DIVISION, TRANSCENDENTAL};

/// A fraction in lowest terms with a positive denominator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rational {
    numerator: i32,
    denominator: i32,
}

impl Rational {
    /// Minus one third.
    pub const MINUS_THIRD: Rational = Rational { numerator: -1, denominator: 3 };
    /// One half.
    pub const HALF: Rational = Rational { numerator: 1, denominator: 2 };

    /// `numerator / denominator` in lowest terms; `None` if the denominator is zero or a part does not fit `i32`.
    pub fn new(numerator: i64, denominator: i64) -> Option<Rational> {
        let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs());
        if denominator == 0 || divisor > i32::MAX as u64 {
            return None;
        }
        let sign = denominator.signum();
        let part = |n: i64| i32::try_from(sign.checked_mul(n)? / divisor as i64).ok();
        Some(Rational { numerator: part(numerator)?, denominator: part(denominator)? })
    }

    /// The integer `n`.
    pub const fn integer(n: i32) -> Rational {
        Rational { numerator: n, denominator: 1 }
    }

    /// The fraction with the smallest denominator up to 12 that rounds to `x`; `None` if there is none.
    pub fn from_f64(x: f64) -> Option<Rational> {
        (1..=12).find_map(|denominator| {
            let numerator = (x * f64::from(denominator)).round();
            let fits = numerator.abs() <= f64::from(i32::MAX) && numerator / f64::from(denominator) == x;
            fits.then(|| Rational::new(numerator as i64, i64::from(denominator)))?
        })
    }

    /// Numerator, with the sign.
    pub fn numerator(self) -> i32 {
        self.numerator
    }

    /// Denominator, positive.
    pub fn denominator(self) -> i32 {
        self.denominator
    }

    /// The integer it is, if it is one.
    pub fn as_integer(self) -> Option<i32> {
        (self.denominator == 1).then_some(self.numerator)
    }

    /// Nearest `f64`.
    pub fn to_f64(self) -> f64 {
        f64::from(self.numerator) / f64::from(self.denominator)
    }

    /// Product; `None` if it does not fit.
    pub fn times(self, other: Rational) -> Option<Rational> {
        let numerator = i64::from(self.numerator) * i64::from(other.numerator);
        Rational::new(numerator, i64::from(self.denominator) * i64::from(other.denominator))
    }

    /// One less; `None` if it does not fit.
    pub fn decrement(self) -> Option<Rational> {
        let numerator = i64::from(self.numerator) - i64::from(self.denominator);
        Rational::new(numerator, i64::from(self.denominator))
    }

    /// `x` raised to it: NaN for negative `x` unless it is an integer.
    pub fn power(self, x: f64) -> f64 {
        match (self.numerator, self.denominator) {
            (n, 1) => x.powi(n),
            (n, 3) if x >= 0.0 => x.cbrt().powi(n),
            _ => x.powf(self.to_f64()),
        }
    }

    /// Cost of the power in additions.
    pub fn cost(self) -> u32 {
        match (self.numerator, self.denominator) {
            (_, 1) => 2 * DIVISION,
            (_, 2 | 3) => TRANSCENDENTAL,
            _ => 2 * TRANSCENDENTAL,
        }
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.as_integer() {
            Some(n) => write!(f, "{n}"),
            None => write!(f, "({}/{})", self.numerator, self.denominator),
        }
    }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a.max(1) } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_in_lowest_terms_with_a_positive_denominator() {
        let p = Rational::new(4, -6).unwrap();
        assert_eq!((p.numerator(), p.denominator()), (-2, 3));
        assert_eq!(Rational::new(1, 0), None);
        assert_eq!(Rational::new(1, i64::from(i32::MAX) + 1), None);
        assert_eq!(Rational::new(i64::MIN, -1), None);
    }

    #[test]
    fn decimal_constants_become_fractions_only_when_exact() {
        assert_eq!(Rational::from_f64(-2.0 / 3.0), Rational::new(-2, 3));
        assert_eq!(Rational::from_f64(1.5), Rational::new(3, 2));
        assert_eq!(Rational::from_f64(0.123), None);
        assert_eq!(Rational::from_f64(f64::NAN), None);
    }

    #[test]
    fn fractional_powers_of_negative_numbers_are_not_numbers() {
        assert!(Rational::new(1, 3).unwrap().power(-8.0).is_nan());
        assert_eq!(Rational::integer(3).power(-2.0), -8.0);
    }
}
