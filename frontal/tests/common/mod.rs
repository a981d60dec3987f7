//! Matrices of finite elements on a structured triangulation of the unit square: elasticity with quadratic triangles, flow with
//! Taylor-Hood triangles.

use ansatz_elements::{Cell, Element, quadrature};

/// A sparse matrix in compressed columns.
pub struct Matrix {
    pub starts: Vec<u32>,
    pub rows: Vec<u32>,
    pub values: Vec<f64>,
}

impl Matrix {
    /// Sums entries (row, column, value) with the same position.
    pub fn from_entries(size: usize, mut entries: Vec<(u32, u32, f64)>) -> Self {
        entries.sort_by_key(|&(row, column, _)| (column, row));
        let (mut starts, mut rows, mut values) = (vec![0_u32; size + 1], Vec::new(), Vec::new());
        let mut last = None;
        for (row, column, value) in entries {
            if last == Some((row, column)) {
                *values.last_mut().expect("an entry came before") += value;
                continue;
            }
            last = Some((row, column));
            rows.push(row);
            values.push(value);
            starts[column as usize + 1] += 1;
        }
        (0..size).for_each(|k| starts[k + 1] += starts[k]);
        Self { starts, rows, values }
    }

    /// Number of equations.
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// Unknowns whose diagonal entry is zero or missing.
    pub fn weak(&self) -> Vec<u32> {
        let column = |k: usize| self.starts[k] as usize..self.starts[k + 1] as usize;
        let has_pivot = |k: usize| column(k).any(|p| self.rows[p] as usize == k && self.values[p] != 0.0);
        (0..self.size()).filter(|&k| !has_pivot(k)).map(|k| k as u32).collect()
    }

    /// The lower triangle.
    pub fn lower(&self) -> Self {
        let mut entries = Vec::new();
        self.for_each(|row, column, value| {
            if row >= column {
                entries.push((row as u32, column as u32, value));
            }
        });
        Self::from_entries(self.size(), entries)
    }

    /// Calls `visit(row, column, value)` for every entry.
    pub fn for_each(&self, mut visit: impl FnMut(usize, usize, f64)) {
        for column in 0..self.size() {
            for p in self.starts[column] as usize..self.starts[column + 1] as usize {
                visit(self.rows[p] as usize, column, self.values[p]);
            }
        }
    }
}

/// What is solved on the square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Problem {
    /// Plane strain, Poisson's ratio 0.3, held at the bottom.
    Elasticity,
    /// Incompressible flow, held at bottom, left and right, linearised about a stream that rises with the height:
    /// convection, and its derivative, multiplied by a number that is one over the viscosity.
    Flow { reynolds: f64 },
}

/// The matrix on `n x n x 2` triangles.
pub fn matrix(problem: Problem, n: usize) -> Matrix {
    let mesh = Mesh { n };
    let (numbers, size) = mesh.number(problem);
    let mut entries = Vec::new();
    for cell in 0..2 * n * n {
        let nodes = mesh.cell(cell);
        let local = element(problem, &mesh, &nodes);
        let unknown =
            |k: usize| if k < 12 { numbers[nodes[k / 2]][k % 2] } else { numbers[nodes[k - 12]][2] };
        for (i, row) in local.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                if let (Some(row), Some(column)) = (unknown(i), unknown(j)) {
                    entries.push((row, column, value));
                }
            }
        }
    }
    Matrix::from_entries(size, entries)
}

/// Grid of quadratic nodes, `2 n + 1` a side.
struct Mesh {
    n: usize,
}

impl Mesh {
    fn side(&self) -> usize {
        2 * self.n + 1
    }

    fn point(&self, node: usize) -> [f64; 2] {
        let (i, j) = (node % self.side(), node / self.side());
        [i, j].map(|k| k as f64 / (2 * self.n) as f64)
    }

