//! What the solver promises, on matrices small enough to check densely.

use super::*;
use crate::solve::sparse::SparsePattern;

/// Deterministic numbers in (-1, 1).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, length: usize) -> Vec<f64> {
        (0..length).map(|_| self.next()).collect()
    }
}

/// Largest magnitude.
fn max_norm(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

struct System {
    pattern: SparsePattern,
    values: Vec<f64>,
}

impl System {
    fn residual(&self, x: &[f64], b: &[f64]) -> f64 {
        let mut r = b.to_vec();
        self.pattern.subtract_product(&self.values, x, &mut r);
        max_norm(&r) / max_norm(b)
    }

    fn solver(&self) -> LinearSolver {
        LinearSolver::new(&self.pattern).unwrap()
    }
}

/// Couples neighbours on a ring and a few random pairs.
fn random_pattern(size: u32, kind: MatrixKind, noise: &mut Noise) -> SparsePattern {
    let mut elements: Vec<[u32; 2]> = (0..size).map(|k| [k, (k + 1) % size]).collect();
    let mut index = || ((noise.next() + 1.0) * 0.5 * f64::from(size)) as u32;
    elements.extend((0..size).map(|_| [index(), index()]));
    SparsePattern::from_elements(size as usize, kind, elements.iter().map(<[u32; 2]>::as_slice))
}

/// Random off-diagonal entries under a dominant diagonal with the given signs.
fn dominant(size: u32, kind: MatrixKind, sign: impl Fn(usize) -> f64) -> System {
    let mut noise = Noise(7);
    let pattern = random_pattern(size, kind, &mut noise);
    let mut values = noise.vector(pattern.entries());
    let mut sums = vec![0.0; size as usize];
    pattern.for_each(|position, row, column| {
        sums[row] += f64::abs(values[position]);
        sums[column] += f64::abs(values[position]);
    });
    pattern.for_each(|position, row, column| {
        if row == column {
            values[position] = sign(row) * (1.0 + sums[row]);
        }
    });
    System { pattern, values }
}

/// Vector Laplacian with cross terms on quadratic triangles, fixed along one side when asked.
///
/// The squares of an `nx` by `ny` grid are halved; every triangle adds a sum of squares of
/// differences of nodal values, so the matrix is positive definite once it is fixed.
fn triangles(nx: u32, ny: u32, fixed: bool) -> System {
    let width = 2 * nx + 1;
    let node = |x: u32, y: u32| y * width + x;
    let equation = |node: u32, component: u32| match fixed {
        true => (!node.is_multiple_of(width)).then(|| 2 * (node - node / width - 1) + component),
        false => Some(2 * node + component),
    };
    let mut elements: Vec<Vec<u32>> = Vec::new();
    for (x, y) in (0..ny).flat_map(|j| (0..nx).map(move |i| (2 * i, 2 * j))) {
        let corners = [
            [(0, 0), (2, 0), (2, 2), (1, 0), (2, 1), (1, 1)],
            [(0, 0), (2, 2), (0, 2), (1, 1), (1, 2), (0, 1)],
        ];
        for triangle in corners {
            elements.push(triangle.iter().map(|&(dx, dy)| node(x + dx, y + dy)).collect());
        }
    }
    let equations: Vec<Vec<u32>> = elements
        .iter()
        .map(|nodes| nodes.iter().flat_map(|&n| [0, 1].map(|c| equation(n, c))).flatten().collect())
        .collect();
    let size = 2 * (width - u32::from(fixed)) * (2 * ny + 1);
    let pattern = SparsePattern::from_elements(
        size as usize,
        MatrixKind::Symmetric,
        equations.iter().map(Vec::as_slice),
    );
    let mut values = vec![0.0; pattern.entries()];
    let mut add = |row: Option<u32>, column: Option<u32>, value: f64| {
        if let (Some(row), Some(column)) = (row, column)
            && row >= column
        {
            values[pattern.position(row, column).unwrap()] += value;
        }
    };
    for nodes in &elements {
        for (k, &a) in nodes.iter().enumerate() {
            let b = nodes[(k + 1) % nodes.len()];
            // the energy (u_a - u_b)^2 + (v_a - v_b)^2 + (u_a - u_b)(v_a - v_b)
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let weight = if i == j { 2.0 } else { 1.0 };
                for (p, q, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                    add(equation(p, i), equation(q, j), sign * weight);
                }
            }
        }
    }
    System { pattern, values }
}

