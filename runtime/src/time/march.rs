//! Marching: accepted steps one after another, each predicted from the last ones, solved, and judged.

use super::control::{Control, Verdict, milne_factor};
use super::history::{History, blend, interpolation_weights};
use super::integrator::{Point, Tableau, advance, tableau};
use super::magnitude::Magnitudes;
use super::{Group, ImplicitSystem, Stage};
use crate::error::SolveError;
use crate::generated::{Integrator, Solve};
use crate::system::Transfer;

/// Part of the largest step over which the rates at a start are measured.
const TRIAL: f64 = 1e-3;

/// A step that was solved and found accurate enough, not yet taken.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// Its end.
    pub end: Point,
    /// Its size.
    pub size: f64,
    /// Newton iterations of the attempt that succeeded.
    pub iterations: usize,
}

/// What a march took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Accepted steps.
    pub accepted: usize,
    /// Attempts that did not converge or were not accurate enough, and steps cut short by events.
    pub rejected: usize,
    /// Newton iterations of all attempts.
    pub iterations: usize,
}

/// Marches one system through time.
pub struct March {
    method: &'static Tableau,
    control: Control,
    magnitudes: Magnitudes,
    history: History,
    settings: Solve,
    statistics: Statistics,
}

impl March {
    /// Starts at `time` with consistent unknowns `y`. The rates there come from one tiny step of backward Euler.
    pub fn new(
        system: &mut dyn ImplicitSystem,
        settings: Solve,
        time: f64,
        y: Vec<f64>,
    ) -> Result<Self, SolveError> {
        let mut control = Control::new(settings.min_step, settings.max_step, settings.step_tolerance);
        let mut magnitudes = Magnitudes::new(system.groups(), settings.min_step, settings.max_step);
        let mut statistics = Statistics::default();
        let start = with_rates(system, settings, time, y, &mut statistics.iterations)?;
        magnitudes.see(&start.values);
        control.restart(magnitudes.time_scale(&start.rates));
        let method = tableau(settings.integrator);
        Ok(Self { method, control, magnitudes, history: History::new(start), settings, statistics })
    }

    /// Starts a new smooth stretch, as after a jump.
    pub fn restart(
        &mut self,
        system: &mut dyn ImplicitSystem,
        time: f64,
        y: Vec<f64>,
    ) -> Result<(), SolveError> {
        let start = with_rates(system, self.settings, time, y, &mut self.statistics.iterations)?;
        self.magnitudes.see(&start.values);
        self.control.restart(self.magnitudes.time_scale(&start.rates));
        self.history = History::new(start);
        Ok(())
    }

    /// Gives all unknowns new numbers.
    pub fn carry(&mut self, transfer: &Transfer, groups: Vec<Group>) {
        self.history.carry(transfer);
        self.magnitudes.renumber(groups);
    }

    /// The last accepted point, or the start.
    pub fn last(&self) -> &Point {
        self.history.last()
    }

    /// Solves the next step, at most to `limit`, in smaller and smaller sizes until it converges and is accurate. The error of the smallest size
    /// comes back with the time reached and that size.
    pub fn propose(&mut self, system: &mut dyn ImplicitSystem, limit: f64) -> Result<Proposal, SolveError> {
        let mut size = self.control.next(limit - self.last().time);
        loop {
            size = match self.attempt(system, size, limit) {
                Ok((proposal, error)) => match self.control.judge(size, error, self.method.order + 1) {
                    Verdict::Accept => return Ok(proposal),
                    Verdict::Retry(smaller) => smaller,
                },
                Err(error) => match self.control.halve(size) {
                    Some(half) => half,
                    None => return Err(SolveError { time: self.last().time, step: size, ..error }),
                },
            }
        }
    }

    /// Solves the step that ends at `time`, whatever its error.
    pub fn propose_until(
        &mut self,
        system: &mut dyn ImplicitSystem,
        time: f64,
    ) -> Result<Proposal, SolveError> {
        self.attempt(system, time - self.last().time, time).map(|(proposal, _)| proposal)
    }

