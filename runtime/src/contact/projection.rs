//! Closest point of a set of smooth curves.
//!
//! Boxes of the spans form a tree that is refitted to the positions; spans are visited nearest first, and in each span
//! the local minima of the distance are the zeros of phi(s) = (x_s - x(s)) . x'(s) where phi falls, found by Newton's
//! method safeguarded by bisection. [`Master::closest`] counts only points where the surfaces face each other;
//! [`Master::nearest`] counts all, the ends of curves included, so that the distance is continuous wherever the point goes.

use super::curve::{Cubic, SmoothCurve};
use super::tree::{Bounds, BoxTree};
use super::{Point, difference, dot, right_of};

/// Parts of a span that are searched for separate minima.
const PARTS: usize = 4;

/// Point of a set of curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Location {
    /// Place of the curve in the set.
    pub curve: usize,
    /// Span of the curve.
    pub span: usize,
    /// Parameter from the start of the span.
    pub offset: f64,
}

/// Closest point of a set of curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Where it is.
    pub location: Location,
    /// Signed distance: positive outside the master body, negative inside.
    pub gap: f64,
    /// Outward unit normal of the master there; at an end of a curve the direction from it to the point.
    pub normal: Point,
    /// Position and its first and second derivative by the parameter of the curve; at an end the first is normal to the normal, the second zero.
    pub curve: [Point; 3],
    /// It is an end of a curve, nearer than its neighbourhood.
    pub end: bool,
}

/// Curves of a master surface at the current positions.
#[derive(Clone, Debug)]
pub struct Master {
    curves: Vec<SmoothCurve>,
    pieces: Vec<Piece>,
    tree: BoxTree,
}

/// A span at the current positions.
#[derive(Clone, Copy, Debug)]
struct Piece {
    curve: usize,
    span: usize,
    cubic: Cubic,
    /// Position and tangent at both ends; neighbours share them to the last bit, and they are exact on an axis, so that
    /// no minimum falls between.
    ends: [[Point; 2]; 2],
}

impl Master {
    /// Curves, not yet at any positions: see [`refit`](Self::refit).
    pub fn new(curves: Vec<SmoothCurve>) -> Self {
        let cubic = Cubic { length: 0.0, coefficients: [[0.0; 2]; 4] };
        let pieces: Vec<Piece> = (curves.iter().enumerate())
            .flat_map(|(curve, smooth)| (0..smooth.span_count()).map(move |span| (curve, span)))
            .map(|(curve, span)| Piece { curve, span, cubic, ends: [[[0.0; 2]; 2]; 2] })
            .collect();
        let tree = BoxTree::new(pieces.len());
        Self { curves, pieces, tree }
    }

    /// The curves.
    pub fn curves(&self) -> &[SmoothCurve] {
        &self.curves
    }

    /// Moves the curves to current positions of the nodes.
    pub fn refit(&mut self, positions: &[Point]) {
        for piece in &mut self.pieces {
            piece.cubic = self.curves[piece.curve].cubic(piece.span, positions);
            let [position, tangent, _, _] = piece.cubic.coefficients;
            let [last_position, last_tangent, _] = piece.cubic.evaluate(piece.cubic.length);
            piece.ends = [[position, tangent], [last_position, last_tangent]];
        }
        for i in 0..self.pieces.len() {
            let Piece { curve, span, .. } = self.pieces[i];
            let (count, on_axis) = (self.curves[curve].span_count(), self.curves[curve].ends_on_axis());
            if span + 1 < count {
                self.pieces[i].ends[1] = self.pieces[i + 1].ends[0];
            } else if self.curves[curve].is_closed() {
                self.pieces[i].ends[1] = self.pieces[i + 1 - count].ends[0];
            }
            for (end, at) in [0, count - 1].into_iter().enumerate() {
                if on_axis[end] && span == at {
                    let [[_, z], [r, _]] = self.pieces[i].ends[end];
                    self.pieces[i].ends[end] = [[0.0, z], [r, 0.0]];
                }
            }
        }
        self.tree.refit(self.pieces.iter().map(|piece| hull(&piece.cubic)));
    }

    /// Closest point within `radius` of `point` whose outward normal opposes `normal`, the outward normal there.
    ///
    /// None where there is no such point, in particular beyond the ends of all curves. Among equally close points the
    /// first in the order of the curves is taken.
    pub fn closest(&self, point: Point, normal: Point, radius: f64) -> Option<Projection> {
        self.best(point, radius, |piece, found| {
            self.minima(piece, point).filter(|p| dot(p.normal, normal) < 0.0).for_each(found);
        })
    }

    /// Nearest point within `radius` of `point`, wherever it faces, the ends of the curves included.
    ///
    /// Among equally near points the first in the order of the curves is taken.
    pub fn nearest(&self, point: Point, radius: f64) -> Option<Projection> {
        self.best(point, radius, |piece, found| {
            self.minima(piece, point).chain(self.ends(piece, point)).for_each(found);
        })
    }

