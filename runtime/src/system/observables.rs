//! Scalars for outputs and events, evaluated after a step.

use super::contact::PairOn;
use super::place::Place;
use super::point::{Sampler, locate, node_places};
use super::sides::{SidePoint, side_points};
use super::terms::{At, Term};
use super::ties::{Tied, bearer};
use super::unknowns::{Unknowns, domain_nodes};
use crate::error::Error;
use crate::generated::{Observable, ObservableKind, PairValue, Program, Sides};
use crate::mesh::Mesh;

/// An observable on a mesh.
pub enum ObservableOn {
    /// Follows from the unknowns alone.
    Value(Value),
    /// Resultant of a block: minus the sum of its residual over these unknowns.
    Force {
        /// Physics block.
        block: usize,
        /// Unknowns.
        unknowns: Vec<usize>,
    },
}

/// An observable that needs no assembly.
pub enum Value {
    /// Sum of integrals.
    Integrals(Vec<Term>),
    /// Integral over edges seen from one side.
    Side(Sampler, Vec<SidePoint>),
    /// Smallest (sign 1) or largest (sign -1) of sampled values.
    Extreme {
        /// 1 for the smallest, -1 for the largest.
        sign: f64,
        /// Function.
        sampler: Sampler,
        /// Where it is sampled.
        places: Vec<Place>,
    },
    /// Smallest (sign 1) or largest (sign -1) value over surfaces of a pair.
    PairExtreme {
        /// 1 for the smallest, -1 for the largest.
        sign: f64,
        /// Pair.
        pair: usize,
        /// Surfaces.
        sides: Sides,
        /// Value at a point.
        function: PairValue,
    },
    /// Integral over surfaces of a pair.
    PairIntegral {
        /// Pair.
        pair: usize,
        /// Surfaces.
        sides: Sides,
        /// Per area as it has moved.
        current: bool,
        /// Integrand at a point.
        function: PairValue,
    },
}

impl ObservableOn {
    /// Prepares an observable.
    pub fn new(
        program: &'static Program,
        observable: &'static Observable,
        mesh: &Mesh,
        unknowns: &Unknowns,
        ties: &[Tied],
        g: &[f64],
    ) -> Result<Self, Error> {
        let extreme =
            |sign, function, places| Value::Extreme { sign, sampler: Sampler::new(function, mesh), places };
        let of_pair = |sign, pair, sides, function| Value::PairExtreme { sign, pair, sides, function };
        Ok(Self::Value(match &observable.kind {
            ObservableKind::Force { block, domain, field, component } => {
                let nodes = domain_nodes(mesh, *domain)?;
                let unknown = |node: u32| unknowns.fields[*field].unknown(node as usize, *component);
                let mut unknowns: Vec<usize> =
                    nodes.into_iter().filter_map(unknown).map(|unknown| bearer(ties, unknown)).collect();
                unknowns.sort_unstable();
                unknowns.dedup();
                return Ok(Self::Force { block: *block, unknowns });
            }
            ObservableKind::Integral(integrals) => Value::Integrals(
                integrals.iter().map(|i| Term::new(i, mesh, unknowns)).collect::<Result<_, _>>()?,
            ),
            ObservableKind::Side { paths, regions, function } => {
                Value::Side(Sampler::new(function, mesh), side_points(mesh, paths, regions, program.weight)?)
            }
            ObservableKind::Min(domain, function) => {
                extreme(1.0, function, node_places(mesh, *domain, function)?)
            }
            ObservableKind::Max(domain, function) => {
                extreme(-1.0, function, node_places(mesh, *domain, function)?)
            }
            ObservableKind::Point(at, domain, function) => {
                extreme(1.0, function, vec![locate(mesh, *domain, at(g))?])
            }
            ObservableKind::PairMin(pair, sides, function) => of_pair(1.0, *pair, *sides, *function),
            ObservableKind::PairMax(pair, sides, function) => of_pair(-1.0, *pair, *sides, *function),
            &ObservableKind::PairIntegral { pair, sides, current, function } => {
                Value::PairIntegral { pair, sides, current, function }
            }
        }))
    }
}

impl Value {
    /// The value at these unknowns and the gaps of the pairs' last update.
    pub fn evaluate(&mut self, unknowns: &Unknowns, pairs: &[PairOn], at: At<'_>) -> f64 {
        match self {
            Self::Integrals(terms) => terms.iter_mut().map(|t| t.value(at)).sum(),
            Self::Side(sampler, points) => {
                let mut sum = 0.0;
                let mut out = vec![0.0; sampler.outputs()];
                for point in points.iter() {
                    sampler.evaluate_with(unknowns, &point.place, &point.normal, at, &mut out);
                    sum += point.weight * out[0];
                }
                sum
            }
            Self::Extreme { sign, sampler, places } => {
                let mut best = f64::INFINITY;
                let mut out = vec![0.0; sampler.outputs()];
                for place in places.iter() {
                    sampler.evaluate(unknowns, place, at, &mut out);
                    best = best.min(*sign * out[0]);
                }
                *sign * best
            }
            Self::PairExtreme { sign, pair, sides, function } => {
                let values = pairs[*pair].values(*sides, *function, at.g);
                *sign * values.map(|value| *sign * value).fold(f64::INFINITY, f64::min)
            }
            Self::PairIntegral { pair, sides, current, function } => {
                pairs[*pair].integral(*sides, *current, *function, at.g)
            }
        }
    }
}

/// Observables of a program on a mesh.
pub fn prepare(
    program: &'static Program,
    mesh: &Mesh,
    unknowns: &Unknowns,
    ties: &[Tied],
    g: &[f64],
) -> Result<Vec<ObservableOn>, Error> {
    program.observables.iter().map(|o| ObservableOn::new(program, o, mesh, unknowns, ties, g)).collect()
}
