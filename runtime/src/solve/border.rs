//! Sparse systems with a border: a few unknowns that couple to many others.
//!
//! A tension, an indentation or a prescribed volume belongs to no element and would fill its rows
//! and columns of the sparse matrix. Instead the sparse equations are eliminated:
//!
//! ```text
//! | K    B | | x |   | f |       S = D - C^T K^-1 B
//! | C^T  D | | y | = | g |       S y = g - C^T K^-1 f,   x = K^-1 f - K^-1 B y
//! ```
//!
//! Solutions are refined with the residual of the whole system, which restores what is lost when
//! `K` alone is nearly singular, as at a limit point (Govaerts, SIAM J. Matrix Anal. 12, 1991).

use super::dense::{DenseLu, negative_eigenvalues};
use super::linear::{
    BACKWARD_ERROR, Definiteness, FactorReport, LinearError, LinearSolver, REFINEMENTS, SolveReport,
};
use super::sparse::SparsePattern;

/// The dense part of a bordered matrix with `m` borders around `n` sparse equations.
#[derive(Clone, Copy, Debug)]
pub struct Border<'a> {
    /// `B`, `n` rows and `m` columns, column after column.
    pub columns: &'a [f64],
    /// `C`, laid out as `B`; `None` when `C = B`.
    pub rows: Option<&'a [f64]>,
    /// `D`, `m` rows and `m` columns, column after column.
    pub corner: &'a [f64],
}

/// A sum of products of columns of length `n`, laid out column after column.
#[derive(Clone, Copy, Debug)]
pub enum Products<'a> {
    /// `sum_k w_k c_k c_k^T`; no weight is zero.
    Weighted {
        /// `c`.
        columns: &'a [f64],
        /// `w`.
        weights: &'a [f64],
    },
    /// `sum_k b_k c_k^T`.
    General {
        /// `b`.
        b: &'a [f64],
        /// `c`.
        c: &'a [f64],
    },
}

/// Direct solver for bordered matrices that share one pattern.
pub struct BorderedSolver {
    sparse: LinearSolver,
    borders: usize,
    columns: Vec<f64>,
    rows: Vec<f64>,
    corner: Vec<f64>,
    /// `K^-1 B`, then `K^-1 C` where it was wanted, then the solution for `ahead` where there is one.
    eliminated: Vec<f64>,
    /// Right-hand side that was solved for together with the borders; none is empty.
    ahead: Vec<f64>,
    schur_matrix: Vec<f64>,
    schur: DenseLu,
    residual: Vec<f64>,
    border_residual: Vec<f64>,
    solution: Vec<f64>,
    border_solution: Vec<f64>,
}

impl BorderedSolver {
    /// Analyses the sparse pattern.
    ///
    /// # Errors
    /// As [`LinearSolver::new`].
    pub fn new(pattern: &SparsePattern) -> Result<Self, LinearError> {
        let [residual, solution] = [(); 2].map(|()| vec![0.0; pattern.size()]);
        Ok(Self {
            sparse: LinearSolver::new(pattern)?,
            borders: 0,
            columns: Vec::new(),
            rows: Vec::new(),
            corner: Vec::new(),
            eliminated: Vec::new(),
            ahead: Vec::new(),
            schur_matrix: Vec::new(),
            schur: DenseLu::new(0),
            residual,
            border_residual: Vec::new(),
            solution,
            border_solution: Vec::new(),
        })
    }

    /// As [`LinearSolver::use_threads`].
    ///
    /// # Errors
    /// As there.
    pub fn use_threads(&mut self, threads: usize) -> Result<(), LinearError> {
        self.sparse.use_threads(threads)
    }

    /// Number of sparse equations.
    pub fn size(&self) -> usize {
        self.sparse.size()
    }

    /// Number of borders, or products, of the last factorisation.
    pub fn borders(&self) -> usize {
        self.borders
    }