    /// The nearest of the points that `candidates` hands over for each piece.
    fn best(
        &self,
        point: Point,
        radius: f64,
        candidates: impl Fn(&Piece, &mut dyn FnMut(Projection)),
    ) -> Option<Projection> {
        let mut best: Option<(usize, Projection)> = None;
        self.tree.visit_nearest(point, radius, |index| {
            candidates(&self.pieces[index], &mut |projection| {
                let closer = best.is_none_or(|(other, nearest)| {
                    (projection.gap.abs(), index) < (nearest.gap.abs(), other)
                });
                if closer && projection.gap.abs() <= radius {
                    best = Some((index, projection));
                }
            });
            best.map_or(radius, |(_, nearest)| nearest.gap.abs())
        });
        best.map(|(_, projection)| projection)
    }

    /// Free ends of the curve on a piece that are nearer to a point than the piece beside them.
    fn ends(&self, piece: &Piece, point: Point) -> impl Iterator<Item = Projection> {
        let (curve, span) = (piece.curve, piece.span);
        let smooth = &self.curves[curve];
        let (axis, last) = (smooth.ends_on_axis(), smooth.span_count() - 1);
        let free = [span == 0 && !axis[0], span == last && !axis[1]].map(|end| end && !smooth.is_closed());
        let (ends, length) = (piece.ends, piece.cubic.length);
        (0..2).filter_map(move |k| {
            let [position, tangent] = ends[k];
            let along = dot(difference(point, position), tangent);
            let beyond = if k == 0 { along < 0.0 } else { along > 0.0 };
            let location = Location { curve, span, offset: if k == 0 { 0.0 } else { length } };
            (free[k] && beyond).then(|| project_on_end(position, point, location))
        })
    }

    /// Nodes of the spans whose boxes overlap a box, ascending, each once.
    pub fn nodes_near(&self, bounds: Bounds) -> Vec<usize> {
        let pieces = self.tree.overlapping(bounds).into_iter().map(|index| &self.pieces[index]);
        let mut nodes: Vec<usize> =
            pieces.flat_map(|piece| self.curves[piece.curve].nodes(piece.span)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Local minima of the distance from a point to a span.
    fn minima(&self, piece: &Piece, point: Point) -> impl Iterator<Item = Projection> {
        let slope = |[position, tangent]: [Point; 2]| dot(difference(point, position), tangent);
        let length = piece.cubic.length;
        let knots: [(f64, f64); PARTS + 1] = std::array::from_fn(|i| {
            let offset = length * i as f64 / PARTS as f64;
            let [position, tangent, _] = piece.cubic.evaluate(offset);
            match i {
                0 => (0.0, slope(piece.ends[0])),
                PARTS => (length, slope(piece.ends[1])),
                _ => (offset, slope([position, tangent])),
            }
        });
        let mirrored = piece.span == 0 && self.curves[piece.curve].ends_on_axis()[0];
        let (curve, span, cubic) = (piece.curve, piece.span, piece.cubic);
        (0..PARTS).filter_map(move |i| {
            let [(from, rising), (to, falling)] = [knots[i], knots[i + 1]];
            let starts = rising > 0.0 || (rising == 0.0 && i == 0 && mirrored);
            (starts && falling <= 0.0).then(|| {
                let offset = falling_zero(&cubic, point, [from, to]);
                project(&cubic, point, Location { curve, span, offset })
            })
        })
    }
}

/// Box of the Bezier points of a cubic, which holds it.
fn hull(cubic: &Cubic) -> Bounds {
    let ([a, b, c, _], h) = (cubic.coefficients, cubic.length);
    let inner = |linear: f64, square: f64| [0, 1].map(|i| a[i] + linear * b[i] + square * c[i]);
    Bounds::of([a, inner(h / 3.0, 0.0), inner(2.0 * h / 3.0, h * h / 3.0), cubic.evaluate(h)[0]])
}

/// Zero of phi between two offsets, where phi falls from at least zero to at most zero.
fn falling_zero(cubic: &Cubic, point: Point, [mut low, mut high]: [f64; 2]) -> f64 {
    let tolerance = 1e-15 * cubic.length;
    let mut offset = 0.5 * (low + high);
    // Newton's method needs about five steps; bisection alone would need fifty.
    for _ in 0..60 {
        let [position, tangent, curvature] = cubic.evaluate(offset);
        let distance = difference(point, position);
        let value = dot(distance, tangent);
        *(if value > 0.0 { &mut low } else { &mut high }) = offset;
        let newton = offset + value / (dot(tangent, tangent) - dot(distance, curvature));
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        let step = (next - offset).abs();
        offset = next;
        if step <= tolerance {
            break;
        }
    }
    offset
}

fn project(cubic: &Cubic, point: Point, location: Location) -> Projection {
    let curve = cubic.evaluate(location.offset);
    let normal = right_of(curve[1]);
    Projection { location, gap: dot(difference(point, curve[0]), normal), normal, curve, end: false }
}

/// An end that is not at the point itself.
fn project_on_end(end: Point, point: Point, location: Location) -> Projection {
    let distance = difference(point, end);
    let gap = dot(distance, distance).sqrt();
    let normal = distance.map(|d| d / gap);
    Projection { location, gap, normal, curve: [end, [-normal[1], normal[0]], [0.0; 2]], end: true }
}

#[cfg(test)]
mod tests;
