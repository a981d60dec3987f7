//! Measures of cells: shape of the straight triangle and distortion by curved edges.

use ansatz_geometry::{Point, point};

/// Signed area of a straight triangle, positive counter-clockwise.
pub(crate) fn signed_area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * point::cross(point::sub(b, a), point::sub(c, a))
}

/// Twice the ratio of the radii of the inscribed and circumscribed circles: 1 for an equilateral triangle, 0 for a
/// flat one, negative for one that is turned over.
pub(crate) fn radius_ratio(triangle: [Point; 3]) -> f64 {
    let [a, b, c] = triangle;
    let [la, lb, lc] = [point::distance(b, c), point::distance(c, a), point::distance(a, b)];
    // 2 r/R with r = 2 A/(la + lb + lc) and R = la lb lc/(4 A).
    let area = signed_area(triangle);
    16.0 * area * area.abs() / ((la + lb + lc) * la * lb * lc)
}

/// A lower bound of the determinant of the Jacobian of a quadratic cell, exact for a straight one (twice its area): the
/// smallest of its Bernstein coefficients, the determinant being a quadratic polynomial.
pub(crate) fn least_determinant(nodes: &[Point; 6]) -> f64 {
    const AT: [Point; 6] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
    let [a, b, c, ab, bc, ca] = AT.map(|at| {
        let [along_x, along_y] = jacobian(nodes, at);
        point::cross(along_x, along_y)
    });
    let on_edges = [2.0 * ab - 0.5 * (a + b), 2.0 * bc - 0.5 * (b + c), 2.0 * ca - 0.5 * (c + a)];
    on_edges.into_iter().chain([a, b, c]).fold(f64::INFINITY, f64::min)
}

/// Area of a quadratic cell with its curved edges.
pub(crate) fn curved_area([a, b, c, ab, bc, ca]: &[Point; 6]) -> f64 {
    // A parabolic segment covers two thirds of the parallelogram around it.
    let bulge = |from: &Point, to: &Point, middle: &Point| {
        let rise = point::sub(*middle, point::lerp(*from, *to, 0.5));
        2.0 / 3.0 * point::cross(rise, point::sub(*to, *from))
    };
    signed_area([*a, *b, *c]) + bulge(a, b, ab) + bulge(b, c, bc) + bulge(c, a, ca)
}

/// Derivatives of the position of a quadratic cell along its two reference coordinates.
pub(crate) fn jacobian(nodes: &[Point; 6], [x, y]: Point) -> [Point; 2] {
    let l = 1.0 - x - y;
    let by_x = [1.0 - 4.0 * l, 4.0 * x - 1.0, 0.0, 4.0 * (l - x), 4.0 * y, -4.0 * y];
    let by_y = [1.0 - 4.0 * l, 0.0, 4.0 * y - 1.0, -4.0 * x, 4.0 * x, 4.0 * (l - y)];
    [combine(nodes, &by_x), combine(nodes, &by_y)]
}

/// Position in a quadratic cell at reference coordinates.
pub(crate) fn position(nodes: &[Point; 6], [x, y]: Point) -> Point {
    let l = 1.0 - x - y;
    let weights = [
        l * (2.0 * l - 1.0),
        x * (2.0 * x - 1.0),
        y * (2.0 * y - 1.0),
        4.0 * l * x,
        4.0 * x * y,
        4.0 * y * l,
    ];
    combine(nodes, &weights)
}

fn combine(nodes: &[Point; 6], weights: &[f64; 6]) -> Point {
    let parts = nodes.iter().zip(weights).map(|(&node, &weight)| point::scale(node, weight));
    parts.fold([0.0; 2], point::add)
}

/// Quality of a quadratic cell: the normalised radius ratio `2 r/R` of the triangle of its vertices, times a lower bound
/// of the determinant of its Jacobian over that of the straight triangle (at most 1). Equilateral and straight is 1;
/// what is not positive may not be invertible.
pub fn cell_quality(nodes: &[Point; 6]) -> f64 {
    let triangle = [nodes[0], nodes[1], nodes[2]];
    let ratio = radius_ratio(triangle);
    let distortion = least_determinant(nodes) / (2.0 * signed_area(triangle));
    if ratio > 0.0 { ratio * distortion.min(1.0) } else { ratio }
}

/// Summary of the quality of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QualityStatistics {
    /// The worst cell's quality.
    pub smallest: f64,
    /// The worst cell.
    pub worst_cell: usize,
    /// Average over cells.
    pub mean: f64,
}
