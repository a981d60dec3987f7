//! Equilibration: row and column factors that bring the entries of a matrix near one.
//!
//! Unknowns of a coupled model carry different units, so entries of one matrix may differ by many
//! powers of ten. Pivots can be compared, and small ones recognised, only after scaling. All factors
//! are powers of two: scaling is exact and the residual of the scaled system is that of the original.

use crate::error::Error;
use crate::pattern::{Kind, Pattern};

/// Sweeps of symmetric equilibration; a positive definite matrix needs one, which only confirms.
const SWEEPS: usize = 5;
/// A row needs no further scaling when its largest entry lies within this factor of one.
const NEAR_ONE: f64 = 4.0;

/// Factors `R` and `C` of the scaled matrix `R A C`; `R = C` when `A` is symmetric.
#[derive(Debug)]
pub struct Scaling {
    /// Factor of every row.
    pub rows: Vec<f64>,
    /// Factor of every column.
    pub columns: Vec<f64>,
    largest: Vec<f64>,
}

impl Scaling {
    /// Unit factors for `size` equations.
    pub fn new(size: usize) -> Self {
        Self { rows: vec![1.0; size], columns: vec![1.0; size], largest: vec![0.0; size] }
    }

    /// Chooses the factors for a matrix with finite entries.
    ///
    /// # Errors
    /// [`Error::EmptyRow`] or [`Error::EmptyColumn`] where all entries are zero.
    pub fn fit(&mut self, pattern: Pattern<'_>, values: &[f64]) -> Result<(), Error> {
        match pattern.kind {
            Kind::Symmetric => self.fit_symmetric(pattern, values)?,
            Kind::Unsymmetric => self.fit_unsymmetric(pattern, values)?,
        }
        self.rows.iter_mut().for_each(|factor| *factor = power_of_two_below(*factor));
        self.columns.iter_mut().for_each(|factor| *factor = power_of_two_below(*factor));
        Ok(())
    }

    /// Scales entries in place; the largest sum of magnitudes in a row of the whole matrix.
    pub fn apply(&self, pattern: Pattern<'_>, values: &mut [f64]) -> f64 {
        let mut sums = vec![0.0; pattern.size()];
        for (column, column_factor) in self.columns.iter().enumerate() {
            let range = pattern.column(column);
            let mut mirrored = 0.0;
            for (&row, value) in pattern.rows[range.clone()].iter().zip(&mut values[range]) {
                let row = row as usize;
                *value *= self.rows[row] * column_factor;
                sums[row] += value.abs();
                mirrored += if row == column { 0.0 } else { value.abs() };
            }
            sums[column] += if pattern.kind == Kind::Symmetric { mirrored } else { 0.0 };
        }
        sums.into_iter().fold(0.0, f64::max)
    }

    /// Unit diagonal first, then the sweeps of Ruiz (RAL-TR-2001-034) towards unit row maxima.
    fn fit_symmetric(&mut self, pattern: Pattern<'_>, values: &[f64]) -> Result<(), Error> {
        for (equation, factor) in self.rows.iter_mut().enumerate() {
            let diagonal = values[pattern.column(equation).start].abs();
            *factor = if diagonal > 0.0 { diagonal.sqrt().recip() } else { 1.0 };
        }
        for _ in 0..SWEEPS {
            self.find_largest(pattern, values);
            if let Some(equation) = self.largest.iter().position(|&entry| entry == 0.0) {
                return Err(Error::EmptyRow { equation });
            }
            if self.largest.iter().all(|entry| (NEAR_ONE.recip()..=NEAR_ONE).contains(entry)) {
                break;
            }
            self.rows.iter_mut().zip(&self.largest).for_each(|(factor, entry)| *factor /= entry.sqrt());
        }
        self.columns.copy_from_slice(&self.rows);
        Ok(())
    }

