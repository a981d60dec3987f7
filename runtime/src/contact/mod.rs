//! Frictionless contact geometry: points of a slave surface against the smooth curves of a master surface.
//!
//! [`curve`] makes a twice continuously differentiable curve of the nodes of a chain of edges, [`projection`] finds the
//! point of such curves closest to a given point, [`gap`] gives the signed gap with its exact first and second
//! derivatives over the nodes of both sides, and [`pair`] holds two surfaces and adds up energy, gradient and Hessian.
//! No law lives here: a model states W(g) and its derivatives. Positions are current, in the plane (x, y) or the
//! meridian half plane (r, z); every chain runs with its body on the left, so that outward is to the right.

pub mod curve;
pub mod gap;
pub mod pair;
pub mod projection;
pub mod tree;

#[cfg(test)]
mod shapes;

pub use curve::{End, SmoothCurve, smooth_curves};
pub use gap::Gap;
pub use pair::traction::{Area, Surface};
pub use pair::{ContactPair, Partner, SlavePoint};

use std::fmt;

/// Point or vector of the plane: (x, y), or (r, z) in a meridian half plane.
pub type Point = [f64; 2];

/// Why a contact surface cannot be made.
#[derive(Clone, Debug, PartialEq)]
pub enum ContactError {
    /// A curve needs at least three nodes.
    TooFewNodes {
        /// Nodes given.
        count: usize,
    },
    /// Two neighbours of a chain lie at the same point of the reference shape.
    CoincidentNodes {
        /// The neighbours.
        nodes: [usize; 2],
    },
    /// A curve was to end on the axis, but its end node does not lie there in the reference shape.
    NotOnAxis {
        /// The end node.
        node: usize,
    },
    /// An edge belongs to both surfaces of a pair: contact of a surface with itself is not treated.
    SelfContact {
        /// Position of the edge among the slave edges.
        edge: usize,
    },
    /// The search radius of a pair is not a positive number.
    Radius {
        /// Radius given, in the unit of length.
        radius: f64,
    },
}

impl fmt::Display for ContactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewNodes { count } => write!(f, "a contact curve needs at least 3 nodes, not {count}"),
            Self::CoincidentNodes { nodes: [a, b] } => {
                write!(f, "neighbouring nodes {a} and {b} of a contact curve coincide")
            }
            Self::NotOnAxis { node } => {
                write!(f, "a contact curve should end on the axis, but node {node} is off it")
            }
            Self::SelfContact { edge } => {
                write!(f, "slave edge {edge} belongs to the master too: a surface cannot touch itself")
            }
            Self::Radius { radius } => {
                write!(f, "the search radius of contact must be positive, not {radius}")
            }
        }
    }
}

impl std::error::Error for ContactError {}

/// Scalar product.
fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// `a - b`.
fn difference(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

/// Unit vector to the right of a tangent: outward where the body is on the left.
fn right_of(tangent: Point) -> Point {
    let length = dot(tangent, tangent).sqrt();
    [tangent[1] / length, -tangent[0] / length]
}
