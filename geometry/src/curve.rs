//! The two kinds of curve a path is made of, parametrised by arc length.

use crate::point::{self, Point};
use std::f64::consts::{PI, TAU};

/// A directed line or circular arc. The parameter `s` runs from 0 to 1 in proportion to arc length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Curve {
    /// Straight from `from` to `to`.
    Line {
        /// Start.
        from: Point,
        /// End.
        to: Point,
    },
    /// Part of the circle about `centre`. The end points are kept as given, so neighbours share them exactly.
    Arc {
        /// Start, on the circle.
        from: Point,
        /// End, on the circle.
        to: Point,
        /// Centre of the circle.
        centre: Point,
        /// Radius of the circle.
        radius: f64,
        /// Angle of `from` seen from the centre \[rad\].
        start: f64,
        /// Signed angle travelled, positive counter-clockwise \[rad\].
        sweep: f64,
    },
}

impl Curve {
    /// Point at `s` in 0..=1; the end points are returned exactly.
    pub fn point(&self, s: f64) -> Point {
        let (from, to) = (self.start(), self.end());
        if s == 0.0 || s == 1.0 {
            return if s == 0.0 { from } else { to };
        }
        match *self {
            Curve::Line { .. } => point::lerp(from, to, s),
            Curve::Arc { centre, radius, start, sweep, .. } => {
                let (sin, cos) = (start + s * sweep).sin_cos();
                [centre[0] + radius * cos, centre[1] + radius * sin]
            }
        }
    }

    /// First point.
    pub fn start(&self) -> Point {
        match *self {
            Curve::Line { from, .. } | Curve::Arc { from, .. } => from,
        }
    }

    /// Last point.
    pub fn end(&self) -> Point {
        match *self {
            Curve::Line { to, .. } | Curve::Arc { to, .. } => to,
        }
    }

    /// Unit tangent at `s`, in the direction of travel.
    pub fn tangent(&self, s: f64) -> Point {
        match *self {
            Curve::Line { from, to } => {
                let along = point::sub(to, from);
                point::scale(along, 1.0 / point::norm(along))
            }
            Curve::Arc { start, sweep, .. } => {
                let (sin, cos) = (start + s * sweep).sin_cos();
                [-sin * sweep.signum(), cos * sweep.signum()]
            }
        }
    }

    /// Arc length.
    pub fn length(&self) -> f64 {
        match *self {
            Curve::Line { from, to } => point::distance(from, to),
            Curve::Arc { radius, sweep, .. } => radius * sweep.abs(),
        }
    }

    /// Signed curvature, positive where the curve turns left.
    pub fn curvature(&self) -> f64 {
        match *self {
            Curve::Line { .. } => 0.0,
            Curve::Arc { radius, sweep, .. } => sweep.signum() / radius,
        }
    }

    /// Parameter in 0..=1 of the point closest to `p`.
    pub fn project(&self, p: Point) -> f64 {
        match *self {
            Curve::Line { from, to } => {
                let along = point::sub(to, from);
                (point::dot(point::sub(p, from), along) / point::dot(along, along)).clamp(0.0, 1.0)
            }
            Curve::Arc { from, to, centre, start, sweep, .. } => {
                let ray = point::sub(p, centre);
                let travelled = (sweep.signum() * (ray[1].atan2(ray[0]) - start)).rem_euclid(TAU);
                if travelled <= sweep.abs() {
                    travelled / sweep.abs()
                } else if point::distance(p, from) <= point::distance(p, to) {
                    0.0
                } else {
                    1.0
                }
            }
        }
    }

    /// Distance from `p` to the curve.
    pub fn distance(&self, p: Point) -> f64 {
        match *self {
            Curve::Line { .. } => point::distance(p, self.point(self.project(p))),
            Curve::Arc { from, to, centre, radius, .. } => match self.faces(p) {
                true => (point::distance(p, centre) - radius).abs(),
                false => point::distance(p, from).min(point::distance(p, to)),
            },
        }
    }

