//! The last accepted points of one smooth stretch of the solution, and polynomials through them: extrapolation predicts the next step,
//! interpolation evaluates anything inside the last one.

use super::integrator::Point;
use crate::system::Transfer;

/// Up to three accepted points, newest last. A jump starts a new stretch: what was before says nothing about what comes.
#[derive(Clone, Debug)]
pub struct History {
    points: Vec<Point>,
    /// The oldest kept point starts the stretch: its rate is known from itself and counts as a second point at the same time.
    from_start: bool,
}

impl History {
    /// Starts a stretch.
    pub fn new(start: Point) -> Self {
        Self { points: vec![start], from_start: true }
    }

    /// Adds an accepted point.
    pub fn push(&mut self, point: Point) {
        self.points.push(point);
        if self.points.len() > 3 {
            self.points.remove(0);
            self.from_start = false;
        }
    }

    /// Gives all points new numbers.
    pub fn carry(&mut self, transfer: &Transfer) {
        for point in &mut self.points {
            point.values = transfer.apply(&point.values);
            point.rates = transfer.apply(&point.rates);
        }
    }

    /// The last point.
    pub fn last(&self) -> &Point {
        &self.points[self.points.len() - 1]
    }

    /// The points, oldest first.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Times of the newest points, newest first, the start of the stretch twice: at most `degree + 1`.
    fn nodes(&self, degree: usize) -> Vec<f64> {
        let doubled = self.from_start.then(|| self.points[0].time);
        self.points.iter().rev().map(|p| p.time).chain(doubled).take(degree + 1).collect()
    }

    /// Extrapolation by the polynomial of at most `degree` (1 or 2) through the newest points.
    pub fn extrapolate(&self, time: f64, degree: usize) -> Vec<f64> {
        let last = self.last();
        let nodes = self.nodes(degree);
        let after = time - last.time;
        let value = |i: usize| {
            let slope = self.slope(0, i);
            let [newest, middle, oldest] = nodes[..] else { return last.values[i] + after * slope };
            let curvature = (slope - self.slope(1, i)) / (newest - oldest);
            last.values[i] + after * (slope + (time - middle) * curvature)
        };
        (0..last.values.len()).map(value).collect()
    }

    /// First divided difference of unknown `i` over the interval that is `back` before the newest; the rate where the interval has no length.
    fn slope(&self, back: usize, i: usize) -> f64 {
        let newer = &self.points[self.points.len() - 1 - back];
        match self.points.len().checked_sub(2 + back) {
            Some(k) => (newer.values[i] - self.points[k].values[i]) / (newer.time - self.points[k].time),
            None => newer.rates[i],
        }
    }

    /// The factor of the error of [`History::extrapolate`]: the extrapolation misses P y^(p+1) with p the degree, P the product of the
    /// distances to the nodes over (p+1)!. Returns (p, P).
    pub fn remainder(&self, time: f64, degree: usize) -> (usize, f64) {
        let nodes = self.nodes(degree);
        let product = nodes.iter().enumerate().map(|(k, node)| (time - node) / (k + 1) as f64).product();
        (nodes.len().saturating_sub(1), product)
    }
}

/// Weights of the last two or three points (times `nodes`, ascending) in the interpolation at `time`: quadratic through three, linear
/// through two. They sum to 1 and are the same for every quantity, so a linear relation between quantities that holds at the points
/// holds in between.
pub fn interpolation_weights(nodes: &[f64], time: f64) -> Vec<f64> {
    let lagrange = |i: usize| {
        let others = (0..nodes.len()).filter(|&j| j != i);
        others.map(|j| (time - nodes[j]) / (nodes[i] - nodes[j])).product()
    };
    (0..nodes.len()).map(lagrange).collect()
}

/// Sum of rows with weights.
pub fn blend<'a>(weights: &[f64], rows: impl IntoIterator<Item = &'a [f64]>) -> Vec<f64> {
    let mut sum = Vec::new();
    for (weight, row) in weights.iter().zip(rows) {
        sum.resize(row.len(), 0.0);
        sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += weight * x);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(time: f64, f: impl Fn(f64) -> f64, rate: f64) -> Point {
        Point { time, values: vec![f(time)], rates: vec![rate] }
    }

    #[test]
    fn extrapolation_of_a_parabola_is_exact_from_the_second_point_on() {
        let f = |t: f64| 1.0 + 2.0 * t - 3.0 * t * t;
        let mut history = History::new(point(0.0, f, 2.0));
        assert_eq!(history.extrapolate(0.5, 2), vec![2.0]);
        for t in [0.5, 0.7, 1.5] {
            history.push(point(t, f, f64::NAN));
            let error = history.extrapolate(2.0, 2)[0] - f(2.0);
            assert!(error.abs() < 1e-13, "{error}");
        }
    }

    #[test]
    fn the_remainder_is_the_error_of_the_extrapolation() {
        let cube = |t: f64| t.powi(3);
        let mut history = History::new(point(0.5, cube, 0.75));
        for t in [0.8, 1.0, 1.3] {
            history.push(point(t, cube, f64::NAN));
            let (degree, factor) = history.remainder(1.7, 2);
            assert_eq!(degree, 2);
            let error = cube(1.7) - history.extrapolate(1.7, 2)[0];
            assert!((error - 6.0 * factor).abs() < 1e-12);
        }
    }

    #[test]
    fn weights_keep_linear_relations_and_meet_the_points() {
        let nodes = [0.3, 0.9, 1.0];
        let weights = interpolation_weights(&nodes, 0.95);
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!((blend(&weights, [&[0.3][..], &[0.9], &[1.0]])[0] - 0.95).abs() < 1e-15);
        assert_eq!(interpolation_weights(&nodes, 1.0), vec![0.0, 0.0, 1.0]);
    }
}
