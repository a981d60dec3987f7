//! The small system of the states, solved exactly inside every evaluation of the fields' balance.
//!
//! States couple to the fields only through functionals, so given those the states follow from r(s, s', z, z', t) = 0 alone. The laws inside
//! have kinks (`match`), on which a plain semismooth Newton method can cycle; then the branches are tried one after another, each a smooth
//! system, and the solution is the one that lies in its own branch.

use crate::generated::{Layout, StateSystem};

/// Newton iterations for one branch.
const ITERATIONS: usize = 60;
/// A step below this, relative to the state, ends the iteration.
const STEP_TOLERANCE: f64 = 1e-13;
/// Most switches whose combinations are enumerated.
const MOST_SWITCHES: usize = 12;

/// Solves the states of one model; keeps its buffers.
pub struct StateSolver {
    system: &'static StateSystem,
    layout: Layout,
    bounds: Vec<(f64, f64)>,
    switches: Vec<bool>,
    residual: Vec<f64>,
    jacobian: Vec<f64>,
}

/// Stage of the time integrator as the states see it: `rate = alpha (value - base)`.
#[derive(Clone, Copy)]
pub struct Stage<'a> {
    /// d rate / d value.
    pub alpha: f64,
    /// Base of each state.
    pub base: &'a [f64],
}

impl StateSolver {
    /// `bounds`: open interval of each state.
    pub fn new(system: &'static StateSystem, layout: Layout, bounds: Vec<(f64, f64)>) -> Self {
        let n = layout.states[1] - layout.states[0];
        Self {
            system,
            layout,
            bounds,
            switches: vec![false; system.switches],
            residual: vec![0.0; n],
            jacobian: vec![0.0; n * n],
        }
    }

    fn count(&self) -> usize {
        self.residual.len()
    }

    /// Solves for the states in `g` (their entries are the first guess), rates included. Errors with the place of the equation that is
    /// furthest from holding.
    pub fn solve(&mut self, g: &mut [f64], stage: Stage<'_>) -> Result<(), &'static str> {
        let guess = g[self.layout.states[0]..self.layout.states[1]].to_vec();
        if self.newton(g, stage, None) {
            return Ok(());
        }
        self.try_branches(g, stage, &guess)
    }

    /// Derivative of the states with respect to the functionals (rates included), row by row, at a solution.
    pub fn sensitivity(&mut self, g: &[f64], alpha: f64, out: &mut [f64]) {
        let n = self.count();
        let columns = self.layout.functionals[1] - self.layout.functionals[0];
        (self.system.switch)(g, &mut self.switches);
        (self.system.jacobian)(g, &self.switches, alpha, &mut self.jacobian);
        (self.system.sensitivity)(g, &self.switches, alpha, out);
        let mut column = vec![0.0; n];
        let factor = Elimination::new(self.jacobian.clone(), n);
        for j in 0..columns {
            for i in 0..n {
                column[i] = -out[i * columns + j];
            }
            factor.solve(&mut column);
            for i in 0..n {
                out[i * columns + j] = column[i];
            }
        }
    }

    /// Solves the equations without time derivatives for the states that are not fixed at the start. A state on which nothing depends yet
    /// keeps its guess.
    pub fn start(&mut self, g: &mut [f64], fixed: &[bool]) -> Result<(), &'static str> {
        let n = self.count();
        let rows: Vec<usize> = (0..n).filter(|&i| self.system.algebraic_equations[i]).collect();
        let columns: Vec<usize> = (0..n).filter(|&i| !fixed[i]).collect();
        for _ in 0..ITERATIONS {
            (self.system.switch)(g, &mut self.switches);
            (self.system.residual)(g, &self.switches, &mut self.residual);
            (self.system.jacobian)(g, &self.switches, 0.0, &mut self.jacobian);
            let step = least_squares_step(&self.jacobian, &self.residual, n, &rows, &columns);
            let mut full = vec![0.0; n];
            for (&column, value) in columns.iter().zip(step) {
                full[column] = value;
            }
            let length = self.inside(g, &full);
            let size = self.relative_size(g, &full);
            self.advance(g, &full, length);
            if length == 1.0 && size < 1e-12 {
                return Ok(());
            }
        }
        Err(self.worst_equation())
    }

