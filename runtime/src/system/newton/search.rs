//! How far Newton's method goes along its direction: as far as the work along it falls, or by the natural monotonicity test.
//!
//! The test is for stationary problems without an energy, such as flows, which have to be reached from wherever their start is. In time, a stage starts near
//! its solution; steps that the test would shorten often lead there in fewer iterations, and where they do not, a shorter step in time does.

use super::{Cause, Iterate, Progress, StageProblem, System, dot, norm};

/// Most halvings of a step of the line search.
const HALVINGS: usize = 8;
/// The line search accepts a step when |du . R| falls below this part of its start.
const DECREASE: f64 = 0.9;
/// A full step that leaves less than this part of the residual is not tested.
const UNTESTED: f64 = 0.05;
/// Shortest damped step that is taken.
const SHORTEST: f64 = 1.0 / 256.0;
/// A damped step is lengthened where the estimate of the best length is so many times its own.
const TIMID: f64 = 4.0;

/// What a damped step tells about the next one.
pub(super) struct Damped {
    /// Part of the direction that was taken.
    length: f64,
    /// Size of the direction.
    size: f64,
    /// The direction that the same factors give at its end.
    pub(super) correction: Vec<f64>,
    /// Size of the correction against that of the direction.
    pub(super) contraction: f64,
}

/// Size of a direction in which each field counts relative to its values.
struct Relative<'a> {
    system: &'a System,
    /// Size of the values of each field and of their change.
    scales: &'a [f64],
}

impl Relative<'_> {
    fn size(&self, direction: &[f64]) -> f64 {
        let sizes = self.system.field_norms(direction);
        let known = sizes.iter().zip(self.scales).filter(|(_, scale)| **scale > 0.0);
        known.map(|(size, scale)| (size / scale).powi(2)).sum::<f64>().sqrt()
    }

    /// Size of `a - factor * b`.
    fn distance(&self, a: &[f64], factor: f64, b: &[f64]) -> f64 {
        let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - factor * b).collect();
        self.size(&difference)
    }
}

impl System {
    /// Goes along the direction as far as it leads towards a solution; `slope` is du . R. The part of the way, and what is there.
    pub(super) fn search(
        &mut self,
        problem: &StageProblem<'_>,
        progress: &mut Progress,
        direction: &[f64],
        slope: f64,
    ) -> Result<(f64, Iterate), Cause> {
        let stationary = problem.alpha == 0.0;
        if stationary && !self.is_symmetric() {
            return self.search_naturally(problem, progress, direction);
        }
        self.search_by_work(problem, &progress.current, direction, slope)
    }

    /// Goes along the direction as far as |du . R| falls from its start, `slope`. A symmetric tangent is that of an energy with the slope du . R: going
    /// down it, the energy falls as long as that is negative, and only going past its minimum is going too far.
    fn search_by_work(
        &mut self,
        problem: &StageProblem<'_>,
        current: &Iterate,
        direction: &[f64],
        slope: f64,
    ) -> Result<(f64, Iterate), Cause> {
        let downhill = self.is_symmetric() && slope < 0.0;
        let mut length = 1.0;
        let mut best: Option<(f64, (f64, Iterate))> = None;
        let mut cause = Cause::NotFinite;
        for _ in 0..=HALVINGS {
            match self.evaluate(problem, self.along(&current.y, direction, length)) {
                Ok(trial) => {
                    let work = dot(direction, &trial.residual);
                    let work = if downhill { work } else { work.abs() };
                    let smaller = norm(&trial.residual) <= norm(&current.residual) * 1e-3;
                    if work <= DECREASE * slope.abs() || smaller {
                        return Ok((length, trial));
                    }
                    if best.as_ref().is_none_or(|(least, _)| work < *least) {
                        best = Some((work, (length, trial)));
                    }
                }
                Err(reason) => cause = reason,
            }
            length *= 0.5;
        }
        best.map(|(_, reached)| reached).ok_or(cause)
    }

    /// Goes along the direction as far as the next direction that the same factors would give gets shorter: the natural monotonicity test of
    /// Deuflhard, *Newton Methods for Nonlinear Problems* (2011), algorithm NLEQ-ERR. Unlike the residual, that direction measures the
    /// distance to the solution, whatever the units of the equations. A full step that leaves little of the residual needs no test.
    fn search_naturally(
        &mut self,
        problem: &StageProblem<'_>,
        progress: &mut Progress,
        direction: &[f64],
    ) -> Result<(f64, Iterate), Cause> {
        let scales = self.scales_of_values(&progress.current.y, direction);
        let size = self.relative(&scales).size(direction);
        let mut length = self.first_length(progress.damped.take(), direction, &scales);
        let mut shortened = false;
        loop {
            let next = match self.evaluate(problem, self.along(&progress.current.y, direction, length)) {
                Ok(trial) => {
                    let little = UNTESTED * norm(&progress.current.residual);
                    if length == 1.0 && norm(&trial.residual) <= little {
                        return Ok((length, trial));
                    }
                    let correction = self.solve_for(&trial.residual)?;
                    let relative = self.relative(&scales);
                    let contraction = relative.size(&correction) / size;
                    let curved = relative.distance(&correction, 1.0 - length, direction);
                    let best = 0.5 * size * length * length / curved;
                    let nearer = contraction <= 1.0 - 0.25 * length;
                    if nearer && !shortened && best.min(1.0) >= TIMID * length {
                        best.min(1.0)
                    } else if nearer || length <= SHORTEST {
                        progress.damped = Some(Damped { length, size, correction, contraction });
                        return Ok((length, trial));
                    } else {
                        shortened = true;
                        best.min(0.5 * length)
                    }
                }
                Err(reason) if length <= SHORTEST => return Err(reason),
                Err(_) => {
                    shortened = true;
                    0.5 * length
                }
            };
            length = next.max(SHORTEST);
        }
    }

    /// Length of a step that the last one suggests: where a whole step would be as far from the linear model as is allowed.
    fn first_length(&self, last: Option<Damped>, direction: &[f64], scales: &[f64]) -> f64 {
        let Some(Damped { length, size, correction, .. }) = last else { return 1.0 };
        let relative = self.relative(scales);
        let curved = relative.distance(&correction, 1.0, direction) * relative.size(direction);
        let best = length * size * relative.size(&correction) / curved;
        if best.is_finite() { best.clamp(SHORTEST, 1.0) } else { 1.0 }
    }

    fn relative<'a>(&'a self, scales: &'a [f64]) -> Relative<'a> {
        Relative { system: self, scales }
    }

    /// Size of the values of each field and of their change, at unknowns that have an equation.
    fn scales_of_values(&self, y: &[f64], direction: &[f64]) -> Vec<f64> {
        let values = self.field_norms(&self.restrict(y));
        values.iter().zip(self.field_norms(direction)).map(|(value, change)| value + change).collect()
    }
}
