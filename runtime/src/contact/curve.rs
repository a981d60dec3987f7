//! Smooth curves through the nodes of a chain of quadratic edges.
//!
//! The chain itself has kinks at its vertices, where a closest point, and with it a contact force, would jump. A
//! [`SmoothCurve`] is the cubic spline, twice continuously differentiable, with one knot per node at the chord length of
//! the reference shape, whose control points come from three neighbouring nodes each:
//! c_i = sum over j of -(t_k - t_l)^2 / (3 (t_j - t_k)(t_j - t_l)) x_j, with {j, k, l} = {i-1, i, i+1}. This
//! quasi-interpolant (the cubic blossom of the local parabola) reproduces cubics for any spacing, so that it is of fourth
//! order on graded chains too, and a point of the curve depends on at most six nodes, linearly. (Knots at the node
//! numbers would ignore the jumps of spacing between edges and be a hundred times less accurate on graded arcs.)

use super::{ContactError, Point, difference, dot};
use std::collections::BTreeMap;

/// How an open curve ends at its first or last node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The curve stops at the node; beyond it, the parabola of the last three nodes stands in for further nodes.
    Free,
    /// The node lies on the axis x = 0 and the curve goes on as its own mirror image.
    Axis,
}

/// Part of one node in a point of a curve: component c of the point is the sum of `weights[0][c]` times component c of
/// the node's position; `weights[1]` and `weights[2]` give the first and second derivative by the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeWeight {
    /// The node.
    pub node: usize,
    /// Weights by order of the derivative and component (they differ by component near an axis only).
    pub weights: [[f64; 2]; 3],
}

/// Cubic piece of a curve at given positions of its nodes, a power series of the offset from its start.
#[derive(Clone, Copy, Debug)]
pub struct Cubic {
    /// Length of the piece in the parameter (reference length).
    pub length: f64,
    /// Coefficients of the powers 0 to 3 of the offset.
    pub coefficients: [Point; 4],
}

impl Cubic {
    /// Position and its first and second derivative by the parameter at an offset from 0 to `length`.
    pub fn evaluate(&self, offset: f64) -> [Point; 3] {
        let [a, b, c, d] = self.coefficients;
        let series = |i: usize| {
            [
                a[i] + offset * (b[i] + offset * (c[i] + offset * d[i])),
                b[i] + offset * (2.0 * c[i] + offset * 3.0 * d[i]),
                2.0 * c[i] + offset * 6.0 * d[i],
            ]
        };
        let (x, y) = (series(0), series(1));
        [[x[0], y[0]], [x[1], y[1]], [x[2], y[2]]]
    }
}

/// Piece of a curve between two knots: for each node that it depends on, power series of the offset by component.
#[derive(Clone, Debug)]
struct Span {
    length: f64,
    series: Vec<(usize, [[f64; 4]; 2])>,
}

/// Twice continuously differentiable curve through (to fourth order in the spacing) an ordered chain of nodes.
///
/// The parameter is the chord length of the reference shape; a point is named by a span (span k runs from node k to node
/// k + 1) and an offset from the start of the span.
#[derive(Clone, Debug)]
pub struct SmoothCurve {
    spans: Vec<Span>,
    closed: bool,
    on_axis: [bool; 2],
}

impl SmoothCurve {
    /// Curve from the first to the last node of a chain, body on the left.
    ///
    /// `nodes` index `reference`, the reference positions. Errors: fewer than three nodes, coincident neighbours, an
    /// end on the axis that is not there.
    pub fn open(nodes: &[usize], reference: &[Point], ends: [End; 2]) -> Result<Self, ContactError> {
        let chain = Chain::new(nodes, reference, Some(ends))?;
        for (end, node) in ends.iter().zip([nodes[0], nodes[nodes.len() - 1]]) {
            if *end == End::Axis && !on_axis(reference[node], chain.length()) {
                return Err(ContactError::NotOnAxis { node });
            }
        }
        let spans = (0..nodes.len() - 1).map(|k| chain.span(k)).collect();
        Ok(Self { spans, closed: false, on_axis: ends.map(|end| end == End::Axis) })
    }

    /// Closed curve through a chain whose last node is followed by the first, body on the left; errors as for
    /// [`open`](Self::open).
    pub fn closed(nodes: &[usize], reference: &[Point]) -> Result<Self, ContactError> {
        let chain = Chain::new(nodes, reference, None)?;
        let spans = (0..nodes.len()).map(|k| chain.span(k)).collect();
        Ok(Self { spans, closed: true, on_axis: [false; 2] })
    }

    /// Number of spans.
    pub fn span_count(&self) -> usize {
        self.spans.len()
    }

    /// Length of a span in the parameter.
    pub fn span_length(&self, span: usize) -> f64 {
        self.spans[span].length
    }

    /// Whether the end of the last span is the start of the first.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Whether the first and the last node lie on the axis, with the mirror image beyond them.
    pub fn ends_on_axis(&self) -> [bool; 2] {
        self.on_axis
    }

