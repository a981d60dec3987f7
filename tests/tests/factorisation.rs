//! The factorisation on a tangent of the dry model, as it is and with rows and columns of all sizes.

use ansatz::system::StageProblem;
use ansatz_frontal::{Kind, Pattern, Solver};
use ansatz_models::dry_contact;
use ansatz_tests::sample::Random;
use ansatz_tests::system;

/// A symmetric matrix with all its entries, column after column.
struct Matrix {
    starts: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl Matrix {
    /// The tangent of the dry model at its start, where rates resist as in steps of 1/`alpha`.
    fn of_the_dry_model(alpha: f64) -> Self {
        let mut system = system(&dry_contact::PROGRAM, &[("coarse", "3")]);
        let base = system.start().expect("the model has a consistent start");
        let problem = StageProblem { time: 0.0, alpha, base: &base };
        let mut probe = system.probe(&problem, &base).expect("the states can be solved for");
        probe.assemble();
        let (starts, rows, values) = probe.sparse_tangent();
        let mut entries = Vec::new();
        for column in 0..starts.len() - 1 {
            for k in starts[column] as usize..starts[column + 1] as usize {
                entries.push((column as u32, rows[k], values[k]));
                if rows[k] as usize != column {
                    entries.push((rows[k], column as u32, values[k]));
                }
            }
        }
        Self::new(starts.len() - 1, entries)
    }

    /// Entries (column, row, value), each once.
    fn new(size: usize, mut entries: Vec<(u32, u32, f64)>) -> Self {
        entries.sort_by_key(|&(column, row, _)| (column, row));
        let mut starts = vec![0; size + 1];
        entries.iter().for_each(|entry| starts[entry.0 as usize + 1] += 1);
        (0..size).for_each(|k| starts[k + 1] += starts[k]);
        let rows = entries.iter().map(|entry| entry.1).collect();
        Self { starts, rows, values: entries.iter().map(|entry| entry.2).collect() }
    }

    fn size(&self) -> usize {
        self.starts.len() - 1
    }

    fn entries(&self) -> Vec<(u32, u32, f64)> {
        let columns =
            (0..self.size()).flat_map(|c| (self.starts[c]..self.starts[c + 1]).map(move |_| c as u32));
        columns
            .zip(&self.rows)
            .zip(&self.values)
            .map(|((column, &row), &value)| (column, row, value))
            .collect()
    }

    /// Rows and columns multiplied by factors.
    fn scaled(&self, rows: &[f64], columns: &[f64]) -> Self {
        let scale = |(c, r, value): (u32, u32, f64)| (c, r, rows[r as usize] * value * columns[c as usize]);
        Self::new(self.size(), self.entries().into_iter().map(scale).collect())
    }

    fn lower(&self) -> Self {
        Self::new(self.size(), self.entries().into_iter().filter(|&(column, row, _)| row >= column).collect())
    }

    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        self.entries()
            .iter()
            .for_each(|&(column, row, value)| product[row as usize] += value * x[column as usize]);
        product
    }

    /// The solution; asserts that its residual is no more than rounding.
    fn solve(&self, kind: Kind, rhs: &[f64]) -> Vec<f64> {
        let pattern = Pattern { kind, starts: &self.starts, rows: &self.rows };
        let mut solver = Solver::new(pattern, &[]).expect("the system is not empty");
        solver.factor(&self.values).expect("the matrix can be factored");
        let mut x = rhs.to_vec();
        let report = solver.solve(&mut x);
        assert!(report.relative_residual <= 1e-12, "{kind:?}: {report:?}");
        x
    }
}

fn difference(x: &[f64], y: &[f64]) -> f64 {
    let largest = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, |m: f64, v| m.max(v.abs()));
    largest(&mut x.iter().zip(y).map(|(x, y)| x - y)) / largest(&mut y.iter().copied())
}

#[test]
fn solutions_of_the_dry_model_are_known_ones_however_it_is_scaled() {
    let mut random = Random::new(3);
    for alpha in [1.0, 1e3] {
        let a = Matrix::of_the_dry_model(alpha);
        let mut numbers =
            |scale: fn(f64) -> f64| -> Vec<f64> { (0..a.size()).map(|_| scale(random.signed())).collect() };
        let wanted = numbers(|x| x);
        let (rows, columns) = (numbers(|x| 10f64.powf(8.0 * x)), numbers(|x| 10f64.powf(8.0 * x)));
        let b = a.times(&wanted);
        let by_cholesky = a.lower().solve(Kind::Symmetric, &b);
        let by_lu = a.solve(Kind::Unsymmetric, &b);
        let rhs: Vec<f64> = b.iter().zip(&rows).map(|(b, row)| b * row).collect();
        let scaled = a.scaled(&rows, &columns).solve(Kind::Unsymmetric, &rhs);
        let unscaled: Vec<f64> = scaled.iter().zip(&columns).map(|(x, column)| x * column).collect();
        // rounding times the condition number, some 1e5
        for (way, x) in [("Cholesky", &by_cholesky), ("LU", &by_lu), ("scaled", &unscaled)] {
            assert!(difference(x, &wanted) < 1e-9, "{way}, alpha {alpha}: {}", difference(x, &wanted));
        }
    }
}
