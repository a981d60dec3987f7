//! The finite elements: a basis on a reference cell, its nodes and where they sit.

use crate::{Cell, p1, p2};

/// A nodal finite element: basis function `i` is 1 at node `i` and 0 at the other nodes.
///
/// Nodes are numbered vertices first, then one for each edge in the order of [`Cell::edges`]. This is the order of
/// VTK cells, so a field is written without renumbering.
#[derive(Debug)]
pub struct Element {
    /// Name of the space in the language, such as `P2`.
    pub name: &'static str,
    /// Reference cell.
    pub cell: Cell,
    /// Highest degree of the polynomials that are all reproduced.
    pub degree: usize,
    /// VTK cell type that has these nodes in this order.
    pub vtk_type: u8,
    /// Number of nodes inside each vertex, edge and face.
    pub nodes_per_entity: [usize; 3],
    /// Nodes of each edge: its two ends, then those inside it.
    pub edge_nodes: &'static [&'static [usize]],
    pub(crate) nodes: &'static [&'static [f64]],
    pub(crate) values: fn(&[f64], &mut [f64]),
    pub(crate) gradients: fn(&[f64], &mut [f64]),
}

impl Element {
    /// Every element.
    pub const ALL: &[&Element] = &[&p1::SEGMENT, &p1::TRIANGLE, &p2::SEGMENT, &p2::TRIANGLE];

    /// Linear segment.
    pub const P1_SEGMENT: &'static Element = &p1::SEGMENT;
    /// Linear triangle.
    pub const P1_TRIANGLE: &'static Element = &p1::TRIANGLE;
    /// Quadratic segment.
    pub const P2_SEGMENT: &'static Element = &p2::SEGMENT;
    /// Quadratic triangle.
    pub const P2_TRIANGLE: &'static Element = &p2::TRIANGLE;

    /// The element of this name on this cell.
    pub fn find(name: &str, cell: Cell) -> Option<&'static Element> {
        Element::ALL.iter().copied().find(|e| e.name == name && e.cell == cell)
    }

    /// Coordinates of the nodes, `node x dimension`.
    pub const fn nodes(&self) -> &'static [&'static [f64]] {
        self.nodes
    }

    /// Values of the basis functions at `x` (one entry per dimension), one per node into `values`.
    ///
    /// # Panics
    /// If a slice is shorter than that.
    pub fn evaluate(&self, x: &[f64], values: &mut [f64]) {
        (self.values)(x, values);
    }

    /// Gradients of the basis functions at `x` in reference coordinates, `node x dimension` row after row into
    /// `gradients`.
    ///
    /// # Panics
    /// If a slice is shorter than that.
    pub fn gradients(&self, x: &[f64], gradients: &mut [f64]) {
        (self.gradients)(x, gradients);
    }
}