    /// Whether the ray from the centre of an arc through `p` meets the arc.
    fn faces(&self, p: Point) -> bool {
        let Curve::Arc { from, to, centre, sweep, .. } = *self else { return false };
        let [a, ray, b] = [from, p, to].map(|q| point::sub(q, centre));
        let (after, before) = (point::cross(a, ray) * sweep >= 0.0, point::cross(ray, b) * sweep >= 0.0);
        if sweep.abs() <= PI { after && before } else { after || before }
    }

    /// The part between parameters `s0` and `s1`; runs backwards where `s1 < s0`.
    pub fn sub_curve(&self, s0: f64, s1: f64) -> Curve {
        let (from, to) = (self.point(s0), self.point(s1));
        match *self {
            Curve::Line { .. } => Curve::Line { from, to },
            Curve::Arc { centre, radius, start, sweep, .. } => {
                Curve::Arc { from, to, centre, radius, start: start + s0 * sweep, sweep: (s1 - s0) * sweep }
            }
        }
    }

    /// The same curve travelled the other way.
    pub fn reversed(&self) -> Curve {
        self.sub_curve(1.0, 0.0)
    }

    /// The same curve with its end points replaced by points within a tolerance of them.
    pub(crate) fn with_ends(self, from: Point, to: Point) -> Curve {
        match self {
            Curve::Line { .. } => Curve::Line { from, to },
            Curve::Arc { centre, radius, start, sweep, .. } => {
                Curve::Arc { from, to, centre, radius, start, sweep }
            }
        }
    }

    /// Whether every number of the curve is finite.
    pub fn is_finite(&self) -> bool {
        let ends = point::is_finite(self.start()) && point::is_finite(self.end());
        match *self {
            Curve::Line { .. } => ends,
            Curve::Arc { centre, radius, start, sweep, .. } => {
                ends && point::is_finite(centre)
                    && radius.is_finite()
                    && start.is_finite()
                    && sweep.is_finite()
            }
        }
    }

    /// Smallest box around the curve: `[lower left, upper right]`.
    pub fn bounds(&self) -> [Point; 2] {
        let mut reached = vec![self.start(), self.end()];
        if let Curve::Arc { centre, radius, .. } = *self {
            let extremes = [[radius, 0.0], [0.0, radius], [-radius, 0.0], [0.0, -radius]];
            reached.extend(
                extremes.map(|offset| point::add(centre, offset)).into_iter().filter(|&p| self.faces(p)),
            );
        }
        point::bounds(&reached)
    }

    /// Contribution of the curve to the area on its left: half the integral of `x dy - y dx`.
    pub(crate) fn swept_area(&self) -> f64 {
        let (a, b) = (self.start(), self.end());
        match *self {
            Curve::Line { .. } => 0.5 * point::cross(a, b),
            Curve::Arc { centre, radius, sweep, .. } => {
                0.5 * (radius * radius * sweep + point::cross(centre, point::sub(b, a)))
            }
        }
    }

    /// How often the curve winds about `p`, counted by crossings of the ray from `p` to the right.
    pub(crate) fn winding(&self, p: Point) -> i32 {
        match *self {
            Curve::Line { from, to } => chord_winding(from, to, p),
            Curve::Arc { centre, radius, sweep, .. } => {
                let parts = (sweep.abs() / (0.5 * PI)).ceil().max(1.0);
                let within = point::distance(p, centre) < radius;
                (0..parts as usize)
                    .map(|k| {
                        let (a, b) = (self.point(k as f64 / parts), self.point((k + 1) as f64 / parts));
                        let outside_chord = point::cross(point::sub(b, a), point::sub(p, a)) * sweep < 0.0;
                        let bulge = i32::from(within && outside_chord) * sweep.signum() as i32;
                        chord_winding(a, b, p) + bulge
                    })
                    .sum()
            }
        }
    }
}

/// Crossings of the ray from `p` to the right by the straight line from `a` to `b`: 1 upwards, -1 downwards.
fn chord_winding(a: Point, b: Point, p: Point) -> i32 {
    let side = point::cross(point::sub(b, a), point::sub(p, a));
    if a[1] <= p[1] && b[1] > p[1] && side > 0.0 {
        1
    } else if a[1] > p[1] && b[1] <= p[1] && side < 0.0 {
        -1
    } else {
        0
    }
}
