//! Step control: how large the error of a step was, whether that is acceptable, and how large the next one should be.
//!
//! The error is measured against the extrapolation of the last points (Milne's device): the extrapolation misses P y^(p+1), the method
//! C h^(p+1) y^(p+1), so their difference times C h^(p+1) / (P + C h^(p+1)) estimates the error of the method. It is taken relative to the largest
//! magnitude that each kind of unknowns has shown so far.

use super::Group;
use super::integrator::Tableau;

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

/// Largest magnitude of each kind of unknowns so far.
#[derive(Clone, Debug)]
pub struct Magnitudes {
    groups: Vec<Group>,
    largest: Vec<f64>,
}

impl Magnitudes {
    /// Nothing seen yet.
    pub fn new(groups: Vec<Group>) -> Self {
        Self { largest: vec![0.0; groups.len()], groups }
    }

    /// Takes account of y.
    pub fn see(&mut self, y: &[f64]) {
        for (group, largest) in self.groups.iter().zip(&mut self.largest) {
            *largest = y[group.range.clone()].iter().fold(*largest, |m, x| m.max(x.abs()));
        }
    }

    /// Root mean square of the difference of `a` and `b`, relative to the magnitudes (`a` included), of the worst tested kind.
    pub fn relative_difference(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut seen = self.clone();
        seen.see(a);
        let relative = |(group, largest): (&Group, &f64)| {
            let range = group.range.clone();
            let sum: f64 = a[range.clone()].iter().zip(&b[range.clone()]).map(|(a, b)| (a - b).powi(2)).sum();
            let mean = (sum / range.len().max(1) as f64).sqrt();
            if *largest > 0.0 { mean / largest } else { 0.0 }
        };
        let tested = seen.groups.iter().zip(&seen.largest).filter(|(group, _)| group.tested);
        tested.map(relative).fold(0.0, f64::max)
    }

    /// Time over which the fastest tested kind changes by its whole magnitude at these rates; infinite if nothing changes or everything is zero.
    pub fn time_scale(&self, rates: &[f64]) -> f64 {
        let fastest = |(group, largest): (&Group, &f64)| {
            let range = group.range.clone();
            let sum: f64 = rates[range.clone()].iter().map(|x| x * x).sum();
            let mean = (sum / range.len().max(1) as f64).sqrt();
            if *largest > 0.0 && mean > 0.0 { largest / mean } else { f64::INFINITY }
        };
        let tested = self.groups.iter().zip(&self.largest).filter(|(group, _)| group.tested);
        tested.map(fastest).fold(f64::INFINITY, f64::min)
    }
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
    /// its magnitude. `time_scale` is that of [`Magnitudes::time_scale`].
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

    #[test]
    fn each_kind_is_measured_by_its_own_magnitude() {
        let group = |range, tested| Group { range, tested };
        let mut seen = Magnitudes::new(vec![group(0..2, true), group(2..3, true), group(3..4, false)]);
        seen.see(&[1000.0, 0.0, 0.1, 1.0]);
        let worst = seen.relative_difference(&[900.0, 0.0, 0.05, 9.0], &[901.0, 1.0, 0.06, 0.0]);
        assert!((worst - 0.1).abs() < 1e-12);
    }

    #[test]
    fn a_kind_that_stays_zero_does_not_count() {
        let seen = Magnitudes::new(vec![Group { range: 0..1, tested: true }]);
        assert_eq!(seen.relative_difference(&[0.0], &[0.0]), 0.0);
        assert_eq!(seen.time_scale(&[1.0]), f64::INFINITY);
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