    /// Factors the sparse matrix with `values`, and the border around it.
    ///
    /// The report's negative eigenvalues are those of the whole matrix (Haynsworth: those of `K`
    /// and of `S`), or `None` when it is not symmetric.
    ///
    /// # Errors
    /// As [`LinearSolver::factor`] for the sparse matrix, which must itself be regular;
    /// [`LinearError::SingularBorder`].
    pub fn factor(
        &mut self,
        values: &[f64],
        border: Border<'_>,
        expected: Definiteness,
    ) -> Result<FactorReport, LinearError> {
        let rows = border.rows.unwrap_or(border.columns);
        self.surround(border.columns.len(), |corner| corner.copy_from_slice(border.corner));
        let report = self.sparse.factor(values, expected)?;
        self.eliminate_columns(border.columns, rows, false, &[])?;
        let negative_pivots = match (report.negative_pivots, border.rows) {
            (Some(negative), None) => {
                Some(negative + negative_eigenvalues(self.borders, &mut self.schur_matrix))
            }
            _ => None,
        };
        Ok(FactorReport { negative_pivots, ..report })
    }

    /// Factors the sum of the sparse matrix and products of columns, `K + sum_k b_k c_k^T`.
    ///
    /// The sum is the matrix of the system bordered by `b_k`, `c_k` and minus the identity (or minus `1/w_k` between equal columns) once the
    /// border unknowns are eliminated (Sherman, Morrison and Woodbury). [`Self::solve`] with a
    /// vanishing border right-hand side solves with the sum and leaves `c_k^T x` (times `w_k`) in the border.
    ///
    /// When `K` is symmetric, the report's negative eigenvalues are those of the symmetric part of
    /// the products added to `K`, so of the sum whenever that is symmetric.
    ///
    /// The `first` right-hand side to be solved for may be empty. Otherwise it goes together with the products through the factors, so that its
    /// solution takes hardly any time.
    ///
    /// # Errors
    /// As [`Self::factor`].
    pub fn factor_low_rank(
        &mut self,
        values: &[f64],
        products: Products<'_>,
        expected: Definiteness,
        first: &[f64],
    ) -> Result<FactorReport, LinearError> {
        let (b, c) = match products {
            Products::Weighted { columns, .. } => (columns, columns),
            Products::General { b, c } => (b, c),
        };
        self.surround(b.len(), |corner| {
            let size = (corner.len() as f64).sqrt() as usize;
            for (k, diagonal) in corner.iter_mut().step_by(size + 1).enumerate() {
                *diagonal = match products {
                    Products::Weighted { weights, .. } => -weights[k].recip(),
                    Products::General { .. } => -1.0,
                };
            }
        });
        let report = self.sparse.factor(values, expected)?;
        let both = matches!(products, Products::General { .. }) && report.negative_pivots.is_some();
        self.eliminate_columns(b, c, both, first)?;
        let change = match products {
            Products::Weighted { weights, .. } => self.negative_by_squares(weights),
            Products::General { .. } => self.negative_by_products(),
        };
        let negative_pivots = report.negative_pivots.map(|negative| negative.saturating_add_signed(change));
        Ok(FactorReport { negative_pivots, ..report })
    }

    /// Makes room for borders of this total length and writes their corner.
    fn surround(&mut self, length: usize, corner: impl FnOnce(&mut [f64])) {
        let borders = length / self.size().max(1);
        if borders != self.borders || self.corner.is_empty() {
            self.borders = borders;
            self.schur = DenseLu::new(borders);
            self.columns.resize(length, 0.0);
            self.rows.resize(length, 0.0);
            self.schur_matrix.resize(borders * borders, 0.0);
            self.corner.resize(borders * borders, 0.0);
            self.border_residual.resize(borders, 0.0);
            self.border_solution.resize(borders, 0.0);
        }
        self.ahead.clear();
        self.corner.fill(0.0);
        corner(&mut self.corner);
    }

    /// Solves for the columns of `B`, of `C` when asked, and what comes first, and factors `S`.
    fn eliminate_columns(
        &mut self,
        b: &[f64],
        c: &[f64],
        both: bool,
        first: &[f64],
    ) -> Result<(), LinearError> {
        if self.borders == 0 {
            return Ok(());
        }
        self.columns.copy_from_slice(b);
        self.rows.copy_from_slice(c);
        self.eliminated.clear();
        for part in [b, if both { c } else { &[] }, first] {
            self.eliminated.extend_from_slice(part);
        }
        self.sparse.solve_unchecked(&mut self.eliminated)?;
        self.ahead.extend_from_slice(first);
        self.schur_matrix.copy_from_slice(&self.corner);
        let eliminated = self.eliminated.chunks_exact(self.sparse.size());
        for (schur, eliminated) in self.schur_matrix.chunks_exact_mut(self.borders).zip(eliminated) {
            subtract_transposed(&self.rows, eliminated, schur);
        }
        self.schur.factor(&self.schur_matrix).map_err(|border| LinearError::SingularBorder { border })
    }

