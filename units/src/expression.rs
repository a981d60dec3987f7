//! Products of units as they are written, such as `nN*s/um^4`, `1/s` or `um^4/(nN*s)`.

use std::fmt;
use std::ops::{Div, Mul};

use crate::{Dimension, Rational, Scale, Unit};

/// A product of powers of units: what it measures and its size in SI. Multiplied and divided with `*` and `/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnitExpr {
    /// What the unit measures.
    pub dimension: Dimension,
    /// Its size in SI units.
    pub scale: Scale,
}

impl UnitExpr {
    /// The unit of plain numbers.
    pub const ONE: UnitExpr = UnitExpr { dimension: Dimension::NUMBER, scale: Scale::ONE };

    /// Reads factors joined by `*` and `/`, from left to right. A factor is a unit, `1` or a product in parentheses,
    /// with an optional whole exponent after `^`.
    ///
    /// # Errors
    /// If the text is no such product, names an unknown unit, or means a unit beyond the range of numbers.
    pub fn parse(text: &str) -> Result<UnitExpr, UnitError> {
        let mut parser = Parser { text, position: 0, depth: 0 };
        let unit = parser.product()?;
        match parser.peek() {
            Some(_) => Err(parser.unexpected("`*`, `/` or the end of the unit")),
            None if unit.scale.value().is_normal() => Ok(unit),
            None => Err(UnitError { position: 0, kind: UnitErrorKind::OutOfRange }),
        }
    }

    /// The unit raised to a power.
    pub fn pow(self, exponent: impl Into<Rational>) -> UnitExpr {
        let exponent = exponent.into();
        UnitExpr { dimension: self.dimension.pow(exponent), scale: self.scale.pow(exponent) }
    }

    /// Its size in SI units as a number.
    pub fn factor_to_si(&self) -> f64 {
        self.scale.value()
    }
}

impl From<&Unit> for UnitExpr {
    fn from(unit: &Unit) -> UnitExpr {
        UnitExpr { dimension: unit.dimension, scale: unit.scale }
    }
}

impl Mul for UnitExpr {
    type Output = UnitExpr;
    fn mul(self, other: UnitExpr) -> UnitExpr {
        UnitExpr { dimension: self.dimension * other.dimension, scale: self.scale * other.scale }
    }
}

impl Div for UnitExpr {
    type Output = UnitExpr;
    fn div(self, other: UnitExpr) -> UnitExpr {
        UnitExpr { dimension: self.dimension / other.dimension, scale: self.scale / other.scale }
    }
}

/// Factor to SI and dimension of a product of units; see [`UnitExpr::parse`], which keeps the factor exact.
///
/// # Errors
/// As [`UnitExpr::parse`].
pub fn parse_unit(text: &str) -> Result<(f64, Dimension), UnitError> {
    UnitExpr::parse(text).map(|unit| (unit.factor_to_si(), unit.dimension))
}

/// What is wrong with a product of units, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitError {
    /// Byte offset in the text.
    pub position: usize,
    /// What is wrong there.
    pub kind: UnitErrorKind,
}

/// The ways in which a product of units can be wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnitErrorKind {
    /// A symbol that is no unit, with the unit that was perhaps meant.
    UnknownUnit {
        /// The symbol as written.
        symbol: String,
        /// The unit most like it.
        nearest: Option<&'static str>,
    },
    /// Something else than what can stand there.
    Unexpected {
        /// The character, or none at the end of the text.
        found: Option<char>,
        /// What could stand there, in words.
        expected: &'static str,
    },
    /// An exponent that is not a whole number from -99 to 99.
    Exponent,
    /// Parentheses nested deeper than the reader follows.
    TooDeep,
    /// A factor to SI beyond the range of floating-point numbers.
    OutOfRange,
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            UnitErrorKind::UnknownUnit { symbol, nearest: None } => write!(f, "unknown unit `{symbol}`"),
            UnitErrorKind::UnknownUnit { symbol, nearest: Some(unit) } => {
                write!(f, "unknown unit `{symbol}`; did you mean `{unit}`?")
            }
            UnitErrorKind::Unexpected { found: Some(c), expected } => {
                write!(f, "expected {expected}, found `{c}`")
            }
            UnitErrorKind::Unexpected { found: None, expected } => {
                write!(f, "expected {expected} at the end")
            }
            UnitErrorKind::Exponent => f.write_str("the exponent of a unit is a whole number from -99 to 99"),
            UnitErrorKind::TooDeep => f.write_str("too many nested parentheses in a unit"),
            UnitErrorKind::OutOfRange => f.write_str("the unit is too large or too small to convert"),
        }
    }
}

impl std::error::Error for UnitError {}

/// Deepest nesting of parentheses that is read.
const MAX_DEPTH: usize = 16;

