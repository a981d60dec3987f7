//! What a value measures: exponents over the base quantities.

use std::fmt;
use std::ops::{Div, Mul};

use crate::Rational;
use crate::product::product;

/// Number of base quantities: length, mass, time, temperature, amount and current.
pub(crate) const BASES: usize = 6;

/// Names of the base quantities.
pub(crate) const BASE_NAMES: [&str; BASES] = ["Length", "Mass", "Time", "Temperature", "Amount", "Current"];

/// Exponents over the base quantities; all are 0 for a plain number.
///
/// Dimensions are multiplied and divided with `*` and `/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dimension {
    exponents: [Rational; BASES],
}

impl Dimension {
    /// A plain number; angles are numbers too.
    pub const NUMBER: Dimension = Dimension::of([0, 0, 0, 0, 0, 0]);
    /// Length, in m.
    pub const LENGTH: Dimension = Dimension::of([1, 0, 0, 0, 0, 0]);
    /// Mass, in kg.
    pub const MASS: Dimension = Dimension::of([0, 1, 0, 0, 0, 0]);
    /// Time, in s.
    pub const TIME: Dimension = Dimension::of([0, 0, 1, 0, 0, 0]);
    /// Temperature, in K.
    pub const TEMPERATURE: Dimension = Dimension::of([0, 0, 0, 1, 0, 0]);
    /// Amount of substance, in mol.
    pub const AMOUNT: Dimension = Dimension::of([0, 0, 0, 0, 1, 0]);
    /// Electric current, in A.
    pub const CURRENT: Dimension = Dimension::of([0, 0, 0, 0, 0, 1]);

    /// The dimension with whole exponents of length, mass, time, temperature, amount and current.
    pub const fn of(exponents: [i32; BASES]) -> Dimension {
        let mut fractions = [Rational::ZERO; BASES];
        let mut base = 0;
        while base < BASES {
            fractions[base] = Rational::integer(exponents[base]);
            base += 1;
        }
        Dimension { exponents: fractions }
    }

    /// The dimension with these exponents of length, mass, time, temperature, amount and current.
    pub const fn from_exponents(exponents: [Rational; BASES]) -> Dimension {
        Dimension { exponents }
    }

    /// Exponents of length, mass, time, temperature, amount and current.
    pub const fn exponents(&self) -> &[Rational; BASES] {
        &self.exponents
    }

    /// Whether this is a plain number.
    pub fn is_number(&self) -> bool {
        *self == Dimension::NUMBER
    }

    /// The dimension raised to a power.
    pub fn pow(self, exponent: impl Into<Rational>) -> Dimension {
        let exponent = exponent.into();
        Dimension { exponents: self.exponents.map(|e| e * exponent) }
    }

    /// The dimension that the language calls `name`, such as `Pressure`.
    pub fn named(name: &str) -> Option<Dimension> {
        NAMED.iter().find(|(known, _)| *known == name).map(|(_, dimension)| *dimension)
    }

    /// Every name that [`Dimension::named`] knows.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMED.iter().map(|(name, _)| *name)
    }

    /// The simplest description in names of the language: `Pressure`, `1/Area`, `Force/Length`, and a product of base
    /// quantities such as `Mass*Length^3/Time` where two names do not suffice.
    pub fn describe(&self) -> String {
        self.name()
            .map(str::to_owned)
            .or_else(|| self.as_power())
            .or_else(|| self.as_reciprocal())
            .or_else(|| self.as_pair('/', |a, b| a / b))
            .or_else(|| self.as_pair('*', |a, b| a * b))
            .unwrap_or_else(|| self.in_bases())
    }

    /// The name of exactly this dimension.
    fn name(&self) -> Option<&'static str> {
        NAMED.iter().find(|(_, dimension)| dimension == self).map(|(name, _)| *name)
    }

    /// `Length^4`: a power above 1 of one base quantity.
    fn as_power(&self) -> Option<String> {
        let mut used = self.exponents.iter().filter(|e| !e.is_zero());
        let (exponent, others) = (used.next()?, used.next());
        (others.is_none() && *exponent > Rational::ZERO).then(|| self.in_bases())
    }

    /// `1/Area`
    fn as_reciprocal(&self) -> Option<String> {
        (Dimension::NUMBER / *self).name().map(|name| format!("1/{name}"))
    }

    /// `Force/Length`: two names joined by an operation.
    fn as_pair(&self, sign: char, join: fn(Dimension, Dimension) -> Dimension) -> Option<String> {
        let pairs = NAMED.iter().flat_map(|first| NAMED.iter().map(move |second| (first, second)));
        pairs
            .into_iter()
            .find(|(first, second)| join(first.1, second.1) == *self)
            .map(|(first, second)| format!("{}{sign}{}", first.0, second.0))
    }

    /// `Length^2*Mass/Time`
    fn in_bases(&self) -> String {
        product(BASE_NAMES.into_iter().zip(self.exponents))
    }
}

