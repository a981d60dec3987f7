//! How products of powers are written: units and dimensions look alike.

use crate::Rational;

/// `a*b^2/(c*d)` for the factors `(a, 1), (b, 2), (c, -1), (d, -1)`; `1` without factors. Exponents of 0 are left out,
/// fractions are written `a^(1/2)`.
pub(crate) fn product<'a>(factors: impl IntoIterator<Item = (&'a str, Rational)>) -> String {
    let (above, below): (Vec<_>, Vec<_>) = factors
        .into_iter()
        .filter(|(_, exponent)| !exponent.is_zero())
        .partition(|(_, exponent)| *exponent > Rational::ZERO);
    let join = |factors: &[(&str, Rational)]| {
        factors.iter().map(|&(name, exponent)| power(name, exponent)).collect::<Vec<_>>().join("*")
    };
    let numerator = if above.is_empty() { "1".to_owned() } else { join(&above) };
    match below.len() {
        0 => numerator,
        1 => format!("{numerator}/{}", join(&below)),
        _ => format!("{numerator}/({})", join(&below)),
    }
}

/// `name` to the absolute value of `exponent`.
fn power(name: &str, exponent: Rational) -> String {
    let exponent = exponent.max(-exponent);
    match exponent.as_integer() {
        Some(1) => name.to_owned(),
        Some(whole) => format!("{name}^{whole}"),
        None => format!("{name}^({exponent})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_read_as_they_are_written() {
        let write =
            |factors: &[(&str, i32)]| product(factors.iter().map(|&(n, e)| (n, Rational::integer(e))));
        assert_eq!(write(&[]), "1");
        assert_eq!(write(&[("a", 1), ("b", 2), ("c", 0)]), "a*b^2");
        assert_eq!(write(&[("a", -2)]), "1/a^2");
        assert_eq!(write(&[("a", 1), ("b", -1), ("c", -3)]), "a/(b*c^3)");
        assert_eq!(product(Rational::new(-1, 2).map(|half| ("a", half))), "1/a^(1/2)");
    }
}