/// Rows and columns multiplied by powers of ten between 1e-8 and 1e8, alike where symmetric.
fn badly_scaled(mut system: System) -> System {
    let mut noise = Noise(3);
    let rows: Vec<f64> = (0..system.pattern.size()).map(|_| 10f64.powf(8.0 * noise.next())).collect();
    let columns: Vec<f64> = match system.pattern.kind() {
        MatrixKind::Symmetric => rows.clone(),
        MatrixKind::Unsymmetric => rows.iter().map(|_| 10f64.powf(8.0 * noise.next())).collect(),
    };
    system.pattern.for_each(|position, row, column| system.values[position] *= rows[row] * columns[column]);
    system
}

/// Factors, solves, and returns both reports after checking the residual on the original matrix.
fn solve(system: &System) -> (FactorReport, SolveReport) {
    let mut solver = system.solver();
    let factored = solver.factor(&system.values, Definiteness::Positive).unwrap();
    let b = Noise(11).vector(system.pattern.size());
    let mut x = b.clone();
    let solved = solver.solve(&mut x).unwrap();
    // relative to the right-hand side: rounding times the condition number, at most 1e3 here
    assert!(system.residual(&x, &b) <= 1e-12, "{}", system.residual(&x, &b));
    (factored, solved)
}

#[test]
fn positive_definite_matrices_are_factored_by_cholesky() {
    for system in [dominant(300, MatrixKind::Symmetric, |_| 1.0), triangles(9, 7, true)] {
        let (factored, solved) = solve(&system);
        assert_eq!((factored.method, factored.negative_pivots), (Method::Llt, Some(0)));
        assert!(solved.backward_error <= BACKWARD_ERROR);
    }
}

#[test]
fn inertia_of_an_indefinite_matrix_is_found() {
    // diagonal dominance makes the signs of the diagonal those of the eigenvalues (Gershgorin)
    let system = dominant(300, MatrixKind::Symmetric, |k| if k % 3 == 0 { -1.0 } else { 1.0 });
    let (factored, _) = solve(&system);
    assert_eq!((factored.method, factored.negative_pivots), (Method::Lblt, Some(100)));
}

#[test]
fn inertia_counts_two_row_pivots() {
    // [[e, 1], [1, e]] has eigenvalues e + 1 and e - 1
    let elements: Vec<[u32; 2]> = (0..20).map(|k| [2 * k, 2 * k + 1]).collect();
    let pattern =
        SparsePattern::from_elements(40, MatrixKind::Symmetric, elements.iter().map(<[u32; 2]>::as_slice));
    let mut values = vec![1.0; pattern.entries()];
    pattern.for_each(|position, row, column| {
        if row == column {
            values[position] = 1e-3;
        }
    });
    let (factored, _) = solve(&System { pattern, values });
    assert_eq!((factored.method, factored.negative_pivots), (Method::Lblt, Some(20)));
}

#[test]
fn a_shifted_membrane_loses_as_many_pivots_either_way() {
    let mut system = triangles(6, 5, true);
    system.pattern.for_each(|position, row, column| {
        if row == column {
            system.values[position] -= 0.9;
        }
    });
    let mut solver = system.solver();
    let first = solver.factor(&system.values, Definiteness::Positive).unwrap();
    assert_eq!(first.method, Method::Lblt);
    assert!(first.negative_pivots.unwrap() > 3);
    assert_eq!(solver.factor(&system.values, Definiteness::Indefinite).unwrap(), first);
    assert_eq!(solve(&system).0, first);
}