    fn newton(&mut self, g: &mut [f64], stage: Stage<'_>, branch: Option<&[bool]>) -> bool {
        let n = self.count();
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            self.set_rates(g, stage);
            match branch {
                Some(held) => self.switches.copy_from_slice(held),
                None => (self.system.switch)(g, &mut self.switches),
            }
            (self.system.residual)(g, &self.switches, &mut self.residual);
            (self.system.jacobian)(g, &self.switches, stage.alpha, &mut self.jacobian);
            let mut step: Vec<f64> = self.residual.iter().map(|r| -r).collect();
            Elimination::new(std::mem::take(&mut self.jacobian), n)
                .solve_keeping(&mut step, &mut self.jacobian);
            if step.iter().any(|x| !x.is_finite()) {
                return false;
            }
            let length = self.inside(g, &step);
            let size = self.relative_size(g, &step);
            self.advance(g, &step, length);
            let stagnant = size < 1e-10 && size >= last;
            if length == 1.0 && (size < STEP_TOLERANCE || stagnant) {
                self.set_rates(g, stage);
                return true;
            }
            last = size;
        }
        false
    }

    fn try_branches(&mut self, g: &mut [f64], stage: Stage<'_>, guess: &[f64]) -> Result<(), &'static str> {
        let states = self.layout.states[0]..self.layout.states[1];
        let count = self.system.switches;
        if count > MOST_SWITCHES {
            return Err(self.worst_equation());
        }
        let mut best: Option<(f64, Vec<f64>)> = None;
        for combination in 0..1usize << count {
            let held: Vec<bool> = (0..count).map(|k| combination >> k & 1 == 1).collect();
            g[states.clone()].copy_from_slice(guess);
            if !self.newton(g, stage, Some(&held)) || !self.lies_in_branch(g, &held) {
                continue;
            }
            let found = g[states.clone()].to_vec();
            let distance: f64 =
                found.iter().zip(guess).map(|(a, b)| ((a - b) / (1.0 + b.abs())).powi(2)).sum();
            if best.as_ref().is_none_or(|(d, _)| distance < *d) {
                best = Some((distance, found));
            }
        }
        let Some((_, found)) = best else {
            g[states].copy_from_slice(guess);
            return Err(self.worst_equation());
        };
        g[states].copy_from_slice(&found);
        self.set_rates(g, stage);
        Ok(())
    }

    /// The solution of a held branch counts if the equations also hold with the switches it implies: laws are continuous, so a switch
    /// that flips exactly at its breakpoint changes nothing.
    fn lies_in_branch(&mut self, g: &[f64], held: &[bool]) -> bool {
        (self.system.switch)(g, &mut self.switches);
        if self.switches == held {
            return true;
        }
        let n = self.count();
        (self.system.residual)(g, &self.switches, &mut self.residual);
        (self.system.jacobian)(g, &self.switches, 0.0, &mut self.jacobian);
        (0..n).all(|i| {
            let states = &g[self.layout.states[0]..self.layout.states[1]];
            let size: f64 = (0..n).map(|j| (self.jacobian[i * n + j] * states[j]).abs()).sum();
            self.residual[i].abs() <= 1e-9 * size.max(f64::MIN_POSITIVE)
        })
    }

    fn set_rates(&self, g: &mut [f64], stage: Stage<'_>) {
        let (states, rates) = (self.layout.states[0], self.layout.state_rates[0]);
        for i in 0..self.count() {
            g[rates + i] = stage.alpha * (g[states + i] - stage.base[i]);
        }
    }

    /// Longest part of the step (at most 1) that keeps 10 % of the distance to a bound.
    fn inside(&self, g: &[f64], step: &[f64]) -> f64 {
        let states = &g[self.layout.states[0]..self.layout.states[1]];
        let mut length = 1.0f64;
        for ((x, dx), (low, high)) in states.iter().zip(step).zip(&self.bounds) {
            let room = if *dx > 0.0 { high - x } else { x - low };
            if dx.abs() > 0.9 * room {
                length = length.min(0.9 * room / dx.abs());
            }
        }
        length
    }

    fn relative_size(&self, g: &[f64], step: &[f64]) -> f64 {
        let states = &g[self.layout.states[0]..self.layout.states[1]];
        let relative = |(x, dx): (&f64, &f64)| dx.abs() / (x.abs() + 1e-6);
        states.iter().zip(step).map(relative).fold(0.0, f64::max)
    }

    fn advance(&self, g: &mut [f64], step: &[f64], length: f64) {
        let states = self.layout.states[0];
        for (i, dx) in step.iter().enumerate() {
            g[states + i] += length * dx;
        }
    }

    fn worst_equation(&self) -> &'static str {
        let worst =
            (0..self.count()).max_by(|&a, &b| self.residual[a].abs().total_cmp(&self.residual[b].abs()));
        worst.map_or("no equation", |i| self.system.places[i])
    }
}

