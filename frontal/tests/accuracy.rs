//! Residuals, and errors against an independent factorisation, on matrices of finite elements.

mod common;

use ansatz_frontal::{Kind, Pattern, SolveReport, Solver};
use common::{Matrix, Problem, matrix};
use faer::prelude::Solve;
use faer::sparse::{SparseColMat, Triplet};

const FLOWS: [Problem; 2] = [Problem::Flow { reynolds: 0.0 }, Problem::Flow { reynolds: 200.0 }];

fn pattern(matrix: &Matrix, kind: Kind) -> Pattern<'_> {
    Pattern { kind, starts: &matrix.starts, rows: &matrix.rows }
}

/// Deterministic numbers in (-1, 1).
fn noise(length: usize) -> Vec<f64> {
    let mut state = 17_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..length).map(|_| next()).collect()
}

fn solve(matrix: &Matrix, kind: Kind, rhs: &[f64]) -> (Vec<f64>, SolveReport) {
    let mut solver = Solver::new(pattern(matrix, kind), &matrix.weak()).unwrap();
    solver.factor(&matrix.values).unwrap();
    let mut x = rhs.to_vec();
    let accuracy = solver.solve(&mut x);
    (x, accuracy)
}

/// Solution by the library's sparse LU, which pivots over whole columns.
fn reference(matrix: &Matrix, rhs: &[f64]) -> Vec<f64> {
    let mut triplets = Vec::new();
    matrix.for_each(|row, column, value| triplets.push(Triplet::new(row, column, value)));
    let a = SparseColMat::<usize, f64>::try_new_from_triplets(rhs.len(), rhs.len(), &triplets).unwrap();
    let b = faer::Col::from_fn(rhs.len(), |k| rhs[k]);
    let x = a.sp_lu().unwrap().solve(&b);
    x.iter().copied().collect()
}

fn difference(x: &[f64], y: &[f64]) -> f64 {
    let norm = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, |m: f64, v| m.max(v.abs()));
    norm(&mut x.iter().zip(y).map(|(x, y)| x - y)) / norm(&mut y.iter().copied())
}

#[test]
fn solutions_are_those_of_a_factorisation_that_pivots_freely() {
    for problem in [Problem::Elasticity, FLOWS[0], FLOWS[1]] {
        let a = matrix(problem, 12);
        let b = noise(a.size());
        let (x, accuracy) = solve(&a, Kind::Unsymmetric, &b);
        assert!(accuracy.relative_residual <= 1e-12, "{problem:?} {accuracy:?}");
        // rounding times a condition number of up to 1e5
        let error = difference(&x, &reference(&a, &b));
        assert!(error < 1e-11, "{problem:?} {error}");
    }
}

#[test]
fn cholesky_and_lu_agree() {
    let a = matrix(Problem::Elasticity, 15);
    let b = noise(a.size());
    let (x, accuracy) = solve(&a.lower(), Kind::Symmetric, &b);
    assert!(accuracy.relative_residual <= 1e-12, "{accuracy:?}");
    let (y, _) = solve(&a, Kind::Unsymmetric, &b);
    assert!(difference(&x, &y) < 1e-11);
}
