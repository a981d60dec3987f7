//! Quadratic Lagrange elements: a node at each vertex and at the middle of each edge.
//!
//! With barycentric coordinates `l`, the vertex functions are `l (2 l - 1)` and those of the edges `4 l l'`.

use crate::{Cell, Element, p1};

pub(crate) const SEGMENT: Element = Element {
    name: "P2",
    cell: Cell::Segment,
    degree: 2,
    vtk_type: 21,
    nodes_per_entity: [1, 1, 0],
    edge_nodes: &[&[0, 1, 2]],
    nodes: &[&[0.0], &[1.0], &[0.5]],
    values: |x, values| quadratic_values::<2>(&p1::SEGMENT, x, values),
    gradients: |x, gradients| quadratic_gradients::<2>(&p1::SEGMENT, x, gradients),
};

pub(crate) const TRIANGLE: Element = Element {
    name: "P2",
    cell: Cell::Triangle,
    degree: 2,
    vtk_type: 22,
    nodes_per_entity: [1, 1, 0],
    edge_nodes: &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]],
    nodes: &[&[0.0, 0.0], &[1.0, 0.0], &[0.0, 1.0], &[0.5, 0.0], &[0.5, 0.5], &[0.0, 0.5]],
    values: |x, values| quadratic_values::<3>(&p1::TRIANGLE, x, values),
    gradients: |x, gradients| quadratic_gradients::<3>(&p1::TRIANGLE, x, gradients),
};

/// Quadratic basis on a simplex with `V` vertices, from its `linear` element.
fn quadratic_values<const V: usize>(linear: &Element, x: &[f64], values: &mut [f64]) {
    let mut l = [0.0; V];
    linear.evaluate(x, &mut l);
    let (at_vertices, on_edges) = values.split_at_mut(V);
    for (value, l) in at_vertices.iter_mut().zip(l) {
        *value = l * (2.0 * l - 1.0);
    }
    for (value, &[a, b]) in on_edges.iter_mut().zip(linear.cell.edges()) {
        *value = 4.0 * l[a] * l[b];
    }
}

/// Gradients of [`quadratic_values`], `node x dimension` with dimension `V - 1`.
fn quadratic_gradients<const V: usize>(linear: &Element, x: &[f64], gradients: &mut [f64]) {
    let dimension = V - 1;
    let mut l = [0.0; V];
    let mut dl = [[0.0; V]; V];
    linear.evaluate(x, &mut l);
    linear.gradients(x, dl.as_flattened_mut());
    let dl = &dl.as_flattened()[..V * dimension];
    let (at_vertices, on_edges) = gradients.split_at_mut(V * dimension);
    for (k, gradient) in at_vertices.iter_mut().enumerate() {
        *gradient = (4.0 * l[k / dimension] - 1.0) * dl[k];
    }
    for (gradient, &[a, b]) in on_edges.chunks_exact_mut(dimension).zip(linear.cell.edges()) {
        for (j, entry) in gradient.iter_mut().enumerate() {
            *entry = 4.0 * (l[a] * dl[b * dimension + j] + l[b] * dl[a * dimension + j]);
        }
    }
}
