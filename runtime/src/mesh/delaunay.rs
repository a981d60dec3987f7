//! A constrained Delaunay triangulation of a divided outline whose cells know their region.

use super::outline::Outline;
use ansatz_geometry::{Point, point};
use spade::handles::{FixedFaceHandle, FixedVertexHandle, InnerTag};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};
use std::collections::BTreeMap;

pub(crate) type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;
pub(crate) type Face = FixedFaceHandle<InnerTag>;

/// Edges of the outline, smaller point index first, with the regions left and right.
pub(crate) type Edges = BTreeMap<[usize; 2], [Option<u16>; 2]>;

/// A place where an outline is divided too coarsely to be triangulated, and the length of its edges there.
pub(crate) type TooCoarse = (Point, f64);

/// The edges of an outline that bound regions.
///
/// # Errors
/// Where two edges join the same points.
pub(crate) fn outline_edges(outline: &Outline) -> Result<Edges, TooCoarse> {
    let mut edges = Edges::new();
    for chain in outline.chains.iter().filter(|chain| chain.is_boundary()) {
        let [left, right] = chain.sides;
        for [a, b] in chain.edges() {
            let (key, sides) = if a < b { ([a, b], [left, right]) } else { ([b, a], [right, left]) };
            if a == b || edges.insert(key, sides).is_some() {
                return Err(place(&outline.points, [a, b]));
            }
        }
    }
    Ok(edges)
}

/// The constrained Delaunay triangulation; vertices keep their order.
///
/// # Errors
/// Where edges cross each other or run through a point.
pub(crate) fn delaunay(points: &[Point], edges: &Edges) -> Result<Delaunay, TooCoarse> {
    let vertices: Vec<Point2<f64>> = points.iter().map(|&[x, y]| Point2::new(x, y)).collect();
    let mut crossing = None;
    let mesh = Delaunay::try_bulk_load_cdt(vertices, edges.keys().copied().collect(), |edge| {
        crossing.get_or_insert(edge);
    });
    let Ok(mesh) = mesh else { return Err(place(points, [0, points.len() - 1])) };
    let missing =
        || edges.keys().find(|edge| !mesh.exists_constraint(handle(edge[0]), handle(edge[1]))).copied();
    match crossing.or_else(missing) {
        None => Ok(mesh),
        Some(edge) => Err(place(points, edge)),
    }
}

/// The triangles within regions: their vertices counter-clockwise and their region.
pub(crate) fn cells(mesh: &Delaunay, edges: &Edges) -> Vec<([usize; 3], u16)> {
    let regions = face_regions(mesh, edges);
    let inner = mesh.inner_faces();
    inner.filter_map(|face| Some((corners(mesh, face.fix()), regions[face.index()]?))).collect()
}

/// Region of every face by its index, spread from the outline across all other edges.
pub(crate) fn face_regions(mesh: &Delaunay, edges: &Edges) -> Vec<Option<u16>> {
    let mut regions = vec![None; mesh.num_all_faces()];
    let mut pending = Vec::new();
    for (&[a, b], sides) in edges {
        let Some(edge) = mesh.get_edge_from_neighbors(handle(a), handle(b)) else { continue };
        for (edge, side) in [(edge, sides[0]), (edge.rev(), sides[1])] {
            if let (Some(face), Some(region)) = (edge.face().as_inner(), side) {
                pending.push((face.fix(), region));
            }
        }
    }
    while let Some((face, region)) = pending.pop() {
        if regions[face.index()].replace(region).is_none() {
            let open = mesh.face(face).adjacent_edges().into_iter().filter(|edge| !edge.is_constraint_edge());
            pending.extend(open.filter_map(|edge| Some((edge.rev().face().as_inner()?.fix(), region))));
        }
    }
    regions
}

/// Vertex indices of a face.
pub(crate) fn corners(mesh: &Delaunay, face: Face) -> [usize; 3] {
    mesh.face(face).vertices().map(|vertex| vertex.index())
}

fn handle(index: usize) -> FixedVertexHandle {
    FixedVertexHandle::from_index(index)
}

fn place(points: &[Point], [a, b]: [usize; 2]) -> TooCoarse {
    (point::lerp(points[a], points[b], 0.5), point::distance(points[a], points[b]))
}