    /// A step with its relative error. The first step after a start has too few points before it for an estimate:
    /// its size alone must make it accurate enough.
    fn attempt(
        &mut self,
        system: &mut dyn ImplicitSystem,
        size: f64,
        limit: f64,
    ) -> Result<(Proposal, f64), SolveError> {
        let mut iterations = 0;
        let predict = |time: f64| self.history.extrapolate(time, self.method.order);
        let end = advance(self.method, system, self.last(), size, predict, &mut iterations);
        self.statistics.rejected += 1;
        self.statistics.iterations += iterations;
        let mut end = end?;
        if (end.time - limit).abs() < 1e-9 * size {
            end.time = limit;
        }
        let order = self.method.order;
        let (degree, remainder) = self.history.remainder(end.time, order);
        let error = if degree < order {
            0.0
        } else {
            let predicted = self.history.extrapolate(end.time, order);
            milne_factor(self.method, remainder, size)
                * self.magnitudes.relative_error(&end, size, &predicted)
        };
        Ok((Proposal { end, size, iterations }, error))
    }

    /// Takes a proposed step.
    pub fn accept(&mut self, proposal: Proposal) {
        self.statistics.accepted += 1;
        self.statistics.rejected -= 1;
        self.magnitudes.see(&proposal.end.values);
        self.history.push(proposal.end);
    }

    /// What it took so far.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// Unknowns and rates at a time inside a proposed step, interpolated between its end and the last accepted points.
    pub fn interpolate(&self, proposal: &Proposal, time: f64) -> Point {
        let points = self.history.points();
        let recent = &points[points.len().saturating_sub(2)..];
        let window: Vec<&Point> = recent.iter().chain([&proposal.end]).collect();
        let times: Vec<f64> = window.iter().map(|p| p.time).collect();
        let weights = interpolation_weights(&times, time);
        Point {
            time,
            values: blend(&weights, window.iter().map(|p| p.values.as_slice())),
            rates: blend(&weights, window.iter().map(|p| p.rates.as_slice())),
        }
    }
}

/// A start with its rates, measured by a tiny step, and algebraic unknowns that belong to it.
fn with_rates(
    system: &mut dyn ImplicitSystem,
    settings: Solve,
    time: f64,
    mut values: Vec<f64>,
    iterations: &mut usize,
) -> Result<Point, SolveError> {
    let mut size = (TRIAL * settings.max_step).max(settings.min_step);
    make_consistent(system, time, size, &mut values, iterations);
    let start = Point { time, rates: vec![0.0; values.len()], values };
    let euler = tableau(Integrator::BackwardEuler);
    loop {
        match advance(euler, system, &start, size, |_| start.values.clone(), iterations) {
            Ok(end) => return Ok(Point { rates: end.rates, ..start }),
            Err(error) if 0.5 * size <= settings.min_step => {
                return Err(SolveError { time, step: size, ..error });
            }
            Err(_) => size *= 0.5,
        }
    }
}

/// Solves for what follows from the other unknowns at a start, these as they are there up to what changes in a step of `size`. Where that fails all
/// stay as they are: the first step is a shorter way to a solution, or tells what is wrong.
fn make_consistent(
    system: &mut dyn ImplicitSystem,
    time: f64,
    size: f64,
    values: &mut Vec<f64>,
    iterations: &mut usize,
) {
    let algebraic = system.algebraic();
    if algebraic.is_empty() {
        return;
    }
    let mut solved = values.clone();
    match system.solve_stage(&Stage { time, alpha: 1.0 / size, base: values }, &mut solved) {
        Ok(taken) => *iterations += taken,
        Err(error) => {
            *iterations += error.iterations;
            return;
        }
    }
    let mut consistent = values.clone();
    algebraic.into_iter().for_each(|range| consistent[range.clone()].copy_from_slice(&solved[range]));
    if system.set_states(time, &mut consistent, &[]).is_ok() {
        *values = consistent;
    }
}
