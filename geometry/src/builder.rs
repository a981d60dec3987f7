//! Builds paths the way a model writes them: from a point, by lines and arcs, to a point.

use crate::curve::Curve;
use crate::error::GeometryError;
use crate::model::{Path, Segment};
use crate::point::{self, Point};
use std::f64::consts::TAU;

/// Direction of travel along an arc.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// Counter-clockwise.
    Ccw,
    /// Clockwise.
    Cw,
}

/// How far off its circle the end of an arc may lie, as a part of the radius.
const ON_CIRCLE: f64 = 1e-6;

/// An arc that travels less than this angle \[rad\] goes all the way round.
const FULL_TURN: f64 = 1e-12;

/// Collects the segments of one path.
#[derive(Debug, Clone)]
pub struct PathBuilder {
    path: Path,
    at: Point,
    errors: Vec<GeometryError>,
}

impl PathBuilder {
    /// Starts the path `name` at a point.
    pub fn from(name: &str, start: Point) -> Self {
        let path = Path { name: name.into(), segments: Vec::new() };
        PathBuilder { path, at: start, errors: Vec::new() }
    }

    /// Goes straight to `to`.
    pub fn line(self, label: Option<&str>, to: Point) -> Self {
        let curve = Curve::Line { from: self.at, to };
        self.push(label, curve)
    }

    /// Goes to `to` on the circle about `centre`; all the way round where `to` is the current point.
    pub fn arc(mut self, label: Option<&str>, centre: Point, turn: Turn, to: Point) -> Self {
        let from = self.at;
        let (radius, reached) = (point::distance(from, centre), point::distance(to, centre));
        if (reached - radius).abs() > ON_CIRCLE * radius {
            let name = label.map_or(self.path.name.clone(), |label| format!("{}.{label}", self.path.name));
            self.errors.push(GeometryError::EndOffCircle { name, centre, radius, to, reached });
        }
        let angle = |p: Point| (p[1] - centre[1]).atan2(p[0] - centre[0]);
        let sign = if turn == Turn::Ccw { 1.0 } else { -1.0 };
        let travelled = (sign * (angle(to) - angle(from))).rem_euclid(TAU);
        let sweep = sign * if travelled < FULL_TURN { TAU } else { travelled };
        self.push(label, Curve::Arc { from, to, centre, radius, start: angle(from), sweep })
    }

    /// The path, or what is wrong with its arcs.
    pub fn build(self) -> Result<Path, Vec<GeometryError>> {
        if self.errors.is_empty() { Ok(self.path) } else { Err(self.errors) }
    }

    fn push(mut self, label: Option<&str>, curve: Curve) -> Self {
        self.at = curve.end();
        self.path.segments.push(Segment { label: label.map(String::from), curve });
        self
    }
}

/// The point at `angle` \[rad, from the first axis, counter-clockwise\] on a circle.
pub fn polar(centre: Point, radius: f64, angle: f64) -> Point {
    [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()]
}

/// Where two circles (centre, radius) meet; of the two points the one closer to `near`.
///
/// # Errors
/// [`GeometryError::CirclesApart`] where they do not meet.
pub fn intersect_circles(a: (Point, f64), b: (Point, f64), near: Point) -> Result<Point, GeometryError> {
    let between = point::sub(b.0, a.0);
    let apart = point::norm(between);
    let along = (apart * apart + a.1 * a.1 - b.1 * b.1) / (2.0 * apart);
    let across = (a.1 * a.1 - along * along).sqrt();
    if !across.is_finite() {
        return Err(GeometryError::CirclesApart { circles: [a, b], apart });
    }
    let unit = point::scale(between, 1.0 / apart);
    let foot = point::add(a.0, point::scale(unit, along));
    let offset = point::scale(point::left(unit), across);
    let (p, q) = (point::add(foot, offset), point::sub(foot, offset));
    Ok(if point::distance(p, near) <= point::distance(q, near) { p } else { q })
}