    /// Nodes (at most six, ascending) that a span depends on.
    pub fn nodes(&self, span: usize) -> impl Iterator<Item = usize> + '_ {
        self.spans[span].series.iter().map(|(node, _)| *node)
    }

    /// A span at current positions of the nodes.
    pub fn cubic(&self, span: usize, positions: &[Point]) -> Cubic {
        let Span { length, series } = &self.spans[span];
        let mut coefficients = [[0.0; 2]; 4];
        for (node, weights) in series {
            for (power, coefficient) in coefficients.iter_mut().enumerate() {
                for (c, value) in coefficient.iter_mut().enumerate() {
                    *value += weights[c][power] * positions[*node][c];
                }
            }
        }
        Cubic { length: *length, coefficients }
    }

    /// Position and its first and second derivative by the parameter, at current positions of the nodes.
    pub fn evaluate(&self, span: usize, offset: f64, positions: &[Point]) -> [Point; 3] {
        self.cubic(span, positions).evaluate(offset)
    }

    /// Nodes (at most six) and their weights in a point of the curve.
    pub fn stencil(&self, span: usize, offset: f64) -> impl Iterator<Item = NodeWeight> + '_ {
        self.spans[span].series.iter().map(move |(node, [x, y])| {
            let coefficients = std::array::from_fn(|power| [x[power], y[power]]);
            let weights = Cubic { length: 0.0, coefficients }.evaluate(offset);
            NodeWeight { node: *node, weights }
        })
    }
}

/// Smooth curves of a chain of quadratic edges (vertices and edge midpoints alternate, a vertex first), cut at vertices
/// where the reference polygon turns by more than `corner` radians.
///
/// A `closed` chain goes on from its last midpoint to its first vertex. In an `axisymmetric` model, an end on the axis is
/// mirrored unless the mirror image would make a corner. Errors as for [`SmoothCurve::open`].
pub fn smooth_curves(
    chain: &[usize],
    closed: bool,
    axisymmetric: bool,
    reference: &[Point],
    corner: f64,
) -> Result<Vec<SmoothCurve>, ContactError> {
    let count = chain.len();
    if count < 3 {
        return Err(ContactError::TooFewNodes { count });
    }
    let at = |i: usize| reference[chain[i % count]];
    let turns = |i: &usize| {
        turning_angle(difference(at(*i), at(i + count - 1)), difference(at(i + 1), at(*i))) > corner
    };
    let inner_vertices = if closed { 0..count } else { 2..count - 2 }.step_by(2);
    let corners: Vec<usize> = inner_vertices.filter(turns).collect();
    let cuts: Vec<usize> = match (closed, corners.first()) {
        (true, None) => return Ok(vec![SmoothCurve::closed(chain, reference)?]),
        (true, Some(&first)) => corners.iter().copied().chain([first + count]).collect(),
        (false, _) => [0].into_iter().chain(corners).chain([count - 1]).collect(),
    };
    cuts.windows(2)
        .map(|cut| {
            let nodes: Vec<usize> = (cut[0]..=cut[1]).map(|i| chain[i % count]).collect();
            let end = |node: usize, neighbour: Option<&usize>| match neighbour {
                Some(&next) if axisymmetric && crosses_axis(reference[node], reference[next], corner) => {
                    End::Axis
                }
                _ => End::Free,
            };
            let ends = [end(nodes[0], nodes.get(1)), end(nodes[nodes.len() - 1], nodes.iter().rev().nth(1))];
            SmoothCurve::open(&nodes, reference, ends)
        })
        .collect()
}

/// Angle between two directions, 0 to pi.
fn turning_angle(a: Point, b: Point) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).abs().atan2(dot(a, b))
}

/// Whether a chain that ends at `end` after `neighbour` reaches the axis and crosses it without a corner.
fn crosses_axis(end: Point, neighbour: Point, corner: f64) -> bool {
    let direction = difference(neighbour, end);
    let mirrored = [direction[0], -direction[1]];
    on_axis(end, direction[0].hypot(direction[1])) && turning_angle(mirrored, direction) <= corner
}

/// Whether a point lies on the axis, to rounding of a given length.
fn on_axis(point: Point, length: f64) -> bool {
    point[0].abs() <= 1e-9 * length
}

/// Nodes of one curve with their knots, continued beyond its ends.
struct Chain<'a> {
    nodes: &'a [usize],
    /// Chord length up to each node; a closed chain has one more, its period.
    knots: Vec<f64>,
    /// None for a closed chain.
    ends: Option<[End; 2]>,
}

