//! Pointwise functions of the fields: values at nodes (frames, smallest and largest values) and at given points.

use super::place::Place;
use super::terms::At;
use super::unknowns::{Unknowns, domain_nodes, path_edges, region_cells};
use crate::error::Error;
use crate::generated::{Derivative, Domain, PointFunction};
use crate::mesh::{Locator, Mesh};

/// A pointwise function on a mesh: knows which of its regions each cell belongs to.
pub struct Sampler {
    function: &'static PointFunction,
    /// Position of each mesh region in the function's list, or none.
    region: Vec<Option<usize>>,
    inputs: Vec<f64>,
}

impl Sampler {
    /// Prepares a function for a mesh.
    pub fn new(function: &'static PointFunction, mesh: &Mesh) -> Self {
        let position = |name: &String| function.regions.iter().position(|r| r == name);
        Self { function, region: mesh.regions.iter().map(position).collect(), inputs: Vec::new() }
    }

    /// Number of results.
    pub fn outputs(&self) -> usize {
        self.function.outputs
    }

    /// Evaluates at a place; `out` has the function's number of outputs.
    pub fn evaluate(&mut self, unknowns: &Unknowns, place: &Place, at: At<'_>, out: &mut [f64]) {
        self.evaluate_with(unknowns, place, &[], at, out);
    }

    /// Evaluates at a place with further inputs behind those of the fields.
    pub fn evaluate_with(
        &mut self,
        unknowns: &Unknowns,
        place: &Place,
        further: &[f64],
        at: At<'_>,
        out: &mut [f64],
    ) {
        self.inputs.clear();
        for &input in self.function.inputs {
            let from = if input.rate { at.rates } else { at.y };
            self.inputs.push(place.weights(input, unknowns).map(|(u, w)| w * from[u]).sum());
        }
        self.inputs.extend_from_slice(further);
        self.inputs.extend_from_slice(place.path.as_flattened());
        let region = place.region.and_then(|region| self.region[region]).unwrap_or(0);
        (self.function.evaluate)(region, place.x, &self.inputs, at.g, out);
    }

    /// Adds the gradient of output 0 with respect to the unknowns, given its derivatives by the inputs.
    pub fn add_gradient(&self, unknowns: &Unknowns, place: &Place, derivatives: &[f64], sum: &mut [f64]) {
        for (&input, d) in self.function.inputs.iter().zip(derivatives) {
            if !input.rate {
                place.weights(input, unknowns).for_each(|(u, w)| sum[u] += d * w);
            }
        }
    }
}

/// One place per node of a domain: in the first of its cells or edges that has the node. On edges, a function that reads gradients looks from
/// the first cell of the mesh that has it.
pub fn node_places(mesh: &Mesh, domain: Domain, function: &PointFunction) -> Result<Vec<Place>, Error> {
    let mut wanted = vec![false; mesh.nodes.len()];
    domain_nodes(mesh, domain)?.iter().for_each(|&n| wanted[n as usize] = true);
    let reads_gradients =
        function.inputs.iter().any(|i| matches!(i.derivative, Some(Derivative::Direction(_))));
    let mut places = Vec::new();
    match domain {
        Domain::Edges(paths) if !reads_gradients => {
            for path in paths {
                for edge in path_edges(mesh, path)? {
                    let new = (0..3).filter(|&k| std::mem::take(&mut wanted[edge[k] as usize]));
                    places.extend(new.map(|k| Place::at_edge_node(mesh, edge, k)));
                }
            }
        }
        _ => {
            for cell in cells_of(mesh, domain)? {
                let new = (0..6).filter(|&k| std::mem::take(&mut wanted[mesh.cells[cell][k] as usize]));
                places.extend(new.map(|k| Place::at_cell_node(mesh, cell, k)));
            }
        }
    }
    Ok(places)
}

/// The cells of a domain; all cells for edges.
fn cells_of(mesh: &Mesh, domain: Domain) -> Result<Vec<usize>, Error> {
    let Domain::Cells(regions) = domain else { return Ok((0..mesh.cells.len()).collect()) };
    let mut all = Vec::new();
    for region in regions {
        all.extend(region_cells(mesh, region)?);
    }
    Ok(all)
}

/// Part of the length of an edge by which a point on a curve may miss the edge, which follows the curve as a parabola does.
const MISSED: f64 = 0.05;

/// The place of a reference point in the cells or on the edges of a domain, or an error that names it.
pub fn locate(mesh: &Mesh, domain: Domain, x: [f64; 2]) -> Result<Place, Error> {
    let outside = |of: &str| Error::Model(format!("the point ({}, {}) lies {of}", x[0], x[1]));
    let Domain::Edges(paths) = domain else {
        let found = Locator::new(mesh, cells_of(mesh, domain)?).locate(x);
        let (cell, local) = found.ok_or_else(|| outside("outside the mesh"))?;
        return Ok(Place::in_cell(mesh, cell, local));
    };
    let mut nearest: Option<(f64, [u32; 3], f64)> = None;
    for path in paths {
        for edge in path_edges(mesh, path)? {
            let (missed, s) = closest(edge.map(|n| mesh.nodes[n as usize]), x);
            if nearest.is_none_or(|(best, ..)| missed < best) {
                nearest = Some((missed, edge, s));
            }
        }
    }
    let (_, edge, s) = nearest
        .filter(|(missed, ..)| *missed < MISSED)
        .ok_or_else(|| outside(&format!("beside `{}`", paths.join(", "))))?;
    Ok(Place::on_edge(mesh, edge, s))
}

/// Distance of a point from an edge as a part of the edge's length, and the parameter of the closest point: Gauss-Newton from the chord.
fn closest(nodes: [[f64; 2]; 3], x: [f64; 2]) -> (f64, f64) {
    let [a, b, m] = nodes;
    let chord = [0, 1].map(|i| b[i] - a[i]);
    let length = chord[0].hypot(chord[1]);
    let mut s = ((x[0] - a[0]) * chord[0] + (x[1] - a[1]) * chord[1]) / (length * length);
    let mut missed = f64::INFINITY;
    for _ in 0..8 {
        s = s.clamp(0.0, 1.0);
        let values = [(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0), 4.0 * s * (1.0 - s)];
        let slopes = [4.0 * s - 3.0, 4.0 * s - 1.0, 4.0 - 8.0 * s];
        let sum = |w: [f64; 3], i: usize| w[0] * a[i] + w[1] * b[i] + w[2] * m[i];
        let off = [0, 1].map(|i| x[i] - sum(values, i));
        let speed = [0, 1].map(|i| sum(slopes, i));
        missed = off[0].hypot(off[1]) / length;
        s += (off[0] * speed[0] + off[1] * speed[1]) / (speed[0] * speed[0] + speed[1] * speed[1]);
    }
    (missed, s.clamp(0.0, 1.0))
}