#[test]
fn a_definite_matrix_expected_to_be_indefinite_has_no_negative_pivot() {
    let system = triangles(4, 4, true);
    let report = system.solver().factor(&system.values, Definiteness::Indefinite).unwrap();
    assert_eq!((report.method, report.negative_pivots), (Method::Lblt, Some(0)));
}

#[test]
fn unsymmetric_matrices_are_factored_by_lu() {
    let system = dominant(300, MatrixKind::Unsymmetric, |k| if k % 3 == 0 { -1.0 } else { 1.0 });
    let (factored, _) = solve(&system);
    assert_eq!((factored.method, factored.negative_pivots), (Method::Lu, None));
}

#[test]
fn sixteen_powers_of_ten_in_rows_and_columns_do_not_matter() {
    let scaled = |system: System| {
        let system = badly_scaled(system);
        let mut solver = system.solver();
        solver.factor(&system.values, Definiteness::Positive).unwrap();
        // a right-hand side with the scale of the rows
        let mut b = vec![0.0; system.pattern.size()];
        system.pattern.subtract_product(&system.values, &vec![1.0; b.len()], &mut b);
        solver.solve(&mut b).unwrap()
    };
    for kind in [MatrixKind::Symmetric, MatrixKind::Unsymmetric] {
        let report = scaled(dominant(300, kind, |k| if k % 3 == 0 { -1.0 } else { 1.0 }));
        assert!(report.backward_error <= BACKWARD_ERROR, "{report:?}");
        assert!(report.relative_residual <= 1e-12, "{report:?}");
    }
    let report = scaled(triangles(6, 5, true));
    assert!(report.relative_residual <= 1e-12, "{report:?}");
}

#[test]
fn an_unsupported_body_is_singular() {
    let system = triangles(6, 5, false);
    let result = system.solver().factor(&system.values, Definiteness::Positive);
    assert!(matches!(result, Err(LinearError::Singular { .. })), "{result:?}");
}

#[test]
fn a_dependent_equation_is_named() {
    // equations 3 and 5 are equal, the others are their own
    for kind in [MatrixKind::Symmetric, MatrixKind::Unsymmetric] {
        let pattern = SparsePattern::from_elements(8, kind, [[3, 5].as_slice()]);
        let solver = &mut LinearSolver::new(&pattern).unwrap();
        let result = solver.factor(&vec![1.0; pattern.entries()], Definiteness::Positive);
        assert!(matches!(result, Err(LinearError::Singular { equation: 3 | 5 })), "{kind:?} {result:?}");
        assert_eq!(solver.solve(&mut [1.0; 8]), Err(LinearError::NotFactored));
    }
}

#[test]
fn empty_equations_are_named() {
    for kind in [MatrixKind::Symmetric, MatrixKind::Unsymmetric] {
        let System { pattern, mut values } = dominant(50, kind, |_| 1.0);
        pattern.for_each(|position, row, column| {
            if row == 17 || (column == 17 && kind == MatrixKind::Symmetric) {
                values[position] = 0.0;
            }
        });
        let result = LinearSolver::new(&pattern).unwrap().factor(&values, Definiteness::Positive);
        assert_eq!(result, Err(LinearError::EmptyRow { equation: 17 }));
    }
    let System { pattern, mut values } = dominant(50, MatrixKind::Unsymmetric, |_| 1.0);
    values[pattern.column(23)].fill(0.0);
    let result = LinearSolver::new(&pattern).unwrap().factor(&values, Definiteness::Positive);
    assert_eq!(result, Err(LinearError::EmptyColumn { equation: 23 }));
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let mut system = dominant(50, MatrixKind::Symmetric, |_| 1.0);
    let mut solver = system.solver();
    solver.factor(&system.values, Definiteness::Positive).unwrap();
    let mut rhs = vec![1.0; 50];
    rhs[31] = f64::NAN;
    assert_eq!(solver.solve(&mut rhs), Err(LinearError::NonFiniteRightHandSide { equation: 31 }));
    let position = system.pattern.position(8, 7).unwrap();
    system.values[position] = f64::INFINITY;
    let result = solver.factor(&system.values, Definiteness::Positive);
    assert!(matches!(result, Err(LinearError::NonFiniteEntry { row: 7 | 8, column: 7 | 8 })), "{result:?}");
}

