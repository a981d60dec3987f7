//! The discretised equations at one point, laid open for tests and benchmarks: energy, residual, tangent.

use super::System;
use super::balance::Balance;
use super::contact::Curvature;
use super::newton::StageProblem;
use super::terms::At;
use super::unknowns::NONE;
use crate::error::Cause;

/// The equations at one point y. Vectors have one entry for each unknown of y.
pub struct Probe<'a> {
    system: &'a mut System,
    y: Vec<f64>,
    rates: Vec<f64>,
    alpha: f64,
    balance: Balance,
}

impl System {
    /// Looks at the equations where the fields have the values in `y`; functionals and states follow from them. Held unknowns keep
    /// the values they have in `y`.
    ///
    /// # Errors
    /// [`Cause::States`] if the states have no solution there.
    pub fn probe(&mut self, problem: &StageProblem<'_>, y: &[f64]) -> Result<Probe<'_>, Cause> {
        let (mut y, mut rates) = (y.to_vec(), vec![0.0; y.len()]);
        self.settle(problem, &mut y, &mut rates)?;
        Ok(Probe { system: self, y, rates, alpha: problem.alpha, balance: Balance::default() })
    }
}

impl Probe<'_> {
    /// Sum of all integrals that have a value; energies of contact pairs do not count.
    pub fn energy(&mut self) -> f64 {
        let at = At { y: &self.y, rates: &self.rates, g: &self.system.g, alpha: self.alpha };
        self.system.assembly.terms.iter_mut().map(|term| term.value(at)).sum()
    }

    /// Residual of all field unknowns; where a value is held it is minus the reaction.
    pub fn residual(&mut self) -> Vec<f64> {
        self.system.unknown_residual(&self.y, &self.rates, self.alpha, None)
    }

    /// Assembles residual and tangent, as one iteration of Newton's method does.
    pub fn assemble(&mut self) {
        self.balance = self.system.linearise(&self.y, &self.rates, self.alpha, Curvature::Kept);
    }

    /// Whether a field unknown is solved for; else a condition holds it.
    pub fn is_free(&self, unknown: usize) -> bool {
        self.system.equations[unknown] != NONE
    }

    /// The sparse part of the tangent last assembled, equation by equation: start of every column, row and value of every entry. Of a symmetric
    /// system it is the lower triangle.
    pub fn sparse_tangent(&self) -> (&[u32], &[u32], &[f64]) {
        let pattern = &self.system.pattern;
        (pattern.column_starts(), pattern.rows(), &self.system.values[..pattern.entries()])
    }

    /// Product of the tangent last assembled with a vector; rows and columns of held unknowns are zero.
    pub fn tangent_times(&self, vector: &[f64]) -> Vec<f64> {
        let system = &*self.system;
        let x = system.restrict(vector);
        let mut product = vec![0.0; x.len()];
        system.pattern.subtract_product(&system.values, &x, &mut product);
        self.balance.products.subtract_product(&x, &mut product);
        let mut full = vec![0.0; vector.len()];
        system.free.iter().zip(product).for_each(|(&unknown, p)| full[unknown as usize] = -p);
        full
    }
}
