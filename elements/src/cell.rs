//! Reference cells: the shapes on which bases and quadrature rules are defined.

/// A reference cell. Facets are ordered so that a triangle is walked counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cell {
    /// The segment from 0 to 1.
    Segment,
    /// The triangle (0, 0), (1, 0), (0, 1).
    Triangle,
}

impl Cell {
    /// Every cell.
    pub const ALL: &[Cell] = &[Cell::Segment, Cell::Triangle];

    /// Number of reference coordinates.
    pub const fn dimension(self) -> usize {
        match self {
            Cell::Segment => 1,
            Cell::Triangle => 2,
        }
    }

    /// Length or area of the reference cell.
    pub const fn measure(self) -> f64 {
        match self {
            Cell::Segment => 1.0,
            Cell::Triangle => 0.5,
        }
    }

    /// Coordinates of the vertices, `vertex x dimension`.
    pub const fn vertices(self) -> &'static [&'static [f64]] {
        match self {
            Cell::Segment => &[&[0.0], &[1.0]],
            Cell::Triangle => &[&[0.0, 0.0], &[1.0, 0.0], &[0.0, 1.0]],
        }
    }

    /// Vertex pairs of the edges: a segment is its own edge; a triangle has 01, 12, 20.
    pub const fn edges(self) -> &'static [[usize; 2]] {
        match self {
            Cell::Segment => &[[0, 1]],
            Cell::Triangle => &[[0, 1], [1, 2], [2, 0]],
        }
    }

    /// Whether the point `x` (one entry per dimension) lies in the closed cell, within `tolerance`.
    pub fn contains(self, x: &[f64], tolerance: f64) -> bool {
        match self {
            Cell::Segment => x[0] >= -tolerance && x[0] <= 1.0 + tolerance,
            Cell::Triangle => x.iter().all(|&c| c >= -tolerance) && x[0] + x[1] <= 1.0 + tolerance,
        }
    }
}
