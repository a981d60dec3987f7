//! Where two curves meet.

use crate::curve::Curve;
use crate::point::{self, Point};

/// What two curves have in common.
#[derive(Debug, Clone, PartialEq)]
pub enum Meeting {
    /// Separate points, possibly none.
    Points(Vec<Point>),
    /// A stretch of positive length around the point.
    Along(Point),
}

/// The common points of two curves, end points included, to within `tolerance` (a length).
pub fn intersect(a: &Curve, b: &Curve, tolerance: f64) -> Meeting {
    if let Some(at) = common_stretch(a, b, tolerance) {
        return Meeting::Along(at);
    }
    let candidates = match (a, b) {
        (Curve::Line { from: p, to: q }, Curve::Line { from: s, to: t }) => lines(*p, *q, *s, *t),
        (Curve::Line { from, to }, Curve::Arc { centre, radius, .. })
        | (Curve::Arc { centre, radius, .. }, Curve::Line { from, to }) => {
            line_circle(*from, *to, *centre, *radius, tolerance)
        }
        (Curve::Arc { centre: c, radius: r, .. }, Curve::Arc { centre: d, radius: s, .. }) => {
            circles((*c, *r), (*d, *s), tolerance)
        }
    };
    let ends = [a.start(), a.end(), b.start(), b.end()];
    let on_both = |p: &Point| a.distance(*p) <= tolerance && b.distance(*p) <= tolerance;
    let mut points: Vec<Point> = Vec::new();
    for p in ends.into_iter().chain(candidates).filter(on_both) {
        if points.iter().all(|&q| point::distance(p, q) > tolerance) {
            points.push(p);
        }
    }
    Meeting::Points(points)
}

/// Where the infinite lines meet; nothing where they are parallel.
fn lines(p: Point, q: Point, s: Point, t: Point) -> Vec<Point> {
    let (along, other) = (point::sub(q, p), point::sub(t, s));
    let parameter = point::cross(point::sub(s, p), other) / point::cross(along, other);
    if parameter.is_finite() { vec![point::lerp(p, q, parameter)] } else { Vec::new() }
}

/// Where the infinite line meets the circle; one that passes within `tolerance` of it touches it.
fn line_circle(from: Point, to: Point, centre: Point, radius: f64, tolerance: f64) -> Vec<Point> {
    let along = point::sub(to, from);
    let unit = point::scale(along, 1.0 / point::norm(along));
    let foot = point::add(from, point::scale(unit, point::dot(point::sub(centre, from), unit)));
    around(foot, unit, point::distance(foot, centre), radius, tolerance)
}

/// Where two circles meet; concentric ones do not.
fn circles((c, r): (Point, f64), (d, s): (Point, f64), tolerance: f64) -> Vec<Point> {
    let between = point::sub(d, c);
    let apart = point::norm(between);
    if apart <= tolerance {
        return Vec::new();
    }
    let unit = point::scale(between, 1.0 / apart);
    let along = (apart * apart + r * r - s * s) / (2.0 * apart);
    let foot = point::add(c, point::scale(unit, along));
    around(foot, point::left(unit), along.abs(), r, tolerance)
}

/// The points of a circle on the line through `foot`, which lies `offset` from its centre.
fn around(foot: Point, unit: Point, offset: f64, radius: f64, tolerance: f64) -> Vec<Point> {
    if offset > radius + tolerance {
        return Vec::new();
    }
    let half = (radius * radius - offset * offset).max(0.0).sqrt();
    [half, -half].map(|step| point::add(foot, point::scale(unit, step))).to_vec()
}

/// The middle of a stretch longer than `tolerance` along which curves of the same line or circle coincide.
fn common_stretch(a: &Curve, b: &Curve, tolerance: f64) -> Option<Point> {
    let same_support = match (a, b) {
        (Curve::Line { from, to }, Curve::Line { .. }) => {
            let unit = a.tangent(0.0);
            let off = |p: Point| point::cross(unit, point::sub(p, *from)).abs() <= tolerance;
            point::distance(*from, *to) > 0.0 && off(b.start()) && off(b.end())
        }
        (Curve::Arc { centre: c, radius: r, .. }, Curve::Arc { centre: d, radius: s, .. }) => {
            point::distance(*c, *d) <= tolerance && (r - s).abs() <= tolerance
        }
        _ => false,
    };
    if !same_support {
        return None;
    }
    let mut cuts = [0.0, a.project(b.start()), a.project(b.end()), 1.0];
    cuts.sort_by(f64::total_cmp);
    let long = |pair: &&[f64]| (pair[1] - pair[0]) * a.length() > 2.0 * tolerance;
    let middles = cuts.windows(2).filter(long).map(|pair| a.point(0.5 * (pair[0] + pair[1])));
    let mut shared = middles.filter(|&p| b.distance(p) <= tolerance);
    shared.next()
}
