//! Residuals, and errors against an independent factorisation, on matrices of finite elements.

mod common;

use ansatz_frontal::{Analysis, Error, Factors, Kind, Pattern, SolveReport, Solver};
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
    let mut solver = Solver::new(pattern(matrix, kind), &matrix.weak()).expect("the system is not empty");
    solver.factor(&matrix.values).expect("the matrix can be factored");
    let mut x = rhs.to_vec();
    let accuracy = solver.solve(&mut x);
    (x, accuracy)
}

/// Solution by the library's sparse LU, which pivots over whole columns.
fn reference(matrix: &Matrix, rhs: &[f64]) -> Vec<f64> {
    let mut triplets = Vec::new();
    matrix.for_each(|row, column, value| triplets.push(Triplet::new(row, column, value)));
    let a = SparseColMat::<usize, f64>::try_new_from_triplets(rhs.len(), rhs.len(), &triplets)
        .expect("positions are valid");
    let b = faer::Col::from_fn(rhs.len(), |k| rhs[k]);
    let x = a.sp_lu().expect("the matrix is regular").solve(&b);
    x.iter().copied().collect()
}

fn difference(x: &[f64], y: &[f64]) -> f64 {
    let norm = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, |m: f64, v| m.max(v.abs()));
    norm(&mut x.iter().zip(y).map(|(x, y)| x - y)) / norm(&mut y.iter().copied())
}