impl Mul for Dimension {
    type Output = Dimension;
    fn mul(self, other: Dimension) -> Dimension {
        Dimension { exponents: std::array::from_fn(|k| self.exponents[k] + other.exponents[k]) }
    }
}

impl Div for Dimension {
    type Output = Dimension;
    fn div(self, other: Dimension) -> Dimension {
        Dimension { exponents: std::array::from_fn(|k| self.exponents[k] - other.exponents[k]) }
    }
}

/// As [`Dimension::describe`].
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.describe())
    }
}

/// The named dimensions of the language; where two names fit, the first one describes.
const NAMED: &[(&str, Dimension)] = &[
    ("Number", Dimension::NUMBER),
    ("Angle", Dimension::NUMBER),
    ("Length", Dimension::LENGTH),
    ("Area", Dimension::of([2, 0, 0, 0, 0, 0])),
    ("Volume", Dimension::of([3, 0, 0, 0, 0, 0])),
    ("Time", Dimension::TIME),
    ("Frequency", Dimension::of([0, 0, -1, 0, 0, 0])),
    ("Velocity", Dimension::of([1, 0, -1, 0, 0, 0])),
    ("Acceleration", Dimension::of([1, 0, -2, 0, 0, 0])),
    ("Mass", Dimension::MASS),
    ("Density", Dimension::of([-3, 1, 0, 0, 0, 0])),
    ("Force", Dimension::of([1, 1, -2, 0, 0, 0])),
    ("Pressure", Dimension::of([-1, 1, -2, 0, 0, 0])),
    ("Energy", Dimension::of([2, 1, -2, 0, 0, 0])),
    ("Power", Dimension::of([2, 1, -3, 0, 0, 0])),
    ("Viscosity", Dimension::of([-1, 1, -1, 0, 0, 0])),
    ("Temperature", Dimension::TEMPERATURE),
    ("Amount", Dimension::AMOUNT),
    ("Concentration", Dimension::of([-3, 0, 0, 0, 1, 0])),
    ("Current", Dimension::CURRENT),
    ("Charge", Dimension::of([0, 0, 1, 0, 0, 1])),
    ("Voltage", Dimension::of([2, 1, -3, 0, 0, -1])),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> Dimension {
        Dimension::named(name).unwrap()
    }

    #[test]
    fn named_dimensions_obey_their_definitions() {
        let relations = [
            ("Force", named("Mass") * named("Acceleration")),
            ("Pressure", named("Force") / named("Area")),
            ("Energy", named("Force") * named("Length")),
            ("Power", named("Energy") / named("Time")),
            ("Viscosity", named("Pressure") * named("Time")),
            ("Density", named("Mass") / named("Volume")),
            ("Concentration", named("Amount") / named("Volume")),
            ("Charge", named("Current") * named("Time")),
            ("Voltage", named("Power") / named("Current")),
            ("Velocity", named("Length") * named("Frequency")),
            ("Acceleration", named("Velocity") / named("Time")),
            ("Area", named("Length").pow(2)),
            ("Volume", named("Area").pow(Rational::new(3, 2).unwrap())),
            ("Angle", Dimension::NUMBER),
        ];
        for (name, dimension) in relations {
            assert_eq!(named(name), dimension, "{name}");
        }
        assert_eq!(Dimension::named("Presure"), None);
        assert!(Dimension::names().all(|name| Dimension::named(name).is_some()));
    }

    #[test]
    fn descriptions_use_the_simplest_names() {
        let per = |a: &str, b: Dimension| (named(a) / b).describe();
        assert_eq!(named("Angle").describe(), "Number");
        assert_eq!(per("Force", Dimension::LENGTH.pow(2)), "Pressure");
        assert_eq!(per("Number", named("Area")), "1/Area");
        assert_eq!(per("Force", Dimension::LENGTH), "Force/Length");
        assert_eq!(per("Energy", Dimension::TEMPERATURE), "Energy/Temperature");
        assert_eq!(per("Mass", Dimension::TIME), "Mass/Time");
        assert_eq!(Dimension::LENGTH.pow(4).describe(), "Length^4");
        assert_eq!(Dimension::LENGTH.pow(Rational::new(1, 2).unwrap()).describe(), "Length^(1/2)");
        assert_eq!((Dimension::LENGTH * Dimension::TEMPERATURE).describe(), "Length*Temperature");
        assert_eq!(Dimension::of([1, 2, 0, -3, 0, 0]).describe(), "Length*Mass^2/Temperature^3");
    }
}
