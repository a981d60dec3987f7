//! P1: assembly of residual and exact tangent at a given displacement, without a solve.
//!
//! The displacement u and the directions v, w are quadratic polynomials, so they lie in every P2 space and the energy E(u), its
//! variation R(u; v) and K(u; v, w) do not depend on basis and numbering.

use crate::{assembly_axi, assembly_plane};
use ansatz::Error;
use ansatz::generated::Program;
use ansatz::mesh::structured_rectangle;
use ansatz::system::{Probe, StageProblem, System};
use std::f64::consts::TAU;

/// Coordinates of the problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Plane strain, per unit of depth.
    PlaneStrain,
    /// Axisymmetric; check values are per radian.
    Axisymmetric,
}

impl Kind {
    fn program(self) -> &'static Program {
        match self {
            Self::PlaneStrain => &assembly_plane::PROGRAM,
            Self::Axisymmetric => &assembly_axi::PROGRAM,
        }
    }

    fn values(self) -> Vec<f64> {
        match self {
            Self::PlaneStrain => assembly_plane::Parameters::default().values(),
            Self::Axisymmetric => assembly_axi::Parameters::default().values(),
        }
    }
}

/// The problem on n x n x 2 triangles.
pub struct Assembly {
    /// The discretised model.
    pub system: System,
    kind: Kind,
    /// Displacement; all unknowns.
    u: Vec<f64>,
    v: Vec<f64>,
    w: Vec<f64>,
}

/// What all codes agree on, whatever their basis.
#[derive(Clone, Copy, Debug)]
pub struct Checks {
    /// Energy E(u).
    pub energy: f64,
    /// Variation R(u; v).
    pub residual: f64,
    /// Second variation K(u; v, w).
    pub tangent: f64,
}

impl Assembly {
    /// Sets up the problem.
    ///
    /// # Errors
    /// None with the shipped models.
    pub fn new(n: usize, kind: Kind) -> Result<Self, Error> {
        let mesh = structured_rectangle(n, n, |x, y| [x, y]);
        let system = System::new(kind.program(), &kind.values(), mesh)?;
        let u = on_nodes(&system, displacement);
        let v = on_nodes(&system, |x, y| [x * y + 0.2 * x, x * x - 0.5 * y * y]);
        let w = on_nodes(&system, |x, y| [x - 0.3 * x * x, x * y + y]);
        Ok(Self { system, kind, u, v, w })
    }

    /// Unknowns, held ones included.
    pub fn unknowns(&self) -> usize {
        self.u.len()
    }

    /// The equations at u.
    ///
    /// # Errors
    /// None: the problem has no states.
    pub fn probe(&mut self) -> Result<Probe<'_>, Error> {
        let problem = StageProblem { time: 0.0, alpha: 0.0, base: &self.u };
        self.system.probe(&problem, &self.u).map_err(|cause| Error::Model(cause.to_string()))
    }

    /// The check values.
    ///
    /// # Errors
    /// None: the problem has no states.
    pub fn checks(&mut self) -> Result<Checks, Error> {
        let per = if self.kind == Kind::Axisymmetric { TAU } else { 1.0 };
        let (v, w) = (self.v.clone(), self.w.clone());
        let mut probe = self.probe()?;
        probe.assemble();
        Ok(Checks {
            energy: probe.energy() / per,
            residual: dot(&probe.residual(), &v) / per,
            tangent: dot(&probe.tangent_times(&w), &v) / per,
        })
    }
}

/// Values of a vector function at the nodes, unknown by unknown.
fn on_nodes(system: &System, function: fn(f64, f64) -> [f64; 2]) -> Vec<f64> {
    let nodes = system.unknowns.fields[0].nodes.iter().map(|&node| system.mesh.nodes[node as usize]);
    nodes.flat_map(|[x, y]| function(x, y)).collect()
}

fn displacement(x: f64, y: f64) -> [f64; 2] {
    [0.05 * x + 0.1 * x * y - 0.05 * x * x, 0.02 * y + 0.08 * y * y - 0.1 * x * y + 0.05 * x * x]
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
