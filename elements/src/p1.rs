//! Linear Lagrange elements: one node at each vertex, the barycentric coordinates as basis.

use crate::{Cell, Element};

pub(crate) const SEGMENT: Element = Element {
    name: "P1",
    cell: Cell::Segment,
    degree: 1,
    vtk_type: 3,
    nodes_per_entity: [1, 0, 0],
    edge_nodes: &[&[0, 1]],
    nodes: Cell::Segment.vertices(),
    values: |x, values| values[..2].copy_from_slice(&[1.0 - x[0], x[0]]),
    gradients: |_, gradients| gradients[..2].copy_from_slice(&[-1.0, 1.0]),
};

pub(crate) const TRIANGLE: Element = Element {
    name: "P1",
    cell: Cell::Triangle,
    degree: 1,
    vtk_type: 5,
    nodes_per_entity: [1, 0, 0],
    edge_nodes: &[&[0, 1], &[1, 2], &[2, 0]],
    nodes: Cell::Triangle.vertices(),
    values: |x, values| values[..3].copy_from_slice(&[1.0 - x[0] - x[1], x[0], x[1]]),
    gradients: |_, gradients| gradients[..6].copy_from_slice(&[-1.0, -1.0, 1.0, 0.0, 0.0, 1.0]),
};
