//! When a residual is small: field by field, since the balances of different fields have different units and sizes.

use super::System;
use super::balance::norm;
use super::terms::At;

/// Roundings that add up in an assembled residual.
const ROUNDINGS: f64 = 8.0;

impl System {
    /// Norm of the entries of each field in a vector over equations.
    pub(super) fn field_norms(&self, of_equations: &[f64]) -> Vec<f64> {
        let norm_of = |range: &std::ops::Range<usize>| norm(&of_equations[range.clone()]);
        self.field_equations().iter().map(norm_of).collect()
    }

    /// Equations of each field; they follow each other like the fields.
    fn field_equations(&self) -> Vec<std::ops::Range<usize>> {
        let place = |unknown: usize| self.free.partition_point(|&u| (u as usize) < unknown);
        let fields = self.unknowns.fields.iter();
        fields.map(|field| place(field.first)..place(field.first + field.count())).collect()
    }

    /// Size of the element forces that balance each other in each field: the scale against which a residual is small.
    pub(super) fn force_scales(&mut self, y: &[f64], rates: &[f64], alpha: f64) -> Vec<f64> {
        let magnitude = self.magnitude(y, rates, alpha);
        self.field_norms(&self.restrict(&magnitude))
    }

    /// Sum of the magnitudes of what each element adds to the residual of each unknown.
    pub(super) fn magnitude(&mut self, y: &[f64], rates: &[f64], alpha: f64) -> Vec<f64> {
        let mut magnitude = vec![0.0; self.unknowns.length];
        let at = At { y, rates, g: &self.g, alpha };
        self.assembly.add_magnitude(at, &mut magnitude);
        self.hand_on(&mut magnitude);
        magnitude
    }

    /// Residual of each field relative to its forces, the largest; the residual itself while no forces are known.
    pub(super) fn relative_size(&self, residual: &[f64], scales: &[f64]) -> f64 {
        let sizes = self.field_norms(residual);
        let relative = |(size, scale): (&f64, &f64)| if *scale > 0.0 { size / scale } else { *size };
        let known = sizes.iter().zip(scales).map(relative);
        if scales.is_empty() { norm(residual) } else { known.fold(0.0, f64::max) }
    }

    /// The equation whose residual is largest against the forces in its field.
    pub(super) fn worst_equation(
        &mut self,
        residual: &[f64],
        alpha: f64,
        y: &[f64],
        rates: &[f64],
    ) -> Option<usize> {
        let scales = self.force_scales(y, rates, alpha);
        let relative = self.field_equations().into_iter().zip(scales).flat_map(|(range, scale)| {
            range.map(move |k| (k, residual[k].abs() / if scale > 0.0 { scale } else { 1.0 }))
        });
        relative.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
    }

    /// Whether the residual of every field is as small as wanted, or as its rounding at `y`, which is kept in `rounding` until there is another tangent.
    pub(super) fn is_small(
        &self,
        residual: &[f64],
        scales: &[f64],
        y: &[f64],
        rounding: &mut Option<Vec<f64>>,
    ) -> bool {
        let wanted = |k: usize| self.settings.newton_tolerance * scales.get(k).copied().unwrap_or(0.0);
        let sizes = self.field_norms(residual);
        if sizes.iter().enumerate().all(|(k, &size)| size <= wanted(k)) {
            return true;
        }
        let rounding = rounding.get_or_insert_with(|| self.field_norms(&self.rounding(y)));
        sizes.iter().enumerate().all(|(k, &size)| size <= wanted(k).max(rounding[k]))
    }

    /// Residual that rounding alone may leave: the rounding of the unknowns, and of the positions that displacements (fields measured in the unit of
    /// length) add to: through the diagonal of the last tangent, or through all of it where fields act on each other.
    fn rounding(&self, y: &[f64]) -> Vec<f64> {
        let length = self.program.base_units[0];
        let mut sizes = vec![0.0; self.free.len()];
        for (field, numbers) in self.program.fields.iter().zip(&self.unknowns.fields) {
            let offset = if field.unit == length { self.cell_size } else { 0.0 };
            let first = self.free.partition_point(|&u| (u as usize) < numbers.first);
            let own =
                self.free[first..].iter().take_while(|&&u| (u as usize) < numbers.first + numbers.count());
            own.zip(&mut sizes[first..]).for_each(|(&u, size)| *size = y[u as usize].abs() + offset);
        }
        let mut sums = vec![0.0; self.free.len()];
        let symmetric = self.is_symmetric();
        if symmetric && self.unknowns.fields.len() == 1 {
            let diagonal = self.diagonal.iter().map(|&place| self.values[place].abs());
            sums.iter_mut().zip(diagonal).zip(&sizes).for_each(|((sum, entry), size)| *sum = entry * size);
        } else {
            self.pattern.for_each(|place, row, column| {
                let entry = self.values[place].abs();
                sums[row] += entry * sizes[column];
                if symmetric && row != column {
                    sums[column] += entry * sizes[row];
                }
            });
        }
        sums.iter_mut().for_each(|sum| *sum *= ROUNDINGS * f64::EPSILON);
        sums
    }
}
