//! Stationary solutions and the first of those in time, step by step, where Newton's method does not reach them at once.
//!
//! The fields' start is in equilibrium with what is applied there; the rest, held values and loads alike, is brought up from there:
//! held values go from the start's to the wanted ones, and of the residual that the start leaves a falling part is taken away. Where the
//! start is zero, these are the loads, and everything grows in proportion.

use super::System;
use super::newton::{NewtonReport, StageProblem};
use crate::error::SolveError;

/// First step of the ramp.
const FIRST: f64 = 0.25;
/// Smallest step before the ramp is given up.
const SMALLEST: f64 = 1.0 / 1024.0;
/// Newton iterations after which a shorter step is better, unless they converge.
const PATIENCE: usize = 8;
/// Relative residual to which points on the way are solved.
const ROUGH: f64 = 1e-3;

/// What is applied so far.
#[derive(Clone, Debug)]
pub(super) struct Ramp {
    /// Part of it, from 0 to 1.
    part: f64,
    /// Unknowns at the start.
    start: Vec<f64>,
    /// Residual of all unknowns there.
    residual: Vec<f64>,
}

impl Ramp {
    /// The value of a held unknown on the way to `wanted`.
    pub(super) fn held(&self, unknown: usize, wanted: f64) -> f64 {
        self.start[unknown] + self.part * (wanted - self.start[unknown])
    }
}

impl System {
    /// Solves a stationary problem from the guess `y`: at once, or else along a ramp from the fields' start.
    ///
    /// # Errors
    /// That of a long attempt to solve it at once, if the ramp does not lead to a solution either.
    pub fn solve_stationary(
        &mut self,
        problem: &StageProblem<'_>,
        y: &mut [f64],
    ) -> Result<NewtonReport, SolveError> {
        let tolerance = self.settings.newton_tolerance;
        let report = match self.try_stage(problem, y, tolerance) {
            Ok(report) => report,
            Err(at_once) => match self.solve_ramped(problem, y) {
                Some(report) => NewtonReport { iterations: report.iterations + at_once.iterations, ..report },
                None => self.solve_stage(problem, y)?,
            },
        };
        self.settle_levels(problem, y)?;
        Ok(report)
    }

    /// Solves a stage to a tolerance with little patience; leaves `y` alone where that fails.
    fn try_stage(
        &mut self,
        problem: &StageProblem<'_>,
        y: &mut [f64],
        tolerance: f64,
    ) -> Result<NewtonReport, SolveError> {
        let settings = self.settings;
        self.settings.newton_iterations = settings.newton_iterations.min(PATIENCE);
        self.settings.newton_tolerance = tolerance;
        let solved = self.solve_stage(problem, y);
        self.settings = settings;
        solved
    }

    /// Goes along a ramp from the fields' start; nothing, and `y` as it was, if there is no way.
    fn solve_ramped(&mut self, problem: &StageProblem<'_>, y: &mut [f64]) -> Option<NewtonReport> {
        let (mut reached, stable_pivots) = (y.to_vec(), self.stable_pivots);
        self.begin_ramp(problem, &mut reached);
        let report = self.climb(problem, &mut reached);
        self.ramp = None;
        match report {
            Some(_) => y.copy_from_slice(&reached),
            None => self.stable_pivots = stable_pivots,
        }
        report
    }

    /// Solves one stage in time from the prediction `y`; the first one along a ramp where Newton's method does not reach it at once, because loads
    /// are there from the start.
    ///
    /// # Errors
    /// As [`Self::solve_stage`], and a free level that nothing can fix.
    pub fn solve_instant(
        &mut self,
        problem: &StageProblem<'_>,
        y: &mut [f64],
    ) -> Result<NewtonReport, SolveError> {
        let first = self.stable_pivots.is_none();
        let report = match self.solve_stage(problem, y) {
            Err(at_once) if first => self.solve_ramped(problem, y).ok_or(at_once)?,
            other => other?,
        };
        self.settle_levels(problem, y)?;
        Ok(report)
    }

    /// Puts `y` at the start of the ramp.
    fn begin_ramp(&mut self, problem: &StageProblem<'_>, y: &mut [f64]) {
        self.start_fields(y);
        let mut rates = vec![0.0; y.len()];
        // Where the states have no solution the first step of the ramp fails, which gives it up.
        let _ = self.settle(problem, y, &mut rates);
        let residual = self.unknown_residual(y, &rates, problem.alpha, None);
        self.ramp = Some(Ramp { part: 0.0, start: y.to_vec(), residual });
    }

    /// Goes up the ramp in steps that grow where they are easy and shrink where they fail; nothing if even the smallest fail.
    fn climb(&mut self, problem: &StageProblem<'_>, y: &mut [f64]) -> Option<NewtonReport> {
        let (mut reached, mut step, mut iterations) = (0.0, FIRST, 0);
        loop {
            let part = f64::min(reached + step, 1.0);
            self.ramp.as_mut()?.part = part;
            let wanted = self.settings.newton_tolerance;
            let tolerance = if part < 1.0 { wanted.max(ROUGH) } else { wanted };
            match self.try_stage(problem, y, tolerance) {
                Ok(report) => {
                    iterations += report.iterations;
                    (reached, step) = (part, 2.0 * step);
                    if reached >= 1.0 {
                        return Some(NewtonReport { iterations, ..report });
                    }
                }
                Err(error) => {
                    iterations += error.iterations;
                    step *= 0.5;
                    if step < SMALLEST {
                        return None;
                    }
                }
            }
        }
    }

    /// Takes away what the start of a ramp leaves and is not applied yet.
    pub(super) fn take_ramp_away(&self, residual: &mut [f64]) {
        if let Some(ramp) = &self.ramp {
            residual.iter_mut().zip(&ramp.residual).for_each(|(r, start)| *r -= (1.0 - ramp.part) * start);
        }
    }
}
