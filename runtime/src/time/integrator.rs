//! One step of a diagonally implicit Runge-Kutta method for F(t, y, y') = 0.
//!
//! Stage i solves F(t + c_i h, Y_i, k_i) = 0 with k_i = alpha (Y_i - base_i), alpha = 1/(h gamma), base_i = y + h sum_(j<i) a_ij k_j. Both methods are
//! stiffly accurate: the last stage is the solution at the end of the step, so it satisfies the algebraic equations there, and its k is the rate.

use super::{ImplicitSystem, Stage};
use crate::error::SolveError;
use crate::generated::Integrator;
use std::f64::consts::FRAC_1_SQRT_2;

/// gamma = 1 - 1/sqrt(2), the root of gamma^2 - 2 gamma + 1/2 that makes two stages L-stable and of order 2.
const GAMMA: f64 = 1.0 - FRAC_1_SQRT_2;

/// Coefficients of a method.
#[derive(Debug)]
pub struct Tableau {
    /// gamma, the diagonal of the coefficient matrix.
    diagonal: f64,
    /// a_ij with j < i of each stage. The node of a stage is c_i = gamma + sum_j a_ij.
    rows: &'static [&'static [f64]],
    /// Order of the method.
    pub order: usize,
    /// C of the local error C h^(order+1) y^(order+1) for y' = lambda y: what the stability function misses of exp.
    pub error_constant: f64,
}

/// R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006-1021: two stages, order 2, L-stable.
static SDIRK2: Tableau = Tableau {
    diagonal: GAMMA,
    rows: &[&[], &[1.0 - GAMMA]],
    order: 2,
    error_constant: 3.0 * GAMMA * GAMMA - 2.0 * GAMMA * GAMMA * GAMMA - 1.0 / 6.0,
};

static BACKWARD_EULER: Tableau = Tableau { diagonal: 1.0, rows: &[&[]], order: 1, error_constant: 0.5 };

/// Coefficients of an integrator.
pub fn tableau(integrator: Integrator) -> &'static Tableau {
    match integrator {
        Integrator::Sdirk2 => &SDIRK2,
        Integrator::BackwardEuler => &BACKWARD_EULER,
    }
}

/// Unknowns and rates at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Time.
    pub time: f64,
    /// Unknowns y.
    pub values: Vec<f64>,
    /// Their rates y'.
    pub rates: Vec<f64>,
}

/// Steps from `start` over `size`, to the end of the step; `predict` gives the first guess of a stage at its time. Newton iterations are added to
/// `iterations`, those of a failed stage too.
pub fn advance(
    method: &Tableau,
    system: &mut dyn ImplicitSystem,
    start: &Point,
    size: f64,
    predict: impl Fn(f64) -> Vec<f64>,
    iterations: &mut usize,
) -> Result<Point, SolveError> {
    let mut end = start.clone();
    let mut slopes: Vec<Vec<f64>> = Vec::new();
    for row in method.rows {
        let mut base = start.values.clone();
        for (factor, slope) in row.iter().zip(&slopes) {
            base.iter_mut().zip(slope).for_each(|(base, slope)| *base += size * factor * slope);
        }
        let node = method.diagonal + row.iter().sum::<f64>();
        let stage =
            Stage { time: start.time + node * size, alpha: 1.0 / (size * method.diagonal), base: &base };
        let mut values = predict(stage.time);
        *iterations +=
            system.solve_stage(&stage, &mut values).inspect_err(|e| *iterations += e.iterations)?;
        let rates = stage.rates(&values);
        slopes.push(rates.clone());
        end = Point { time: stage.time, values, rates };
    }
    Ok(end)
}
