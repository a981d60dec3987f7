//! Curves that meet without a shared point: no fault of the geometry, but what lives on them is not joined there.
//!
//! Regions have their crossings checked; a path that bounds none, such as a thin sheet, may miss what it is meant to be attached to.

use crate::boundary::{Boundary, Source};
use crate::curve::Curve;
use crate::error::At;
use crate::intersect::{Meeting, intersect};
use crate::model::Geometry;
use crate::point::{self, Point};
use crate::vertices::Vertices;
use std::collections::BTreeSet;
use std::fmt;

/// An end within this part of its path's length of another path is near it.
const NEAR: f64 = 0.01;

/// Something that a path which bounds no region may not be meant to do. Positions and lengths are in coherent model units.
#[derive(Debug, Clone, PartialEq)]
pub enum Doubt {
    /// An end lies beside another path, or on it, and is no end of one of its segments.
    LooseEnd {
        /// The path.
        path: String,
        /// Its end.
        at: Point,
        /// Path or `path.label` of the nearest other one.
        other: String,
        /// How far away that is.
        distance: f64,
    },
    /// An end lies inside a region.
    EndInside {
        /// The path.
        path: String,
        /// Its end.
        at: Point,
        /// The region.
        region: String,
    },
    /// It crosses another path.
    Crossing {
        /// The path.
        path: String,
        /// Path or `path.label` of the other one.
        other: String,
        /// One point where they meet.
        at: Point,
    },
}

impl Doubt {
    /// The path that may not be as it is meant.
    pub fn path(&self) -> &str {
        match self {
            Self::LooseEnd { path, .. } | Self::EndInside { path, .. } | Self::Crossing { path, .. } => path,
        }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LooseEnd { path, at, other, distance } => write!(
                f,
                "the end {} of `{path}` is not attached: it lies {distance:.3e} from `{other}` and shares no point with it",
                At(at)
            ),
            Self::EndInside { path, at, region } => write!(
                f,
                "the end {} of `{path}` is not attached: it lies inside `{region}` and shares no point with it",
                At(at)
            ),
            Self::Crossing { path, other, at } => {
                write!(f, "`{path}` and `{other}` cross at {} and share no point there", At(at))
            }
        }
    }
}

impl Geometry {
    /// What may not be meant in a geometry without [faults](Geometry::check).
    pub fn doubts(&self) -> Vec<Doubt> {
        let boundaries: Vec<(usize, Boundary)> = (0..self.regions.len())
            .filter_map(|region| Some((region, self.boundary(region).ok()?)))
            .collect();
        let pieces = boundaries.iter().flat_map(|(_, boundary)| boundary.pieces());
        let bounding: BTreeSet<usize> = pieces
            .filter_map(|piece| match piece.source {
                Source::Segment { path, .. } => Some(path),
                Source::Axis => None,
            })
            .collect();
        let vertices = Vertices::of(self);
        let free = (0..self.paths.len()).filter(|path| !bounding.contains(path));
        free.flat_map(|path| {
            let mut doubts = self.crossed(path, &vertices);
            doubts.extend(self.loose(path, &vertices, &boundaries));
            doubts
        })
        .collect()
    }

    /// Ends of a path that nothing holds though something is near.
    fn loose(&self, path: usize, vertices: &Vertices, boundaries: &[(usize, Boundary)]) -> Vec<Doubt> {
        let (ends, segments) = (&vertices.ends[path], &self.paths[path].segments);
        let [Some(first), Some(last)] = [ends.first(), ends.last()] else { return Vec::new() };
        let length: f64 = segments.iter().map(|segment| segment.curve.length()).sum();
        let others = || self.others(path);
        let attached = |end: usize| others().any(|(p, s, _)| vertices.ends[p][s].contains(&end));
        let name = || self.paths[path].name.clone();
        let doubt = |end: usize| {
            let at = vertices.points[end];
            if attached(end) {
                return None;
            }
            let near = others().map(|(p, s, curve)| (curve.distance(at), p, s));
            let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((distance, p, s)) = nearest.filter(|(distance, ..)| *distance <= NEAR * length) {
                return Some(Doubt::LooseEnd { path: name(), at, other: self.segment_name(p, s), distance });
            }
            let (region, _) = boundaries.iter().find(|(_, boundary)| boundary.contains(at))?;
            Some(Doubt::EndInside { path: name(), at, region: self.regions[*region].name.clone() })
        };
        let ends = if first[0] == last[1] { Vec::new() } else { vec![first[0], last[1]] };
        ends.into_iter().filter_map(doubt).collect()
    }

