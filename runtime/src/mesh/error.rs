//! Why a mesh could not be made, as data; displayed as what, where and what now.

use super::sizing::Place;
use ansatz_geometry::{GeometryError, Point};
use std::fmt;

/// Why a mesh could not be made. Positions and lengths are in coherent model units.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshError {
    /// The geometry itself is at fault.
    Geometry(Vec<GeometryError>),
    /// A size refers to a region, path or label that does not exist.
    UnknownPlace {
        /// The place as named.
        place: Place,
    },
    /// A size is not a positive number.
    BadSize {
        /// Its value.
        size: f64,
        /// Where it should apply.
        on: Vec<Place>,
    },
    /// The size that a gap asks for is not a positive number.
    BadFilmSize {
        /// Its value.
        size: f64,
        /// The gap.
        gap: f64,
        /// Where it was found.
        at: Point,
    },
    /// The growth rate is not above 1.
    BadGrowth {
        /// Its value.
        growth: f64,
    },
    /// The sizes ask for more nodes on the boundaries than a mesh may have.
    TooFine {
        /// Path or `path.label`.
        name: String,
        /// Edges asked for on it.
        edges: f64,
    },
    /// Boundaries divided into straight edges still run into each other after all attempts at refining.
    Entangled {
        /// Where they meet.
        at: Point,
    },
    /// The surfaces around a moving region run into each other.
    Overlap {
        /// The region.
        region: String,
        /// Where they meet.
        at: Point,
    },
    /// A cell is worse than accepted after all attempts at refining.
    Quality {
        /// Region of the cell.
        region: String,
        /// Its centroid.
        at: Point,
        /// Its quality.
        found: f64,
        /// Smallest accepted.
        wanted: f64,
    },
}

impl std::error::Error for MeshError {}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use MeshError as E;
        match self {
            E::Geometry(errors) => {
                write!(f, "the geometry cannot be meshed")?;
                errors.iter().try_for_each(|error| write!(f, "\n  {error}"))
            }
            E::UnknownPlace { place } => {
                write!(f, "a mesh size is given on `{place}`, which is no region, path or path.label")
            }
            E::BadSize { size, on } => {
                let places: Vec<String> = on.iter().map(ToString::to_string).collect();
                write!(f, "the mesh size {size} on {} is not a positive length", places.join(" + "))
            }
            E::BadFilmSize { size, gap, at: [x, y] } => write!(
                f,
                "the mesh size that a gap of {gap:.3e} at ({x:.4}, {y:.4}) asks for is {size:.3e}, not a positive length; give it \
                 bounds, such as `max(0.01 um, film.gap/2)`"
            ),
            E::BadGrowth { growth } => {
                write!(f, "the mesh growth rate {growth} is not above 1; use e.g. `growth = 1.25`")
            }
            E::TooFine { name, edges } => {
                write!(f, "the mesh sizes ask for {edges:.1e} edges on `{name}`; give a larger size there")
            }
            E::Entangled { at: [x, y] } => write!(
                f,
                "boundaries near ({x:.4}, {y:.4}) are too close to each other to be meshed; give a smaller size there, or \
                 move them apart"
            ),
            E::Overlap { region, at: [x, y] } => write!(
                f,
                "the surfaces around `{region}` run into each other near ({x:.4}, {y:.4}); what keeps them apart is too weak, or the edges there are \
                 too long"
            ),
            E::Quality { region, at: [x, y], found, wanted } => write!(
                f,
                "the best mesh found has a cell of quality {found:.2} in region `{region}` near ({x:.4}, {y:.4}), below \
                 {wanted}; give a smaller size there, or accept it with `quality = {:.2}`",
                (100.0 * found).floor() / 100.0
            ),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Everywhere => write!(f, "everywhere"),
            Place::Region(name) | Place::Path(name) => write!(f, "{name}"),
            Place::Start(path) => write!(f, "{path}.start"),
            Place::End(path) => write!(f, "{path}.end"),
            Place::Segment(path, label) => write!(f, "{path}.{label}"),
            Place::Point([x, y]) => write!(f, "({x}, {y})"),
        }
    }
}
