//! Integrals over elements: their residual, tangent and value, added through precomputed positions.

use super::elements::{Elements, Gathered};
use super::unknowns::{NONE, Unknowns};
use crate::error::Error;
use crate::generated::{BATCH, GlobalTangent, Integral, Row};
use crate::mesh::Mesh;
use crate::solve::sparse::{MatrixKind, SparsePattern};

/// Where everything is evaluated: unknowns, their rates, globals, and d rate / d value.
#[derive(Clone, Copy)]
pub struct At<'a> {
    /// Unknowns y.
    pub y: &'a [f64],
    /// Their time derivatives.
    pub rates: &'a [f64],
    /// Globals.
    pub g: &'a [f64],
    /// d rate / d value of the time integrator [1/time].
    pub alpha: f64,
}

/// Where tangents go.
#[derive(Clone, Copy)]
pub struct Layout<'a> {
    /// Entries of the matrix.
    pub pattern: &'a SparsePattern,
    /// Equation of each field unknown, or [`NONE`].
    pub equations: &'a [u32],
    /// Unknowns that equal rates: their columns go to a second matrix.
    pub follows: &'a [bool],
    /// Number of matrix values: those of the pattern and a spare one, or twice as many.
    pub length: usize,
}

/// An integral on the elements of its domain.
pub struct Term {
    /// The emitted integral.
    pub integral: &'static Integral,
    /// Its elements.
    pub elements: Elements,
    /// Place in the matrix values of each tangent row and lane.
    positions: Vec<[u32; BATCH]>,
    /// Place of the transposed entry, where a symmetric tangent goes into an unsymmetric matrix.
    mirrored: Vec<[u32; BATCH]>,
    gathered: Gathered,
    out: Vec<Row>,
}

impl Term {
    /// Collects the elements of an integral.
    pub fn new(integral: &'static Integral, mesh: &Mesh, unknowns: &Unknowns) -> Result<Self, Error> {
        Ok(Self::on(Elements::new(mesh, unknowns, integral)?, integral))
    }

    /// The integral on the batches that have some unknown of those asked for.
    pub fn part(&self, wanted: impl Fn(u32) -> bool) -> Self {
        Self::on(self.elements.part(wanted), self.integral)
    }

    fn on(elements: Elements, integral: &'static Integral) -> Self {
        let rows = elements.local() + tangent_rows(integral.symmetric, elements.local());
        let out = vec![Row::ZERO; rows.max(1)];
        let gathered = elements.buffers();
        Self { integral, elements, positions: Vec::new(), mirrored: Vec::new(), gathered, out }
    }

    /// Looks up where the tangent goes, if there is one; entries of held unknowns go to the spare last value, columns of unknowns that equal rates
    /// to a second matrix behind it.
    pub fn locate(&mut self, Layout { pattern, equations, follows, .. }: Layout<'_>) {
        if self.integral.tangent.is_none() {
            return;
        }
        let (n, spare) = (self.elements.local(), pattern.entries() as u32);
        let symmetric = self.integral.symmetric;
        let mirror = symmetric && pattern.kind() == MatrixKind::Unsymmetric;
        self.positions.clear();
        self.mirrored.clear();
        let mut places = vec![0; pattern.size()];
        let mut blocks = vec![[spare; BATCH]; n * n];
        let mut block = vec![spare; n * n];
        for batch in 0..self.elements.batches() {
            let unknowns = self.elements.unknowns(batch);
            for lane in 0..BATCH {
                let unknown = |i: usize| unknowns[i][lane] as usize;
                let of_lane: Vec<Option<u32>> =
                    (0..n).map(|i| Some(equations[unknown(i)]).filter(|&e| e != NONE)).collect();
                pattern.block_positions(&of_lane, &mut places, &mut block);
                for (k, (to, &place)) in blocks.iter_mut().zip(&block).enumerate() {
                    let second = if place != spare && follows[unknown(k % n)] { spare + 1 } else { 0 };
                    to[lane] = place + second;
                }
            }
            for i in 0..n {
                for j in 0..if symmetric { i + 1 } else { n } {
                    self.positions.push(blocks[i * n + j]);
                    if mirror {
                        self.mirrored.push(if i == j { [spare; BATCH] } else { blocks[j * n + i] });
                    }
                }
            }
        }
    }

    /// Takes those places from the same integral on the same cells.
    pub fn take_places(&mut self, from: &mut Self) {
        self.positions = std::mem::take(&mut from.positions);
        self.mirrored = std::mem::take(&mut from.mirrored);
    }