    /// Nodes of a triangle: vertices, then the middles of its edges.
    fn cell(&self, cell: usize) -> [usize; 6] {
        let (square, half) = (cell / 2, cell % 2);
        let (x, y) = (2 * (square % self.n), 2 * (square / self.n));
        let corners = [[[0, 0], [2, 0], [2, 2]], [[0, 0], [2, 2], [0, 2]]][half];
        let edges = Element::P2_TRIANGLE.edge_nodes;
        let node = |[a, b]: [usize; 2]| (y + b) * self.side() + x + a;
        let middle = |k: usize| {
            let (p, q) = (corners[edges[k][0]], corners[edges[k][1]]);
            node([(p[0] + q[0]) / 2, (p[1] + q[1]) / 2])
        };
        [node(corners[0]), node(corners[1]), node(corners[2]), middle(0), middle(1), middle(2)]
    }

    /// Numbers of the two components and the pressure at every node, and how many there are.
    fn number(&self, problem: Problem) -> (Vec<[Option<u32>; 3]>, usize) {
        let side = self.side();
        let mut count = 0;
        let mut next = |free: bool| {
            free.then(|| {
                count += 1;
                count - 1
            })
        };
        let number = |node: usize| {
            let (i, j) = (node % side, node / side);
            let (held, pressure) = match problem {
                Problem::Elasticity => (j == 0, false),
                Problem::Flow { .. } => (j == 0 || i == 0 || i + 1 == side, i % 2 == 0 && j % 2 == 0),
            };
            [next(!held), next(!held), next(pressure)]
        };
        let numbers = (0..side * side).map(number).collect();
        (numbers, count as usize)
    }
}

/// Matrix of one triangle: two components at six nodes, three pressures.
fn element(problem: Problem, mesh: &Mesh, nodes: &[usize; 6]) -> [[f64; 15]; 15] {
    let p = [0, 1, 2].map(|k| mesh.point(nodes[k]));
    let edge = |k: usize| [p[k][0] - p[0][0], p[k][1] - p[0][1]];
    let ([a, c], [b, d]) = (edge(1), edge(2));
    let determinant = a * d - b * c;
    let mut matrix = [[0.0; 15]; 15];
    let rule = quadrature(Cell::Triangle, 5).expect("the table goes that far");
    for (x, weight) in rule.iter() {
        let (mut n, mut g, mut q) = ([0.0; 6], [0.0; 12], [0.0; 3]);
        Element::P2_TRIANGLE.evaluate(x, &mut n);
        Element::P2_TRIANGLE.gradients(x, &mut g);
        Element::P1_TRIANGLE.evaluate(x, &mut q);
        let gradient = |k: usize| {
            let (r, s) = (g[2 * k], g[2 * k + 1]);
            [(d * r - c * s) / determinant, (a * s - b * r) / determinant]
        };
        let gradients: [[f64; 2]; 6] = std::array::from_fn(gradient);
        let height = p[0][1] + c * x[0] + d * x[1];
        add_point(problem, (&n, &gradients, &q), height, weight * determinant, &mut matrix);
    }
    matrix
}

/// Adds one quadrature point.
fn add_point(
    problem: Problem,
    (n, g, q): (&[f64; 6], &[[f64; 2]; 6], &[f64; 3]),
    height: f64,
    weight: f64,
    matrix: &mut [[f64; 15]; 15],
) {
    let (lambda, reynolds) = match problem {
        Problem::Elasticity => (1.5, 0.0),
        Problem::Flow { reynolds } => (0.0, reynolds),
    };
    for a in 0..6 {
        for b in 0..6 {
            let dot = g[a][0] * g[b][0] + g[a][1] * g[b][1];
            // the stream is (height^2, height)
            let carried = n[a] * (height * height * g[b][0] + height * g[b][1]);
            let slope = [[0.0, 2.0 * height], [0.0, 1.0]];
            for i in 0..2 {
                for j in 0..2 {
                    let same = if i == j { dot + reynolds * carried } else { 0.0 };
                    let convected = reynolds * n[a] * n[b] * slope[i][j];
                    let value = same + g[a][j] * g[b][i] + lambda * g[a][i] * g[b][j] + convected;
                    matrix[2 * a + i][2 * b + j] += weight * value;
                }
            }
        }
        if let Problem::Flow { .. } = problem {
            for (k, q) in q.iter().enumerate() {
                for i in 0..2 {
                    matrix[2 * a + i][12 + k] -= weight * g[a][i] * q;
                    matrix[12 + k][2 * a + i] -= weight * g[a][i] * q;
                }
            }
        }
    }
}
