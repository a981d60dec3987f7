//! Newton's method for one implicit stage of the time integrator.

mod search;

use super::System;
use super::balance::{Balance, norm};
use super::broyden::Broyden;
use super::contact::{Curvature, PairOn};
use crate::error::{Cause, SolveError};
use crate::solve::linear::{Definiteness, LinearError};
use search::Damped;
use std::ops::Range;

/// Factors are kept for a further step while each step leaves less than this part of the residual: five such steps take as long as new factors.
const CONTRACTION: f64 = 0.5;
/// A stage goes on beyond its iterations while each leaves less than this part of the residual.
const CONVERGING: f64 = 0.1;
/// How much stiffer the rates are made where the tangent has unstable modes, and how often at most.
const DAMPING: (f64, usize) = (4.0, 4);

/// One implicit stage: find y with F(t, y, alpha (y - base)) = 0.
#[derive(Clone, Copy, Debug)]
pub struct StageProblem<'a> {
    /// Time of the stage.
    pub time: f64,
    /// d rate / d value [1/time]; 0 for a stationary problem.
    pub alpha: f64,
    /// Base of the rates, all unknowns.
    pub base: &'a [f64],
}

impl StageProblem<'_> {
    /// Rates of a range of unknowns.
    pub fn rates(&self, y: &[f64], rates: &mut [f64], range: Range<usize>) {
        for i in range {
            rates[i] = self.alpha * (y[i] - self.base[i]);
        }
    }
}

/// How a stage was solved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NewtonReport {
    /// Iterations, one factorisation each.
    pub iterations: usize,
    /// Relative residual at the end.
    pub residual: f64,
    /// Unstable modes of the last tangent: its negative pivots beyond those of the first stage solved (which a saddle point problem has).
    pub unstable_modes: usize,
}

/// A point on the way: unknowns, rates and residual that belong together.
struct Iterate {
    y: Vec<f64>,
    rates: Vec<f64>,
    residual: Vec<f64>,
}

/// What is known of the present factors when they may serve the next stage too.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factored {
    alpha: f64,
    negative_pivots: usize,
}

/// How far a stage is.
struct Progress {
    current: Iterate,
    /// Size of the forces that balance in each field; a residual is small against it. That of the last stage until a second tangent is needed.
    scales: Vec<f64>,
    /// The last step made the residual so much smaller that the same factors will do again.
    keep_factors: bool,
    /// Residual of each field that rounding alone may leave, with the tangent of these factors; none before it is asked for.
    rounding: Option<Vec<f64>>,
    /// Steps taken with these factors.
    steps: Broyden,
    /// The last new tangent made the residual, or the direction, much smaller.
    converging: bool,
    /// Negative pivots of the last exact tangent.
    negative_pivots: usize,
    /// What the last step tells about the next, where it was damped or might have been.
    damped: Option<Damped>,
    report: NewtonReport,
}

impl System {
    /// Solves one stage; `y` is the prediction on entry and the solution on return. Where nothing can be evaluated at the prediction, the base of
    /// the rates is the start.
    pub fn solve_stage(
        &mut self,
        problem: &StageProblem<'_>,
        y: &mut [f64],
    ) -> Result<NewtonReport, SolveError> {
        let predicted = self.evaluate_held(problem, y);
        let current = match predicted.or_else(|_| self.evaluate_held(problem, problem.base)) {
            Ok(iterate) => iterate,
            Err(cause) => return Err(self.failure(problem, cause, &NewtonReport::default(), None)),
        };
        let mut progress = self.resume(problem, current);
        while progress.report.iterations < self.settings.newton_iterations || progress.converging {
            match self.iterate(problem, &mut progress) {
                Ok(false) => {}
                Ok(true) => {
                    y.copy_from_slice(&progress.current.y);
                    return Ok(self.remember(problem, &progress));
                }
                Err(cause) => {
                    return Err(self.failure(problem, cause, &progress.report, Some(&progress.current)));
                }
            }
        }
        Err(self.failure(problem, Cause::NoConvergence, &progress.report, Some(&progress.current)))
    }

    /// Progress at the start of a stage. Where the last stage needed at most one tangent and had the same rates, its factors may still do.
    fn resume(&self, problem: &StageProblem<'_>, current: Iterate) -> Progress {
        let usable = self.factored.filter(|f| (f.alpha - problem.alpha).abs() <= 1e-9 * f.alpha);
        Progress {
            current,
            scales: self.forces.clone(),
            keep_factors: usable.is_some(),
            rounding: None,
            steps: Broyden::default(),
            converging: false,
            negative_pivots: usable.map_or(0, |f| f.negative_pivots),
            damped: None,
            report: NewtonReport::default(),
        }
    }

