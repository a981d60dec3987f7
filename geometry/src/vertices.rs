//! The distinct end points of all segments: points within the tolerance of each other are one vertex.

use crate::model::Geometry;
use crate::point::{self, Point};

/// Distinct end points of a geometry's segments, in order of first appearance.
#[derive(Debug, Clone, PartialEq)]
pub struct Vertices {
    /// Position of each vertex; the first of the points merged into it, with r = 0 exactly on the axis.
    pub points: Vec<Point>,
    /// `ends[path][segment]` = vertex at the segment's start and at its end.
    pub ends: Vec<Vec<[usize; 2]>>,
}

impl Vertices {
    /// Collects and merges the end points of `geometry`.
    pub fn of(geometry: &Geometry) -> Self {
        let tolerance = geometry.tolerance();
        let mut points = Vec::new();
        let mut vertex = |p: Point| {
            let known = points.iter().position(|&q| point::distance(p, q) <= tolerance);
            known.unwrap_or_else(|| {
                let on_axis = geometry.axisymmetric && p[0].abs() <= tolerance;
                points.push(if on_axis { [0.0, p[1]] } else { p });
                points.len() - 1
            })
        };
        let ends = geometry
            .paths
            .iter()
            .map(|path| {
                path.segments.iter().map(|s| [vertex(s.curve.start()), vertex(s.curve.end())]).collect()
            })
            .collect();
        Vertices { points, ends }
    }
}