    /// Change of the number of negative eigenvalues from `K` to `K + sum_k w_k c_k c_k^T`.
    fn negative_by_squares(&mut self, weights: &[f64]) -> isize {
        let in_corner = weights.iter().filter(|weight| **weight > 0.0).count();
        negative_eigenvalues(self.borders, &mut self.schur_matrix) as isize - in_corner as isize
    }

    /// Change of the number of negative eigenvalues from `K` to `K + (B C^T + C B^T) / 2`.
    ///
    /// The latter is `K - U J^-1 U^T` with `U = [B C]` and `J = -2 [0 I; I 0]`, which has one
    /// negative eigenvalue for each border; Haynsworth's formula is applied from both corners.
    fn negative_by_products(&self) -> isize {
        let order = 2 * self.borders;
        let mut schur = vec![0.0; order * order];
        let eliminated = self.eliminated.chunks_exact(self.sparse.size());
        for (k, (column, eliminated)) in schur.chunks_exact_mut(order.max(1)).zip(eliminated).enumerate() {
            column[(k + self.borders) % order] = -2.0;
            let (upper, lower) = column.split_at_mut(self.borders);
            subtract_transposed(&self.columns, eliminated, upper);
            subtract_transposed(&self.rows, eliminated, lower);
        }
        negative_eigenvalues(order, &mut schur) as isize - self.borders as isize
    }

    /// Solves in place: `f` becomes `x`, `g` becomes `y`.
    ///
    /// # Errors
    /// As [`LinearSolver::solve`].
    pub fn solve(&mut self, f: &mut [f64], g: &mut [f64]) -> Result<SolveReport, LinearError> {
        if self.borders == 0 {
            return self.sparse.solve(f);
        }
        self.solution.copy_from_slice(f);
        self.border_solution.copy_from_slice(g);
        self.eliminate(Target::Solution)?;
        let mut report = self.check(f, g)?;
        while report.backward_error > BACKWARD_ERROR && report.refinements < REFINEMENTS {
            let before = report;
            self.eliminate(Target::Residual)?;
            add(&self.residual, &mut self.solution);
            add(&self.border_residual, &mut self.border_solution);
            report = SolveReport { refinements: before.refinements + 1, ..self.check(f, g)? };
            if report.backward_error > 0.5 * before.backward_error {
                break;
            }
        }
        f.copy_from_slice(&self.solution);
        g.copy_from_slice(&self.border_solution);
        Ok(report)
    }

    /// Block elimination of the right-hand side held in a pair of vectors.
    fn eliminate(&mut self, target: Target) -> Result<(), LinearError> {
        let (x, y) = match target {
            Target::Solution => (&mut self.solution, &mut self.border_solution),
            Target::Residual => (&mut self.residual, &mut self.border_residual),
        };
        if self.ahead == *x {
            let start = self.eliminated.len() - x.len();
            x.copy_from_slice(&self.eliminated[start..]);
        } else {
            self.sparse.solve_unchecked(x)?;
        }
        subtract_transposed(&self.rows, x, y);
        self.schur.solve(y);
        subtract_product(&self.eliminated, y, x);
        Ok(())
    }

    /// Residual of the whole system, and the larger of the backward errors of its two parts.
    fn check(&mut self, f: &[f64], g: &[f64]) -> Result<SolveReport, LinearError> {
        self.residual.copy_from_slice(f);
        subtract_product(&self.columns, &self.border_solution, &mut self.residual);
        let mut report = self.sparse.residual(&self.solution, &mut self.residual)?;
        self.border_residual.copy_from_slice(g);
        subtract_product(&self.corner, &self.border_solution, &mut self.border_residual);
        subtract_transposed(&self.rows, &self.solution, &mut self.border_residual);
        for (border, residual) in self.border_residual.iter().enumerate() {
            let row = self.rows[border * self.solution.len()..].iter().zip(&self.solution);
            let corner = self.corner.iter().skip(border).step_by(self.borders).zip(&self.border_solution);
            let terms = g[border].abs() + row.chain(corner).map(|(a, x)| (a * x).abs()).sum::<f64>();
            if *residual != 0.0 {
                report.backward_error = report.backward_error.max(residual.abs() / terms);
            }
        }
        Ok(report)
    }
}

