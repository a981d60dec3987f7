//! Checks a geometry and reports every fault at once.

use crate::boundary::{Boundary, Piece, Source};
use crate::curve::Curve;
use crate::error::{Gap, GeometryError};
use crate::intersect::{Meeting, intersect};
use crate::model::Geometry;
use crate::point::{self, Point};
use crate::vertices::Vertices;

/// Two curves that leave a shared end in directions closer than this (sine of the angle) are tangent there, and
/// meet again only beyond this part of the geometry's diagonal: nearer, rounding decides.
const TANGENT: f64 = 1e-4;

/// Distance of the probes left and right of a curve, as a part of the curve's length.
const PROBE: f64 = 1e-4;

impl Geometry {
    /// Every fault of the geometry; empty where it can be meshed. Faults that only follow from another one are
    /// left out. Paths that bound no region are checked by themselves only.
    pub fn check(&self) -> Vec<GeometryError> {
        let mut errors = self.curve_errors();
        errors.extend(self.chain_errors());
        if !errors.is_empty() {
            return errors;
        }
        let mut boundaries = Vec::new();
        for region in 0..self.regions.len() {
            match self.boundary(region) {
                Ok(boundary) => boundaries.push((region, boundary)),
                Err(faults) => errors.extend(faults),
            }
        }
        let crossings = self.crossings(&boundaries);
        if crossings.is_empty() {
            errors.extend(self.overlaps(&boundaries));
        }
        errors.extend(crossings);
        errors
    }

    /// Curves that are not finite, have no length or cross the axis.
    fn curve_errors(&self) -> Vec<GeometryError> {
        let tolerance = self.tolerance();
        let fault = |name: String, curve: &Curve| {
            let r = curve.bounds()[0][0];
            if !curve.is_finite() {
                Some(GeometryError::NotFinite { name, from: curve.start(), to: curve.end() })
            } else if curve.length() <= tolerance {
                Some(GeometryError::ZeroLength { name, at: curve.start() })
            } else if self.axisymmetric && r < -tolerance {
                Some(GeometryError::NegativeRadius { name, r })
            } else {
                None
            }
        };
        let indexed = self.paths.iter().enumerate();
        let all = indexed.flat_map(|(p, path)| path.segments.iter().enumerate().map(move |(s, x)| (p, s, x)));
        all.filter_map(|(p, s, segment)| fault(self.segment_name(p, s), &segment.curve)).collect()
    }

    /// Paths whose segments do not follow each other.
    fn chain_errors(&self) -> Vec<GeometryError> {
        let tolerance = self.tolerance();
        let mut errors = Vec::new();
        for (p, path) in self.paths.iter().enumerate() {
            for (s, pair) in path.segments.windows(2).enumerate() {
                let (end, start) = (pair[0].curve.end(), pair[1].curve.start());
                if point::distance(end, start) > tolerance {
                    let from = (self.segment_name(p, s), end);
                    let to = Some((self.segment_name(p, s + 1), start));
                    errors.push(GeometryError::BrokenPath { path: path.name.clone(), gap: Gap { from, to } });
                }
            }
        }
        errors
    }

    /// Boundary curves that meet elsewhere than at shared end points.
    fn crossings(&self, boundaries: &[(usize, Boundary)]) -> Vec<GeometryError> {
        let mut pieces: Vec<&Piece> = boundaries.iter().flat_map(|(_, boundary)| boundary.pieces()).collect();
        pieces.retain(|piece| piece.source != Source::Axis);
        pieces.sort_by_key(|piece| piece.source);
        pieces.dedup_by_key(|piece| piece.source);
        let points = Vertices::of(self).points;
        let mut errors = Vec::new();
        for (k, a) in pieces.iter().enumerate() {
            for b in &pieces[..k] {
                let names = [self.source_name(b.source), self.source_name(a.source)];
                let fault = match intersect(&a.curve, &b.curve, self.tolerance()) {
                    Meeting::Along(at) => Some(GeometryError::Coincident { names, at }),
                    Meeting::Points(common) => {
                        let crossing = common.into_iter().find(|&p| !self.is_shared_end(a, b, p, &points));
                        crossing.map(|at| GeometryError::Crossing { names, at })
                    }
                };
                errors.extend(fault.filter(|fault| !errors.contains(fault)));
            }
        }
        errors
    }

    /// Whether `p` is an end point of both pieces, or near one where they are tangent.
    fn is_shared_end(&self, a: &Piece, b: &Piece, p: Point, points: &[Point]) -> bool {
        let [low, high] = self.bounds();
        let diagonal = point::distance(low, high);
        a.ends.iter().filter(|&end| b.ends.contains(end)).any(|&end| {
            let heading = |piece: &Piece| piece.curve.tangent(if piece.ends[0] == end { 0.0 } else { 1.0 });
            let tangent = point::cross(heading(a), heading(b)).abs() < TANGENT;
            let reach = if tangent { TANGENT * diagonal } else { 2.0 * self.tolerance() };
            point::distance(p, points[end]) <= reach
        })
    }

    /// Pairs of regions that cover the same ground, found by probing both sides of every boundary curve.
    fn overlaps(&self, boundaries: &[(usize, Boundary)]) -> Vec<GeometryError> {
        let mut found: Vec<([usize; 2], Point)> = Vec::new();
        for piece in boundaries.iter().flat_map(|(_, boundary)| boundary.pieces()) {
            let aside = point::scale(point::left(piece.curve.tangent(0.5)), PROBE * piece.curve.length());
            let middle = piece.curve.point(0.5);
            for at in [point::add(middle, aside), point::sub(middle, aside)] {
                let covering = boundaries.iter().filter(|(_, boundary)| boundary.contains(at));
                let covering: Vec<usize> = covering.map(|&(region, _)| region).collect();
                for pair in covering.windows(2).map(|pair| [pair[0], pair[1]]) {
                    if found.iter().all(|&(known, _)| known != pair) {
                        found.push((pair, at));
                    }
                }
            }
        }
        let name = |region: usize| self.regions[region].name.clone();
        found.into_iter().map(|(pair, at)| GeometryError::Overlap { regions: pair.map(name), at }).collect()
    }
}
