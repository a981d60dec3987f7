//! The cells of a moving region, from when they are made until they have become too flat.

use super::motion::Motion;
use super::quality::cell_quality;
use super::{Mesh, MeshPath, PathEdge};
use crate::solve::linear::LinearError;
use ansatz_geometry::{Point, point};

/// The cells of a region as they were made.
pub(super) struct Filling {
    /// The region by itself; its surfaces are the first of its paths, pieces of the axis follow.
    mesh: Mesh,
    /// Its first node in the whole mesh.
    pub(super) first_node: usize,
    /// Sizes wanted at the points of its outline.
    pub(super) sizes: Vec<f64>,
    motion: Motion,
}

impl Filling {
    /// Prepares the motion of a region that was just meshed by itself, whose nodes start at `first_node` in the whole mesh.
    ///
    /// # Errors
    /// The motion cannot be computed.
    pub(super) fn new(mesh: Mesh, first_node: usize, sizes: Vec<f64>) -> Result<Self, LinearError> {
        let motion = Motion::new(&mesh)?;
        Ok(Self { mesh, first_node, sizes, motion })
    }

    /// Its nodes when those on each surface, edge by edge, have gone to `positions`; none where a cell would be of less than a given quality.
    pub(super) fn moved<'a>(
        &mut self,
        surfaces: impl Iterator<Item = &'a [PathEdge]>,
        positions: &[Point],
        quality: f64,
    ) -> Option<Vec<Point>> {
        let mut places = vec![None; self.mesh.nodes.len()];
        let mut paths = self.mesh.paths.iter();
        for (edges, own) in surfaces.zip(paths.by_ref()) {
            for (edge, own) in edges.iter().zip(&own.edges) {
                (0..3).for_each(|k| places[own.nodes[k] as usize] = Some(positions[edge.nodes[k] as usize]));
            }
        }
        paths.for_each(|axis| stretch(axis, &self.mesh.nodes, &mut places));
        let nodes = self.follow(&places).ok()?;
        let flat = |cell: &[u32; 6]| cell_quality(&cell.map(|node| nodes[node as usize])) < quality;
        (!self.mesh.cells.iter().any(flat)).then_some(nodes)
    }

    /// All nodes, where some places are given: vertices by the motion, middles of other edges half-way.
    fn follow(&mut self, places: &[Option<Point>]) -> Result<Vec<Point>, LinearError> {
        let nodes = &self.mesh.nodes;
        let displacement =
            |(place, &start): (&Option<Point>, &Point)| place.map_or([0.0; 2], |p| point::sub(p, start));
        let vertices = self.mesh.vertex_count;
        let mut displacements: Vec<Point> = places[..vertices].iter().zip(nodes).map(displacement).collect();
        self.motion.extend(&mut displacements)?;
        let mut moved: Vec<Point> =
            nodes.iter().zip(&displacements).map(|(&x, &u)| point::add(x, u)).collect();
        moved.resize(nodes.len(), [0.0; 2]);
        for cell in &self.mesh.cells {
            for edge in 0..3 {
                let [a, b, middle] =
                    [cell[edge], cell[(edge + 1) % 3], cell[3 + edge]].map(|node| node as usize);
                moved[middle] = places[middle].unwrap_or_else(|| point::lerp(moved[a], moved[b], 0.5));
            }
        }
        Ok(moved)
    }
}

/// Places of the nodes on a piece of the axis, whose ends have places already: each keeps its share of the length.
fn stretch(axis: &MeshPath, nodes: &[Point], places: &mut [Option<Point>]) {
    let [Some(first), Some(last)] = [axis.edges.first(), axis.edges.last()] else { return };
    let ends = [first.nodes[0], last.nodes[1]].map(|node| node as usize);
    let [Some(from), Some(to)] = ends.map(|end| places[end]) else { return };
    let [start, length] = [nodes[ends[0]], point::sub(nodes[ends[1]], nodes[ends[0]])];
    for node in axis.edges.iter().flat_map(|edge| edge.nodes).map(|node| node as usize) {
        let share = point::dot(point::sub(nodes[node], start), length) / point::dot(length, length);
        places[node] = Some(point::lerp(from, to, share));
    }
}
