//! Places at which fields have values: inside cells, and on the edges of paths.

use super::unknowns::Unknowns;
use crate::generated::{Derivative, PointInput};
use crate::mesh::Mesh;
use ansatz_elements::Element;

/// Part of the way to the middle of its element at which a node is approached, so that hoop terms such as u_r/r have their limit on the axis.
const NUDGE: f64 = 1e-6;

/// A basis function at a place: its value, its derivative in both directions of the plane, and that by the arc length of a path.
type Basis = [f64; 4];

/// A place inside a cell or on an edge, with the basis there.
#[derive(Clone, Debug)]
pub struct Place {
    /// Region of the mesh that the cell belongs to; none on an edge.
    pub region: Option<usize>,
    /// Reference position of the point \[length\].
    pub x: [f64; 2],
    /// Unit tangent and curvature vector \[1/length\] of the path through it; zero in a cell.
    pub path: [[f64; 2]; 2],
    nodes: Vec<u32>,
    quadratic: Vec<Basis>,
    linear: Vec<Basis>,
}

impl Place {
    /// At local coordinates of a cell.
    pub fn in_cell(mesh: &Mesh, cell: usize, local: [f64; 2]) -> Self {
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
            [phi[0], dx, dy, 0.0]
        };
        Self {
            region: Some(usize::from(mesh.cell_region[cell])),
            x,
            path: [[0.0; 2]; 2],
            nodes: mesh.cells[cell].to_vec(),
            quadratic: geometry.iter().map(to_space).collect(),
            linear: basis(Element::P1_TRIANGLE, local).iter().map(to_space).collect(),
        }
    }

    /// At the parameter `s` (0 to 1) of an edge `[start, end, middle]`.
    pub fn on_edge(mesh: &Mesh, edge: [u32; 3], s: f64) -> Self {
        let nodes = edge.map(|n| mesh.nodes[n as usize]);
        let (values, slopes) = segment(Element::P2_SEGMENT, s);
        let sum = |weights: &[f64], axis: usize| -> f64 {
            weights.iter().zip(&nodes).map(|(weight, node)| weight * node[axis]).sum()
        };
        let x = [0, 1].map(|axis| sum(&values, axis));
        let speed = [0, 1].map(|axis| sum(&slopes, axis));
        let length = speed[0].hypot(speed[1]);
        let tangent = speed.map(|c| c / length);
        // The second derivatives of the basis on an edge are 4, 4 and -8.
        let second = [0, 1].map(|axis| sum(&[4.0, 4.0, -8.0], axis) / (length * length));
        let part = tangent[0] * second[0] + tangent[1] * second[1];
        let curvature = [0, 1].map(|axis| second[axis] - part * tangent[axis]);
        let along = |element| {
            let (values, slopes) = segment(element, s);
            values.iter().zip(slopes).map(|(value, slope)| [*value, 0.0, 0.0, slope / length]).collect()
        };
        Self {
            region: None,
            x,
            path: [tangent, curvature],
            nodes: edge.to_vec(),
            quadratic: along(Element::P2_SEGMENT),
            linear: along(Element::P1_SEGMENT),
        }
    }

    /// At a node of a cell (0..6), approached from inside.
    pub fn at_cell_node(mesh: &Mesh, cell: usize, node: usize) -> Self {
        let corner = Element::P2_TRIANGLE.nodes()[node];
        let local = [0, 1].map(|i| corner[i] + NUDGE * (1.0 / 3.0 - corner[i]));
        Self::in_cell(mesh, cell, local)
    }

    /// At a node of an edge (0..3), approached from inside.
    pub fn at_edge_node(mesh: &Mesh, edge: [u32; 3], node: usize) -> Self {
        let s = Element::P2_SEGMENT.nodes()[node][0];
        Self::on_edge(mesh, edge, s + NUDGE * (0.5 - s))
    }

    /// The place in a cell with the path that it is on, its tangent and curvature.
    pub fn on_path(mut self, path: [[f64; 2]; 2]) -> Self {
        self.path = path;
        for basis in self.quadratic.iter_mut().chain(&mut self.linear) {
            basis[3] = basis[1] * path[0][0] + basis[2] * path[0][1];
        }
        self
    }

    /// The unknowns that one input is a sum of, with their weights.
    pub fn weights<'a>(
        &'a self,
        input: PointInput,
        unknowns: &'a Unknowns,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let field = &unknowns.fields[input.field];
        let basis = if field.nodes_per_cell == 6 { &self.quadratic } else { &self.linear };
        let kind = match input.derivative {
            None => 0,
            Some(Derivative::Direction(direction)) => 1 + direction,
            Some(Derivative::Along) => 3,
        };
        basis.iter().zip(&self.nodes).filter_map(move |(phi, &node)| {
            field.unknown(node as usize, input.component).map(|unknown| (unknown, phi[kind]))
        })
    }
}

/// Values of the basis functions of a triangle and their derivatives by the local coordinates.
fn basis(element: &Element, local: [f64; 2]) -> Vec<[f64; 3]> {
    let count = element.nodes().len();
    let mut values = vec![0.0; count];
    let mut gradients = vec![0.0; 2 * count];
    element.evaluate(&local, &mut values);
    element.gradients(&local, &mut gradients);
    values.iter().zip(gradients.chunks(2)).map(|(v, g)| [*v, g[0], g[1]]).collect()
}

/// Values of the basis functions of a segment and their derivatives by its parameter.
fn segment(element: &Element, s: f64) -> (Vec<f64>, Vec<f64>) {
    let (mut values, mut slopes) = (vec![0.0; element.nodes().len()], vec![0.0; element.nodes().len()]);
    element.evaluate(&[s], &mut values);
    element.gradients(&[s], &mut slopes);
    (values, slopes)
}
