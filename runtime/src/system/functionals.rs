//! Functionals that equations use: scalars Z(fields), their gradients, and the loads c_k grad Z_k on them.

use super::place::Place;
use super::point::{Sampler, locate};
use super::terms::{At, Term};
use super::unknowns::Unknowns;
use crate::error::Error;
use crate::generated::{Functional, FunctionalKind};
use crate::mesh::Mesh;

/// A functional on a mesh.
pub struct FunctionalOn {
    /// Its gradient with respect to all unknowns, filled by [`FunctionalOn::evaluate_gradient`].
    pub gradient: Vec<f64>,
    kind: Kind,
}

enum Kind {
    Integrals(Vec<Term>),
    Point { sampler: Sampler, place: Place, outputs: Vec<f64> },
}

impl FunctionalOn {
    /// Prepares a functional; `g` holds parameters, measures and constants.
    pub fn new(
        functional: &'static Functional,
        mesh: &Mesh,
        unknowns: &Unknowns,
        g: &[f64],
    ) -> Result<Self, Error> {
        let kind = match &functional.kind {
            FunctionalKind::Integral(integrals) => Kind::Integrals(
                integrals.iter().map(|i| Term::new(i, mesh, unknowns)).collect::<Result<_, _>>()?,
            ),
            FunctionalKind::Point { at, domain, function } => Kind::Point {
                sampler: Sampler::new(function, mesh),
                place: locate(mesh, *domain, at(g))?,
                outputs: vec![0.0; function.outputs],
            },
        };
        Ok(Self { gradient: vec![0.0; unknowns.length], kind })
    }

    /// Integrals whose tangent may contribute to the matrix.
    pub fn terms_mut(&mut self) -> &mut [Term] {
        match &mut self.kind {
            Kind::Integrals(terms) => terms,
            Kind::Point { .. } => &mut [],
        }
    }

    /// Integrals of this functional.
    pub fn terms(&self) -> &[Term] {
        match &self.kind {
            Kind::Integrals(terms) => terms,
            Kind::Point { .. } => &[],
        }
    }

    /// The value Z.
    pub fn value(&mut self, unknowns: &Unknowns, at: At<'_>) -> f64 {
        match &mut self.kind {
            Kind::Integrals(terms) => terms.iter_mut().map(|t| t.value(at)).sum(),
            Kind::Point { sampler, place, outputs } => {
                sampler.evaluate(unknowns, place, at, outputs);
                outputs[0]
            }
        }
    }

    /// Fills the gradient.
    pub fn evaluate_gradient(&mut self, unknowns: &Unknowns, at: At<'_>) {
        self.gradient.fill(0.0);
        match &mut self.kind {
            Kind::Integrals(terms) => {
                terms.iter_mut().for_each(|t| t.add_residual(at, 1.0, &mut self.gradient))
            }
            Kind::Point { sampler, place, outputs } => {
                sampler.evaluate(unknowns, place, at, outputs);
                sampler.add_gradient(unknowns, place, &outputs[1..], &mut self.gradient);
            }
        }
    }

    /// Adds `factor` times the second derivative to the matrix values (nothing for a linear functional).
    pub fn add_curvature(&mut self, at: At<'_>, factor: f64, values: &mut [f64], scratch: &mut [f64]) {
        for term in self.terms_mut() {
            if term.integral.tangent.is_some() {
                term.add_tangent(at, factor, scratch, values);
            }
        }
    }
}