    /// Keeps what the next stages need to know of a solved one; its report.
    fn remember(&mut self, problem: &StageProblem<'_>, progress: &Progress) -> NewtonReport {
        let &Progress { negative_pivots, report, .. } = progress;
        self.factored =
            (report.iterations <= 1).then_some(Factored { alpha: problem.alpha, negative_pivots });
        self.forces.clone_from(&progress.scales);
        self.stable_pivots.get_or_insert(negative_pivots);
        NewtonReport { unstable_modes: self.unstable_modes(negative_pivots), ..report }
    }

    /// Negative pivots that the first stage solved did not have. Until there is one, none is taken for unstable.
    fn unstable_modes(&self, negative_pivots: usize) -> usize {
        self.stable_pivots.map_or(0, |stable| negative_pivots.saturating_sub(stable))
    }

    /// Steps with the present factors as long as they do, then one with a new tangent; true when converged.
    fn iterate(&mut self, problem: &StageProblem<'_>, progress: &mut Progress) -> Result<bool, Cause> {
        while progress.keep_factors {
            if self.step_with_old_factors(problem, progress)? && self.converged(progress) {
                return Ok(true);
            }
        }
        let (balance, direction) = self.direction(problem, progress)?;
        progress.report.iterations += 1;
        let before = norm(&progress.current.residual);
        let slope = dot(&direction, &balance.residual);
        let (length, reached) = self.search(problem, progress, &direction, slope)?;
        progress.current = reached;
        progress.rounding = None;
        progress.steps.clear();
        if length == 1.0 {
            progress.steps.push(direction);
        }
        let contraction = norm(&progress.current.residual) / before;
        let of_direction = progress.damped.as_ref().map_or(contraction, |damped| damped.contraction);
        progress.keep_factors = contraction.max(of_direction) < CONTRACTION;
        progress.converging = contraction.min(of_direction) < CONVERGING;
        if progress.scales.is_empty() || progress.report.iterations > 1 {
            let Iterate { y, rates, .. } = &progress.current;
            progress.scales = self.force_scales(y, rates, problem.alpha);
        }
        Ok(self.converged(progress))
    }

    /// A full step in the direction that the last factors give with what was learned since; taken, and tried again, if it makes the residual much
    /// smaller.
    fn step_with_old_factors(
        &mut self,
        problem: &StageProblem<'_>,
        progress: &mut Progress,
    ) -> Result<bool, Cause> {
        let Progress { current, damped, .. } = progress;
        let mut direction = match damped.take() {
            Some(damped) => damped.correction,
            None => self.solve_for(&current.residual)?,
        };
        progress.steps.correct(&mut direction);
        let trial = self.evaluate(problem, self.along(&current.y, &direction, 1.0));
        progress.keep_factors = false;
        let Ok(trial) = trial else { return Ok(false) };
        if norm(&trial.residual) > CONTRACTION * norm(&current.residual) {
            return Ok(false);
        }
        progress.keep_factors = true;
        progress.current = trial;
        progress.steps.push(direction);
        Ok(true)
    }

    fn converged(&self, progress: &mut Progress) -> bool {
        let Progress { current, scales, rounding, report, .. } = progress;
        report.residual = self.relative_size(&current.residual, scales);
        self.is_small(&current.residual, scales, &current.y, rounding)
    }

    /// Newton direction at the current iterate.
    fn direction(
        &mut self,
        problem: &StageProblem<'_>,
        progress: &mut Progress,
    ) -> Result<(Balance, Vec<f64>), Cause> {
        let (alpha, current) = (problem.alpha, &progress.current);
        let mut balance = self.linearise(&current.y, &current.rates, alpha, Curvature::Kept);
        if self.pairs.iter().filter(|pair| pair.acts()).any(|pair| !pair.covered()) {
            self.rebuild_pattern(&current.y).map_err(|e| Cause::Singular(e.to_string()))?;
            balance = self.linearise(&current.y, &current.rates, alpha, Curvature::Kept);
        }
        progress.negative_pivots = self.factor(&balance)?;
        if self.unstable_modes(progress.negative_pivots) > 0 {
            balance = self.stabilise(problem, current)?.unwrap_or(balance);
        }
        let direction = self.solve_for(&balance.residual)?;
        Ok((balance, direction))
    }

