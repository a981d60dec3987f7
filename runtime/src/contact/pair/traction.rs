//! Forces on the points of the slave that depend on the gap and on the slave's own normal, per area of the reference shape or as it has moved.
//!
//! A point of the slave is x = N q with the tangent t = N' q along its edge, q the positions of the edge's nodes. With the flux f(g, n) per area
//! and the measure m = w |t| omega(x) (omega: 1, or 2 pi r), the work on a node is N m f, and its derivative
//!
//! - by the gap: f_g grad g, over the nodes of both surfaces,
//! - by the normal: dn = -(n . N' dq)/|t| t/|t|,
//! - by the measure: dm = w omega t/|t| . N' dq + w |t| grad omega . N dq.
//!
//! Forces of this kind have no energy, and the tangent is not symmetric: the other surface moves the force, but bears none of it.

use super::{ContactPair, Coordinate};
use crate::contact::gap::Gap;
use crate::contact::{Point, dot, right_of};

/// What a force is distributed over.
#[derive(Clone, Copy, Debug)]
pub enum Area {
    /// Area of the reference shape.
    Reference,
    /// Area as the surface has moved: length times this weight of a position, which is affine in it (1, or 2 pi r).
    Current(fn(Point) -> f64),
}

/// A flux with its derivatives by the gap and by both components of the normal.
pub type Traction = [Point; 4];

/// The slave's surface at a point, as it has moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surface {
    /// Position.
    pub position: Point,
    /// Derivative of the position along the edge.
    pub tangent: Point,
}

impl Surface {
    /// Unit normal out of the slave's body.
    pub fn normal(&self) -> Point {
        right_of(self.tangent)
    }
}

/// Measure of a point, with its derivatives by position and tangent.
struct Measure {
    value: f64,
    by_position: Point,
    by_tangent: Point,
}

impl ContactPair {
    /// Surface of the slave at each point, at the positions of the last update.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Integral of a function of place, gap and normal over the points that have a gap.
    pub fn integral(&self, area: Area, function: &dyn Fn(usize, f64, Point) -> f64) -> f64 {
        self.facing()
            .map(|(k, gap)| self.measure(area, k).value * function(k, gap.value, self.surfaces[k].normal()))
            .sum()
    }

    /// Adds the work of a flux on the nodes of the slave, entry by entry; an entry may come in several parts.
    pub fn add_work(
        &self,
        area: Area,
        flux: &dyn Fn(usize, f64, Point) -> Point,
        mut add: impl FnMut(Coordinate, f64),
    ) {
        for (k, gap) in self.facing() {
            let flux = flux(k, gap.value, self.surfaces[k].normal());
            let measure = self.measure(area, k).value;
            for (&node, shape) in gap.nodes().iter().zip(self.points[k].shape) {
                (0..2).for_each(|c| add((node, c), measure * shape * flux[c]));
            }
        }
    }

    /// Adds the derivative of the work, entry by entry: (row, column, value); an entry may come in several parts.
    pub fn add_work_tangent(
        &self,
        area: Area,
        law: &dyn Fn(usize, f64, Point) -> Traction,
        mut add: impl FnMut(Coordinate, Coordinate, f64),
    ) {
        for (k, gap) in self.facing() {
            let law = law(k, gap.value, self.surfaces[k].normal());
            if law == [[0.0; 2]; 4] {
                continue;
            }
            let (point, nodes) = (&self.points[k], gap.nodes());
            for j in 0..nodes.len() {
                for d in 0..2 {
                    let change = self.change(area, k, gap, law, (j, d));
                    for (&node, shape) in nodes.iter().zip(point.shape) {
                        (0..2).for_each(|c| add((node, c), (nodes[j], d), shape * change[c]));
                    }
                }
            }
        }
    }

    /// Derivative of measure times flux by a coordinate: (place in the gap's nodes, component).
    fn change(&self, area: Area, k: usize, gap: &Gap, law: Traction, (j, d): (usize, usize)) -> Point {
        let [flux, by_gap, by_first, by_second] = law;
        let measure = self.measure(area, k);
        let along = gap.gradient()[j][d];
        let mut change = [0, 1].map(|c| measure.value * by_gap[c] * along);
        if j < 3 {
            let (shape, slope) = (self.points[k].shape[j], self.points[k].slope[j]);
            let Surface { tangent, .. } = self.surfaces[k];
            let (length, normal) = (dot(tangent, tangent).sqrt(), self.surfaces[k].normal());
            let stretch = measure.by_position[d] * shape + measure.by_tangent[d] * slope;
            let turn = tangent.map(|t| -normal[d] * slope / length * t / length);
            for c in 0..2 {
                let by_normal = by_first[c] * turn[0] + by_second[c] * turn[1];
                change[c] += stretch * flux[c] + measure.value * by_normal;
            }
        }
        change
    }

    /// Points with a gap: place and gap.
    fn facing(&self) -> impl Iterator<Item = (usize, &Gap)> {
        self.gaps.iter().enumerate().filter_map(|(k, gap)| Some((k, gap.as_ref()?)))
    }

    fn measure(&self, area: Area, k: usize) -> Measure {
        let (point, Surface { position, tangent }) = (&self.points[k], self.surfaces[k]);
        match area {
            Area::Reference => Measure { value: point.measure, by_position: [0.0; 2], by_tangent: [0.0; 2] },
            Area::Current(weight) => {
                let (length, here) = (dot(tangent, tangent).sqrt(), weight(position));
                let gradient = [[1.0, 0.0], [0.0, 1.0]].map(|unit| weight(unit) - weight([0.0; 2]));
                Measure {
                    value: point.weight * length * here,
                    by_position: gradient.map(|slope| point.weight * length * slope),
                    by_tangent: tangent.map(|t| point.weight * here * t / length),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
