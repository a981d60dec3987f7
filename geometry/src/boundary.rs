//! The oriented boundary of a region, put together from the parts of its loop.

use crate::curve::Curve;
use crate::error::{Gap, GeometryError};
use crate::model::{Geometry, LoopPart, Region};
use crate::point::{self, Point};
use crate::vertices::Vertices;
use std::collections::BTreeMap;

/// Where a piece of a boundary comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// Segment of a path, by index.
    Segment {
        /// Index in [`Geometry::paths`].
        path: usize,
        /// Index in its segments.
        segment: usize,
    },
    /// The line of symmetry.
    Axis,
}

/// A curve of a boundary, directed with the region on its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// What it is.
    pub source: Source,
    /// Its shape in the direction of travel.
    pub curve: Curve,
    /// Whether that is against the direction of the path.
    pub reversed: bool,
    /// Vertices at its start and end.
    pub ends: [usize; 2],
}

impl Piece {
    fn reverse(&self) -> Piece {
        let [a, b] = self.ends;
        Piece { curve: self.curve.reversed(), reversed: !self.reversed, ends: [b, a], ..*self }
    }
}

/// Closed loops with the region on their left: outer ones counter-clockwise, holes clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// Each loop in order of travel.
    pub loops: Vec<Vec<Piece>>,
}

impl Boundary {
    /// All pieces, loop by loop.
    pub fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.loops.iter().flatten()
    }

    /// Enclosed plane area (no hoop factor).
    pub fn area(&self) -> f64 {
        self.pieces().map(|piece| piece.curve.swept_area()).sum()
    }

    /// Whether the region contains `p`; either answer on the boundary itself.
    pub fn contains(&self, p: Point) -> bool {
        winding(self.pieces(), p) != 0
    }
}

fn winding<'a>(pieces: impl IntoIterator<Item = &'a Piece>, p: Point) -> i32 {
    pieces.into_iter().map(|piece| piece.curve.winding(p)).sum()
}

impl Geometry {
    /// Puts together the boundary of the region with index `region`.
    ///
    /// # Errors
    /// Every reason why its parts form no closed loops.
    pub fn boundary(&self, region: usize) -> Result<Boundary, Vec<GeometryError>> {
        let vertices = Vertices::of(self);
        let region = &self.regions[region];
        let mut pieces = self.named_pieces(region, &vertices)?;
        if region.parts.contains(&LoopPart::Axis) {
            let closing = self.axis_pieces(&pieces, &vertices);
            pieces.extend(closing);
        }
        self.require_closed(region, &pieces, &vertices)?;
        Ok(Boundary { loops: orient(trace(pieces)) })
    }

    /// The segments that a loop names, in their own direction.
    fn named_pieces(&self, region: &Region, vertices: &Vertices) -> Result<Vec<Piece>, Vec<GeometryError>> {
        let (mut pieces, mut errors) = (Vec::new(), Vec::new());
        for part in &region.parts {
            let (path, label) = match part {
                LoopPart::Path(path) => (path, None),
                LoopPart::Segment(path, label) => (path, Some(label)),
                LoopPart::Axis if self.axisymmetric => continue,
                LoopPart::Axis => {
                    errors.push(GeometryError::NoAxis { region: region.name.clone() });
                    continue;
                }
            };
            let before = pieces.len();
            if let Some(path) = self.path_index(path) {
                for (segment, s) in self.paths[path].segments.iter().enumerate() {
                    if label.is_none() || s.label.as_ref() == label {
                        let ends = vertices.ends[path][segment];
                        let curve = s.curve.with_ends(vertices.points[ends[0]], vertices.points[ends[1]]);
                        let source = Source::Segment { path, segment };
                        pieces.push(Piece { source, curve, reversed: false, ends });
                    }
                }
            }
            if pieces.len() == before {
                let part = label.map_or(path.clone(), |label| format!("{path}.{label}"));
                errors.push(GeometryError::UnknownPart { region: region.name.clone(), part });
            }
        }
        if errors.is_empty() { Ok(pieces) } else { Err(errors) }
    }

    /// Lines on r = 0 between the free ends there, taken in pairs from below: inside, outside, inside, ...
    fn axis_pieces(&self, pieces: &[Piece], vertices: &Vertices) -> Vec<Piece> {
        let tolerance = self.tolerance();
        let mut ends = free_ends(pieces);
        ends.retain(|&v| vertices.points[v][0].abs() <= tolerance);
        ends.sort_by(|&a, &b| vertices.points[a][1].total_cmp(&vertices.points[b][1]));
        let pairs = ends.chunks_exact(2);
        pairs
            .map(|pair| {
                let curve = Curve::Line { from: vertices.points[pair[0]], to: vertices.points[pair[1]] };
                Piece { source: Source::Axis, curve, reversed: false, ends: [pair[0], pair[1]] }
            })
            .collect()
    }