    /// Largest magnitude in every row of the scaled symmetric matrix.
    fn find_largest(&mut self, pattern: Pattern<'_>, values: &[f64]) {
        self.largest.fill(0.0);
        for (column, column_factor) in self.rows.iter().enumerate() {
            let range = pattern.column(column);
            let mut mirrored = 0.0_f64;
            for (&row, value) in pattern.rows[range.clone()].iter().zip(&values[range]) {
                let entry = (self.rows[row as usize] * value * column_factor).abs();
                let largest = &mut self.largest[row as usize];
                *largest = largest.max(entry);
                mirrored = mirrored.max(entry);
            }
            self.largest[column] = self.largest[column].max(mirrored);
        }
    }

    /// Unit row maxima, then unit column maxima.
    fn fit_unsymmetric(&mut self, pattern: Pattern<'_>, values: &[f64]) -> Result<(), Error> {
        self.rows.fill(0.0);
        pattern.for_each(|position, row, _| self.rows[row] = self.rows[row].max(values[position].abs()));
        if let Some(equation) = self.rows.iter().position(|&entry| entry == 0.0) {
            return Err(Error::EmptyRow { equation });
        }
        self.rows.iter_mut().for_each(|entry| *entry = entry.recip());
        for (column, largest) in self.columns.iter_mut().enumerate() {
            let range = pattern.column(column);
            let entries = pattern.rows[range.clone()].iter().zip(&values[range]);
            let scaled = entries.map(|(&row, value)| self.rows[row as usize] * value.abs());
            *largest = scaled.fold(0.0, f64::max);
        }
        if let Some(equation) = self.columns.iter().position(|&entry| entry == 0.0) {
            return Err(Error::EmptyColumn { equation });
        }
        self.columns.iter_mut().for_each(|entry| *entry = entry.recip());
        Ok(())
    }
}

/// The largest power of two that is not above a positive normal number.
fn power_of_two_below(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    f64::from_bits(x.to_bits() & EXPONENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scaled_magnitudes(kind: Kind, dense: [[f64; 3]; 3]) -> Vec<f64> {
        let (starts, rows): (&[u32], &[u32]) = match kind {
            Kind::Symmetric => (&[0, 3, 5, 6], &[0, 1, 2, 1, 2, 2]),
            Kind::Unsymmetric => (&[0, 3, 6, 9], &[0, 1, 2, 0, 1, 2, 0, 1, 2]),
        };
        let pattern = Pattern { kind, starts, rows };
        let mut values = vec![0.0; rows.len()];
        pattern.for_each(|position, row, column| values[position] = dense[row][column]);
        let mut scaling = Scaling::new(3);
        scaling.fit(pattern, &values).unwrap();
        let mut magnitudes = vec![0.0_f64; 3];
        pattern.for_each(|position, row, column| {
            let entry = (scaling.rows[row] * values[position] * scaling.columns[column]).abs();
            magnitudes[row] = magnitudes[row].max(entry);
            if kind == Kind::Symmetric {
                magnitudes[column] = magnitudes[column].max(entry);
            }
        });
        magnitudes
    }

    #[test]
    fn powers_of_two_are_exact() {
        assert_eq!([1.0, 3.9, 0.3].map(power_of_two_below), [1.0, 2.0, 0.25]);
    }

    #[test]
    fn rows_come_near_one_over_sixteen_powers_of_ten() {
        let definite = [[4e-8, 1.0, 0.0], [1.0, 4e8, 0.0], [0.0, 0.0, 1.0]];
        let zero_diagonal = [[0.0, 1e6, 1e-6], [1e6, 0.0, 0.0], [1e-6, 0.0, 1e-8]];
        let unsymmetric = [[1.0, 1e8, 2e-8], [0.0, 3e-8, 1e-8], [1e-8, 0.0, 5.0]];
        for (kind, dense) in
            [(Kind::Symmetric, definite), (Kind::Symmetric, zero_diagonal), (Kind::Unsymmetric, unsymmetric)]
        {
            for magnitude in scaled_magnitudes(kind, dense) {
                // each of the two truncations to a power of two loses less than a factor of two
                assert!((0.06..=NEAR_ONE).contains(&magnitude), "{magnitude}");
            }
        }
    }
}
