//! How large cells should be: the rules of a model's `mesh` block, and the size field that follows from them.

use super::error::MeshError;
use ansatz_geometry::{Boundary, Curve, Geometry, Point, point};
use std::f64::consts::FRAC_PI_6;

/// Where a size applies.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    /// In the whole geometry.
    Everywhere,
    /// Within a region.
    Region(String),
    /// Along all segments of a path.
    Path(String),
    /// Along one labelled segment: path, label.
    Segment(String, String),
    /// Around the first point of a path.
    Start(String),
    /// Around the last point of a path.
    End(String),
    /// Around a point.
    Point(Point),
}

/// `size = size on a + b`: an upper bound on the length of cell edges at some places.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeRule {
    /// Edge length in coherent model units, positive.
    pub size: f64,
    /// Where it applies.
    pub on: Vec<Place>,
}

/// A model's `mesh` block.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSizing {
    /// Where several apply the smallest wins. Without one for [`Place::Everywhere`], a tenth of the diagonal does.
    pub rules: Vec<SizeRule>,
    /// Ratio of the sizes of neighbouring cells that bounds the transition between sizes, above 1.
    pub growth: f64,
    /// Smallest accepted [cell quality](super::cell_quality), between 0 and 1.
    pub quality: f64,
}

impl Default for MeshSizing {
    fn default() -> Self {
        MeshSizing { rules: Vec::new(), growth: 1.25, quality: 0.3 }
    }
}

impl MeshSizing {
    /// Upper bound on the size of cells in a region, away from everything that asks for smaller ones.
    pub(crate) fn largest_in(&self, region: &str, geometry: &Geometry) -> f64 {
        let [low, high] = geometry.bounds();
        let here = |place: &Place| *place == Place::Everywhere || *place == Place::Region(region.into());
        let rules = self.rules.iter().filter(|rule| rule.on.iter().any(here));
        rules.map(|rule| rule.size).fold(COARSEST * point::distance(low, high), f64::min)
    }
}

/// Part of the diagonal that bounds sizes where no rule applies everywhere.
const COARSEST: f64 = 0.1;

/// An edge on an arc turns by at most this angle \[rad\].
const TURN: f64 = FRAC_PI_6;

enum Shape<'a> {
    Everywhere,
    Region(&'a Boundary),
    Curves(Vec<Curve>),
    Point(Point),
}

/// Wanted edge length at every point: the smallest of `size + (growth - 1)*distance` over all places with a size.
pub(crate) struct SizeField<'a> {
    sources: Vec<(f64, Shape<'a>)>,
    slope: f64,
}

impl<'a> SizeField<'a> {
    /// The field of `sizing` for a checked geometry with one boundary per region.
    pub(crate) fn new(
        geometry: &Geometry,
        boundaries: &'a [Boundary],
        sizing: &MeshSizing,
    ) -> Result<Self, MeshError> {
        if !(sizing.growth > 1.0 && sizing.growth.is_finite()) {
            return Err(MeshError::BadGrowth { growth: sizing.growth });
        }
        let mut sources = Vec::new();
        for rule in &sizing.rules {
            if !(rule.size > 0.0 && rule.size.is_finite()) {
                return Err(MeshError::BadSize { size: rule.size, on: rule.on.clone() });
            }
            for place in &rule.on {
                sources.push((rule.size, shape(geometry, boundaries, place)?));
            }
        }
        if !sources.iter().any(|(_, shape)| matches!(shape, Shape::Everywhere)) {
            let [low, high] = geometry.bounds();
            sources.push((COARSEST * point::distance(low, high), Shape::Everywhere));
        }
        for segment in geometry.paths.iter().flat_map(|path| &path.segments) {
            if let Curve::Arc { radius, .. } = segment.curve {
                sources.push((TURN * radius, Shape::Curves(vec![segment.curve])));
            }
        }
        sources.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(SizeField { sources, slope: sizing.growth - 1.0 })
    }

    /// Sizes at points, and everywhere at most `largest`.
    pub(crate) fn around(
        points: impl IntoIterator<Item = (f64, Point)>,
        largest: f64,
        growth: f64,
    ) -> SizeField<'static> {
        let mut sources: Vec<(f64, Shape<'static>)> =
            points.into_iter().map(|(size, at)| (size, Shape::Point(at))).collect();
        sources.push((largest, Shape::Everywhere));
        sources.sort_by(|a, b| a.0.total_cmp(&b.0));
        SizeField { sources, slope: growth - 1.0 }
    }

    /// Asks for `size` around a point.
    pub(crate) fn refine(&mut self, at: Point, size: f64) {
        let rank = self.sources.partition_point(|source| source.0 < size);
        self.sources.insert(rank, (size, Shape::Point(at)));
    }

    /// Wanted edge length at `p`.
    pub(crate) fn at(&self, p: Point) -> f64 {
        let mut smallest = f64::INFINITY;
        for (size, shape) in &self.sources {
            if *size >= smallest {
                break;
            }
            smallest = smallest.min(size + self.slope * shape.distance(p));
        }
        smallest
    }
}

impl Shape<'_> {
    fn distance(&self, p: Point) -> f64 {
        let nearest = |curves: &mut dyn Iterator<Item = &Curve>| {
            curves.map(|curve| curve.distance(p)).fold(f64::INFINITY, f64::min)
        };
        match self {
            Shape::Everywhere => 0.0,
            Shape::Region(boundary) if boundary.contains(p) => 0.0,
            Shape::Region(boundary) => nearest(&mut boundary.pieces().map(|piece| &piece.curve)),
            Shape::Curves(curves) => nearest(&mut curves.iter()),
            Shape::Point(at) => point::distance(*at, p),
        }
    }
}

fn shape<'a>(geometry: &Geometry, boundaries: &'a [Boundary], place: &Place) -> Result<Shape<'a>, MeshError> {
    let unknown = || MeshError::UnknownPlace { place: place.clone() };
    let curves = |name: &str, label: Option<&String>| {
        let path = geometry.paths.iter().find(|path| path.name == name).ok_or_else(unknown)?;
        let named = path.segments.iter().filter(|s| label.is_none() || s.label.as_ref() == label);
        let curves: Vec<Curve> = named.map(|segment| segment.curve).collect();
        if curves.is_empty() { Err(unknown()) } else { Ok(Shape::Curves(curves)) }
    };
    let ends = |name: &str| {
        let path = geometry.paths.iter().find(|path| path.name == name).ok_or_else(unknown)?;
        let (first, last) = path.segments.first().zip(path.segments.last()).ok_or_else(unknown)?;
        Ok([first.curve.start(), last.curve.end()])
    };
    match place {
        Place::Everywhere => Ok(Shape::Everywhere),
        Place::Region(name) => {
            let region = geometry.regions.iter().position(|region| region.name == *name);
            region.map(|region| Shape::Region(&boundaries[region])).ok_or_else(unknown)
        }
        Place::Path(name) => curves(name, None),
        Place::Segment(name, label) => curves(name, Some(label)),
        Place::Start(name) => ends(name).map(|[start, _]| Shape::Point(start)),
        Place::End(name) => ends(name).map(|[_, end]| Shape::Point(end)),
        Place::Point(at) => Ok(Shape::Point(*at)),
    }
}
