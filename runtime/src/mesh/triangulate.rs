//! Triangulates a divided outline: Delaunay, advancing front, smoothing. Points on the outline stay as divided.

use super::delaunay::{TooCoarse, cells, delaunay, outline_edges};
use super::front::advance;
use super::outline::Outline;
use super::sizing::SizeField;
use super::smooth::smooth;
use ansatz_geometry::Point;
use spade::Triangulation as _;

/// Straight triangles with their regions.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Triangles {
    /// Boundary points of the outline, then inner ones.
    pub(crate) points: Vec<Point>,
    /// Vertices of each triangle, counter-clockwise, and its region.
    pub(crate) cells: Vec<([usize; 3], u16)>,
}

/// Rounds of smoothing, each followed by a new triangulation of the moved points.
const SMOOTHING: usize = 4;

/// Fills the regions within `outline` with triangles that follow the size field.
pub(crate) fn triangulate(outline: &Outline, field: &SizeField<'_>) -> Result<Triangles, TooCoarse> {
    let edges = outline_edges(outline)?;
    let mut mesh = delaunay(&outline.points[..outline.boundary_points], &edges)?;
    advance(&mut mesh, &edges, field);
    let mut points: Vec<Point> = mesh.vertices().map(|vertex| vertex.position().into()).collect();
    for _ in 0..SMOOTHING {
        smooth(&mut points, outline.boundary_points, &cells(&mesh, &edges), field);
        mesh = delaunay(&points, &edges)?;
    }
    Ok(Triangles { cells: cells(&mesh, &edges), points })
}