/// Gaussian elimination with partial pivoting and row scaling, n <= 20 or so.
struct Elimination {
    n: usize,
    matrix: Vec<f64>,
    order: Vec<usize>,
    scale: Vec<f64>,
}

impl Elimination {
    fn new(mut matrix: Vec<f64>, n: usize) -> Self {
        let scale: Vec<f64> = (0..n)
            .map(|i| 1.0 / matrix[i * n..(i + 1) * n].iter().fold(0.0f64, |m, x| m.max(x.abs())))
            .collect();
        for i in 0..n {
            matrix[i * n..(i + 1) * n].iter_mut().for_each(|x| *x *= scale[i]);
        }
        let mut order: Vec<usize> = (0..n).collect();
        for k in 0..n {
            let pivot = (k..n).max_by(|&a, &b| matrix[a * n + k].abs().total_cmp(&matrix[b * n + k].abs()));
            let pivot = pivot.unwrap_or(k);
            if pivot != k {
                order.swap(k, pivot);
                for j in 0..n {
                    matrix.swap(k * n + j, pivot * n + j);
                }
            }
            for i in k + 1..n {
                let factor = matrix[i * n + k] / matrix[k * n + k];
                matrix[i * n + k] = factor;
                for j in k + 1..n {
                    matrix[i * n + j] -= factor * matrix[k * n + j];
                }
            }
        }
        Self { n, matrix, order, scale }
    }

    fn solve(&self, b: &mut [f64]) {
        let n = self.n;
        let mut x: Vec<f64> = self.order.iter().map(|&i| b[i] * self.scale[i]).collect();
        for i in 0..n {
            for j in 0..i {
                x[i] -= self.matrix[i * n + j] * x[j];
            }
        }
        for i in (0..n).rev() {
            for j in i + 1..n {
                x[i] -= self.matrix[i * n + j] * x[j];
            }
            x[i] /= self.matrix[i * n + i];
        }
        b.copy_from_slice(&x);
    }

    /// Solves and hands the buffer back.
    fn solve_keeping(self, b: &mut [f64], buffer: &mut Vec<f64>) {
        self.solve(b);
        *buffer = self.matrix;
    }
}

/// Gauss-Newton step on chosen rows and columns; a column of zeros gets no step.
fn least_squares_step(
    jacobian: &[f64],
    residual: &[f64],
    n: usize,
    rows: &[usize],
    columns: &[usize],
) -> Vec<f64> {
    let m = columns.len();
    let row_scale =
        |i: usize| 1.0 / columns.iter().fold(f64::MIN_POSITIVE, |s, &j| s.max(jacobian[i * n + j].abs()));
    let column_scale: Vec<f64> = columns
        .iter()
        .map(|&j| rows.iter().fold(0.0f64, |s, &i| s.max((row_scale(i) * jacobian[i * n + j]).abs())))
        .map(|s| if s > 0.0 { 1.0 / s } else { 0.0 })
        .collect();
    let mut normal = vec![0.0; m * m];
    let mut right = vec![0.0; m];
    for &i in rows {
        let scale = row_scale(i);
        for a in 0..m {
            let ja = jacobian[i * n + columns[a]] * scale * column_scale[a];
            right[a] -= ja * residual[i] * scale;
            for b in 0..m {
                normal[a * m + b] += ja * jacobian[i * n + columns[b]] * scale * column_scale[b];
            }
        }
    }
    for a in 0..m {
        normal[a * m + a] += 1e-14;
    }
    Elimination::new(normal, m).solve(&mut right);
    right.iter().zip(column_scale).map(|(x, s)| x * s).collect()
}
