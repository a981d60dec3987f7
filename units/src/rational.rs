//! Exact exponents of dimensions and scales.

use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A fraction in lowest terms with a positive denominator.
///
/// Arithmetic saturates at `i32::MAX`: such exponents have no meaning, and must not stop a compiler either.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rational {
    numerator: i32,
    denominator: i32,
}

impl Rational {
    /// 0
    pub const ZERO: Rational = Rational::integer(0);
    /// 1
    pub const ONE: Rational = Rational::integer(1);

    /// A whole number.
    pub const fn integer(value: i32) -> Rational {
        Rational { numerator: value, denominator: 1 }
    }

    /// The fraction `numerator/denominator`; `None` if the denominator is 0.
    pub fn new(numerator: i32, denominator: i32) -> Option<Rational> {
        (denominator != 0).then(|| Rational::reduced(numerator.into(), denominator.into()))
    }

    /// The fraction with a denominator of at most 60 that equals `value` up to rounding, such as 2/3 for
    /// 0.6666666666666666; `None` if there is none.
    pub fn from_f64(value: f64) -> Option<Rational> {
        let tolerance = 4.0 * f64::EPSILON * value.abs().max(1.0);
        (1..=60).find_map(|denominator| {
            let numerator = (value * f64::from(denominator)).round();
            let close = (value - numerator / f64::from(denominator)).abs() <= tolerance;
            let fits = numerator.abs() <= f64::from(i32::MAX);
            (close && fits).then(|| Rational::reduced(numerator as i64, denominator.into()))
        })
    }

    /// The part above the bar; it carries the sign.
    pub const fn numerator(self) -> i32 {
        self.numerator
    }

    /// The part below the bar, at least 1.
    pub const fn denominator(self) -> i32 {
        self.denominator
    }

    /// Whether this is 0.
    pub const fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// The value as a whole number, if it is one.
    pub fn as_integer(self) -> Option<i32> {
        (self.denominator == 1).then_some(self.numerator)
    }

    /// The nearest floating-point number.
    pub fn to_f64(self) -> f64 {
        f64::from(self.numerator) / f64::from(self.denominator)
    }

    /// Lowest terms of `numerator/denominator`, where the denominator is not 0 and neither is `i64::MIN`.
    fn reduced(numerator: i64, denominator: i64) -> Rational {
        let divisor = gcd(numerator.abs(), denominator.abs()) * denominator.signum();
        let limit = i64::from(i32::MAX);
        Rational {
            numerator: (numerator / divisor).clamp(-limit, limit) as i32,
            denominator: (denominator / divisor).min(limit) as i32,
        }
    }

    /// Both parts with room for a product.
    fn parts(self) -> (i64, i64) {
        (self.numerator.into(), self.denominator.into())
    }
}

/// Greatest common divisor of two numbers that are not negative and not both 0.
fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

impl From<i32> for Rational {
    fn from(value: i32) -> Rational {
        Rational::integer(value)
    }
}

impl Add for Rational {
    type Output = Rational;
    fn add(self, other: Rational) -> Rational {
        let ((a, b), (c, d)) = (self.parts(), other.parts());
        Rational::reduced(a * d + c * b, b * d)
    }
}

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        let (a, b) = self.parts();
        Rational::reduced(-a, b)
    }
}

impl Sub for Rational {
    type Output = Rational;
    fn sub(self, other: Rational) -> Rational {
        self + -other
    }
}

impl Mul for Rational {
    type Output = Rational;
    fn mul(self, other: Rational) -> Rational {
        let ((a, b), (c, d)) = (self.parts(), other.parts());
        Rational::reduced(a * c, b * d)
    }
}

impl Div for Rational {
    type Output = Rational;
    /// # Panics
    /// If `other` is 0.
    fn div(self, other: Rational) -> Rational {
        assert!(!other.is_zero(), "division of an exponent by zero");
        let ((a, b), (c, d)) = (self.parts(), other.parts());
        Rational::reduced(a * d, b * c)
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Rational) -> Ordering {
        let ((a, b), (c, d)) = (self.parts(), other.parts());
        (a * d).cmp(&(c * b))
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Rational) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// `2`, `-1` or `3/2`.
impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.denominator {
            1 => write!(f, "{}", self.numerator),
            denominator => write!(f, "{}/{denominator}", self.numerator),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fraction(numerator: i32, denominator: i32) -> Rational {
        Rational::new(numerator, denominator).unwrap()
    }

    #[test]
    fn fractions_are_kept_in_lowest_terms() {
        assert_eq!(fraction(4, -6), fraction(-2, 3));
        assert_eq!(fraction(4, -6).to_string(), "-2/3");
        assert_eq!(fraction(0, -5), Rational::ZERO);
        assert_eq!(Rational::new(1, 0), None);
    }

    #[test]
    fn arithmetic_is_exact() {
        assert_eq!(fraction(1, 2) + fraction(1, 3), fraction(5, 6));
        assert_eq!(fraction(1, 2) - fraction(1, 2), Rational::ZERO);
        assert_eq!(fraction(2, 3) * fraction(3, 4), fraction(1, 2));
        assert_eq!(fraction(2, 3) / fraction(-4, 3), fraction(-1, 2));
        assert!(fraction(-1, 2) < fraction(1, 3));
    }

    #[test]
    fn exponents_without_meaning_saturate() {
        let huge = Rational::integer(i32::MAX);
        let tiny = fraction(1, i32::MAX);
        assert_eq!(huge * huge + huge, huge);
        assert_eq!(-huge * huge, -huge);
        assert!(tiny * tiny + tiny > Rational::ZERO);
        assert_eq!(fraction(i32::MIN, i32::MIN), Rational::ONE);
    }

    #[test]
    fn decimal_exponents_are_recognised() {
        assert_eq!(Rational::from_f64(-2.0 / 3.0), Some(fraction(-2, 3)));
        assert_eq!(Rational::from_f64(2.5), Some(fraction(5, 2)));
        assert_eq!(Rational::from_f64(std::f64::consts::PI), None);
        assert_eq!(Rational::from_f64(f64::NAN), None);
        assert_eq!(Rational::from_f64(f64::INFINITY), None);
        assert_eq!(Rational::from_f64(1e300), None);
    }
}
