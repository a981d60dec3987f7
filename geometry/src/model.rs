//! Paths, regions and the whole geometry, as named data.

use crate::curve::Curve;
use crate::point::{self, Point};

/// One line or arc of a path, with the label a model gave it.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Label within the path, e.g. `rim` of `endo.rim`.
    pub label: Option<String>,
    /// Its shape.
    pub curve: Curve,
}

/// A named chain of segments, each starting where the one before it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Name in the model.
    pub name: String,
    /// The chain, at least one segment.
    pub segments: Vec<Segment>,
}

/// One entry of a region's loop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LoopPart {
    /// A whole path.
    Path(String),
    /// One labelled segment: path, label.
    Segment(String, String),
    /// The line of symmetry r = 0, wherever the rest of the loop leaves a gap on it. Axisymmetric models only.
    Axis,
}

impl LoopPart {
    /// The whole path `name`.
    pub fn path(name: &str) -> Self {
        LoopPart::Path(name.into())
    }

    /// The segment `path.label`.
    pub fn segment(path: &str, label: &str) -> Self {
        LoopPart::Segment(path.into(), label.into())
    }
}

/// A named region: what its loop encloses. Paths may be listed in any order and direction; closed loops within
/// closed loops are holes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Region {
    /// Name in the model.
    pub name: String,
    /// What bounds it.
    pub parts: Vec<LoopPart>,
}

impl Region {
    /// Region `name` within a loop of `parts`.
    pub fn new(name: &str, parts: impl IntoIterator<Item = LoopPart>) -> Self {
        Region { name: name.into(), parts: parts.into_iter().collect() }
    }
}

/// The whole geometry of a model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Geometry {
    /// Paths in the order of the model.
    pub paths: Vec<Path>,
    /// Regions in the order of the model.
    pub regions: Vec<Region>,
    /// Whether the first coordinate is a distance r from the axis of symmetry.
    pub axisymmetric: bool,
}

/// Distance below which two points count as one, as a part of the geometry's diagonal.
const TOLERANCE: f64 = 1e-9;

impl Geometry {
    /// Smallest box around all finite curves: `[lower left, upper right]`; see [`point::bounds`].
    pub fn bounds(&self) -> [Point; 2] {
        let boxes: Vec<[Point; 2]> =
            self.curves().filter(|curve| curve.is_finite()).map(Curve::bounds).collect();
        point::bounds(boxes.as_flattened())
    }

    /// Distance below which two points count as one.
    pub fn tolerance(&self) -> f64 {
        let [low, high] = self.bounds();
        TOLERANCE * point::distance(low, high)
    }

    /// The index of the path `name`.
    pub fn path_index(&self, name: &str) -> Option<usize> {
        self.paths.iter().position(|path| path.name == name)
    }

    /// `path` or `path.label` of a segment, for messages.
    pub fn segment_name(&self, path: usize, segment: usize) -> String {
        let owner = &self.paths[path];
        match &owner.segments[segment].label {
            Some(label) => format!("{}.{label}", owner.name),
            None => owner.name.clone(),
        }
    }

    fn curves(&self) -> impl Iterator<Item = &Curve> {
        self.paths.iter().flat_map(|path| path.segments.iter().map(|segment| &segment.curve))
    }
}
