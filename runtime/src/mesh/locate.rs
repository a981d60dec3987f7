//! Finds the cell that holds a point, and the point's reference coordinates in it.

use super::Mesh;
use super::quality::{jacobian, position};
use ansatz_geometry::{Point, point};

/// Newton steps to invert a cell's map; it converges quadratically and cells are only slightly curved.
const STEPS: usize = 12;
/// How far outside the reference triangle a point still counts as inside.
const INSIDE: f64 = 1e-9;

/// Cells by the squares of a grid that their bounding boxes touch: for locating many points.
pub struct Locator<'m> {
    mesh: &'m Mesh,
    low: Point,
    side: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<u32>>,
}

impl Mesh {
    /// The cell that holds `p` and the reference coordinates of `p` in it; none outside the mesh. On a shared edge
    /// the first cell. Tries all cells: use a [`Locator`] for many points.
    pub fn locate(&self, p: Point) -> Option<(usize, Point)> {
        (0..self.cells.len()).find_map(|cell| Some((cell, invert(&self.cell_nodes(cell), p)?)))
    }
}

impl<'m> Locator<'m> {
    /// Sorts some cells of a mesh into a grid with about as many squares as cells.
    pub fn new(mesh: &'m Mesh, among: impl IntoIterator<Item = usize>) -> Self {
        let [low, high] = point::bounds(&mesh.nodes);
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        let side = (width * height / mesh.cells.len().max(1) as f64).sqrt();
        let count = |length: f64| ((length / side) as usize).saturating_add(1).min(mesh.cells.len() + 1);
        let (columns, rows) = (count(width), count(height));
        let mut locator = Locator { mesh, low, side, columns, rows, cells: vec![Vec::new(); columns * rows] };
        for cell in among {
            let [low, high] = cell_bounds(&mesh.cell_nodes(cell));
            let ([first, bottom], [last, top]) = (locator.square(low), locator.square(high));
            for row in bottom..=top {
                for column in first..=last {
                    locator.cells[row * columns + column].push(cell as u32);
                }
            }
        }
        locator
    }

    /// As [`Mesh::locate`].
    pub fn locate(&self, p: Point) -> Option<(usize, Point)> {
        let [column, row] = self.square(p);
        let near = &self.cells[row * self.columns + column];
        near.iter().find_map(|&cell| {
            let cell = cell as usize;
            Some((cell, invert(&self.mesh.cell_nodes(cell), p)?))
        })
    }

    /// Column and row of the square at `p`, or of the nearest one.
    fn square(&self, p: Point) -> [usize; 2] {
        let index = |k: usize, count: usize| (((p[k] - self.low[k]) / self.side) as usize).min(count - 1);
        [index(0, self.columns), index(1, self.rows)]
    }
}

/// Reference coordinates of `p` in a quadratic cell, if it is inside.
fn invert(nodes: &[Point; 6], p: Point) -> Option<Point> {
    let [low, high] = cell_bounds(nodes);
    if (0..2).any(|k| p[k] < low[k] || p[k] > high[k]) {
        return None;
    }
    let mut at = [1.0 / 3.0; 2];
    for _ in 0..STEPS {
        let off = point::sub(p, position(nodes, at));
        let [x, y] = jacobian(nodes, at);
        let determinant = point::cross(x, y);
        let step = [point::cross(off, y) / determinant, point::cross(x, off) / determinant];
        at = point::add(at, step);
        if point::norm(step) < 1e-14 {
            break;
        }
    }
    let l = 1.0 - at[0] - at[1];
    let inside = at[0].min(at[1]).min(l) >= -INSIDE;
    let closed = point::distance(position(nodes, at), p) <= INSIDE * point::distance(low, high);
    (inside && closed).then_some(at)
}

/// A box around a curved cell: that of its nodes, widened by as much as a curved edge may leave it.
fn cell_bounds(nodes: &[Point; 6]) -> [Point; 2] {
    let [low, high] = point::bounds(nodes);
    let margin = 0.25 * (high[0] - low[0]).max(high[1] - low[1]);
    [low.map(|x| x - margin), high.map(|x| x + margin)]
}
