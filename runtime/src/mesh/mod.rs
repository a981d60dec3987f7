//! Meshes of curved quadratic triangles: made from a geometry and a size field, structured for tests, or from triangles made elsewhere.
//!
//! From a checked [`Geometry`] to a [`Mesh`]: `sizing` gives the wanted edge length at every point, `outline` divides
//! the curves by it, `triangulate` fills the regions (`delaunay`, `front`, `smooth`), `assemble` adds mid-edge nodes
//! and numbers everything for locality. Knows no field and no equation. The same input gives the same mesh, bit by
//! bit.
//!
//! [`Geometry`]: ansatz_geometry::Geometry

mod assemble;
mod delaunay;
mod error;
mod filling;
mod film;
mod follow;
mod front;
mod generate;
mod hilbert;
mod locate;
mod motion;
mod outline;
mod quality;
mod sizing;
mod smooth;
mod structured;
#[cfg(test)]
mod tests;
mod triangles;
mod triangulate;

pub use error::MeshError;
pub use film::FilmSize;
pub use follow::Follower;
pub use locate::Locator;
pub use quality::{QualityStatistics, cell_quality};
pub use sizing::{MeshSizing, Place, SizeRule};
pub use structured::structured_rectangle;
pub use triangles::mesh_of_triangles;

use ansatz_geometry::Point;
use std::ops::Range;

/// A conforming mesh of quadratic triangles.
///
/// Node order within a cell: vertices 0, 1, 2 counter-clockwise, then the middles of the edges 01, 12, 20. Mid-edge
/// nodes lie on the curve, half-way by arc length, where the edge is part of a path; else in the middle.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Positions: first all vertices, then all mid-edge nodes, each in the order in which the cells use them.
    pub nodes: Vec<Point>,
    /// How many of the nodes are vertices.
    pub vertex_count: usize,
    /// Nodes of each cell, grouped by region and along a Hilbert curve within each.
    pub cells: Vec<[u32; 6]>,
    /// Region of each cell, an index into `regions`; never decreasing.
    pub cell_region: Vec<u16>,
    /// Region names.
    pub regions: Vec<String>,
    /// Each segment of each path in the order of the geometry, then the pieces of the `axis` from below; then those of each moving region.
    pub paths: Vec<MeshPath>,
    /// Node at each [vertex](ansatz_geometry::Vertices) of the geometry.
    pub corners: Vec<u32>,
    /// How many of the cells are those of bodies, in their reference shape; those of [moving regions](Follower), in their present one, follow.
    pub body_cells: usize,
    /// How many of the nodes are those of bodies.
    pub body_nodes: usize,
    /// Nodes of moving regions on the surface of bodies, ascending, each with the body's node.
    pub links: Vec<[u32; 2]>,
}

/// The edges along one segment of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPath {
    /// Name of the path.
    pub path: String,
    /// Label of the segment.
    pub label: Option<String>,
    /// The moving region whose nodes the edges have; none for those of bodies.
    pub seen_from: Option<String>,
    /// Edges in the direction of the path, each starting where the one before it ends.
    pub edges: Vec<PathEdge>,
}

/// A quadratic edge on a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PathEdge {
    /// Start, end and middle node, in the direction of the path.
    pub nodes: [u32; 3],
    /// The cell left of it; none on the outside, both none where the path bounds no region.
    pub left: Option<CellEdge>,
    /// The cell right of it.
    pub right: Option<CellEdge>,
}

/// An edge as part of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellEdge {
    /// Index of the cell.
    pub cell: u32,
    /// 0, 1 or 2: from vertex `edge` to the next one.
    pub edge: u8,
}

impl Mesh {
    /// Edges of `path`, `path.label` or `axis` in the direction of the path, those of a moving region as `region/path`; empty where there is no
    /// such path.
    pub fn path_edges(&self, name: &str) -> impl Iterator<Item = &PathEdge> {
        let (seen_from, name) =
            name.split_once('/').map_or((None, name), |(region, name)| (Some(region), name));
        let (path, label) = name.split_once('.').map_or((name, None), |(path, label)| (path, Some(label)));
        let named = self.paths.iter().filter(move |segment| {
            segment.path == path
                && segment.seen_from.as_deref() == seen_from
                && (label.is_none() || segment.label.as_deref() == label)
        });
        named.flat_map(|segment| &segment.edges)
    }

    /// The bodies alone, without moving regions.
    pub fn bodies(&self) -> Mesh {
        let regions = self.cell_region[..self.body_cells].last().map_or(0, |&last| usize::from(last) + 1);
        let of_bodies = |path: &&MeshPath| path.seen_from.is_none();
        let paths: Vec<MeshPath> = self.paths.iter().filter(of_bodies).cloned().collect();
        Mesh {
            nodes: self.nodes[..self.body_nodes].to_vec(),
            vertex_count: self.vertex_count,
            cells: self.cells[..self.body_cells].to_vec(),
            cell_region: self.cell_region[..self.body_cells].to_vec(),
            regions: self.regions[..regions].to_vec(),
            paths,
            corners: self.corners.clone(),
            body_cells: self.body_cells,
            body_nodes: self.body_nodes,
            links: Vec::new(),
        }
    }

    /// Cells of a region; empty where there is no such region.
    pub fn region_cells(&self, name: &str) -> Range<usize> {
        match self.regions.iter().position(|region| region == name) {
            None => 0..0,
            Some(region) => {
                let bound = |region: usize| self.cell_region.partition_point(|&r| usize::from(r) < region);
                bound(region)..bound(region + 1)
            }
        }
    }

    /// Positions of the six nodes of a cell.
    pub fn cell_nodes(&self, cell: usize) -> [Point; 6] {
        self.cells[cell].map(|node| self.nodes[node as usize])
    }

    /// Plane area of a region with its curved edges (no hoop factor).
    pub fn region_area(&self, name: &str) -> f64 {
        self.region_cells(name).map(|cell| quality::curved_area(&self.cell_nodes(cell))).sum()
    }

    /// The node closest to `p`.
    pub fn nearest_node(&self, p: Point) -> Option<u32> {
        let far = |node: &Point| ansatz_geometry::point::distance(*node, p);
        let nearest =
            (0..self.nodes.len()).min_by(|&a, &b| far(&self.nodes[a]).total_cmp(&far(&self.nodes[b])));
        nearest.map(|node| node as u32)
    }

    /// Worst and mean [`cell_quality`].
    pub fn quality(&self) -> QualityStatistics {
        let qualities = (0..self.cells.len()).map(|cell| cell_quality(&self.cell_nodes(cell)));
        let mut statistics = QualityStatistics { smallest: f64::INFINITY, worst_cell: 0, mean: 0.0 };
        for (cell, quality) in qualities.enumerate() {
            statistics.mean += quality / self.cells.len() as f64;
            if quality < statistics.smallest {
                (statistics.smallest, statistics.worst_cell) = (quality, cell);
            }
        }
        statistics
    }
}
