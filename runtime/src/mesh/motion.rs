//! How a mesh of a moving region goes along with its surface: the inside follows smoothly, until cells become too flat.

use super::Mesh;
use crate::solve::linear::{Definiteness, LinearError, LinearSolver};
use crate::solve::sparse::{MatrixKind, SparsePattern};
use ansatz_geometry::{Point, point};

/// Marks a vertex whose place is given.
const GIVEN: u32 = u32::MAX;

/// Displacement of the inner vertices from that of the surface: harmonic, with cells the stiffer the smaller they are, so that large ones give way
/// (Jacobian-based stiffening: K. Stein, T. Tezduyar, R. Benney, J. Appl. Mech. 70, 2003).
pub(super) struct Motion {
    /// Equation of each vertex.
    equations: Vec<u32>,
    /// Stiffness between an inner vertex, by its equation, and a given one.
    couplings: Vec<(u32, u32, f64)>,
    /// Factors between inner vertices; none where all are given.
    solver: Option<LinearSolver>,
}

impl Motion {
    /// For a mesh of the region by itself, in the shape that displacements start from.
    ///
    /// # Errors
    /// Those of the factorisation; the matrix of a mesh of positive areas is positive definite.
    pub(super) fn new(mesh: &Mesh) -> Result<Self, LinearError> {
        let equations = number_inner(mesh);
        let count = equations.iter().filter(|&&e| e != GIVEN).count();
        let inner = |cell: &[u32; 6]| -> Vec<u32> {
            cell[..3].iter().map(|&v| equations[v as usize]).filter(|&e| e != GIVEN).collect()
        };
        let groups: Vec<Vec<u32>> = mesh.cells.iter().map(inner).collect();
        let pattern =
            SparsePattern::from_elements(count, MatrixKind::Symmetric, groups.iter().map(Vec::as_slice));
        let mut values = vec![0.0; pattern.entries()];
        let mut couplings = Vec::new();
        for cell in &mesh.cells {
            let vertices = [cell[0], cell[1], cell[2]];
            let stiffness = stiffness(vertices.map(|v| mesh.nodes[v as usize]));
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                match [vertices[i], vertices[j]].map(|v| equations[v as usize]) {
                    [GIVEN, _] => {}
                    [row, GIVEN] => couplings.push((row, vertices[j], stiffness[i][j])),
                    [row, column] if row < column => {}
                    [row, column] => {
                        pattern
                            .position(row, column)
                            .into_iter()
                            .for_each(|at| values[at] += stiffness[i][j]);
                    }
                }
            }
        }
        let mut solver = if count == 0 { None } else { Some(LinearSolver::new(&pattern)?) };
        if let Some(solver) = &mut solver {
            solver.factor(&values, Definiteness::Positive)?;
        }
        Ok(Self { equations, couplings, solver })
    }

    /// Fills in the displacements of inner vertices; those of the others are given.
    ///
    /// # Errors
    /// Displacements that are not finite.
    pub(super) fn extend(&mut self, displacements: &mut [Point]) -> Result<(), LinearError> {
        let Some(solver) = &mut self.solver else { return Ok(()) };
        let n = solver.size();
        let mut loads = vec![0.0; 2 * n];
        for &(row, vertex, stiffness) in &self.couplings {
            for axis in 0..2 {
                loads[axis * n + row as usize] -= stiffness * displacements[vertex as usize][axis];
            }
        }
        solver.solve(&mut loads)?;
        for (displacement, &equation) in displacements.iter_mut().zip(&self.equations) {
            if equation != GIVEN {
                *displacement = [loads[equation as usize], loads[n + equation as usize]];
            }
        }
        Ok(())
    }
}

/// Numbers the vertices that lie on no path.
fn number_inner(mesh: &Mesh) -> Vec<u32> {
    let mut equations = vec![0; mesh.vertex_count];
    for edge in mesh.paths.iter().flat_map(|path| &path.edges) {
        edge.nodes[..2].iter().for_each(|&vertex| equations[vertex as usize] = GIVEN);
    }
    let inner = equations.iter_mut().filter(|equation| **equation != GIVEN);
    inner.zip(0..).for_each(|(equation, number)| *equation = number);
    equations
}

/// Integrals of the products of the gradients of the linear shape functions, divided by the area.
fn stiffness([a, b, c]: [Point; 3]) -> [[f64; 3]; 3] {
    let opposite = [point::sub(c, b), point::sub(a, c), point::sub(b, a)];
    let twice_area = point::cross(opposite[2], point::sub(c, a));
    // grad phi_i is the opposite side, turned by a right angle, over twice the area.
    opposite.map(|from| opposite.map(|to| point::dot(from, to) / (twice_area * twice_area)))
}
