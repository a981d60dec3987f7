//! Quantities as they are typed on a command line: a number and, after it, a unit.

use std::fmt;

use crate::{Dimension, Scale, UnitError, UnitExpr, convert};

/// A number with its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// The measure in `unit`, finite.
    pub value: f64,
    /// What is counted.
    pub unit: UnitExpr,
}

impl Quantity {
    /// Reads `1.2 um`, `5`, `-3.5e2 [nN/um]` or `1000 kg/m^3`: here nothing follows the unit, so the brackets, which
    /// the language asks for around a product, may be left out.
    ///
    /// # Errors
    /// If the text does not start with a number, or does not go on with a unit.
    pub fn parse(text: &str) -> Result<Quantity, QuantityError> {
        let text = text.trim_end();
        let start = text.len() - text.trim_start().len();
        let end = start + number_length(&text[start..]);
        let value = text[start..end].parse().ok().filter(|value: &f64| value.is_finite());
        let value = value.ok_or_else(|| QuantityError::NotANumber(text[start..].to_owned()))?;
        if end == text.len() {
            return Ok(Quantity { value, unit: UnitExpr::ONE });
        }
        let (offset, unit) = without_brackets(text, end);
        let unit = UnitExpr::parse(unit).map_err(|error| {
            QuantityError::Unit(UnitError { position: error.position + offset, kind: error.kind })
        })?;
        Ok(Quantity { value, unit })
    }

    /// What the quantity measures.
    pub fn dimension(&self) -> Dimension {
        self.unit.dimension
    }

    /// The measure in SI units.
    pub fn to_si(&self) -> f64 {
        convert(self.value, self.unit.scale, Scale::ONE)
    }
}

/// SI value and dimension of a quantity; see [`Quantity::parse`].
///
/// # Errors
/// As [`Quantity::parse`].
pub fn parse_quantity(text: &str) -> Result<(f64, Dimension), QuantityError> {
    Quantity::parse(text).map(|quantity| (quantity.to_si(), quantity.dimension()))
}

/// What is wrong with a quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum QuantityError {
    /// The text does not start with a finite number.
    NotANumber(String),
    /// The unit is wrong; the position counts from the start of the whole text.
    Unit(UnitError),
}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            QuantityError::NotANumber(text) => {
                write!(f, "expected a number and a unit, such as `1.2 um`, found `{text}`")
            }
            QuantityError::Unit(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for QuantityError {}

/// Length of the decimal number at the start of `text`; an `e` belongs to it only with digits after it.
fn number_length(text: &str) -> usize {
    let sign = |at: usize| usize::from(text[at..].starts_with(['+', '-']));
    let digits = |at: usize| text[at..].bytes().take_while(u8::is_ascii_digit).count();
    let mut end = sign(0);
    end += digits(end);
    if text[end..].starts_with('.') {
        end += 1 + digits(end + 1);
    }
    if text[end..].starts_with(['e', 'E']) {
        let exponent = end + 1 + sign(end + 1);
        if digits(exponent) > 0 {
            end = exponent + digits(exponent);
        }
    }
    end
}

/// The unit in `text` from `start` on without white space and one pair of brackets, and where it starts.
fn without_brackets(text: &str, start: usize) -> (usize, &str) {
    let unit = text[start..].trim_start();
    match unit.strip_prefix('[').and_then(|inner| inner.strip_suffix(']')) {
        Some(inner) => (text.len() - 1 - inner.len(), inner),
        None => (text.len() - unit.len(), unit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_and_without_units_are_read() {
        assert_eq!(parse_quantity("1.2 um"), Ok((1.2e-6, Dimension::LENGTH)));
        assert_eq!(parse_quantity("5"), Ok((5.0, Dimension::NUMBER)));
        let stiffness = Dimension::of([0, 1, -2, 0, 0, 0]);
        assert_eq!(parse_quantity("-3.5e2 [nN/um]"), Ok((-0.35, stiffness)));
        let density = Dimension::of([-3, 1, 0, 0, 0, 0]);
        assert_eq!(parse_quantity("1000 [kg/m^3]"), Ok((1000.0, density)));
        assert_eq!(parse_quantity(" 1000kg/m^3 "), Ok((1000.0, density)));
        assert_eq!(parse_quantity("1e-2m"), Ok((0.01, Dimension::LENGTH)));
    }

    #[test]
    fn errors_point_into_the_whole_text() {
        for text in ["", "um", "-", "nan", "inf", "1e999 m", "- 5", "\u{b5}"] {
            assert!(matches!(parse_quantity(text), Err(QuantityError::NotANumber(_))), "{text}");
        }
        for (text, at) in
            [("3 [nN/umm]", 6), (" 3 umm", 3), ("3 [um", 2), ("5 um um", 5), ("2 em", 2), ("2 []", 3)]
        {
            match parse_quantity(text) {
                Err(QuantityError::Unit(error)) => assert_eq!(error.position, at, "{text}: {error}"),
                other => panic!("{text}: {other:?}"),
            }
        }
    }
}
