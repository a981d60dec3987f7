//! Assembly of the balance's integrals, on one thread or on several.
//!
//! Several threads share the nodes out, and with them rows of the residual and columns of the matrix. Each thread evaluates every batch of
//! elements that reaches a node of its own and keeps what belongs there. Elements on the seams are evaluated more than once; in return every sum
//! has the same terms in the same order, and so the same bits, on any number of threads.

use super::shares::Shares;
use super::terms::{At, Layout, Term};
use super::ties::Tied;
use super::unknowns::Unknowns;
use crate::mesh::Mesh;

/// Fewer cells than this for each thread are not worth starting it.
const WORTHWHILE: usize = 256;

/// The integrals of the balance.
pub struct Assembly {
    /// All of them, on all their elements.
    pub terms: Vec<Term>,
    /// None on one thread.
    shares: Option<Shares>,
}

impl Assembly {
    /// For one thread.
    pub fn new(terms: Vec<Term>) -> Self {
        Self { terms, shares: None }
    }

    /// Shares out the work among some threads, as many as are worth while. [`Self::locate`] is to follow.
    pub fn share(&mut self, threads: usize, mesh: &Mesh, unknowns: &Unknowns, ties: &[Tied]) {
        let count = threads.min(mesh.cells.len() / WORTHWHILE);
        self.shares = (count > 1).then(|| Shares::new(count, &self.terms, mesh, unknowns, ties));
    }

    /// Looks up where the tangents go.
    pub fn locate(&mut self, layout: Layout<'_>) {
        match &mut self.shares {
            Some(shares) => shares.locate(layout),
            None => self.terms.iter_mut().for_each(|term| term.locate(layout)),
        }
    }

    /// Takes the places of the tangents from the same integrals on the same cells, shared out likewise.
    pub fn take_places(&mut self, from: &mut Self) {
        match (&mut self.shares, &mut from.shares) {
            (Some(shares), Some(from)) => shares.take_places(from),
            _ => take_places(&mut self.terms, &mut from.terms),
        }
    }

    /// Adds the residuals of the integrals in wanted physics blocks (all unknowns).
    pub fn add_residual(&mut self, at: At<'_>, wanted: impl Fn(usize) -> bool + Sync, residual: &mut [f64]) {
        let add = |terms: &mut [Term], sum: &mut [f64], _: &mut [f64]| {
            let terms = terms.iter_mut().filter(|term| wanted(term.integral.block));
            terms.for_each(|term| term.add_residual(at, 1.0, sum));
        };
        self.run(residual, &mut [], add);
    }

    /// Adds the magnitudes of the element residuals: the size of the forces that balance.
    pub fn add_magnitude(&mut self, at: At<'_>, magnitude: &mut [f64]) {
        let add = |terms: &mut [Term], sum: &mut [f64], _: &mut [f64]| {
            terms.iter_mut().for_each(|term| term.add_magnitude(at, sum));
        };
        self.run(magnitude, &mut [], add);
    }

    /// Adds the residuals and overwrites the matrix values, spare ones included, by the tangents.
    pub fn linearise(&mut self, at: At<'_>, residual: &mut [f64], values: &mut [f64]) {
        let add = |terms: &mut [Term], sum: &mut [f64], values: &mut [f64]| {
            terms.iter_mut().for_each(|term| term.add_tangent(at, 1.0, sum, values));
        };
        self.run(residual, values, add);
    }

    /// Hands a job its terms, the sums to add to and matrix values that are zero.
    fn run(
        &mut self,
        sums: &mut [f64],
        values: &mut [f64],
        job: impl Fn(&mut [Term], &mut [f64], &mut [f64]) + Sync,
    ) {
        values.fill(0.0);
        match &mut self.shares {
            Some(shares) => shares.run(sums, values, &job),
            None => job(&mut self.terms, sums, values),
        }
    }
}

/// Takes the places of tangents, term by term.
pub(super) fn take_places(terms: &mut [Term], from: &mut [Term]) {
    terms.iter_mut().zip(from).for_each(|(term, from)| term.take_places(from));
}
