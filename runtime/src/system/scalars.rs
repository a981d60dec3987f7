//! The scalars on their own: stages of a model without equations for fields, and states that an event sets.

use super::{NewtonReport, StageProblem, System};
use crate::error::{Cause, SolveError};

impl System {
    /// Solves a stage of a model whose field unknowns are all held, or that has none: what is left are functionals and states.
    pub fn solve_scalars(
        &mut self,
        problem: &StageProblem<'_>,
        y: &mut [f64],
    ) -> Result<NewtonReport, SolveError> {
        self.apply_holds(problem.time, y);
        let mut rates = vec![0.0; y.len()];
        self.settle(problem, y, &mut rates).map_err(|cause| failure(cause, problem.time))?;
        Ok(NewtonReport { iterations: 1, ..NewtonReport::default() })
    }

    /// Gives states (by number) new values at a time. The other differential states stay; functionals and algebraic states in `y` follow.
    pub fn set_states(
        &mut self,
        time: f64,
        y: &mut [f64],
        values: &[(usize, f64)],
    ) -> Result<(), SolveError> {
        let states = self.unknowns.states..self.unknowns.functionals;
        for &(state, value) in values {
            y[states.start + state] = value;
        }
        let layout = self.program.layout;
        self.g[layout.time] = time;
        self.g[layout.states[0]..layout.states[1]].copy_from_slice(&y[states.clone()]);
        let rates = vec![0.0; y.len()];
        self.evaluate_functionals(y, &rates);
        if let (Some(solver), Some(system)) = (&mut self.states, &self.program.state_system) {
            let mut fixed = system.differential.to_vec();
            values.iter().for_each(|&(state, _)| fixed[state] = true);
            solver.start(&mut self.g, &fixed).map_err(|place| failure(Cause::States(place.into()), time))?;
        }
        y[states].copy_from_slice(&self.g[layout.states[0]..layout.states[1]]);
        Ok(())
    }
}

fn failure(cause: Cause, time: f64) -> SolveError {
    SolveError {
        cause,
        time,
        step: 0.0,
        iterations: 1,
        residual: f64::NAN,
        place: "the states".into(),
        terms: Vec::new(),
    }
}