    /// Other paths that a path meets where neither of them has an end.
    fn crossed(&self, path: usize, vertices: &Vertices) -> Vec<Doubt> {
        let reach = 2.0 * self.tolerance();
        let is_end = |p: Point| vertices.points.iter().any(|&end| point::distance(p, end) <= reach);
        let mut doubts = Vec::new();
        for segment in &self.paths[path].segments {
            for (p, s, curve) in self.others(path) {
                let at = match intersect(&segment.curve, curve, self.tolerance()) {
                    Meeting::Along(at) => Some(at),
                    Meeting::Points(common) => common.into_iter().find(|&at| !is_end(at)),
                };
                let name = self.paths[path].name.clone();
                doubts.extend(at.map(|at| Doubt::Crossing {
                    path: name,
                    other: self.segment_name(p, s),
                    at,
                }));
            }
        }
        doubts
    }

    /// All segments of other paths: path, segment, curve.
    fn others(&self, path: usize) -> impl Iterator<Item = (usize, usize, &Curve)> {
        let indexed = self.paths.iter().enumerate().filter(move |(p, _)| *p != path);
        indexed.flat_map(|(p, other)| other.segments.iter().enumerate().map(move |(s, x)| (p, s, &x.curve)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builder::PathBuilder;
    use crate::model::{LoopPart, Path, Region};

    fn wire(from: Point, to: Point) -> Path {
        PathBuilder::from("wire", from).line(None, to).build().unwrap()
    }

    fn doubts(wire: Path) -> Vec<Doubt> {
        let corners = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
        let rim = corners.iter().fold(PathBuilder::from("rim", [0.0, 0.0]), |rim, &to| rim.line(None, to));
        let regions = vec![Region::new("square", [LoopPart::path("rim")])];
        let geometry = Geometry { paths: vec![rim.build().unwrap(), wire], regions, axisymmetric: false };
        assert_eq!(geometry.check(), []);
        geometry.doubts()
    }

    #[test]
    fn a_wire_on_a_corner_is_attached_and_one_far_away_is_meant_to_be() {
        assert_eq!(doubts(wire([1.0, 1.0], [2.0, 1.0])), []);
        assert_eq!(doubts(wire([1.5, 1.0], [2.5, 1.0])), []);
    }

    #[test]
    fn an_end_beside_or_on_a_path_is_loose() {
        for (x, distance) in [(1.005, 0.005), (1.0, 0.0), (0.995, 0.005)] {
            let found = doubts(wire([x, 0.5], [2.0, 0.5]));
            let loose = found.iter().find_map(|doubt| match doubt {
                Doubt::LooseEnd { distance, .. } => Some(*distance),
                _ => None,
            });
            assert!((loose.unwrap() - distance).abs() < 1e-12, "{found:?}");
            assert_eq!(found.len(), 1 + usize::from(x < 1.0), "{found:?}");
        }
    }

    #[test]
    fn an_end_inside_a_region_is_loose_and_the_edge_is_crossed() {
        let found = doubts(wire([0.5, 0.5], [2.0, 0.5]));
        assert!(matches!(&found[..], [Doubt::Crossing { .. }, Doubt::EndInside { .. }]), "{found:?}");
    }
}