    /// Factors a tangent without unstable modes where the exact one has some: that of a smaller time step, in which rates resist more, or else that
    /// without the curvature of the contact. The search starts near what helped last. None, and the exact tangent's factors, where nothing does.
    fn stabilise(&mut self, problem: &StageProblem<'_>, current: &Iterate) -> Result<Option<Balance>, Cause> {
        let resists = problem.alpha > 0.0 && self.assembly.terms.iter().any(|term| term.integral.rates);
        let (factor, times) = if resists { DAMPING } else { (1.0, 0) };
        let stiffer = (1..=times).map(|k| (problem.alpha * factor.powi(k as i32), Curvature::Kept));
        let flat = self.pairs.iter().any(PairOn::acts).then_some((problem.alpha, Curvature::Dropped));
        let first = self.stabiliser.saturating_sub(1);
        for (k, (alpha, curvature)) in stiffer.chain(flat).enumerate().skip(first) {
            let balance = self.linearise(&current.y, &current.rates, alpha, curvature);
            let negative_pivots = self.factor(&balance)?;
            if self.unstable_modes(negative_pivots) == 0 || curvature == Curvature::Dropped {
                self.stabiliser = k;
                return Ok(Some(balance));
            }
        }
        if times > 0 {
            let exact = self.linearise(&current.y, &current.rates, problem.alpha, Curvature::Kept);
            self.factor(&exact)?;
        }
        Ok(None)
    }

    /// Factors the linearised balance, whose residual is to be solved for first; the number of its negative pivots.
    fn factor(&mut self, balance: &Balance) -> Result<usize, Cause> {
        let first = negative(&balance.residual);
        let entries = self.pattern.entries();
        let expected = if self.indefinite { Definiteness::Indefinite } else { Definiteness::Positive };
        let factors = self
            .solver
            .factor_low_rank(&self.values[..entries], balance.products.columns(), expected, &first)
            .map_err(|e| self.matrix_failure(e))?;
        let negative_pivots = factors.negative_pivots.unwrap_or(0);
        self.indefinite = negative_pivots > 0;
        Ok(negative_pivots)
    }

    /// Direction that the present factors give for a residual.
    fn solve_for(&mut self, residual: &[f64]) -> Result<Vec<f64>, Cause> {
        let mut direction = negative(residual);
        let mut border = vec![0.0; self.solver.borders()];
        self.solver.solve(&mut direction, &mut border).map_err(|e| self.matrix_failure(e))?;
        Ok(direction)
    }

    /// Unknowns a part of the way along a direction of the equations.
    fn along(&self, y: &[f64], direction: &[f64], length: f64) -> Vec<f64> {
        let mut moved = y.to_vec();
        for (&unknown, d) in self.free.iter().zip(direction) {
            moved[unknown as usize] += length * d;
        }
        moved
    }

    /// The iterate at y with the held values of the stage.
    fn evaluate_held(&mut self, problem: &StageProblem<'_>, y: &[f64]) -> Result<Iterate, Cause> {
        let mut y = y.to_vec();
        self.apply_holds(problem.time, &mut y);
        self.evaluate(problem, y)
    }

    /// Settles the scalars and assembles the residual at y.
    fn evaluate(&mut self, problem: &StageProblem<'_>, mut y: Vec<f64>) -> Result<Iterate, Cause> {
        let mut rates = vec![0.0; y.len()];
        self.settle(problem, &mut y, &mut rates)?;
        let full = self.unknown_residual(&y, &rates, problem.alpha, None);
        let residual = self.restrict(&full);
        if residual.iter().any(|r| !r.is_finite()) {
            return Err(Cause::NotFinite);
        }
        Ok(Iterate { y, rates, residual })
    }

    fn matrix_failure(&self, error: LinearError) -> Cause {
        let named = |equation| Cause::Singular(self.name_equation(equation));
        match error {
            LinearError::Singular { equation }
            | LinearError::EmptyRow { equation }
            | LinearError::EmptyColumn { equation } => named(equation),
            LinearError::NonFiniteEntry { .. } | LinearError::NonFiniteRightHandSide { .. } => {
                Cause::NotFinite
            }
            other => Cause::Singular(other.to_string()),
        }
    }

    /// Describes a failed solve: the largest residual, where it is and which physics blocks make it up.
    fn failure(
        &mut self,
        problem: &StageProblem<'_>,
        cause: Cause,
        report: &NewtonReport,
        last: Option<&Iterate>,
    ) -> SolveError {
        let mut error = SolveError {
            cause,
            time: problem.time,
            step: 0.0,
            iterations: report.iterations,
            residual: report.residual,
            place: String::from("unknown: not even the first residual could be evaluated"),
            terms: Vec::new(),
        };
        let Some(last) = last else { return error };
        let Some(worst) = self.worst_equation(&last.residual, problem.alpha, &last.y, &last.rates) else {
            return error;
        };
        error.place = self.name_equation(worst);
        let unknown = self.free[worst] as usize;
        for (block, name) in self.program.blocks.iter().enumerate() {
            let residual = self.unknown_residual(&last.y, &last.rates, problem.alpha, Some(block));
            if residual[unknown] != 0.0 {
                error.terms.push(((*name).into(), residual[unknown]));
            }
        }
        error.terms.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        error
    }
}

fn negative(x: &[f64]) -> Vec<f64> {
    x.iter().map(|x| -x).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
