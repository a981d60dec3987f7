//! Quadrature points on paths as seen from the cells on one side, where gradients and normals have one value.

use super::place::Place;
use crate::error::Error;
use crate::mesh::{CellEdge, Mesh, PathEdge};
use ansatz_elements::{Cell, Element, quadrature};

/// Degree of the rule on each edge.
const DEGREE: usize = 7;

/// A quadrature point on an edge of a cell.
pub struct SidePoint {
    /// Where it is.
    pub place: Place,
    /// Unit normal out of the cell.
    pub normal: [f64; 2],
    /// Quadrature weight times the measure there.
    pub weight: f64,
}

/// The points of all edges of paths, each seen from its cell in one of the regions.
///
/// # Errors
/// [`Error::Model`] if an edge has none of the regions on its sides, or two.
pub fn side_points(
    mesh: &Mesh,
    paths: &[&str],
    regions: &[&str],
    weight: fn([f64; 2]) -> f64,
) -> Result<Vec<SidePoint>, Error> {
    let mut points = Vec::new();
    for path in paths {
        for edge in mesh.path_edges(path) {
            let side = one_side(mesh, edge, regions).ok_or_else(|| {
                let regions = regions.join(", ");
                Error::Model(format!("`{path}` has edges that do not have exactly one side in {regions}"))
            })?;
            points_of(mesh, edge, side, weight, &mut points);
        }
    }
    Ok(points)
}

fn one_side(mesh: &Mesh, edge: &PathEdge, regions: &[&str]) -> Option<CellEdge> {
    let wanted = |side: &CellEdge| {
        let region = &mesh.regions[mesh.cell_region[side.cell as usize] as usize];
        regions.contains(&region.as_str())
    };
    match (edge.left.filter(wanted), edge.right.filter(wanted)) {
        (Some(side), None) | (None, Some(side)) => Some(side),
        _ => None,
    }
}

fn points_of(
    mesh: &Mesh,
    path: &PathEdge,
    side: CellEdge,
    weight: fn([f64; 2]) -> f64,
    points: &mut Vec<SidePoint>,
) {
    let (cell, edge) = (side.cell as usize, usize::from(side.edge));
    let nodes = mesh.cells[cell];
    let along = [nodes[edge], nodes[(edge + 1) % 3], nodes[3 + edge]].map(|n| mesh.nodes[n as usize]);
    let corners = Element::P1_TRIANGLE.nodes();
    let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
    let mut slopes = [0.0; 3];
    // Segments have rules of this degree.
    for (s, part) in quadrature(Cell::Segment, DEGREE).iter().flat_map(|rule| rule.iter()) {
        let local = [0, 1].map(|i| from[i] + s[0] * (to[i] - from[i]));
        Element::P2_SEGMENT.gradients(s, &mut slopes);
        let tangent = [0, 1].map(|i| (0..3).map(|k| slopes[k] * along[k][i]).sum::<f64>());
        let length = tangent[0].hypot(tangent[1]);
        let on_path = if along[0] == mesh.nodes[path.nodes[0] as usize] { s[0] } else { 1.0 - s[0] };
        let shape = Place::on_edge(mesh, path.nodes, on_path).path;
        let place = Place::in_cell(mesh, cell, local).on_path(shape);
        let weight = part * length * weight(place.x);
        points.push(SidePoint { normal: [tangent[1] / length, -tangent[0] / length], weight, place });
    }
}
