//! Pointwise functions of the fields: values at nodes (frames, smallest and largest values) and at given points.

use super::terms::At;
use super::unknowns::{Unknowns, domain_nodes, region_cells};
use crate::error::Error;
use crate::generated::{Domain, PointFunction, PointInput};
use crate::mesh::{Locator, Mesh};
use ansatz_elements::Element;

/// Part of the way to the cell's centre at which a node is approached, so that hoop terms such as u_r/r have their limit on the axis.
const NUDGE: f64 = 1e-6;

/// A place inside a cell, with the basis there.
#[derive(Clone, Debug)]
pub struct Place {
    /// Cell of the mesh.
    pub cell: usize,
    /// Reference position of the point \[length\].
    pub x: [f64; 2],
    /// Quadratic basis: value and derivative in both reference directions of space, per node.
    quadratic: Vec<[f64; 3]>,
    /// Linear basis, likewise.
    linear: Vec<[f64; 3]>,
}

impl Place {
    /// At local coordinates of a cell.
    pub fn new(mesh: &Mesh, cell: usize, local: [f64; 2]) -> Self {
        let geometry = basis(Element::P2_TRIANGLE, local);
        let nodes = mesh.cells[cell].map(|n| mesh.nodes[n as usize]);
        let mut x = [0.0; 2];
        let mut jacobian = [[0.0; 2]; 2];
        for (node, phi) in nodes.iter().zip(&geometry) {
            for i in 0..2 {
                x[i] += phi[0] * node[i];
                for j in 0..2 {
                    jacobian[i][j] += node[i] * phi[1 + j];
                }
            }
        }
        let det = jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0];
        let to_space = |phi: &[f64; 3]| {
            let dx = (phi[1] * jacobian[1][1] - phi[2] * jacobian[1][0]) / det;
            let dy = (phi[2] * jacobian[0][0] - phi[1] * jacobian[0][1]) / det;
            [phi[0], dx, dy]
        };
        let quadratic = geometry.iter().map(to_space).collect();
        let linear = basis(Element::P1_TRIANGLE, local).iter().map(to_space).collect();
        Self { cell, x, quadratic, linear }
    }

    /// At a node of a cell (0..6), approached from inside.
    pub fn at_node(mesh: &Mesh, cell: usize, node: usize) -> Self {
        let corner = Element::P2_TRIANGLE.nodes()[node];
        let local = [0, 1].map(|i| corner[i] + NUDGE * (1.0 / 3.0 - corner[i]));
        Self::new(mesh, cell, local)
    }

    /// Value of one input and the unknowns it is a sum of, with their weights.
    fn weights<'a>(
        &'a self,
        input: PointInput,
        mesh: &'a Mesh,
        unknowns: &'a Unknowns,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let field = &unknowns.fields[input.field];
        let basis = if field.nodes_per_cell == 6 { &self.quadratic } else { &self.linear };
        let kind = input.derivative.map_or(0, |d| 1 + d);
        let nodes = &mesh.cells[self.cell];
        basis.iter().zip(nodes).filter_map(move |(phi, &node)| {
            field.unknown(node as usize, input.component).map(|unknown| (unknown, phi[kind]))
        })
    }
}

/// Values of the basis functions and their derivatives by the local coordinates.
fn basis(element: &Element, local: [f64; 2]) -> Vec<[f64; 3]> {
    let count = element.nodes().len();
    let mut values = vec![0.0; count];
    let mut gradients = vec![0.0; 2 * count];
    element.evaluate(&local, &mut values);
    element.gradients(&local, &mut gradients);
    values.iter().zip(gradients.chunks(2)).map(|(v, g)| [*v, g[0], g[1]]).collect()
}

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
    pub fn evaluate(&mut self, mesh: &Mesh, unknowns: &Unknowns, place: &Place, at: At<'_>, out: &mut [f64]) {
        self.evaluate_with(mesh, unknowns, place, &[], at, out);
    }

    /// Evaluates at a place with further inputs behind those of the fields.
    pub fn evaluate_with(
        &mut self,
        mesh: &Mesh,
        unknowns: &Unknowns,
        place: &Place,
        further: &[f64],
        at: At<'_>,
        out: &mut [f64],
    ) {
        self.inputs.clear();
        for &input in self.function.inputs {
            let from = if input.rate { at.rates } else { at.y };
            self.inputs.push(place.weights(input, mesh, unknowns).map(|(u, w)| w * from[u]).sum());
        }
        self.inputs.extend_from_slice(further);
        let region = self.region[mesh.cell_region[place.cell] as usize].unwrap_or(0);
        (self.function.evaluate)(region, place.x, &self.inputs, at.g, out);
    }

    /// Adds the gradient of output 0 with respect to the unknowns, given its derivatives by the inputs.
    pub fn add_gradient(
        &self,
        mesh: &Mesh,
        unknowns: &Unknowns,
        place: &Place,
        derivatives: &[f64],
        sum: &mut [f64],
    ) {
        for (&input, d) in self.function.inputs.iter().zip(derivatives) {
            if !input.rate {
                place.weights(input, mesh, unknowns).for_each(|(u, w)| sum[u] += d * w);
            }
        }
    }
}

/// One place per node of a domain: in the first cell that has the node and, for cells, belongs to the domain.
pub fn node_places(mesh: &Mesh, domain: Domain) -> Result<Vec<Place>, Error> {
    let mut wanted = vec![false; mesh.nodes.len()];
    domain_nodes(mesh, domain)?.iter().for_each(|&n| wanted[n as usize] = true);
    let cells: Vec<usize> = match domain {
        Domain::Cells(regions) => {
            let mut all = Vec::new();
            for region in regions {
                all.extend(region_cells(mesh, region)?);
            }
            all
        }
        Domain::Edges(_) => (0..mesh.cells.len()).collect(),
    };
    let mut places = Vec::new();
    for cell in cells {
        for (k, &node) in mesh.cells[cell].iter().enumerate() {
            if std::mem::take(&mut wanted[node as usize]) {
                places.push(Place::at_node(mesh, cell, k));
            }
        }
    }
    Ok(places)
}

/// The place of a reference point, or an error that names it.
pub fn locate(mesh: &Mesh, x: [f64; 2]) -> Result<Place, Error> {
    let outside = || Error::Model(format!("the point ({}, {}) lies outside the mesh", x[0], x[1]));
    let (cell, local) = Locator::new(mesh).locate(x).ok_or_else(outside)?;
    Ok(Place::new(mesh, cell, local))
}
