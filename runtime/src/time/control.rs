//! Step control: how large the error of a step was, whether that is acceptable, and how large the next one should be.
//!
//! The error is measured against the extrapolation of the last points (Milne's device): the extrapolation misses P y^(p+1), the method
//! C h^(p+1) y^(p+1), so their difference times C h^(p+1) / (P + C h^(p+1)) estimates the error of the method. It is taken relative to the
//! [magnitude](super::magnitude) of each kind of unknowns.

use super::integrator::Tableau;
use crate::generated::Solve;

/// Largest step of a model that names none, as a part of its time span.
const LARGEST: f64 = 1.0 / 50.0;
/// Smallest step of a model that names none, as a part of its largest.
const SMALLEST: f64 = 1e-6;
/// First step after a start, as a part of the largest.
const START: f64 = 0.02;
/// Part of the step that the error would allow.
const SAFETY: f64 = 0.9;
/// A step grows by at most this factor.
const MOST_GROWTH: f64 = 2.0;
/// A rejected step shrinks at least to, and at most by, these factors.
const SHRINK: (f64, f64) = (0.1, 0.7);
/// Exponents of the PI controller (Gustafsson 1991), over the order of the error.
const PI: (f64, f64) = (0.7, 0.4);

/// Settings with bounds of the step where the model names none (they are zero or infinite): a fiftieth of the time span, and a millionth of the
/// largest step. A smallest step above the largest gives way, unless it alone is named.
pub fn with_step_bounds(settings: Solve) -> Solve {
    let Some((start, end)) = settings.time else { return settings };
    let named = |size: f64| (size > 0.0 && size.is_finite()).then_some(size);
    let smallest = named(settings.min_step);
    let max_step = named(settings.max_step).unwrap_or((LARGEST * (end - start)).max(smallest.unwrap_or(0.0)));
    let min_step = smallest.unwrap_or(SMALLEST * max_step).min(max_step);
    Solve { max_step, min_step, ..settings }
}

/// Part of the difference between solution and extrapolation that is the error of the method; `remainder` is the factor P of an extrapolation of
/// the method's order.
pub fn milne_factor(method: &Tableau, remainder: f64, size: f64) -> f64 {
    let missed = method.error_constant * size.powi(method.order as i32 + 1);
    missed / (remainder + missed)
}

/// What becomes of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It is accepted.
    Accept,
    /// It is tried again with this size.
    Retry(f64),
}

/// Chooses step sizes between `smallest` and `largest`.
#[derive(Clone, Debug)]
pub struct Control {
    smallest: f64,
    largest: f64,
    tolerance: f64,
    size: f64,
    /// Error of the last accepted step over the tolerance.
    previous: f64,
    /// The last attempt failed: the next step does not grow.
    careful: bool,
}

impl Control {
    /// Sizes between `smallest` and `largest`, errors (relative) up to `tolerance`.
    pub fn new(smallest: f64, largest: f64, tolerance: f64) -> Self {
        Self { smallest, largest, tolerance, size: largest, previous: 1.0, careful: false }
    }

    /// Size for the first step after a start or a jump: a fiftieth of the largest, and no unknown should change by more than sqrt(tolerance) of
    /// its magnitude. `time_scale` is that of [`time_scale`](super::magnitude::Magnitudes::time_scale).
    pub fn restart(&mut self, time_scale: f64) {
        let size = (START * self.largest).min(self.tolerance.sqrt() * time_scale);
        self.size = size.clamp(self.smallest, self.largest);
        (self.previous, self.careful) = (1.0, false);
    }

    /// Size of the next step if `remaining` time is left: it ends exactly there or leaves at least half a step for another one.
    pub fn next(&self, remaining: f64) -> f64 {
        if remaining <= self.size * (1.0 + 1e-9) {
            remaining
        } else if remaining < 2.0 * self.size {
            0.5 * remaining
        } else {
            self.size
        }
    }

