//! Plane geometry of a model: named paths of lines and arcs, and regions bounded by loops of them.
//!
//! Plain data built from evaluated numbers in coherent model units. The compiler builds it with the default
//! parameters to check a model's `geometry` block; a simulator builds it again at run start with the actual
//! parameters, checks it and meshes it. Knows no mesh, no unit and no syntax.
//!
//! ```
//! use ansatz_geometry::{Geometry, LoopPart, PathBuilder, Region, Turn};
//!
//! let cap = PathBuilder::from("cap", [0.0, -1.0]).arc(None, [0.0, 0.0], Turn::Ccw, [0.0, 1.0]).build()?;
//! let ball = Region::new("ball", [LoopPart::path("cap"), LoopPart::Axis]);
//! let geometry = Geometry { paths: vec![cap], regions: vec![ball], axisymmetric: true };
//! assert!(geometry.check().is_empty());
//! let area = geometry.boundary(0)?.area();
//! assert!((area - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
//! # Ok::<(), Vec<ansatz_geometry::GeometryError>>(())
//! ```

mod boundary;
mod builder;
mod check;
mod curve;
mod doubt;
mod error;
mod intersect;
mod model;
pub mod point;
mod vertices;

pub use boundary::{Boundary, Piece, Source};
pub use builder::{PathBuilder, Turn, intersect_circles, polar};
pub use curve::Curve;
pub use doubt::Doubt;
pub use error::{Gap, GeometryError};
pub use intersect::{Meeting, intersect};
pub use model::{Geometry, LoopPart, Path, Region, Segment};
pub use point::Point;
pub use vertices::Vertices;