    /// Changes where entries of the tangent go.
    pub fn redirect(&mut self, new: impl Fn(u32) -> u32) {
        let places = self.positions.iter_mut().chain(&mut self.mirrored).flatten();
        places.for_each(|place| *place = new(*place));
    }

    /// Value of the integral; 0 if the integrand has none.
    pub fn value(&mut self, at: At<'_>) -> f64 {
        let Some(kernel) = self.integral.value else { return 0.0 };
        let mut sum = 0.0;
        for batch in 0..self.elements.batches() {
            let elements = self.elements.gather(batch, at.y, at.rates, at.alpha, &mut self.gathered);
            kernel(&elements, at.g, &mut self.out[..1]);
            sum += self.out[0][..self.elements.count(batch)].iter().sum::<f64>();
        }
        sum
    }

    /// Adds `factor` times the residual to `residual` (all unknowns).
    pub fn add_residual(&mut self, at: At<'_>, factor: f64, residual: &mut [f64]) {
        let n = self.elements.local();
        for batch in 0..self.elements.batches() {
            let elements = self.elements.gather(batch, at.y, at.rates, at.alpha, &mut self.gathered);
            (self.integral.residual)(&elements, at.g, &mut self.out[..n]);
            scatter_rows(&self.elements, batch, &self.out[..n], factor, residual);
        }
    }

    /// Adds the magnitudes of the element residuals: the size of the forces that balance.
    pub fn add_magnitude(&mut self, at: At<'_>, magnitude: &mut [f64]) {
        let n = self.elements.local();
        for batch in 0..self.elements.batches() {
            let elements = self.elements.gather(batch, at.y, at.rates, at.alpha, &mut self.gathered);
            (self.integral.residual)(&elements, at.g, &mut self.out[..n]);
            self.out[..n].iter_mut().for_each(|row| *row = Row(row.map(f64::abs)));
            scatter_rows(&self.elements, batch, &self.out[..n], 1.0, magnitude);
        }
    }

    /// Adds `factor` times the residual and the tangent. `values` has one spare entry at its end.
    pub fn add_tangent(&mut self, at: At<'_>, factor: f64, residual: &mut [f64], values: &mut [f64]) {
        let Some(kernel) = self.integral.tangent else {
            return self.add_residual(at, factor, residual);
        };
        let n = self.elements.local();
        let rows = tangent_rows(self.integral.symmetric, n);
        for batch in 0..self.elements.batches() {
            let elements = self.elements.gather(batch, at.y, at.rates, at.alpha, &mut self.gathered);
            kernel(&elements, at.g, &mut self.out[..n + rows]);
            scatter_rows(&self.elements, batch, &self.out[..n], factor, residual);
            let count = self.elements.count(batch);
            let tangent = &self.out[n..n + rows];
            scatter_entries(
                tangent,
                &self.positions[batch * rows..(batch + 1) * rows],
                count,
                factor,
                values,
            );
            if !self.mirrored.is_empty() {
                scatter_entries(
                    tangent,
                    &self.mirrored[batch * rows..(batch + 1) * rows],
                    count,
                    factor,
                    values,
                );
            }
        }
    }

    /// Adds d residual / d g[slot] to one column per slot of the integral.
    pub fn add_global_tangent(&mut self, at: At<'_>, tangent: &GlobalTangent, columns: &mut [Vec<f64>]) {
        let n = self.elements.local();
        let mut out = vec![Row::ZERO; n * tangent.slots.len()];
        for batch in 0..self.elements.batches() {
            let elements = self.elements.gather(batch, at.y, at.rates, at.alpha, &mut self.gathered);
            (tangent.kernel)(&elements, at.g, &mut out);
            for (column, rows) in columns.iter_mut().zip(out.chunks(n)) {
                scatter_rows(&self.elements, batch, rows, 1.0, column);
            }
        }
    }
}

fn tangent_rows(symmetric: bool, n: usize) -> usize {
    if symmetric { n * (n + 1) / 2 } else { n * n }
}

fn scatter_rows(elements: &Elements, batch: usize, rows: &[Row], factor: f64, sum: &mut [f64]) {
    let count = elements.count(batch);
    for (row, unknowns) in rows.iter().zip(elements.unknowns(batch)) {
        for (value, unknown) in row.iter().zip(unknowns).take(count) {
            sum[*unknown as usize] += factor * value;
        }
    }
}

fn scatter_entries(rows: &[Row], positions: &[[u32; BATCH]], count: usize, factor: f64, values: &mut [f64]) {
    for (row, position) in rows.iter().zip(positions) {
        for (value, place) in row.iter().zip(position).take(count) {
            values[*place as usize] += factor * value;
        }
    }
}
