//! Time: from a discretised model F(t, y, y') = 0 to its accepted steps, events and outputs.
//!
//! The pieces, from the inside out: [`integrator`] makes one step of the implicit method, [`history`] predicts the next step from the last ones,
//! [`magnitude`] knows what errors are measured against, [`control`] chooses step sizes, [`march`] puts these together, [`events`] finds when conditions turn true inside a step, [`schedule`] knows when
//! something is due, [`output`] makes table rows and frames, and [`run`] drives a whole run. None of them knows meshes or physics: what is integrated is an [`ImplicitSystem`].

pub mod control;
pub mod events;
pub mod history;
pub mod integrator;
pub mod magnitude;
pub mod march;
pub mod output;
pub mod root;
pub mod run;
pub mod schedule;
#[cfg(test)]
mod tests;

use crate::error::SolveError;
use crate::mesh::Mesh;
use crate::system::Transfer;
use integrator::Point;
use std::ops::Range;

/// One implicit stage: find y with F(time, y, alpha (y - base)) = 0.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// Time of the stage.
    pub time: f64,
    /// d rate / d value [1/time]; 0 in a stationary problem.
    pub alpha: f64,
    /// Base of the rates, one entry per unknown.
    pub base: &'a [f64],
}

impl Stage<'_> {
    /// Rates that belong to `y`.
    pub fn rates(&self, y: &[f64]) -> Vec<f64> {
        y.iter().zip(self.base).map(|(y, base)| self.alpha * (y - base)).collect()
    }
}

/// Unknowns of one kind, such as a field or a state: they share one magnitude in the error test.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Their places in y.
    pub range: Range<usize>,
    /// Whether the error test looks at them. Algebraic unknowns follow from the others and are left out.
    pub tested: bool,
}

/// A differential-algebraic system F(t, y, y') = 0 that can solve its implicit stages.
pub trait ImplicitSystem {
    /// The kinds of unknowns.
    fn groups(&self) -> Vec<Group>;

    /// Places in y of what follows from the other unknowns at any instant, since its rates do not occur in the equations, and is not brought in line
    /// with them by [`Self::set_states`].
    fn algebraic(&self) -> Vec<Range<usize>>;

    /// Solves for y at a stage; `y` is the prediction on entry and the solution on return. Returns the Newton iterations it took.
    /// After an error the contents of `y` mean nothing.
    fn solve_stage(&mut self, stage: &Stage<'_>, y: &mut [f64]) -> Result<usize, SolveError>;

    /// Gives states (by number) new values and makes `y` consistent with them and with the fields at `time`.
    fn set_states(&mut self, time: f64, y: &mut [f64], values: &[(usize, f64)]) -> Result<(), SolveError>;

    /// Prepares the step after an accepted point; with new meshes of moving regions if they are asked for `anew`. How unknowns go along, where they
    /// are carried to other places.
    ///
    /// # Errors
    /// What was prepared cannot go on from there.
    fn renew(&mut self, _point: &Point, _anew: bool) -> Result<Option<Transfer>, SolveError> {
        Ok(None)
    }

    /// All globals at a time with these unknowns and rates, observables included.
    fn observe(&mut self, point: &Point) -> Vec<f64>;

    /// Columns of a field frame (by number) at a point with these globals: node by node, component by component [internal units].
    fn sample(&mut self, frame: usize, point: &Point, g: &[f64]) -> Vec<Vec<f64>>;

    /// The mesh on which frames are sampled now, where it is not the same throughout a run.
    fn present_mesh(&self) -> Option<Mesh> {
        None
    }
}