#[test]
fn a_saddle_point_matrix_with_zeros_on_its_diagonal_is_solved() {
    // one constraint on the sum of each pair of neighbours
    let elements: Vec<[u32; 3]> = (0..30).map(|k| [k, k + 1, 31 + k]).collect();
    let pattern =
        SparsePattern::from_elements(61, MatrixKind::Symmetric, elements.iter().map(<[u32; 3]>::as_slice));
    let mut values = vec![0.0; pattern.entries()];
    pattern.for_each(|position, row, column| {
        values[position] = match (row < 31, row == column) {
            (true, true) => 2.0,
            (true, false) => -0.5,
            (false, true) => 0.0,
            (false, false) => 1.0,
        };
    });
    let (factored, _) = solve(&System { pattern, values });
    assert!(matches!(factored.negative_pivots, Some(30) | None), "{factored:?}");
}

#[test]
fn a_permutation_needs_pivots_from_everywhere() {
    let pattern = random_pattern(40, MatrixKind::Unsymmetric, &mut Noise(5));
    let mut values = vec![0.0; pattern.entries()];
    pattern.for_each(|position, row, column| {
        if row == (column + 1) % 40 {
            values[position] = 2.0 + column as f64;
        }
    });
    let (factored, solved) = solve(&System { pattern, values });
    assert!(matches!(factored.method, Method::Lu | Method::PivotingLu), "{factored:?}");
    assert!(solved.backward_error <= BACKWARD_ERROR, "{solved:?}");
}

#[test]
fn several_right_hand_sides_are_solved_at_once() {
    for kind in [MatrixKind::Symmetric, MatrixKind::Unsymmetric] {
        let system = dominant(60, kind, |k| if k == 5 { -1.0 } else { 1.0 });
        let mut solver = system.solver();
        solver.factor(&system.values, Definiteness::Positive).unwrap();
        let b = Noise(5).vector(180);
        let mut x = b.clone();
        solver.solve(&mut x).unwrap();
        for (x, b) in x.chunks(60).zip(b.chunks(60)) {
            assert!(system.residual(x, b) <= 1e-14, "{kind:?} {}", system.residual(x, b));
        }
    }
}

#[test]
fn reused_storage_gives_identical_bits() {
    let system = triangles(6, 5, true);
    let indefinite: Vec<f64> = system.values.iter().map(|value| -value).collect();
    let mut solver = system.solver();
    let b = Noise(5).vector(system.pattern.size());
    let mut solutions = [0, 1].map(|_| {
        solver.factor(&system.values, Definiteness::Positive).unwrap();
        let mut x = b.clone();
        solver.solve(&mut x).unwrap();
        solver.factor(&indefinite, Definiteness::Positive).unwrap();
        let mut y = [b.clone(), b.clone()].concat();
        solver.solve(&mut y).unwrap();
        [x, y].concat()
    });
    let [first, second] = &mut solutions;
    assert_eq!(first, second);
}

#[test]
fn no_equations_are_an_error() {
    for kind in [MatrixKind::Symmetric, MatrixKind::Unsymmetric] {
        let pattern = SparsePattern::from_elements(0, kind, std::iter::empty());
        assert_eq!(LinearSolver::new(&pattern).err(), Some(LinearError::NoEquations));
    }
}

#[test]
fn one_equation_is_divided() {
    for kind in [MatrixKind::Symmetric, MatrixKind::Unsymmetric] {
        let pattern = SparsePattern::from_elements(1, kind, std::iter::empty());
        let mut solver = LinearSolver::new(&pattern).unwrap();
        solver.factor(&[4.0], Definiteness::Positive).unwrap();
        let mut x = [2.0];
        solver.solve(&mut x).unwrap();
        assert_eq!(x, [0.5]);
    }
}
