//! Small dense systems: what remains of a bordered system once its sparse part is eliminated.
//!
//! Matrices are square, column after column, with at most a few tens of rows.

/// Pivots of a matrix with unit row maxima below this are rounding errors.
const SMALLEST_PIVOT: f64 = 64.0 * f64::EPSILON;
/// Entries below this part of the largest do not count in a sum of squares.
const SQUARES: f64 = 1e-13;
/// A pivot on the diagonal is used down to this part of the largest entry beside it.
const SMALLEST_DIAGONAL: f64 = 0.1;
/// Sweeps of Jacobi rotations; convergence is quadratic and takes fewer than ten.
const SWEEPS: usize = 30;

/// A symmetric matrix as a sum of squares, `sum_k w_k v_k v_k^T`: (w, v) one after another, as many as its rank.
///
/// By elimination with the largest pivot left on the diagonal. `None` where the matrix is not symmetric, or where the diagonal that is left is too small.
pub fn squares(size: usize, matrix: &[f64]) -> Option<Vec<(f64, Vec<f64>)>> {
    let largest = matrix.iter().fold(0.0_f64, |largest, a| largest.max(a.abs()));
    let negligible = SQUARES * largest;
    let symmetric = (0..size * size).all(|k| {
        let (i, j) = (k % size, k / size);
        (matrix[k] - matrix[i * size + j]).abs() <= negligible
    });
    let mut rest = matrix.to_vec();
    let mut squares = Vec::new();
    while symmetric && rest.iter().any(|a| a.abs() > negligible) {
        let diagonal = |&k: &usize| rest[k * size + k].abs();
        let pivot = (0..size).max_by(|a, b| diagonal(a).total_cmp(&diagonal(b)))?;
        let column = &rest[pivot * size..][..size];
        let weight = column[pivot];
        if squares.len() == size || column.iter().any(|a| a.abs() > weight.abs() / SMALLEST_DIAGONAL) {
            return None;
        }
        let square: Vec<f64> = column.iter().map(|a| a / weight).collect();
        for (k, entry) in rest.iter_mut().enumerate() {
            *entry -= weight * square[k % size] * square[k / size];
        }
        squares.push((weight, square));
    }
    symmetric.then_some(squares)
}

/// LU factors of a dense matrix, with scaled rows and partial pivoting.
#[derive(Clone, Debug)]
pub struct DenseLu {
    factors: Vec<f64>,
    row_factors: Vec<f64>,
    /// Row exchanged with row `k` at step `k`.
    exchanges: Vec<usize>,
}

impl DenseLu {
    /// Storage for matrices of `size` rows.
    pub fn new(size: usize) -> Self {
        Self { factors: vec![0.0; size * size], row_factors: vec![1.0; size], exchanges: vec![0; size] }
    }

    /// Factors a matrix.
    ///
    /// # Errors
    /// The column at which the remaining matrix vanishes or is not finite.
    pub fn factor(&mut self, matrix: &[f64]) -> Result<(), usize> {
        let size = self.exchanges.len();
        self.factors.copy_from_slice(matrix);
        for (row, factor) in self.row_factors.iter_mut().enumerate() {
            let largest =
                matrix.iter().skip(row).step_by(size).fold(0.0_f64, |largest, a| largest.max(a.abs()));
            *factor = if largest > 0.0 { largest.recip() } else { 1.0 };
        }
        for (k, value) in self.factors.iter_mut().enumerate() {
            *value *= self.row_factors[k % size];
        }
        (0..size).try_for_each(|step| self.eliminate(step))
    }

    fn eliminate(&mut self, step: usize) -> Result<(), usize> {
        let size = self.exchanges.len();
        let magnitude = |row: &usize| self.factors[step * size + row].abs();
        let pivot = (step..size).max_by(|a, b| magnitude(a).total_cmp(&magnitude(b))).unwrap_or(step);
        if !(SMALLEST_PIVOT..f64::INFINITY).contains(&magnitude(&pivot)) {
            return Err(step);
        }
        self.exchanges[step] = pivot;
        for column in self.factors.chunks_exact_mut(size) {
            column.swap(step, pivot);
        }
        let (left, right) = self.factors.split_at_mut((step + 1) * size);
        let multipliers = &mut left[step * size..];
        for row in step + 1..size {
            multipliers[row] /= multipliers[step];
        }
        for column in right.chunks_exact_mut(size) {
            for row in step + 1..size {
                column[row] -= multipliers[row] * column[step];
            }
        }
        Ok(())
    }

    /// Solves in place with the factors.
    pub fn solve(&self, x: &mut [f64]) {
        let size = self.exchanges.len();
        x.iter_mut().zip(&self.row_factors).for_each(|(value, factor)| *value *= factor);
        for (step, &pivot) in self.exchanges.iter().enumerate() {
            x.swap(step, pivot);
        }
        for (step, column) in self.factors.chunks_exact(size).enumerate() {
            for row in step + 1..size {
                x[row] -= column[row] * x[step];
            }
        }
        for (step, column) in self.factors.chunks_exact(size).enumerate().rev() {
            x[step] /= column[step];
            for row in 0..step {
                x[row] -= column[row] * x[step];
            }
        }
    }
}

