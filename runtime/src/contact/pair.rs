//! Two surfaces in contact: points of the slave, curves of the master, and sums over the points.
//!
//! The energy of a pair is the sum over its points of measure times W(g), for a law W given at the call; its gradient
//! and Hessian over the nodal positions are exact, projection included. The points of the slave are those of a
//! quadrature rule on its edges, with the measures of the reference shape (2 pi r included where that is meant).
//! [`traction`] adds up forces that have no energy.

use super::curve::SmoothCurve;
use super::gap::Gap;
use super::projection::Master;
use super::tree::Bounds;
use super::{ContactError, Point};
use traction::Surface;

pub mod traction;

/// Quadrature point of a slave edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlavePoint {
    /// Place of the edge among the slave edges.
    pub edge: usize,
    /// Shape functions of the edge's start, end and middle node at the point.
    pub shape: [f64; 3],
    /// Derivatives of the shape functions along the edge, start to end.
    pub slope: [f64; 3],
    /// Weight of the quadrature, part of the parameter.
    pub weight: f64,
    /// Reference measure that the point stands for.
    pub measure: f64,
}

impl SlavePoint {
    /// Point of a quadratic edge at `t` from 0 (start) to 1 (end), which stands for this part of the parameter; so does its measure, until another
    /// is given.
    pub fn new(edge: usize, t: f64, weight: f64) -> Self {
        let shape = [(1.0 - t) * (1.0 - 2.0 * t), t * (2.0 * t - 1.0), 4.0 * t * (1.0 - t)];
        Self { edge, shape, slope: [4.0 * t - 3.0, 4.0 * t - 1.0, 4.0 - 8.0 * t], weight, measure: weight }
    }

    /// The surface at the point, of an edge with these nodes.
    pub fn surface(&self, edge: [usize; 3], positions: &[Point]) -> Surface {
        let sum = |weights: [f64; 3]| {
            [0, 1].map(|c| (0..3).map(|i| weights[i] * positions[edge[i]][c]).sum::<f64>())
        };
        Surface { position: sum(self.shape), tangent: sum(self.slope) }
    }
}

/// Law of contact: W(g) per reference measure with W' and W'', for a point (by its place) and its gap.
pub type Law<'a> = &'a dyn Fn(usize, f64) -> [f64; 3];

/// Coordinate of a node: (node, component).
pub type Coordinate = (usize, usize);

/// Which point of the master is the partner of a point of the slave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// The closest of those that face it: what may touch it from outside.
    Facing,
    /// The nearest of all, ends included: the distance is continuous.
    Nearest,
}

/// Slave points against master curves.
#[derive(Clone, Debug)]
pub struct ContactPair {
    edges: Vec<[usize; 3]>,
    points: Vec<SlavePoint>,
    master: Master,
    partner: Partner,
    radius: f64,
    surfaces: Vec<Surface>,
    gaps: Vec<Option<Gap>>,
}

