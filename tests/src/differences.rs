//! Derivatives by central differences of fourth order.

/// Points of the difference, in steps, and their weights.
const STENCIL: [(f64, f64); 4] =
    [(-2.0, 1.0 / 12.0), (-1.0, -8.0 / 12.0), (1.0, 8.0 / 12.0), (2.0, -1.0 / 12.0)];
/// Rounding errors that a value of the functions under test may carry, relative to it.
const ROUNDING: f64 = 1e-14;

/// A derivative found by differences, and how much of it may be rounding.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// The derivative.
    pub value: f64,
    /// Bound of what rounding contributes.
    pub rounding: f64,
}

/// Derivative of every result of `function` at 0, from its values at multiples of `step`.
///
/// Apart from rounding the error is about step^4/30 of the fifth derivative.
pub fn derivative(step: f64, mut function: impl FnMut(f64) -> Vec<f64>) -> Vec<Difference> {
    let mut sum = Vec::new();
    for (point, weight) in STENCIL {
        let values = function(point * step);
        sum.resize(values.len(), Difference { value: 0.0, rounding: 0.0 });
        for (s, value) in sum.iter_mut().zip(values) {
            s.value += weight / step * value;
            s.rounding += (weight / step * value).abs() * ROUNDING;
        }
    }
    sum
}

/// Asserts that derivatives agree with differences: to `tolerance` of the largest of them, and rounding.
///
/// # Panics
/// If they do not; the message names `what` and the entry.
#[track_caller]
pub fn assert_agree(what: &str, exact: &[f64], differences: &[Difference], tolerance: f64) {
    assert_eq!(exact.len(), differences.len(), "{what}");
    let scale = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (k, (found, by)) in exact.iter().zip(differences).enumerate() {
        let close = (found - by.value).abs() <= tolerance * scale + by.rounding;
        assert!(close, "{what}: entry {k} is {found:e}, differences say {by:?}, the largest is {scale:e}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_four_are_exact() {
        let found = derivative(0.1, |h| vec![(1.0 + h).powi(4), 3.0]);
        assert_agree("x^4 and a constant", &[4.0, 0.0], &found, 0.0);
    }

    #[test]
    #[should_panic(expected = "entry 0")]
    fn a_wrong_derivative_is_seen() {
        assert_agree("x", &[1.0 + 1e-7], &derivative(0.1, |h| vec![h]), 1e-8);
    }
}
