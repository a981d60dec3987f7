//! Sparse factorisation of assembled matrices: analysis, factorisation and solution with one right-hand side.

use crate::clock::{Clock, time_on};
use crate::matrices::{Matrix, Problem, matrix};
use ansatz_frontal::{Analysis, Kind, Pattern, Solver};
use serde_json::{Value, json};

/// Flow at Reynolds number 100 (`ns`) or elasticity (`elastic`, Cholesky) on a square with about `unknowns` unknowns.
///
/// Times are computing time on one thread and time on the clock on several: of factorisations in the order that many of them end up with, and of the
/// analyses that find the first order (`analyse_s`) and that one (`dissect_s`).
///
/// # Errors
/// What the factorisation says about the matrix; none with these problems.
pub fn factorisation(kind: &str, unknowns: usize, threads: usize) -> Result<Value, String> {
    let (matrix, form) = sample(kind, unknowns)?;
    let pattern = Pattern { kind: form, starts: &matrix.starts, rows: &matrix.rows };
    let weak = matrix.weak();
    let clock = Clock::start();
    let mut solver = Solver::with_threads(pattern, &weak, threads).map_err(|e| e.to_string())?;
    let analyse = clock.seconds();
    let clock = Clock::start();
    Analysis::thorough(pattern, &weak).map_err(|e| e.to_string())?;
    let dissect = clock.seconds();
    let mut pivots = solver.factor(&matrix.values).map_err(|e| e.to_string())?;
    let factor = time_on(threads, || pivots = solver.factor(&matrix.values).unwrap_or(pivots));
    let rhs: Vec<f64> = (0..matrix.size()).map(|k| (k as f64).sin()).collect();
    let mut x = rhs.clone();
    let report = solver.solve(&mut x);
    let solve = time_on(threads, || {
        x.copy_from_slice(&rhs);
        solver.solve(&mut x);
    });
    let analysis = solver.factors().analysis();
    Ok(json!({
        "problem": "lu", "kind": kind, "peer": "ansatz", "n_dofs": matrix.size(), "threads": threads,
        "analyse_s": analyse, "dissect_s": dissect, "factor_s": factor, "solve_s": solve,
        "nnz": analysis.factor_entries(), "memory_mb": analysis.memory(threads) as f64 * 1e-6,
        "flops": analysis.operations(), "gflops": analysis.operations() / factor * 1e-9,
        "perturbed": pivots.perturbed, "residual": report.relative_residual,
        "backward_error": report.backward_error, "refinements": report.refinements,
    }))
}

/// The matrix of a problem, or its lower triangle where Cholesky applies.
fn sample(kind: &str, unknowns: usize) -> Result<(Matrix, Kind), String> {
    // n x n x 2 triangles have 8 n^2 displacements or velocities and n^2 pressures
    let side = |each: f64| (unknowns as f64 / each).sqrt().round() as usize;
    match kind {
        "ns" => Ok((matrix(Problem::Flow { reynolds: 100.0 }, side(9.0)), Kind::Unsymmetric)),
        "elastic" => Ok((matrix(Problem::Elasticity, side(8.0)).lower(), Kind::Symmetric)),
        _ => Err(format!("`{kind}` is neither `ns` nor `elastic`")),
    }
}