impl<'a> Chain<'a> {
    fn new(nodes: &'a [usize], reference: &[Point], ends: Option<[End; 2]>) -> Result<Self, ContactError> {
        if nodes.len() < 3 {
            return Err(ContactError::TooFewNodes { count: nodes.len() });
        }
        let mut knots = vec![0.0];
        let last = if ends.is_some() { nodes.len() - 1 } else { nodes.len() };
        for i in 0..last {
            let pair = [nodes[i], nodes[(i + 1) % nodes.len()]];
            let chord = difference(reference[pair[1]], reference[pair[0]]);
            let knot = knots[i] + chord[0].hypot(chord[1]);
            // Also refuses positions that are not numbers.
            if !(knot > knots[i] && knot.is_finite()) {
                return Err(ContactError::CoincidentNodes { nodes: pair });
            }
            knots.push(knot);
        }
        Ok(Self { nodes, knots, ends })
    }

    fn length(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// Place of index `i` on the chain: the turn of a closed chain and the index within it, or for an open chain the
    /// index mirrored at the end beyond which it lies, if any.
    fn place(&self, i: isize) -> Place {
        let last = self.knots.len() as isize - 1;
        match self.ends {
            None => Place::Turn(i.div_euclid(last), i.rem_euclid(last) as usize),
            Some([end, _]) if i < 0 => Place::Beyond { end, origin: 0, image: i.unsigned_abs() },
            Some([_, end]) if i > last => {
                Place::Beyond { end, origin: last as usize, image: (2 * last - i) as usize }
            }
            _ => Place::Turn(0, i as usize),
        }
    }

    fn knot(&self, i: isize) -> f64 {
        match self.place(i) {
            Place::Turn(turn, index) => turn as f64 * self.length() + self.knots[index],
            Place::Beyond { origin, image, .. } => 2.0 * self.knots[origin] - self.knots[image],
        }
    }

    /// Position `i` of the continued chain in terms of nodes: (place among the nodes, weight by component).
    fn position(&self, i: isize) -> Vec<(usize, [f64; 2])> {
        match self.place(i) {
            Place::Turn(_, index) => vec![(index, [1.0; 2])],
            Place::Beyond { end: End::Axis, image, .. } => vec![(image, [-1.0, 1.0])],
            Place::Beyond { end: End::Free, origin, .. } => {
                let nearest = if origin == 0 { [0, 1, 2] } else { [origin, origin - 1, origin - 2] };
                let t = nearest.map(|index| self.knots[index]);
                let weights = [0, 1, 2].map(|j| {
                    let (k, l) = ((j + 1) % 3, (j + 2) % 3);
                    (self.knot(i) - t[k]) * (self.knot(i) - t[l]) / ((t[j] - t[k]) * (t[j] - t[l]))
                });
                nearest.into_iter().zip(weights.map(|w| [w; 2])).collect()
            }
        }
    }

    /// Weights of positions `i - 1`, `i`, `i + 1` in control point `i`.
    fn control_weights(&self, i: isize) -> [f64; 3] {
        let t = [i - 1, i, i + 1].map(|j| self.knot(j));
        [0, 1, 2].map(|j| {
            let (k, l) = ((j + 1) % 3, (j + 2) % 3);
            -(t[k] - t[l]).powi(2) / (3.0 * (t[j] - t[k]) * (t[j] - t[l]))
        })
    }

    /// Power series, in the offset from knot `k`, of the cubic B-splines centred at knots `k - 1` to `k + 2` between
    /// knots `k` and `k + 1` (de Boor's recursion over the degree).
    fn basis(&self, k: isize) -> [[f64; 4]; 4] {
        let mut basis = [[0.0; 4]; 4];
        basis[0][0] = 1.0;
        for degree in 1..4 {
            let mut raised = [[0.0; 4]; 4];
            for j in 0..degree {
                let first = k + 1 + j as isize - degree as isize;
                let (a, b) =
                    (self.knot(first) - self.knot(k), self.knot(first + degree as isize) - self.knot(k));
                for power in 0..degree {
                    let value = basis[j][power] / (b - a);
                    raised[j][power] += b * value;
                    raised[j][power + 1] -= value;
                    raised[j + 1][power] -= a * value;
                    raised[j + 1][power + 1] += value;
                }
            }
            basis = raised;
        }
        basis
    }

    fn span(&self, k: usize) -> Span {
        let mut series = BTreeMap::<usize, [[f64; 4]; 2]>::new();
        for (center, spline) in (k as isize - 1..).zip(self.basis(k as isize)) {
            for (i, control) in (center - 1..).zip(self.control_weights(center)) {
                for (index, weight) in self.position(i) {
                    let node = series.entry(self.nodes[index]).or_default();
                    for (component, weight) in node.iter_mut().zip(weight) {
                        for (value, power) in component.iter_mut().zip(spline) {
                            *value += power * control * weight;
                        }
                    }
                }
            }
        }
        Span { length: self.knots[k + 1] - self.knots[k], series: series.into_iter().collect() }
    }
}

/// Where an index of a continued chain lies.
enum Place {
    /// On the chain: turn of a closed chain, index.
    Turn(isize, usize),
    /// Beyond an end at index `origin`, as the mirror image of index `image`.
    Beyond { end: End, origin: usize, image: usize },
}

#[cfg(test)]
mod tests;