/// A matrix of every sort.
fn samples() -> [(&'static str, Matrix); 4] {
    [
        ("elasticity", matrix(Problem::Elasticity, 12)),
        ("Stokes", matrix(FLOWS[0], 12)),
        ("Navier-Stokes", matrix(FLOWS[1], 12)),
        ("contact", contact()),
    ]
}

#[test]
fn solutions_are_those_of_a_factorisation_that_pivots_freely() {
    for (problem, a) in samples() {
        let b = noise(a.size());
        let (x, accuracy) = solve(&a, Kind::Unsymmetric, &b);
        assert!(accuracy.relative_residual <= 1e-12, "{problem} {accuracy:?}");
        // rounding times a condition number of up to 1e5
        let error = difference(&x, &reference(&a, &b));
        assert!(error < 1e-11, "{problem} {error}");
    }
}

/// Powers of ten between 1e-8 and 1e8.
fn scales(length: usize, seed: usize) -> Vec<f64> {
    noise(length + seed)[seed..].iter().map(|x| 10f64.powf(8.0 * x)).collect()
}

/// Rows and columns multiplied by factors.
fn scaled(matrix: &Matrix, rows: &[f64], columns: &[f64]) -> Matrix {
    let mut entries = Vec::new();
    matrix.for_each(|row, column, value| {
        entries.push((row as u32, column as u32, rows[row] * value * columns[column]));
    });
    Matrix::from_entries(matrix.size(), entries)
}

/// Elasticity with stiff springs between unknowns that belong to no common element, pulled sideways when compressed.
fn contact() -> Matrix {
    let a = matrix(Problem::Elasticity, 10);
    let mut entries = Vec::new();
    a.for_each(|row, column, value| entries.push((row as u32, column as u32, value)));
    let last = a.size() as u32 - 1;
    for k in 0..15 {
        let (p, q) = (last - 2 * k, 7 * k);
        for (i, j, value) in [(p, p, 1e5), (p, q, -1e5), (q, p, -1e5), (q, q, 1e5)] {
            entries.push((i, j, value));
            entries.push((i - i % 2 + (i + 1) % 2, j, 0.3 * value));
            entries.push((j, i - i % 2 + (i + 1) % 2, 0.0));
        }
    }
    Matrix::from_entries(a.size(), entries)
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

#[test]
fn sixteen_powers_of_ten_in_rows_and_columns_do_not_matter() {
    for (problem, a) in samples() {
        let (rows, columns) = (scales(a.size(), 0), scales(a.size(), 5));
        let bad = scaled(&a, &rows, &columns);
        // a right-hand side with the scale of the rows, for a solution whose scaled form is noise
        let wanted: Vec<f64> = noise(a.size()).iter().zip(&columns).map(|(x, scale)| x / scale).collect();
        let mut b = vec![0.0; a.size()];
        bad.for_each(|row, column, value| b[row] += value * wanted[column]);
        let (x, report) = solve(&bad, Kind::Unsymmetric, &b);
        assert!(report.relative_residual <= 1e-12, "{problem} {report:?}");
        let unscaled =
            |x: &[f64]| -> Vec<f64> { x.iter().zip(&columns).map(|(x, scale)| x * scale).collect() };
        // rounding times the condition number of the equilibrated matrix
        let error = difference(&unscaled(&x), &unscaled(&wanted));
        assert!(error < 1e-9, "{problem} {error}");
    }
    let a = matrix(Problem::Elasticity, 12);
    let factors = scales(a.size(), 0);
    let b: Vec<f64> = noise(a.size()).iter().zip(&factors).map(|(x, factor)| x * factor).collect();
    let (_, report) = solve(&scaled(&a, &factors, &factors).lower(), Kind::Symmetric, &b);
    assert!(report.relative_residual <= 1e-12, "{report:?}");
}

#[test]
fn several_right_hand_sides_are_solved_as_one_by_one() {
    for (a, kind) in
        [(matrix(FLOWS[1], 9), Kind::Unsymmetric), (matrix(Problem::Elasticity, 9).lower(), Kind::Symmetric)]
    {
        let mut solver = Solver::new(pattern(&a, kind), &a.weak()).unwrap();
        solver.factor(&a.values).unwrap();
        // a pair; a full batch and what is left
        for count in [2, 11] {
            let rhs = noise(count * a.size());
            let mut together = rhs.clone();
            assert!(solver.solve(&mut together).relative_residual <= 1e-12);
            for (one, b) in together.chunks(a.size()).zip(rhs.chunks(a.size())) {
                let mut alone = b.to_vec();
                solver.solve(&mut alone);
                assert!(difference(one, &alone) < 1e-11);
            }
        }
    }
}

#[test]
fn the_same_matrix_gives_the_same_bits() {
    let a = matrix(FLOWS[1], 20);
    let mut factors =
        Factors::new(Analysis::new(pattern(&a, Kind::Unsymmetric), &a.weak()).unwrap()).unwrap();
    let mut solution = |values: &[f64]| {
        factors.factor(values).unwrap();
        let mut x = noise(a.size());
        factors.solve(&mut x);
        x
    };
    let first = solution(&a.values);
    let other: Vec<f64> =
        a.values.iter().enumerate().map(|(k, v)| v * (1.0 + 0.1 * (k as f64).sin())).collect();
    solution(&other);
    assert_eq!(solution(&a.values), first);
    assert_eq!(solve(&a, Kind::Unsymmetric, &first), solve(&a, Kind::Unsymmetric, &first));
}

#[test]
fn threads_change_no_more_than_rounding() {
    let flow = matrix(FLOWS[1], 40);
    let solid = matrix(Problem::Elasticity, 40).lower();
    for (a, kind) in [(&flow, Kind::Unsymmetric), (&solid, Kind::Symmetric)] {
        let analysis = Analysis::new(pattern(a, kind), &a.weak()).unwrap();
        let solutions = [1, 2, 3].map(|threads| {
            let mut factors = Factors::with_threads(analysis.clone(), threads).unwrap();
            assert_eq!(factors.threads(), threads);
            factors.factor(&a.values).unwrap();
            let mut x = noise(4 * a.size());
            factors.solve(&mut x[..a.size()]);
            factors.solve(&mut x[a.size()..]);
            x
        });
        assert!(difference(&solutions[1], &solutions[0]) < 1e-11);
        assert!(difference(&solutions[2], &solutions[0]) < 1e-11);
    }
}

#[test]
fn nested_dissection_saves_operations_and_needs_no_other_pivots() {
    let flow = matrix(FLOWS[1], 47);
    let solid = matrix(Problem::Elasticity, 47).lower();
    for (a, kind, saved) in [(&flow, Kind::Unsymmetric, 0.0), (&solid, Kind::Symmetric, 0.2)] {
        let (pattern, weak) = (pattern(a, kind), a.weak());
        let analyses =
            [Analysis::new(pattern, &weak), Analysis::thorough(pattern, &weak)].map(Result::unwrap);
        assert!(analyses[1].operations() < (1.0 - saved) * analyses[0].operations());
        let [x, y] = analyses.map(|analysis| {
            let mut factors = Factors::new(analysis).unwrap();
            assert_eq!(factors.factor(&a.values).unwrap().perturbed, 0);
            let mut x = noise(a.size());
            factors.solve(&mut x);
            x
        });
        // without scaling and refinement
        assert!(difference(&x, &y) < 1e-9, "{}", difference(&x, &y));
    }
}

#[test]
fn a_better_order_is_looked_for_once_it_pays() {
    let a = matrix(Problem::Elasticity, 30).lower();
    let mut solver = Solver::new(pattern(&a, Kind::Symmetric), &[]).unwrap();
    let operations = |solver: &Solver| solver.factors().analysis().operations();
    let first = operations(&solver);
    let solution = |solver: &mut Solver| {
        solver.factor(&a.values).unwrap();
        let mut x = noise(a.size());
        solver.solve(&mut x);
        x
    };
    let before = solution(&mut solver);
    assert_eq!(operations(&solver), first, "one factorisation does not pay for another order");
    let later = (0..200).map(|_| solution(&mut solver)).last().expect("a solution");
    assert!(operations(&solver) < first);
    assert!(difference(&later, &before) < 1e-11);
}

#[test]
fn a_pivot_that_is_not_positive_is_named() {
    let mut a = matrix(Problem::Elasticity, 6).lower();
    a.values[a.starts[31] as usize] = -1.0;
    let mut solver = Solver::new(pattern(&a, Kind::Symmetric), &[]).unwrap();
    let result = solver.factor(&a.values);
    assert!(matches!(result, Err(Error::NotPositive { .. })), "{result:?}");
}

#[test]
fn a_pressure_without_a_level_is_a_recorded_pivot() {
    // velocities held all around leave the level of the pressure open
    let a = closed(&matrix(FLOWS[1], 8), 8);
    let mut solver = Solver::new(pattern(&a, Kind::Unsymmetric), &a.weak()).unwrap();
    let pivots = solver.factor(&a.values).unwrap();
    assert!(pivots.perturbed == 1 && pivots.smallest < 1e-13, "{pivots:?}");
    let unknown = solver.factors().analysis().order()[pivots.turn];
    assert!(a.weak().contains(&unknown), "{unknown} is no pressure");
}

#[test]
fn a_pivot_that_vanishes_inside_its_front_is_recorded_and_repaired() {
    let a = matrix(Problem::Elasticity, 12);
    let analysis = Analysis::new(pattern(&a, Kind::Unsymmetric), &[]).unwrap();
    // the column eliminated first keeps one entry only, in the row of the neighbour that is eliminated last: outside its front
    let first = analysis.order()[0] as usize;
    let turn = |k: u32| analysis.order().iter().position(|&other| other == k);
    let neighbours = &a.rows[a.starts[first] as usize..a.starts[first + 1] as usize];
    let last = *neighbours.iter().max_by_key(|&&row| turn(row)).expect("a node has neighbours");
    let mut entries = Vec::new();
    a.for_each(|row, column, value| {
        let kept = if column == first { f64::from(u8::from(row == last as usize)) } else { value };
        entries.push((row as u32, column as u32, kept));
    });
    let a = Matrix::from_entries(a.size(), entries);
    let mut solver = Solver::new(pattern(&a, Kind::Unsymmetric), &[]).unwrap();
    let pivots = solver.factor(&a.values).unwrap();
    assert_eq!(pivots.perturbed, 1, "{pivots:?}");
    assert_eq!(solver.factors().analysis().order()[pivots.turn] as usize, first);
    let wanted = noise(a.size());
    let mut b = vec![0.0; a.size()];
    a.for_each(|row, column, value| b[row] += value * wanted[column]);
    let mut x = b.clone();
    let report = solver.solve(&mut x);
    assert!(report.refinements > 0 && report.relative_residual <= 1e-12, "{report:?}");
    // rounding times a condition number of some 1e5
    let error = difference(&x, &wanted).max(difference(&x, &reference(&a, &b)));
    assert!(error < 1e-10, "{error}");
}

/// The cavity: velocities on the upper side are held too, by rows and columns of the identity.
fn closed(a: &Matrix, n: usize) -> Matrix {
    // the last row of nodes: two velocities at inner ones, a pressure at every second
    let inner = 2 * (2 * n - 1) + n + 1;
    let weak = a.weak();
    let held = |k: usize| k + inner >= a.size() && !weak.contains(&(k as u32));
    let mut entries = Vec::new();
    a.for_each(|row, column, value| {
        let keep = !held(row) && !held(column) || row == column;
        entries.push((row as u32, column as u32, if keep { value } else { 0.0 }));
    });
    Matrix::from_entries(a.size(), entries)
}

#[test]
fn no_equations_are_an_error() {
    let pattern = Pattern { kind: Kind::Symmetric, starts: &[0], rows: &[] };
    assert_eq!(Analysis::new(pattern, &[]).err(), Some(Error::NoEquations));
}