    /// Judges a step of `size` with relative `error` from an estimate of order `order` (error ~ size^order). A step at the smallest size is always
    /// accepted: no smaller one would follow a jump of the solution more closely.
    pub fn judge(&mut self, size: f64, error: f64, order: usize) -> Verdict {
        let ratio = (error / self.tolerance).max(1e-10);
        let order = order as f64;
        if ratio > 1.0 && size > self.smallest {
            self.careful = true;
            let factor = (SAFETY * ratio.powf(-1.0 / order)).clamp(SHRINK.0, SHRINK.1);
            self.size = (factor * size).max(self.smallest);
            return Verdict::Retry(self.size);
        }
        let factor = SAFETY * ratio.powf(-PI.0 / order) * self.previous.powf(PI.1 / order);
        let growth = if self.careful { 1.0 } else { MOST_GROWTH };
        let proposed = size * factor.clamp(SHRINK.0, growth);
        let shortened = size < self.size * (1.0 - 1e-9);
        self.size =
            if shortened { proposed.max(self.size) } else { proposed }.clamp(self.smallest, self.largest);
        (self.previous, self.careful) = (ratio.max(1e-4), false);
        Verdict::Accept
    }

    /// Half the size after a failed solve; `None` below the smallest size.
    pub fn halve(&mut self, size: f64) -> Option<f64> {
        self.careful = true;
        self.size = 0.5 * size;
        (self.size >= self.smallest).then_some(self.size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generated::Integrator;

    fn bounds(max_step: f64, min_step: f64) -> (f64, f64) {
        let settings = Solve {
            time: Some((50.0, 250.0)),
            integrator: Integrator::Sdirk2,
            max_step,
            min_step,
            step_tolerance: 1e-4,
            newton_tolerance: 1e-8,
            newton_iterations: 10,
        };
        let Solve { max_step, min_step, .. } = with_step_bounds(settings);
        (max_step, min_step)
    }

    #[test]
    fn bounds_that_are_not_named_follow_from_the_span() {
        assert_eq!(bounds(f64::INFINITY, 0.0), (4.0, 4e-6));
        assert_eq!(bounds(0.5, 0.0), (0.5, 5e-7));
        assert_eq!(bounds(f64::INFINITY, 0.25), (4.0, 0.25));
        assert_eq!(bounds(0.5, 0.25), (0.5, 0.25));
    }

    #[test]
    fn bounds_never_cross() {
        assert_eq!(bounds(f64::INFINITY, 10.0), (10.0, 10.0));
        assert_eq!(bounds(0.5, 10.0), (0.5, 0.5));
    }

    #[test]
    fn steps_shrink_on_error_grow_slowly_and_stay_in_range() {
        let mut control = Control::new(1e-3, 1.0, 1e-4);
        control.restart(10.0);
        assert_eq!(control.next(100.0), 0.02);
        assert_eq!(control.judge(0.02, 8e-4, 3), Verdict::Retry(0.9 * 0.02 / 2.0));
        assert_eq!(control.judge(0.009, 1e-9, 3), Verdict::Accept);
        assert_eq!(control.next(100.0), 0.009, "no growth right after a rejection");
        assert_eq!(control.judge(0.009, 0.0, 3), Verdict::Accept);
        assert_eq!(control.next(100.0), 0.018, "at most twice as large");
        for _ in 0..20 {
            let size = control.next(100.0);
            assert_eq!(control.judge(size, 0.0, 3), Verdict::Accept);
        }
        assert_eq!(control.next(100.0), 1.0);
        assert_eq!(control.judge(1e-3, 1.0, 3), Verdict::Accept, "the smallest step is never rejected");
    }

    #[test]
    fn the_last_steps_share_what_remains() {
        let control = Control::new(1e-6, 1.0, 1e-4);
        assert_eq!(control.next(3.0), 1.0);
        assert_eq!(control.next(1.2), 0.6);
        assert_eq!(control.next(0.6), 0.6);
    }

    #[test]
    fn a_step_cut_short_by_the_end_does_not_slow_the_next() {
        let mut control = Control::new(1e-6, 1.0, 1e-4);
        assert_eq!(control.judge(0.01, 1e-9, 3), Verdict::Accept);
        assert_eq!(control.next(100.0), 1.0);
    }

    #[test]
    fn halving_gives_up_below_the_smallest_size() {
        let mut control = Control::new(0.3, 1.0, 1e-4);
        assert_eq!(control.halve(1.0), Some(0.5));
        assert_eq!(control.halve(0.5), None);
    }
}
