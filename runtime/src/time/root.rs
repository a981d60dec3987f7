//! Root of a function between two points of opposite sign.

/// Most evaluations; the bisections among them alone divide the interval by 2^30.
const MOST: usize = 90;

/// The point in (`low`, `high`] at which `f` turns from not positive to positive, to within `tolerance`: `f` is positive there.
///
/// Regula falsi with the Illinois weight, and every third time a bisection, so conditions that jump are found as well. `f_low` and `f_high` are the
/// values at the ends; the first must not be positive, the second must.
pub fn turning_point(
    (mut low, mut high): (f64, f64),
    (mut f_low, mut f_high): (f64, f64),
    tolerance: f64,
    mut f: impl FnMut(f64) -> f64,
) -> f64 {
    let mut last_positive = None;
    for k in 1..=MOST {
        if high - low <= tolerance {
            break;
        }
        let secant = low + (high - low) * (f_low / (f_low - f_high));
        let bisect = k % 3 == 0 || !secant.is_finite();
        // Half a tolerance from either end, so that a secant that has arrived closes the interval.
        let x = if bisect {
            0.5 * (low + high)
        } else {
            secant.clamp(low + 0.5 * tolerance, high - 0.5 * tolerance)
        };
        let value = f(x);
        let positive = value > 0.0;
        if positive {
            (high, f_high) = (x, value);
        } else {
            (low, f_low) = (x, value);
        }
        if last_positive == Some(positive) {
            *(if positive { &mut f_low } else { &mut f_high }) *= 0.5;
        }
        last_positive = Some(positive);
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(f: impl Fn(f64) -> f64, tolerance: f64) -> (f64, usize) {
        let mut count = 0;
        let ends = (f(0.0), f(1.0));
        let root = turning_point((0.0, 1.0), ends, tolerance, |x| {
            count += 1;
            f(x)
        });
        (root, count)
    }

    #[test]
    fn a_smooth_condition_takes_few_evaluations() {
        let (root, count) = found(|x| x * x - 0.3, 1e-9);
        assert!((root - 0.3f64.sqrt()).abs() <= 1e-9 && count <= 14, "{root} {count}");
    }

    #[test]
    fn a_jump_is_found_by_bisection() {
        for place in [0.003, 0.5, 0.7, 0.9999] {
            let (root, count) = found(|x| if x > place { 1.0 } else { -1e-3 }, 1e-6);
            assert!(root > place && root - place <= 1e-6 && count <= 60, "{root} {count}");
        }
    }

    #[test]
    fn the_result_is_on_the_positive_side() {
        let (root, _) = found(|x| (x - 0.25).powi(3), 1e-6);
        assert!(root > 0.25 && root <= 0.25 + 1e-6);
    }
}