    fn require_closed(
        &self,
        region: &Region,
        pieces: &[Piece],
        vertices: &Vertices,
    ) -> Result<(), Vec<GeometryError>> {
        let mut errors = self.gaps(region, pieces, vertices);
        for (vertex, touching) in incidence(pieces) {
            if touching.len() > 2 {
                let names = touching.iter().map(|&k| self.source_name(pieces[k].source)).collect();
                let at = vertices.points[vertex];
                errors.push(GeometryError::Branch { region: region.name.clone(), names, at });
            }
        }
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    /// The free ends of a loop, paired with the nearest other free end.
    fn gaps(&self, region: &Region, pieces: &[Piece], vertices: &Vertices) -> Vec<GeometryError> {
        let tolerance = self.tolerance();
        let on_axis = |v: usize| self.axisymmetric && vertices.points[v][0].abs() <= tolerance;
        let named = |v: usize| {
            let piece = pieces.iter().find(|piece| piece.ends.contains(&v));
            let name = piece.map(|piece| self.source_name(piece.source)).unwrap_or_default();
            (name, vertices.points[v])
        };
        let mut free = free_ends(pieces);
        let mut errors = Vec::new();
        while let Some(from) = free.pop() {
            let gap = |&v: &usize| point::distance(vertices.points[v], vertices.points[from]);
            let nearest = (0..free.len()).min_by(|&i, &j| gap(&free[i]).total_cmp(&gap(&free[j])));
            let to = nearest.map(|index| free.remove(index));
            errors.push(GeometryError::NotClosed {
                region: region.name.clone(),
                gap: Gap { from: named(from), to: to.map(named) },
                on_axis: on_axis(from) && to.is_some_and(on_axis),
            });
        }
        errors
    }

    /// Name of a piece for messages.
    pub(crate) fn source_name(&self, source: Source) -> String {
        match source {
            Source::Segment { path, segment } => self.segment_name(path, segment),
            Source::Axis => "axis".into(),
        }
    }
}

/// Pieces by vertex; a closed piece is listed twice at its only vertex.
fn incidence(pieces: &[Piece]) -> BTreeMap<usize, Vec<usize>> {
    let mut touching = BTreeMap::<usize, Vec<usize>>::new();
    for (k, piece) in pieces.iter().enumerate() {
        for end in piece.ends {
            touching.entry(end).or_default().push(k);
        }
    }
    touching
}

/// Vertices where only one piece ends.
fn free_ends(pieces: &[Piece]) -> Vec<usize> {
    incidence(pieces).into_iter().filter(|(_, touching)| touching.len() == 1).map(|(v, _)| v).collect()
}

/// Follows pieces whose every vertex has two ends into closed loops.
fn trace(mut pieces: Vec<Piece>) -> Vec<Vec<Piece>> {
    let mut loops = Vec::new();
    while !pieces.is_empty() {
        let mut chain = vec![pieces.remove(0)];
        let mut at = chain[0].ends[1];
        while let Some(next) = pieces.iter().position(|piece| piece.ends.contains(&at)) {
            let piece = pieces.remove(next);
            let piece = if piece.ends[0] == at { piece } else { piece.reverse() };
            at = piece.ends[1];
            chain.push(piece);
        }
        loops.push(chain);
    }
    loops
}

/// Turns loops so that what they enclose together lies on their left, holes being inside an odd number of others.
fn orient(loops: Vec<Vec<Piece>>) -> Vec<Vec<Piece>> {
    let is_hole = |index: usize| {
        let probe = loops[index][0].curve.point(0.5);
        let others = loops.iter().enumerate().filter(|&(other, _)| other != index);
        others.filter(|(_, pieces)| winding(*pieces, probe) != 0).count() % 2 == 1
    };
    let holes: Vec<bool> = (0..loops.len()).map(is_hole).collect();
    let turned = loops.into_iter().zip(holes).map(|(pieces, hole)| {
        let area: f64 = pieces.iter().map(|piece| piece.curve.swept_area()).sum();
        if (area < 0.0) == hole { pieces } else { pieces.iter().rev().map(Piece::reverse).collect() }
    });
    turned.collect()
}
