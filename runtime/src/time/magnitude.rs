//! How large each kind of unknowns is: what errors and changes are measured against.
//!
//! The magnitude of a kind is the largest value it has shown. That says nothing in the step in which a kind begins to move from rest: against
//! values that were zero at its start any step is coarse, however small it is. In that step alone, the kind counts as large as it would
//! become in a largest step at the same pace.

use super::Group;
use super::integrator::Point;

/// Magnitudes of all kinds so far.
#[derive(Clone, Debug)]
pub struct Magnitudes {
    kinds: Vec<Kind>,
    smallest_step: f64,
    largest_step: f64,
}

#[derive(Clone, Debug)]
struct Kind {
    group: Group,
    /// Largest value so far.
    largest: f64,
}

impl Kind {
    fn largest(&self, y: &[f64]) -> f64 {
        y[self.group.range.clone()].iter().fold(0.0, |m, x| m.max(x.abs()))
    }

    /// Root mean square of the difference of `a` and `b`.
    fn mean_difference(&self, a: &[f64], b: &[f64]) -> f64 {
        let range = self.group.range.clone();
        let sum: f64 = a[range.clone()].iter().zip(&b[range.clone()]).map(|(a, b)| (a - b).powi(2)).sum();
        (sum / range.len().max(1) as f64).sqrt()
    }
}

impl Magnitudes {
    /// Nothing seen yet; steps lie between `smallest_step` and `largest_step`.
    pub fn new(groups: Vec<Group>, smallest_step: f64, largest_step: f64) -> Self {
        let kind = |group| Kind { group, largest: 0.0 };
        Self { kinds: groups.into_iter().map(kind).collect(), smallest_step, largest_step }
    }

    /// Gives the kinds new places.
    pub fn renumber(&mut self, groups: Vec<Group>) {
        self.kinds.iter_mut().zip(groups).for_each(|(kind, group)| kind.group = group);
    }

    /// Takes account of y.
    pub fn see(&mut self, y: &[f64]) {
        for kind in &mut self.kinds {
            kind.largest = kind.largest.max(kind.largest(y));
        }
    }

    /// A kind counts as at rest if a rate would outgrow its largest value so far within the smallest step.
    fn at_rest(&self, kind: &Kind, rates: &[f64]) -> bool {
        kind.largest <= kind.largest(rates) * self.smallest_step
    }

    /// Magnitude at the end of a step of `size`.
    fn magnitude(&self, kind: &Kind, end: &Point, size: f64) -> f64 {
        let pace = if self.at_rest(kind, &end.rates) { self.largest_step / size } else { 1.0 };
        kind.largest.max(pace.max(1.0) * kind.largest(&end.values))
    }

    /// Root mean square of the difference of the end of a step of `size` from its prediction, relative to the magnitude, of the worst tested kind.
    pub fn relative_error(&self, end: &Point, size: f64, predicted: &[f64]) -> f64 {
        let relative = |kind: &Kind| {
            let magnitude = self.magnitude(kind, end, size);
            if magnitude > 0.0 { kind.mean_difference(&end.values, predicted) / magnitude } else { 0.0 }
        };
        self.kinds.iter().filter(|kind| kind.group.tested).map(relative).fold(0.0, f64::max)
    }

    /// Time over which the fastest tested kind changes by its largest value at these rates; infinite if nothing moves, or only what is at rest.
    pub fn time_scale(&self, rates: &[f64]) -> f64 {
        let moving = self.kinds.iter().filter(|kind| kind.group.tested && !self.at_rest(kind, rates));
        let zero = vec![0.0; rates.len()];
        moving.map(|kind| kind.largest / kind.mean_difference(rates, &zero)).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(range: std::ops::Range<usize>, tested: bool) -> Group {
        Group { range, tested }
    }

    fn point(values: &[f64], rates: &[f64]) -> Point {
        Point { time: 0.0, values: values.to_vec(), rates: rates.to_vec() }
    }

    #[test]
    fn each_kind_is_measured_by_its_own_magnitude() {
        let mut seen =
            Magnitudes::new(vec![group(0..2, true), group(2..3, true), group(3..4, false)], 1e-6, 1.0);
        seen.see(&[1000.0, 0.0, 0.1, 1.0]);
        let end = point(&[900.0, 0.0, 0.05, 9.0], &[0.0; 4]);
        let worst = seen.relative_error(&end, 1.0, &[901.0, 1.0, 0.06, 0.0]);
        assert!((worst - 0.1).abs() < 1e-12);
    }

    #[test]
    fn a_kind_that_stays_zero_does_not_count() {
        let seen = Magnitudes::new(vec![group(0..1, true)], 1e-6, 1.0);
        assert_eq!(seen.relative_error(&point(&[0.0], &[0.0]), 0.1, &[0.0]), 0.0);
        assert_eq!(seen.time_scale(&[1.0]), f64::INFINITY, "it has no time scale, however fast it starts");
    }

    #[test]
    fn what_begins_to_move_counts_by_what_it_would_become_in_a_largest_step() {
        let mut seen = Magnitudes::new(vec![group(0..1, true)], 1e-6, 1.0);
        let (noise, end) = (1e-17, point(&[0.02], &[0.1]));
        seen.see(&[noise]);
        assert!((seen.relative_error(&end, 0.25, &[0.0]) - 0.25).abs() < 1e-12);
        seen.see(&end.values);
        assert!((seen.relative_error(&end, 0.25, &[0.01]) - 0.5).abs() < 1e-12, "from then on by itself");
    }
}
