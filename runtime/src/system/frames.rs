//! Field frames: pointwise functions at the nodes of regions or paths, averaged over the elements that meet at a node.

use super::place::Place;
use super::point::Sampler;
use super::terms::At;
use super::unknowns::{Unknowns, domain_nodes, path_edges, region_cells};
use crate::error::Error;
use crate::generated::{Domain, Frames};
use crate::mesh::Mesh;

/// Samples the columns of one frame.
pub struct FrameSampler {
    sampler: Sampler,
    /// Places with the position of their node in the frame's nodes.
    places: Vec<(usize, Place)>,
    /// Elements that meet at each node.
    meeting: Vec<f64>,
    /// (first output, components) of each column.
    columns: Vec<(usize, usize)>,
}

impl FrameSampler {
    /// Prepares a frame. Its nodes are the mesh nodes of its domain in ascending order.
    pub fn new(frames: &'static Frames, mesh: &Mesh) -> Result<Self, Error> {
        let nodes = domain_nodes(mesh, frames.domain)?;
        let mut places = Vec::new();
        let mut meeting = vec![0.0; nodes.len()];
        let mut visit = |node: u32, place: Place| {
            if let Ok(position) = nodes.binary_search(&node) {
                places.push((position, place));
                meeting[position] += 1.0;
            }
        };
        match frames.domain {
            Domain::Cells(regions) => {
                for region in regions {
                    for cell in region_cells(mesh, region)? {
                        (0..6).for_each(|k| visit(mesh.cells[cell][k], Place::at_cell_node(mesh, cell, k)));
                    }
                }
            }
            Domain::Edges(paths) | Domain::Ends(paths) => {
                for path in paths {
                    for edge in path_edges(mesh, path)? {
                        (0..3).for_each(|k| visit(edge[k], Place::at_edge_node(mesh, edge, k)));
                    }
                }
            }
        }
        let columns = frames.columns.iter().map(|c| (c.offset, c.components)).collect();
        Ok(Self { sampler: Sampler::new(&frames.function, mesh), places, meeting, columns })
    }

    /// Node values of each column, node by node, component by component (internal units).
    pub fn sample(&mut self, unknowns: &Unknowns, at: At<'_>) -> Vec<Vec<f64>> {
        let count = self.meeting.len();
        let mut values: Vec<Vec<f64>> = self.columns.iter().map(|(_, n)| vec![0.0; n * count]).collect();
        let mut out = vec![0.0; self.sampler.outputs()];
        for (position, place) in &self.places {
            self.sampler.evaluate(unknowns, place, at, &mut out);
            for (column, &(offset, n)) in values.iter_mut().zip(&self.columns) {
                for i in 0..n {
                    column[position * n + i] += out[offset + i] / self.meeting[*position];
                }
            }
        }
        values
    }
}
