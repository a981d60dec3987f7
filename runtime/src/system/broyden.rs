//! Broyden's method: factors of a tangent that is no longer the present one, put right by the steps that were taken with them.
//!
//! After a full step s from one residual to the next, the tangent is changed by a product of two vectors such that it maps s to the change of
//! the residual. The steps alone say what that does to its inverse, so nothing but them is kept (C. T. Kelley, *Iterative Methods for Linear and
//! Nonlinear Equations*, 1995, section 7.3).

/// Full steps since the factors were made, oldest first.
#[derive(Clone, Debug, Default)]
pub(super) struct Broyden {
    steps: Vec<Vec<f64>>,
}

impl Broyden {
    /// Forgets all steps: the factors are new, or the last step was not a full one.
    pub fn clear(&mut self) {
        self.steps.clear();
    }

    /// Takes note of a full step in the direction of the factors, corrected by [`Self::correct`] where there were steps before.
    pub fn push(&mut self, step: Vec<f64>) {
        self.steps.push(step);
    }

    /// Turns the direction that the factors give for the residual after the last step into that of the changed tangent.
    pub fn correct(&self, direction: &mut [f64]) {
        for pair in self.steps.windows(2) {
            let along = part_along(&pair[0], direction);
            direction.iter_mut().zip(&pair[1]).for_each(|(d, next)| *d += along * next);
        }
        if let Some(last) = self.steps.last() {
            let stretch = 1.0 / (1.0 - part_along(last, direction));
            direction.iter_mut().for_each(|d| *d *= stretch);
        }
    }
}

/// Length of a vector along a step, in lengths of the step.
fn part_along(step: &[f64], vector: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    dot(step, vector) / dot(step, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = 4;

    /// A linear residual: three times the unknowns in two directions, half of them in another one.
    fn residual(x: &[f64]) -> Vec<f64> {
        vec![3.0 * x[0] - 1.0, x[1] + 2.0, 0.5 * x[2] - 1.0, 3.0 * x[3] + x[0] - 2.0]
    }

    #[test]
    fn linear_equations_are_solved_in_twice_as_many_steps_as_unknowns() {
        // D. M. Gay, SIAM J. Numer. Anal. 16 (1979) 623-630; the factors are those of the identity
        let (mut x, mut broyden) = (vec![0.0; SIZE], Broyden::default());
        for _ in 0..2 * SIZE {
            let mut step: Vec<f64> = residual(&x).iter().map(|r| -r).collect();
            broyden.correct(&mut step);
            x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
            broyden.push(step);
        }
        let left = residual(&x).iter().fold(0.0_f64, |m, r| m.max(r.abs()));
        assert!(left < 1e-9, "{left} is left");
    }

    #[test]
    fn without_steps_the_factors_speak_for_themselves() {
        let mut broyden = Broyden::default();
        broyden.push(vec![1.0, 2.0]);
        broyden.clear();
        let mut direction = [0.3, -0.4];
        broyden.correct(&mut direction);
        assert_eq!(direction, [0.3, -0.4]);
    }
}