/// A reader of [`UnitExpr`] from `position` on.
struct Parser<'a> {
    text: &'a str,
    position: usize,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn product(&mut self) -> Result<UnitExpr, UnitError> {
        let mut product = self.factor()?;
        loop {
            if self.take('*') {
                product = product * self.factor()?;
            } else if self.take('/') {
                product = product / self.factor()?;
            } else {
                return Ok(product);
            }
        }
    }

    fn factor(&mut self) -> Result<UnitExpr, UnitError> {
        let base = match self.peek() {
            Some('(') => self.parentheses()?,
            Some(c) if is_word(c) => self.symbol()?,
            _ => return Err(self.unexpected("a unit")),
        };
        if self.take('^') { Ok(base.pow(self.exponent()?)) } else { Ok(base) }
    }

    fn parentheses(&mut self) -> Result<UnitExpr, UnitError> {
        if self.depth == MAX_DEPTH {
            return Err(self.error(UnitErrorKind::TooDeep));
        }
        self.depth += 1;
        self.take('(');
        let product = self.product()?;
        self.depth -= 1;
        if self.take(')') { Ok(product) } else { Err(self.unexpected("`*`, `/` or `)`")) }
    }

    fn symbol(&mut self) -> Result<UnitExpr, UnitError> {
        let symbol = self.leading(is_word);
        let unit = match symbol {
            "1" => UnitExpr::ONE,
            _ => Unit::find(symbol).map(UnitExpr::from).ok_or_else(|| self.error(unknown(symbol)))?,
        };
        self.position += symbol.len();
        Ok(unit)
    }

    fn exponent(&mut self) -> Result<i32, UnitError> {
        let sign = if self.take('-') { -1 } else { 1 };
        self.skip_white();
        let digits = self.leading(|c| is_word(c) || c == '.');
        match digits.parse::<u8>() {
            Ok(value @ 0..=99) => {
                self.position += digits.len();
                Ok(sign * i32::from(value))
            }
            _ => Err(self.error(UnitErrorKind::Exponent)),
        }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.position..]
    }

    /// The longest run of characters from `position` on that satisfy `accept`.
    fn leading(&self, accept: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        &rest[..rest.find(|c| !accept(c)).unwrap_or(rest.len())]
    }

    fn skip_white(&mut self) {
        self.position = self.text.len() - self.rest().trim_start().len();
    }

    /// The next character that is not white space, with `position` on it.
    fn peek(&mut self) -> Option<char> {
        self.skip_white();
        self.rest().chars().next()
    }

    /// Goes past `c`, an ASCII character, if it comes next.
    fn take(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        self.position += usize::from(found);
        found
    }

    fn error(&self, kind: UnitErrorKind) -> UnitError {
        UnitError { position: self.position, kind }
    }

    fn unexpected(&mut self, expected: &'static str) -> UnitError {
        let found = self.peek();
        self.error(UnitErrorKind::Unexpected { found, expected })
    }
}

/// Whether `c` can be part of a symbol.
fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// An unknown symbol; a Greek mu stands for the `u` of the language.
fn unknown(symbol: &str) -> UnitErrorKind {
    let ascii = symbol.replace(['\u{b5}', '\u{3bc}'], "u");
    let nearest = Unit::meant(&ascii);
    UnitErrorKind::UnknownUnit { symbol: symbol.to_owned(), nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_read_from_left_to_right() {
        let parse = |text| UnitExpr::parse(text).unwrap();
        assert_eq!(parse("kPa"), parse("nN/um^2"));
        assert_eq!(parse("um^4/(nN*s)"), parse("um^4/nN/s"));
        assert_eq!(parse(" 1 / s "), parse("Hz"));
        assert_eq!(parse("m^-2"), parse("1/m^2"));
        assert_eq!(parse("(m/s)^2*kg"), parse("J"));
        assert_eq!(parse("W/A"), parse("V"));
        assert_eq!(parse("mol/m^3"), parse("mM"));
    }

    #[test]
    fn factor_and_dimension_come_together() {
        let force = Dimension::of([1, 1, -2, 0, 0, 0]);
        assert_eq!(parse_unit("nN"), Ok((1e-9, force)));
        assert_eq!(parse_unit("nN*s/um^4"), Ok((1e15, force * Dimension::TIME / Dimension::LENGTH.pow(4))));
        assert_eq!(parse_unit("um/min").map(|(factor, _)| factor), Ok(1e-6 / 60.0));
    }

    #[test]
    fn errors_say_where_and_what() {
        let message = |text: &str| {
            let error = UnitExpr::parse(text).unwrap_err();
            (error.position, error.to_string())
        };
        let cases = [
            ("nN/umm", 3, "unknown unit `umm`; did you mean `um`?"),
            ("kpa", 0, "unknown unit `kpa`; did you mean `kPa`?"),
            ("1/\u{b5}m", 2, "unknown unit `\u{b5}m`; did you mean `um`?"),
            ("furlong", 0, "unknown unit `furlong`"),
            ("", 0, "expected a unit at the end"),
            ("m*", 2, "expected a unit at the end"),
            ("m s", 2, "expected `*`, `/` or the end of the unit, found `s`"),
            ("m/(s*", 5, "expected a unit at the end"),
            ("m/(s", 4, "expected `*`, `/` or `)` at the end"),
            ("m^2.5", 2, "the exponent of a unit is a whole number from -99 to 99"),
            ("m^100", 2, "the exponent of a unit is a whole number from -99 to 99"),
            ("m^n", 2, "the exponent of a unit is a whole number from -99 to 99"),
            ("((km^99)^99)^99", 0, "the unit is too large or too small to convert"),
            ("2*m", 0, "unknown unit `2`"),
        ];
        for (text, position, expected) in cases {
            assert_eq!(message(text), (position, expected.to_owned()), "{text}");
        }
        assert_eq!(UnitExpr::parse(&"(".repeat(100_000)).unwrap_err().kind, UnitErrorKind::TooDeep);
    }
}
