//! Moves inner vertices to where their triangles are better shaped.

use super::quality::{radius_ratio, signed_area};
use super::sizing::SizeField;
use ansatz_geometry::{Point, point};

/// A vertex may move where its worst triangle stays at least this good.
const GOOD: f64 = 0.7;

/// Moves each point from `fixed` on to the mean of the centroids of its triangles, weighted by their area in units of
/// the wanted size, unless that makes its worst triangle bad or worse.
pub(crate) fn smooth(points: &mut [Point], fixed: usize, cells: &[([usize; 3], u16)], field: &SizeField<'_>) {
    let stars = stars(points.len(), cells);
    let weights: Vec<f64> = cells.iter().map(|(cell, _)| field.at(centroid(points, cell)).powi(-2)).collect();
    for vertex in fixed..points.len() {
        let star = &stars[vertex];
        let worst = |points: &[Point]| {
            let shapes = star.iter().map(|&k| radius_ratio(cells[k].0.map(|v| points[v])));
            shapes.fold(f64::INFINITY, f64::min)
        };
        let mut sum = ([0.0; 2], 0.0);
        for &k in star {
            let weight = weights[k] * signed_area(cells[k].0.map(|v| points[v]));
            sum = (point::add(sum.0, point::scale(centroid(points, &cells[k].0), weight)), sum.1 + weight);
        }
        let (before, was) = (points[vertex], worst(points));
        points[vertex] = point::scale(sum.0, 1.0 / sum.1);
        if worst(points).is_nan() || worst(points) < was.min(GOOD) {
            points[vertex] = before;
        }
    }
}

fn centroid(points: &[Point], cell: &[usize; 3]) -> Point {
    point::centroid(cell.map(|v| points[v]))
}

/// Cells around each vertex.
fn stars(vertices: usize, cells: &[([usize; 3], u16)]) -> Vec<Vec<usize>> {
    let mut stars = vec![Vec::new(); vertices];
    for (k, (cell, _)) in cells.iter().enumerate() {
        for &vertex in cell {
            stars[vertex].push(k);
        }
    }
    stars
}
