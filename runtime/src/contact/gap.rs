//! Signed gap between a slave point and a smooth master curve, with exact derivatives over the nodes of both.
//!
//! Slave point x_s = N_s q and curve x(s) = N_m(s) q depend linearly on the nodal positions q; the closest point has
//! (x_s - x) . t = 0 with t = x'(s), and x_s - x = g n with the master's outward unit normal n. With
//! A = [N_s, -N_m], a = A^T t, b = A_s^T n (A_s: derivative of A by s), m = t . t, h = n . x'' and D = m - g h,
//! differentiating the closest-point condition gives ds = (a - g b)/D . dq and with it
//!
//! - grad g = A^T n, since n is normal to t and a unit vector,
//! - Hess g = (-h/m a a^T + a b^T + b a^T - g b b^T) / D.
//!
//! At an end of the curve, which does not move along it, n is the direction from there, and Hess g = a a^T / (m g) with any t normal to n.
//!
//! The Hessian is that of the condensed problem: the motion of the closest point along the curve and the turning of the
//! normal are in it. D is positive at a minimum of the distance; it vanishes at the centre of curvature.

use super::curve::{NodeWeight, SmoothCurve};
use super::projection::{Location, Projection};
use super::{Point, dot};

/// Most nodes that a gap depends on: three of the slave edge, six of the master curve.
pub const GAP_NODES: usize = 9;

/// Gap of one slave point with its derivatives over the positions of `nodes()`.
///
/// A node of both surfaces appears twice; its parts add up.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    /// Signed gap: positive where the surfaces are apart, negative where they overlap.
    pub value: f64,
    /// Outward unit normal of the master at the closest point.
    pub normal: Point,
    /// The closest point on the master.
    pub location: Location,
    count: usize,
    nodes: [usize; GAP_NODES],
    /// By node and component: grad g, a and b of the module's formulas.
    gradient: [Point; GAP_NODES],
    along: [Point; GAP_NODES],
    turning: [Point; GAP_NODES],
    /// Factors of a a^T, a b^T + b a^T and b b^T in the Hessian.
    factors: [f64; 3],
}

impl Gap {
    /// Gap of a slave point, the sum of `shape` times the positions of `slave` nodes, to its projection on `curve`.
    pub fn new(slave: [usize; 3], shape: [f64; 3], curve: &SmoothCurve, projection: &Projection) -> Self {
        let Projection { location, gap, normal, curve: [_, tangent, curvature], end } = *projection;
        let (m, h) = (dot(tangent, tangent), dot(normal, curvature));
        let denominator = m - gap * h;
        let mut result = Self {
            value: gap,
            normal,
            location,
            count: 0,
            nodes: [0; GAP_NODES],
            gradient: [[0.0; 2]; GAP_NODES],
            along: [[0.0; 2]; GAP_NODES],
            turning: [[0.0; 2]; GAP_NODES],
            factors: match end {
                true => [1.0 / (m * gap), 0.0, 0.0],
                false => [-h / (m * denominator), 1.0 / denominator, -gap / denominator],
            },
        };
        for (node, weight) in slave.into_iter().zip(shape) {
            result.add(NodeWeight { node, weights: [[weight; 2], [0.0; 2], [0.0; 2]] }, 1.0, tangent);
        }
        for node in curve.stencil(location.span, location.offset) {
            result.add(node, -1.0, tangent);
        }
        result
    }

    fn add(
        &mut self,
        NodeWeight { node, weights: [value, slope, _] }: NodeWeight,
        sign: f64,
        tangent: Point,
    ) {
        let scaled = |weights: Point, vector: Point| [0, 1].map(|c| sign * weights[c] * vector[c]);
        self.nodes[self.count] = node;
        self.gradient[self.count] = scaled(value, self.normal);
        self.along[self.count] = scaled(value, tangent);
        self.turning[self.count] = scaled(slope, self.normal);
        self.count += 1;
    }

    /// Nodes that the gap depends on: the three slave nodes, then those of the master.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes[..self.count]
    }

    /// Gradient of the gap: for each of `nodes()`, the derivatives by its two coordinates.
    pub fn gradient(&self) -> &[Point] {
        &self.gradient[..self.count]
    }

    /// Second derivative of the gap by two coordinates, each given as (place in `nodes()`, component).
    pub fn hessian(&self, (i, c): (usize, usize), (j, d): (usize, usize)) -> f64 {
        let [aa, ab, bb] = self.factors;
        let (along_i, turning_i) = (self.along[i][c], self.turning[i][c]);
        let (along_j, turning_j) = (self.along[j][d], self.turning[j][d]);
        aa * along_i * along_j + ab * (along_i * turning_j + turning_i * along_j) + bb * turning_i * turning_j
    }
}

#[cfg(test)]
mod tests;