/// The pair of vectors that a block elimination is applied to.
#[derive(Clone, Copy)]
enum Target {
    Solution,
    Residual,
}

/// `y += x`.
fn add(x: &[f64], y: &mut [f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += x);
}

/// `y -= A x`, with `A` column after column.
fn subtract_product(a: &[f64], x: &[f64], y: &mut [f64]) {
    for (column, factor) in a.chunks_exact(y.len()).zip(x) {
        y.iter_mut().zip(column).for_each(|(y, a)| *y -= a * factor);
    }
}

/// `y -= A^T x`, with `A` column after column.
fn subtract_transposed(a: &[f64], x: &[f64], y: &mut [f64]) {
    for (column, y) in a.chunks_exact(x.len()).zip(y) {
        *y -= column.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::linear::Method;
    use crate::solve::sparse::MatrixKind;

    const SIZE: usize = 40;

    /// A chain of springs with unit stiffness between neighbours and `ground` at every node.
    fn chain(kind: MatrixKind, ground: f64) -> (SparsePattern, Vec<f64>) {
        let elements: Vec<[u32; 2]> = (1..SIZE as u32).map(|k| [k - 1, k]).collect();
        let pattern = SparsePattern::from_elements(SIZE, kind, elements.iter().map(<[u32; 2]>::as_slice));
        let mut values = vec![0.0; pattern.entries()];
        pattern.for_each(|position, row, column| {
            let springs = if row == 0 || row + 1 == SIZE { 1.0 } else { 2.0 };
            values[position] = if row == column { springs + ground } else { -1.0 };
        });
        (pattern, values)
    }

    fn columns(count: usize, phase: f64) -> Vec<f64> {
        (0..count * SIZE).map(|k| (phase + k as f64 * 0.37).sin()).collect()
    }

    /// Solves the bordered system densely.
    fn dense(pattern: &SparsePattern, values: &[f64], border: Border<'_>, rhs: &[f64]) -> Vec<f64> {
        let size = rhs.len();
        let mut matrix = vec![0.0; size * size];
        pattern.for_each(|position, row, column| {
            matrix[column * size + row] = values[position];
            if pattern.kind() == MatrixKind::Symmetric {
                matrix[row * size + column] = values[position];
            }
        });
        let rows = border.rows.unwrap_or(border.columns);
        for j in 0..size - SIZE {
            for k in 0..SIZE {
                matrix[(SIZE + j) * size + k] = border.columns[j * SIZE + k];
                matrix[k * size + SIZE + j] = rows[j * SIZE + k];
            }
            for i in 0..size - SIZE {
                matrix[(SIZE + j) * size + SIZE + i] = border.corner[j * (size - SIZE) + i];
            }
        }
        let mut lu = DenseLu::new(size);
        lu.factor(&matrix).unwrap();
        let mut x = rhs.to_vec();
        lu.solve(&mut x);
        x
    }

    fn assert_close(computed: &[f64], exact: &[f64], tolerance: f64) {
        let largest = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (a, b) in computed.iter().zip(exact) {
            assert!((a - b).abs() <= tolerance * largest, "{a} is not {b}");
        }
    }

    #[test]
    fn bordered_solutions_agree_with_dense_ones() {
        let (b, c, corner) =
            (columns(3, 0.0), columns(3, 1.0), [1.0, 0.2, 0.0, -0.1, 2.0, 0.3, 0.0, 0.4, 0.0]);
        let rhs = columns(2, 0.5)[..SIZE + 3].to_vec();
        for (kind, rows) in [
            (MatrixKind::Symmetric, None),
            (MatrixKind::Symmetric, Some(&c)),
            (MatrixKind::Unsymmetric, Some(&c)),
        ] {
            let (pattern, values) = chain(kind, 0.1);
            let border = Border { columns: &b, rows: rows.map(Vec::as_slice), corner: &corner };
            let mut solver = BorderedSolver::new(&pattern).unwrap();
            let factored = solver.factor(&values, border, Definiteness::Positive).unwrap();
            assert_eq!(factored.negative_pivots.is_some(), rows.is_none());
            let (mut x, mut y) = (rhs[..SIZE].to_vec(), rhs[SIZE..].to_vec());
            let report = solver.solve(&mut x, &mut y).unwrap();
            assert!(report.backward_error <= BACKWARD_ERROR, "{report:?}");
            assert_close(&[x, y].concat(), &dense(&pattern, &values, border, &rhs), 1e-12);
        }
    }

    #[test]
    fn constraints_and_negative_springs_count_in_the_inertia() {
        let (pattern, values) = chain(MatrixKind::Symmetric, 0.1);
        let b = columns(2, 0.0);
        let mut solver = BorderedSolver::new(&pattern).unwrap();
        for (corner, negative) in [([0.0; 4], 2), ([-1.0, 0.0, 0.0, 1e6], 1), ([1e6, 0.0, 0.0, 1e6], 0)] {
            let border = Border { columns: &b, rows: None, corner: &corner };
            let report = solver.factor(&values, border, Definiteness::Positive).unwrap();
            assert_eq!((report.method, report.negative_pivots), (Method::Llt, Some(negative)));
        }
        let indefinite: Vec<f64> = values.iter().map(|value| -value).collect();
        let border = Border { columns: &b, rows: None, corner: &[0.0; 4] };
        let report = solver.factor(&indefinite, border, Definiteness::Indefinite).unwrap();
        assert_eq!(report.negative_pivots, Some(SIZE));
    }

    #[test]
    fn low_rank_sums_agree_with_assembled_ones() {
        // a spring of stiffness 9 between the ends, left out of the sparse matrix
        let (pattern, values) = chain(MatrixKind::Symmetric, 0.1);
        let mut stretch = vec![0.0; SIZE];
        (stretch[0], stretch[SIZE - 1]) = (1.0, -1.0);
        let products = Products::Weighted { columns: &stretch, weights: &[9.0] };
        let mut solver = BorderedSolver::new(&pattern).unwrap();
        let report = solver.factor_low_rank(&values, products, Definiteness::Positive, &[]).unwrap();
        assert_eq!(report.negative_pivots, Some(0));
        let f = columns(1, 0.2);
        let (mut x, mut force) = (f.clone(), [0.0]);
        solver.solve(&mut x, &mut force).unwrap();
        let mut residual = f;
        pattern.subtract_product(&values, &x, &mut residual);
        let expected = 9.0 * (x[0] - x[SIZE - 1]);
        residual[0] -= expected;
        residual[SIZE - 1] += expected;
        assert!(residual.iter().all(|r| r.abs() < 1e-13), "{residual:?}");
        assert!((force[0] - expected).abs() < 1e-12);
    }

    #[test]
    fn a_spring_that_pushes_shows_in_the_inertia() {
        let (pattern, values) = chain(MatrixKind::Symmetric, 0.1);
        let c = columns(2, 0.4);
        let mut solver = BorderedSolver::new(&pattern).unwrap();
        for (weights, negative) in [([1.0, 2.0], 0), ([-1e-6, 2.0], 0), ([-1.0, 2.0], 1), ([-1.0, -2.0], 2)] {
            let products = Products::Weighted { columns: &c, weights: &weights };
            let report = solver.factor_low_rank(&values, products, Definiteness::Positive, &[]).unwrap();
            assert_eq!(report.negative_pivots, Some(negative), "{weights:?}");
        }
    }

    #[test]
    fn unstable_products_show_in_the_inertia_of_the_sum() {
        // K + C M C^T with a symmetric M, given as products of B = C M with C
        let c = columns(2, 0.4);
        for (ground, m) in [
            (0.1, [[1.0, 2.0], [2.0, 1.0]]),
            (0.1, [[-1.0, 0.5], [0.5, -1.0]]),
            (0.1, [[0.0, 0.0], [0.0, 0.0]]),
            (-0.3, [[-1.0, 0.5], [0.5, -1.0]]),
            (-0.3, [[1e3, 0.0], [0.0, 1e-3]]),
        ] {
            let (pattern, values) = chain(MatrixKind::Symmetric, ground);
            let product = |j: usize, k: usize| c[k] * m[0][j] + c[SIZE + k] * m[1][j];
            let b: Vec<f64> =
                (0..2).flat_map(|j| (0..SIZE).map(move |k| (j, k))).map(|(j, k)| product(j, k)).collect();
            let mut sum: Vec<f64> = (0..SIZE * SIZE)
                .map(|entry| (0..2).map(|j| b[j * SIZE + entry % SIZE] * c[j * SIZE + entry / SIZE]).sum())
                .collect();
            pattern.for_each(|position, row, column| {
                sum[column * SIZE + row] += values[position];
                sum[row * SIZE + column] += if row == column { 0.0 } else { values[position] };
            });
            let negative = negative_eigenvalues(SIZE, &mut sum);
            let mut solver = BorderedSolver::new(&pattern).unwrap();
            let products = Products::General { b: &b, c: &c };
            let report = solver.factor_low_rank(&values, products, Definiteness::Positive, &[]).unwrap();
            assert_eq!(report.negative_pivots, Some(negative), "{ground} {m:?}");
        }
    }

    #[test]
    fn what_goes_through_the_factors_with_the_products_is_solved_as_if_alone() {
        let (pattern, values) = chain(MatrixKind::Symmetric, 0.1);
        let (c, weights) = (columns(2, 0.4), [1.0, 2.0]);
        let products = Products::Weighted { columns: &c, weights: &weights };
        let rhs = |k: usize| columns(1, 0.3 * k as f64);
        let mut solutions = [rhs(1), Vec::new()].map(|first| {
            let mut solver = BorderedSolver::new(&pattern).unwrap();
            solver.factor_low_rank(&values, products, Definiteness::Positive, &first).unwrap();
            [1, 2, 1].map(|k| {
                let (mut x, mut y) = (rhs(k), vec![0.0; 2]);
                let report = solver.solve(&mut x, &mut y).unwrap();
                assert!(report.backward_error <= BACKWARD_ERROR, "{report:?}");
                x
            })
        });
        let [together, alone] = &mut solutions;
        for (x, y) in together.iter().flatten().zip(alone.iter().flatten()) {
            // the condition of a chain of forty springs, a thousand or so, times the backward error
            assert!((x - y).abs() <= 1e-10 * y.abs().max(1.0), "{x} {y}");
        }
        assert_eq!(together[0], together[2]);
    }

    #[test]
    fn a_border_that_holds_a_nearly_free_body_keeps_its_accuracy() {
        // without the border a rigid motion costs 1e-9 of a spring
        let (pattern, values) = chain(MatrixKind::Symmetric, 1e-9);
        let mean = vec![1.0; SIZE];
        let border = Border { columns: &mean, rows: None, corner: &[0.0] };
        let mut solver = BorderedSolver::new(&pattern).unwrap();
        solver.factor(&values, border, Definiteness::Positive).unwrap();
        let (mut x, mut y) = (columns(1, 0.3), [0.7]);
        let rhs = [x.as_slice(), &y].concat();
        let report = solver.solve(&mut x, &mut y).unwrap();
        assert!(report.backward_error <= BACKWARD_ERROR && report.refinements > 0, "{report:?}");
        assert_close(&[x.as_slice(), &y].concat(), &dense(&pattern, &values, border, &rhs), 1e-12);
    }

    #[test]
    fn equal_borders_are_singular() {
        let (pattern, values) = chain(MatrixKind::Symmetric, 0.1);
        let b = [columns(1, 0.0), columns(1, 0.0)].concat();
        let border = Border { columns: &b, rows: None, corner: &[0.0; 4] };
        let result = BorderedSolver::new(&pattern).unwrap().factor(&values, border, Definiteness::Positive);
        assert_eq!(result, Err(LinearError::SingularBorder { border: 1 }));
    }

    #[test]
    fn no_border_is_the_sparse_system() {
        let (pattern, values) = chain(MatrixKind::Symmetric, 0.1);
        let mut bordered = BorderedSolver::new(&pattern).unwrap();
        let border = Border { columns: &[], rows: None, corner: &[] };
        bordered.factor(&values, border, Definiteness::Positive).unwrap();
        let mut sparse = LinearSolver::new(&pattern).unwrap();
        sparse.factor(&values, Definiteness::Positive).unwrap();
        let (mut x, mut y) = (columns(1, 0.0), columns(1, 0.0));
        bordered.solve(&mut x, &mut []).unwrap();
        sparse.solve(&mut y).unwrap();
        assert_eq!(x, y);
    }
}