/// Number of negative eigenvalues of a symmetric matrix, which is overwritten.
///
/// Rows and columns are first scaled alike, which changes no sign, then Jacobi's rotations are
/// applied (Golub and Van Loan, Matrix Computations, section 8.5).
pub fn negative_eigenvalues(size: usize, matrix: &mut [f64]) -> usize {
    let scale = |row: usize| matrix[row * size..(row + 1) * size].iter().fold(0.0_f64, |m, a| m.max(a.abs()));
    let scales: Vec<f64> = (0..size).map(|row| scale(row).max(f64::MIN_POSITIVE).sqrt().recip()).collect();
    for (k, value) in matrix.iter_mut().enumerate() {
        *value *= scales[k % size] * scales[k / size];
    }
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for q in 1..size {
            for p in 0..q {
                rotated |= rotate(size, matrix, p, q);
            }
        }
        if !rotated {
            break;
        }
    }
    (0..size).filter(|&k| matrix[k * size + k] < 0.0).count()
}

/// Rotates the entry (`p`, `q`) to zero; false when it already vanishes beside the diagonal.
fn rotate(size: usize, matrix: &mut [f64], p: usize, q: usize) -> bool {
    let at = |row: usize, column: usize| column * size + row;
    let (app, aqq, apq) = (matrix[at(p, p)], matrix[at(q, q)], matrix[at(p, q)]);
    if apq.abs() <= f64::EPSILON * (app.abs() * aqq.abs()).sqrt() {
        return false;
    }
    let theta = (aqq - app) / (2.0 * apq);
    let tangent = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let cosine = tangent.hypot(1.0).recip();
    let sine = tangent * cosine;
    for k in 0..size {
        let (akp, akq) = (matrix[at(k, p)], matrix[at(k, q)]);
        matrix[at(k, p)] = cosine * akp - sine * akq;
        matrix[at(k, q)] = sine * akp + cosine * akq;
    }
    for k in 0..size {
        let (apk, aqk) = (matrix[at(p, k)], matrix[at(q, k)]);
        matrix[at(p, k)] = cosine * apk - sine * aqk;
        matrix[at(q, k)] = sine * apk + cosine * aqk;
    }
    (matrix[at(p, q)], matrix[at(q, p)]) = (0.0, 0.0);
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    const SADDLE: [f64; 9] = [0.0, 2.0, 1e6, 2.0, 0.0, -3e6, 1e6, -3e6, 5e12];

    #[test]
    fn a_difference_is_one_square() {
        let found = squares(2, &[3.0, -3.0, -3.0, 3.0]).unwrap();
        assert_eq!(found, [(3.0, vec![-1.0, 1.0])]);
        assert_eq!(squares(2, &[0.0; 4]).unwrap(), []);
    }

    #[test]
    fn squares_add_up_to_the_matrix() {
        let matrix = [2.0, 1.0, 0.5, 1.0, -3.0, 1.0, 0.5, 1.0, 1.0];
        let mut sum = [0.0; 9];
        for (weight, square) in squares(3, &matrix).unwrap() {
            (0..9).for_each(|k| sum[k] += weight * square[k % 3] * square[k / 3]);
        }
        assert!(sum.iter().zip(&matrix).all(|(a, b)| (a - b).abs() < 1e-14), "{sum:?}");
    }

    #[test]
    fn matrices_without_squares_are_known() {
        assert_eq!(squares(2, &[1.0, 2.0, 0.0, 1.0]), None, "not symmetric");
        assert_eq!(squares(2, &[0.0, 1.0, 1.0, 0.0]), None, "no diagonal");
    }

    #[test]
    fn zero_diagonals_and_mixed_units_are_solved() {
        let mut lu = DenseLu::new(3);
        lu.factor(&SADDLE).unwrap();
        // columns times (1, 2, 3e-6)
        let mut x = [7.0, -7.0, 1e7];
        lu.solve(&mut x);
        for (computed, exact) in x.iter().zip([1.0, 2.0, 3e-6]) {
            assert!((computed / exact - 1.0).abs() < 1e-14, "{x:?}");
        }
    }

    #[test]
    fn dependent_columns_are_named() {
        let mut lu = DenseLu::new(3);
        assert_eq!(lu.factor(&[1.0, 2.0, 3.0, 2.0, 4.0, 6.0, 1.0, 0.0, 0.0]), Err(1));
        assert_eq!(lu.factor(&[f64::NAN; 9]), Err(0));
    }

    #[test]
    fn negative_eigenvalues_are_counted() {
        assert_eq!(negative_eigenvalues(1, &mut [-3.0]), 1);
        assert_eq!(negative_eigenvalues(2, &mut [0.0, 1.0, 1.0, 0.0]), 1);
        // x y saddle plus a stiff direction: the determinant is negative
        assert_eq!(negative_eigenvalues(3, &mut SADDLE.clone()), 1);
        assert_eq!(negative_eigenvalues(3, &mut SADDLE.map(|a| -a)), 2);
    }
}
