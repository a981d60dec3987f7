//! Divides the curves of a geometry into edges that follow the size field.
//!
//! A curve of length l gets n edges, n being the integral of 1/size along it, rounded; each edge takes an equal share
//! of that integral. Nodes are therefore as smooth and as symmetric as the size field.

use super::error::MeshError;
use super::sizing::SizeField;
use ansatz_geometry::{Boundary, Curve, Geometry, Point, Source, Vertices};
use std::collections::BTreeMap;
use std::ops::Range;

/// The edges of one segment of a path, or of one piece of the axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chain {
    /// Name of the path; `axis` for the line of symmetry.
    pub(crate) path: String,
    /// Label of the segment.
    pub(crate) label: Option<String>,
    /// Indices of the points along it, one more than edges.
    pub(crate) points: Vec<usize>,
    /// The point on the curve half-way along each edge.
    pub(crate) middles: Vec<Point>,
    /// Regions left and right of it in its own direction.
    pub(crate) sides: [Option<u16>; 2],
}

impl Chain {
    /// Point indices of each edge.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [usize; 2]> {
        self.points.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// Whether it bounds a region.
    pub(crate) fn is_boundary(&self) -> bool {
        self.sides != [None, None]
    }
}

/// All divided curves: those that bound regions first.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Outline {
    /// Points on the curves; those on boundaries of regions first.
    pub(crate) points: Vec<Point>,
    /// How many of them lie on boundaries of regions.
    pub(crate) boundary_points: usize,
    /// In the order of the geometry, the axis last.
    pub(crate) chains: Vec<Chain>,
    /// `corners[vertex]` = point index of a vertex of the geometry.
    pub(crate) corners: Vec<usize>,
}

/// A curve to divide.
struct Span {
    path: String,
    label: Option<String>,
    curve: Curve,
    ends: [usize; 2],
    sides: [Option<u16>; 2],
}

/// Most edges on one curve.
const EDGE_LIMIT: f64 = 1e6;

impl Outline {
    /// Divides all curves of a checked geometry with one boundary per region.
    pub(crate) fn new(
        geometry: &Geometry,
        boundaries: &[Boundary],
        field: &SizeField<'_>,
    ) -> Result<Self, MeshError> {
        let vertices = Vertices::of(geometry);
        let spans = spans(geometry, boundaries, &vertices);
        let mut outline = Outline { corners: vec![usize::MAX; vertices.points.len()], ..Outline::default() };
        let mut chains: Vec<Option<Chain>> = spans.iter().map(|_| None).collect();
        for boundary_pass in [true, false] {
            for (span, chain) in spans.iter().zip(&mut chains) {
                if (span.sides != [None, None]) == boundary_pass {
                    *chain = Some(outline.divide(span, &vertices.points, field)?);
                }
            }
            if boundary_pass {
                outline.boundary_points = outline.points.len();
            }
        }
        outline.chains = chains.into_iter().flatten().collect();
        Ok(outline)
    }

    fn divide(&mut self, span: &Span, vertices: &[Point], field: &SizeField<'_>) -> Result<Chain, MeshError> {
        let name = || span.label.as_ref().map_or(span.path.clone(), |label| format!("{}.{label}", span.path));
        let mut points = vec![self.corner(span.ends[0], vertices)];
        let (inner, middles) = self.divide_curve(&span.curve, field, &name)?;
        points.extend(inner);
        points.push(self.corner(span.ends[1], vertices));
        Ok(Chain { path: span.path.clone(), label: span.label.clone(), points, middles, sides: span.sides })
    }

    /// Adds the points between the ends of a curve: their indices, and the middles of all its edges.
    pub(crate) fn divide_curve(
        &mut self,
        curve: &Curve,
        field: &SizeField<'_>,
        name: &dyn Fn() -> String,
    ) -> Result<(Range<usize>, Vec<Point>), MeshError> {
        let cuts = cuts(curve, field).map_err(|edges| MeshError::TooFine { name: name(), edges })?;
        let first = self.points.len();
        self.points.extend(cuts[1..cuts.len() - 1].iter().map(|&s| curve.point(s)));
        let middles = cuts.windows(2).map(|pair| curve.point(0.5 * (pair[0] + pair[1]))).collect();
        Ok((first..self.points.len(), middles))
    }

    /// The point of a vertex of the geometry, added on its first use.
    fn corner(&mut self, vertex: usize, vertices: &[Point]) -> usize {
        if self.corners[vertex] == usize::MAX {
            self.corners[vertex] = self.points.len();
            self.points.push(vertices[vertex]);
        }
        self.corners[vertex]
    }
}

/// Every segment of every path, then every piece of the axis, with the regions beside it.
fn spans(geometry: &Geometry, boundaries: &[Boundary], vertices: &Vertices) -> Vec<Span> {
    let mut sides = BTreeMap::<Source, [Option<u16>; 2]>::new();
    let mut axis = Vec::new();
    for (region, piece) in
        boundaries.iter().enumerate().flat_map(|(k, b)| b.pieces().map(move |piece| (k, piece)))
    {
        match piece.source {
            Source::Axis => axis.push((region as u16, piece)),
            source => sides.entry(source).or_default()[usize::from(piece.reversed)] = Some(region as u16),
        }
    }
    axis.sort_by(|(_, a), (_, b)| a.curve.start()[1].total_cmp(&b.curve.start()[1]));
    let mut spans = Vec::new();
    for (p, path) in geometry.paths.iter().enumerate() {
        for (s, segment) in path.segments.iter().enumerate() {
            let sides = sides.get(&Source::Segment { path: p, segment: s }).copied().unwrap_or_default();
            spans.push(Span {
                path: path.name.clone(),
                label: segment.label.clone(),
                curve: segment.curve,
                ends: vertices.ends[p][s],
                sides,
            });
        }
    }
    // A region keeps its part of the axis on its left, so the pieces run downwards and the axis is listed upwards.
    spans.extend(axis.into_iter().map(|(region, piece)| Span {
        path: "axis".into(),
        label: None,
        curve: piece.curve.reversed(),
        ends: [piece.ends[1], piece.ends[0]],
        sides: [None, Some(region)],
    }));
    spans
}

/// Parameters 0 = s_0 < ... < s_n = 1 of the division of a curve, or the number of edges if there are too many.
fn cuts(curve: &Curve, field: &SizeField<'_>) -> Result<Vec<f64>, f64> {
    let sample = |count: usize| -> Vec<f64> {
        (0..=count).map(|k| curve.length() / field.at(curve.point(k as f64 / count as f64))).collect()
    };
    let densest = sample(64).into_iter().fold(0.0, f64::max);
    if densest > EDGE_LIMIT {
        return Err(densest);
    }
    let density = sample((4.0 * densest).ceil().max(64.0) as usize);
    let step = 1.0 / (density.len() - 1) as f64;
    let mut total = vec![0.0];
    for pair in density.windows(2) {
        total.push(total[total.len() - 1] + 0.5 * step * (pair[0] + pair[1]));
    }
    let sum = total[total.len() - 1];
    let edges = sum.round().max(1.0) as usize;
    let inner = (1..edges).map(|k| {
        let share = sum * k as f64 / edges as f64;
        let above = total.partition_point(|&t| t < share);
        let (low, high) = (total[above - 1], total[above]);
        (above as f64 - (high - share) / (high - low)) * step
    });
    Ok(std::iter::once(0.0).chain(inner).chain([1.0]).collect())
}