impl ContactPair {
    /// Pair of slave edges (start, end and middle node; body on the left) with their points, and master curves.
    ///
    /// Gaps are looked for within `radius`. Errors: an edge that belongs to the master too, a radius that is not
    /// positive. Gaps are unknown until the first [`update`](Self::update).
    pub fn new(
        edges: Vec<[usize; 3]>,
        points: Vec<SlavePoint>,
        master: Vec<SmoothCurve>,
        (partner, radius): (Partner, f64),
    ) -> Result<Self, ContactError> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(ContactError::Radius { radius });
        }
        let mut nodes: Vec<usize> = master
            .iter()
            .flat_map(|curve| (0..curve.span_count()).flat_map(|span| curve.nodes(span)))
            .collect();
        nodes.sort_unstable();
        // Surfaces may share a vertex, where one ends and the other starts, but no middle node of an edge.
        if let Some(edge) = edges.iter().position(|[_, _, middle]| nodes.binary_search(middle).is_ok()) {
            return Err(ContactError::SelfContact { edge });
        }
        let (surfaces, gaps) = (vec![Surface::default(); points.len()], vec![None; points.len()]);
        Ok(Self { edges, points, master: Master::new(master), partner, radius, surfaces, gaps })
    }

    /// Slave points, in the order of [`gaps`](Self::gaps).
    pub fn points(&self) -> &[SlavePoint] {
        &self.points
    }

    /// Gap of each point at the positions of the last update; None where no partner is within the radius.
    pub fn gaps(&self) -> &[Option<Gap>] {
        &self.gaps
    }

    /// Finds the gaps at current positions of the nodes.
    pub fn update(&mut self, positions: &[Point]) {
        self.master.refit(positions);
        let found = self.gaps.iter_mut().zip(&mut self.surfaces);
        for ((gap, surface), point) in found.zip(&self.points) {
            let edge = self.edges[point.edge];
            *surface = point.surface(edge, positions);
            let closest = match self.partner {
                Partner::Facing => self.master.closest(surface.position, surface.normal(), self.radius),
                Partner::Nearest => self.master.nearest(surface.position, self.radius),
            };
            *gap = closest.map(|projection| {
                Gap::new(edge, point.shape, &self.master.curves()[projection.location.curve], &projection)
            });
        }
    }

    /// Energy of the pair: the sum of measure times W(g).
    pub fn energy(&self, law: Law<'_>) -> f64 {
        self.contributions(law).map(|(measure, _, [energy, _, _])| measure * energy).sum()
    }

    /// Adds the gradient of the energy, entry by entry; an entry may come in several parts.
    pub fn gradient(&self, law: Law<'_>, mut add: impl FnMut(Coordinate, f64)) {
        for (measure, gap, [_, force, _]) in self.contributions(law) {
            for (&node, derivative) in gap.nodes().iter().zip(gap.gradient()) {
                for (component, value) in derivative.iter().enumerate() {
                    add((node, component), measure * force * value);
                }
            }
        }
    }

    /// Adds the Hessian of the energy, entry by entry, both triangles; an entry may come in several parts.
    pub fn hessian(&self, law: Law<'_>, mut add: impl FnMut(Coordinate, Coordinate, f64)) {
        for (measure, gap, [_, force, stiffness]) in self.contributions(law) {
            let (nodes, gradient) = (gap.nodes(), gap.gradient());
            let coordinates = || (0..nodes.len()).flat_map(|i| [(i, 0), (i, 1)]);
            for row in coordinates() {
                for column in coordinates() {
                    let product = gradient[row.0][row.1] * gradient[column.0][column.1];
                    let value = stiffness * product + force * gap.hessian(row, column);
                    add((nodes[row.0], row.1), (nodes[column.0], column.1), measure * value);
                }
            }
        }
    }

    /// Points with a gap at which the law is not zero: measure, gap, law.
    fn contributions(&self, law: Law<'_>) -> impl Iterator<Item = (f64, &Gap, [f64; 3])> {
        self.gaps.iter().zip(&self.points).enumerate().filter_map(move |(index, (gap, point))| {
            let gap = gap.as_ref()?;
            let law = law(index, gap.value);
            (law != [0.0; 3]).then_some((point.measure, gap, law))
        })
    }

    /// For each slave edge, the master nodes (ascending) of all curve pieces within `radius`, and of those within `margin` of the closest points
    /// of its gaps below `limit`: the couplings to provide in a sparsity pattern so that the pair may move by about that much. The gaps are
    /// those of the last [`update`](Self::update), at the same positions.
    pub fn potential_nodes(
        &self,
        positions: &[Point],
        radius: f64,
        (limit, margin): (f64, f64),
    ) -> Vec<Vec<usize>> {
        let near = |edge: &[usize; 3]| {
            let [start, end, middle] = edge.map(|node| positions[node]);
            // The control point between the ends of the parabola, whose triangle holds the edge.
            let control = [0, 1].map(|c| 2.0 * middle[c] - 0.5 * (start[c] + end[c]));
            self.master.nodes_near(Bounds::of([start, end, control]).grown(radius))
        };
        let mut nodes: Vec<Vec<usize>> = self.edges.iter().map(near).collect();
        for ((gap, surface), point) in self.gaps.iter().zip(&self.surfaces).zip(&self.points) {
            if let Some(gap) = gap.as_ref().filter(|gap| gap.value < limit) {
                let closest = [0, 1].map(|c| surface.position[c] - gap.value * gap.normal[c]);
                nodes[point.edge].extend(self.master.nodes_near(Bounds::of([closest]).grown(margin)));
            }
        }
        for nodes in &mut nodes {
            nodes.sort_unstable();
            nodes.dedup();
        }
        nodes
    }

    /// Whether a pattern with the couplings `potential` (see [`potential_nodes`](Self::potential_nodes)) holds those of
    /// all gaps below `limit`, beyond which the law is zero. If not, the pattern has to be made again.
    pub fn covered(&self, potential: &[Vec<usize>], limit: f64) -> bool {
        self.gaps.iter().zip(&self.points).all(|(gap, point)| match gap {
            Some(gap) if gap.value < limit => {
                gap.nodes()[3..].iter().all(|node| potential[point.edge].binary_search(node).is_ok())
            }
            _ => true,
        })
    }
}

#[cfg(test)]
mod tests;
