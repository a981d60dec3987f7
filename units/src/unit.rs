//! The closed list of units of the language.

use crate::{Dimension, Scale};

/// A unit with a symbol of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// How the unit is written, such as `um`.
    pub symbol: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// Its size in SI units.
    pub scale: Scale,
}

impl Unit {
    /// Every unit, by quantity and then by size.
    pub const ALL: &[Unit] = UNITS;

    /// The unit written `symbol`.
    pub fn find(symbol: &str) -> Option<&'static Unit> {
        Unit::ALL.iter().find(|unit| unit.symbol == symbol)
    }

    /// The unit that `word` may have been meant for: the first of the list that differs by case only, as the commoner ones stand before the others,
    /// else the most similar one.
    pub fn meant(word: &str) -> Option<&'static str> {
        let symbols = || Unit::ALL.iter().map(|unit| unit.symbol);
        symbols().find(|symbol| symbol.eq_ignore_ascii_case(word)).or_else(|| crate::nearest(word, symbols()))
    }

    /// Its size in SI units as a number.
    pub fn factor_to_si(&self) -> f64 {
        self.scale.value()
    }
}

/// A unit that is a power of ten of the SI unit.
const fn decimal(symbol: &'static str, dimension: Dimension, exponent: i32) -> Unit {
    Unit { symbol, dimension, scale: Scale::ten(exponent) }
}

/// A unit that is `2^two 3^three 5^five pi^pi` of the SI unit.
const fn other(symbol: &'static str, dimension: Dimension, [two, three, five, pi]: [i32; 4]) -> Unit {
    Unit { symbol, dimension, scale: Scale::new(two, three, five, pi) }
}

const FREQUENCY: Dimension = Dimension::of([0, 0, -1, 0, 0, 0]);
const FORCE: Dimension = Dimension::of([1, 1, -2, 0, 0, 0]);
const PRESSURE: Dimension = Dimension::of([-1, 1, -2, 0, 0, 0]);
const ENERGY: Dimension = Dimension::of([2, 1, -2, 0, 0, 0]);
const POWER: Dimension = Dimension::of([2, 1, -3, 0, 0, 0]);
const CONCENTRATION: Dimension = Dimension::of([-3, 0, 0, 0, 1, 0]);
const CHARGE: Dimension = Dimension::of([0, 0, 1, 0, 0, 1]);
const VOLTAGE: Dimension = Dimension::of([2, 1, -3, 0, 0, -1]);

const UNITS: &[Unit] = &[
    decimal("rad", Dimension::NUMBER, 0),
    other("deg", Dimension::NUMBER, [-2, -2, -1, 1]), // pi/180
    decimal("pm", Dimension::LENGTH, -12),
    decimal("nm", Dimension::LENGTH, -9),
    decimal("um", Dimension::LENGTH, -6),
    decimal("mm", Dimension::LENGTH, -3),
    decimal("cm", Dimension::LENGTH, -2),
    decimal("m", Dimension::LENGTH, 0),
    decimal("km", Dimension::LENGTH, 3),
    decimal("ug", Dimension::MASS, -9),
    decimal("mg", Dimension::MASS, -6),
    decimal("g", Dimension::MASS, -3),
    decimal("kg", Dimension::MASS, 0),
    decimal("ns", Dimension::TIME, -9),
    decimal("us", Dimension::TIME, -6),
    decimal("ms", Dimension::TIME, -3),
    decimal("s", Dimension::TIME, 0),
    other("min", Dimension::TIME, [2, 1, 1, 0]),  // 60
    other("hour", Dimension::TIME, [4, 2, 2, 0]), // 3600
    other("day", Dimension::TIME, [7, 3, 2, 0]),  // 86400
    decimal("Hz", FREQUENCY, 0),
    decimal("kHz", FREQUENCY, 3),
    decimal("mK", Dimension::TEMPERATURE, -3),
    decimal("K", Dimension::TEMPERATURE, 0),
    decimal("mol", Dimension::AMOUNT, 0),
    decimal("nM", CONCENTRATION, -6), // M is mol per litre
    decimal("uM", CONCENTRATION, -3),
    decimal("mM", CONCENTRATION, 0),
    decimal("M", CONCENTRATION, 3),
    decimal("pN", FORCE, -12),
    decimal("nN", FORCE, -9),
    decimal("uN", FORCE, -6),
    decimal("mN", FORCE, -3),
    decimal("N", FORCE, 0),
    decimal("kN", FORCE, 3),
    decimal("mPa", PRESSURE, -3),
    decimal("Pa", PRESSURE, 0),
    decimal("kPa", PRESSURE, 3),
    decimal("MPa", PRESSURE, 6),
    decimal("GPa", PRESSURE, 9),
    decimal("fJ", ENERGY, -15),
    decimal("pJ", ENERGY, -12),
    decimal("nJ", ENERGY, -9),
    decimal("mJ", ENERGY, -3),
    decimal("J", ENERGY, 0),
    decimal("kJ", ENERGY, 3),
    decimal("mW", POWER, -3),
    decimal("W", POWER, 0),
    decimal("kW", POWER, 3),
    decimal("mA", Dimension::CURRENT, -3),
    decimal("A", Dimension::CURRENT, 0),
    decimal("C", CHARGE, 0),
    decimal("mV", VOLTAGE, -3),
    decimal("V", VOLTAGE, 0),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_are_unique() {
        let mut symbols: Vec<_> = Unit::ALL.iter().map(|unit| unit.symbol).collect();
        symbols.sort_unstable();
        assert!(symbols.windows(2).all(|pair| pair[0] != pair[1]));
    }

    #[test]
    fn a_slip_of_case_means_the_commoner_unit() {
        assert_eq!(["MM", "PA", "kpa"].map(Unit::meant), [Some("mm"), Some("Pa"), Some("kPa")]);
        assert_eq!(Unit::meant("ums"), Some("um"));
        assert_eq!(Unit::meant("banana"), None);
    }

    #[test]
    fn prefixes_mean_their_powers_of_ten() {
        let prefixes =
            [("f", 1e-15), ("p", 1e-12), ("n", 1e-9), ("u", 1e-6), ("m", 1e-3), ("c", 1e-2), ("k", 1e3)];
        for unit in Unit::ALL {
            let Some((prefix, base)) = unit.symbol.split_at_checked(1) else { continue };
            let factor = prefixes.iter().find(|(known, _)| *known == prefix).map(|(_, factor)| *factor);
            if let (Some(base), Some(factor)) = (Unit::find(base), factor) {
                assert_eq!(unit.dimension, base.dimension, "{}", unit.symbol);
                assert_eq!(
                    unit.scale,
                    base.scale * Scale::ten(f64::log10(factor).round() as i32),
                    "{}",
                    unit.symbol
                );
            }
        }
    }

    #[test]
    fn units_that_are_no_powers_of_ten_have_their_factors() {
        let factor = |symbol| Unit::find(symbol).unwrap().factor_to_si();
        assert_eq!([factor("min"), factor("hour"), factor("day")], [60.0, 3600.0, 86400.0]);
        assert_eq!(factor("deg"), std::f64::consts::PI / 180.0);
        assert_eq!([factor("g"), factor("M"), factor("MPa"), factor("GPa")], [1e-3, 1e3, 1e6, 1e9]);
    }
}
