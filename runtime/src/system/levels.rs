//! Scalar fields whose level nothing fixes: the pressure of an incompressible fluid in a closed box, the steady temperature of an insulated
//! body. Their equations see differences only, so adding a constant changes nothing and one equation follows from the others.
//!
//! Found at the start, for each connected part of a field: the constant lies in the kernel of the tangent and of its transpose. Then one unknown
//! of the part leaves the equations, and every solution is shifted so that the mean over the part stays that of the field's start. The
//! equation left out must hold all the same: what flows into a closed box has to flow out of it.

use super::System;
use super::contact::Curvature;
use super::elements::geometry;
use super::globals::quadrature_points;
use super::newton::StageProblem;
use super::start::number_equations;
use super::terms::At;
use super::unknowns::{NONE, domain_elements, field_nodes};
use crate::error::{Cause, Error, SolveError};
use ansatz_elements::Element;
use std::collections::BTreeMap;

/// Part of a row that may be left of a sum that is zero, and of the largest row.
const CANCELLED: [f64; 2] = [1e-8, 1e-13];
/// Part of what is balanced that the equation left out may miss. A profile that is held with the error of its interpolation misses less.
const BALANCED: f64 = 1e-5;
/// Degree of the rule for means: exact for quadratic fields times 2 pi r on straight cells.
const MEAN_DEGREE: usize = 4;

/// A connected part of a scalar field whose level nothing fixes.
#[derive(Clone, Debug)]
pub(super) struct Level {
    field: usize,
    /// Unknowns of the part with their share of the mean, which add up to 1.
    shares: Vec<(usize, f64)>,
    /// The unknown without an equation.
    left_out: usize,
    /// The mean at the start.
    mean: f64,
}

impl Level {
    fn mean_of(&self, y: &[f64]) -> f64 {
        self.shares.iter().map(|&(unknown, share)| share * y[unknown]).sum()
    }
}

/// Sum and sum of magnitudes.
type Sum = [f64; 2];

impl System {
    /// Finds the free levels at the start `y` and takes one equation of each out of the system.
    pub(super) fn fix_levels(&mut self, y: &[f64]) -> Result<(), Error> {
        if self.levels.is_none() {
            let levels = self.free_levels(y)?;
            if !levels.is_empty() {
                let held = self.held.iter().map(|h| h.unknown);
                let without = held.chain(levels.iter().map(|level| level.left_out));
                (self.equations, self.free) = number_equations(&self.unknowns, without, &self.ties);
                self.rebuild_pattern(y)?;
            }
            self.levels = Some(levels);
        }
        self.levels.iter_mut().flatten().for_each(|level| level.mean = level.mean_of(y));
        Ok(())
    }

    fn free_levels(&mut self, y: &[f64]) -> Result<Vec<Level>, Error> {
        let mut candidates = Vec::new();
        for field in (0..self.unknowns.fields.len()).filter(|&f| self.unknowns.fields[f].components == 1) {
            let parts = self.parts(field)?;
            candidates.extend(parts.into_iter().filter(|part| self.is_solved_for(part)));
        }
        if candidates.is_empty() {
            return Ok(candidates);
        }
        let shaken = self.shaken(y);
        let alpha = self.settings.time.map_or(0.0, |_| 1.0 / self.settings.max_step);
        let rates = vec![0.0; y.len()];
        let balance = self.linearise(&shaken, &rates, alpha, Curvature::Kept);
        candidates.retain(|part| self.is_free(part, &balance.products.factors()));
        Ok(candidates)
    }

    /// Connected parts of a scalar field.
    fn parts(&self, field: usize) -> Result<Vec<Level>, Error> {
        let numbers = &self.unknowns.fields[field];
        let mut part: Vec<usize> = (0..numbers.nodes.len()).collect();
        let mut weights = vec![0.0; numbers.nodes.len()];
        for domain in self.program.fields[field].domains {
            let shape = geometry(*domain);
            for nodes in domain_elements(&self.mesh, *domain)?.concat() {
                let places: Vec<usize> = nodes[..field_nodes(nodes.len(), numbers.nodes_per_cell)]
                    .iter()
                    .map(|&n| numbers.position[n as usize] as usize)
                    .collect();
                places.windows(2).for_each(|pair| join(&mut part, pair[0], pair[1]));
                let element = linear_or(shape, places.len());
                let mut basis = vec![0.0; places.len()];
                for (local, x, weight) in quadrature_points(&self.mesh, shape, &nodes, MEAN_DEGREE) {
                    element.evaluate(&local, &mut basis);
                    let weight = weight * (self.program.weight)(x);
                    places.iter().zip(&basis).for_each(|(&place, value)| weights[place] += weight * value);
                }
            }
        }
        let mut parts: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        for (place, &weight) in weights.iter().enumerate() {
            parts.entry(root(&part, place)).or_default().push((numbers.first + place, weight));
        }
        let level = |mut shares: Vec<(usize, f64)>| {
            let total: f64 = shares.iter().map(|(_, weight)| weight).sum();
            shares.iter_mut().for_each(|(_, weight)| *weight /= total);
            Level { field, left_out: shares[0].0, shares, mean: 0.0 }
        };
        Ok(parts.into_values().map(level).collect())
    }

    fn is_solved_for(&self, part: &Level) -> bool {
        part.shares.iter().all(|&(unknown, _)| self.equations[unknown] != NONE)
    }

    /// Unknowns near y at which nothing vanishes by chance.
    fn shaken(&self, y: &[f64]) -> Vec<f64> {
        let length = self.program.base_units[0];
        let mut shaken = y.to_vec();
        for (field, numbers) in self.program.fields.iter().zip(&self.unknowns.fields) {
            let size = if field.unit == length { 1e-3 * self.cell_size } else { 1.0 };
            let range = numbers.first..numbers.first + numbers.count();
            for (unknown, value) in range.clone().zip(&mut shaken[range]) {
                if self.equations[unknown] != NONE {
                    *value += size * (unknown as f64).sin();
                }
            }
        }
        shaken
    }

    /// Whether the tangent last assembled, with the columns of its outer products, and its transpose turn the constant on a part into zero.
    fn is_free(&self, part: &Level, columns: &[&[f64]]) -> bool {
        let count = self.free.len();
        let mut inside = vec![false; count];
        part.shares.iter().for_each(|&(unknown, _)| inside[self.equations[unknown] as usize] = true);
        let mut rows: Vec<Sum> = vec![[0.0; 2]; count];
        let mut transposed = rows.clone();
        let mirrored = self.is_symmetric();
        self.pattern.for_each(|position, row, column| {
            let entry = self.values[position];
            add(&mut rows[row], entry, inside[column]);
            add(&mut transposed[column], entry, inside[row]);
            if mirrored && row != column {
                add(&mut rows[column], entry, inside[row]);
            }
        });
        let of_columns = columns.iter().flat_map(|all| all.chunks(count.max(1))).map(|column| {
            let mut sum = [0.0; 2];
            column.iter().zip(&inside).for_each(|(&entry, &inside)| add(&mut sum, entry, inside));
            sum
        });
        let of_columns: Vec<Sum> = of_columns.collect();
        vanish(&rows) && (mirrored || vanish(&transposed)) && of_columns.iter().all(|sum| vanish(&[*sum]))
    }

    /// Shifts the free levels of a solution to their means.
    ///
    /// # Errors
    /// [`Cause::Unbalanced`] if an equation that was left out does not hold.
    pub(super) fn settle_levels(
        &mut self,
        problem: &StageProblem<'_>,
        y: &mut [f64],
    ) -> Result<(), SolveError> {
        let levels = self.levels.take().unwrap_or_default();
        let settled = if levels.is_empty() { Ok(()) } else { self.check_levels(problem, &levels, y) };
        for level in &levels {
            let shift = level.mean - level.mean_of(y);
            level.shares.iter().for_each(|&(unknown, _)| y[unknown] += shift);
        }
        self.levels = Some(levels);
        settled
    }

    fn check_levels(
        &mut self,
        problem: &StageProblem<'_>,
        levels: &[Level],
        y: &[f64],
    ) -> Result<(), SolveError> {
        let mut rates = vec![0.0; y.len()];
        problem.rates(y, &mut rates, 0..y.len());
        let residual = self.unknown_residual(y, &rates, problem.alpha, None);
        // What flows through cells where the unknowns are as large as they are, but do not cancel.
        let flows = self.magnitude(&uneven(y), &uneven(&rates), problem.alpha);
        for level in levels {
            let missing = residual[level.left_out];
            let of_part = level.shares.iter().map(|&(unknown, _)| flows[unknown]);
            if missing.abs() > BALANCED * of_part.sum::<f64>() {
                return Err(SolveError {
                    cause: Cause::Unbalanced(self.program.fields[level.field].name),
                    time: problem.time,
                    step: 0.0,
                    iterations: 0,
                    residual: missing,
                    place: self.statements_at(level.left_out, y, &rates, problem.alpha),
                    terms: Vec::new(),
                });
            }
        }
        Ok(())
    }

    /// Where the statements stand that make up the residual at an unknown.
    fn statements_at(&mut self, unknown: usize, y: &[f64], rates: &[f64], alpha: f64) -> String {
        let at = At { y, rates, g: &self.g, alpha };
        let mut places = Vec::new();
        for term in &mut self.assembly.terms {
            let mut magnitude = vec![0.0; y.len()];
            term.add_magnitude(at, &mut magnitude);
            if magnitude[unknown] > 0.0 {
                places.push(term.integral.place);
            }
        }
        places.join(", ")
    }
}

/// The element with this many nodes on the cell of a quadratic one.
fn linear_or(quadratic: &'static Element, nodes: usize) -> &'static Element {
    let linear = Element::find("P1", quadratic.cell).filter(|element| element.nodes().len() == nodes);
    linear.unwrap_or(quadratic)
}

/// Numbers of the same size that cancel nowhere by design.
fn uneven(y: &[f64]) -> Vec<f64> {
    y.iter().enumerate().map(|(k, value)| value * (1.0 + k as f64).sin()).collect()
}

fn add(sum: &mut Sum, entry: f64, counts: bool) {
    if counts {
        sum[0] += entry;
        sum[1] += entry.abs();
    }
}

/// Whether sums are zero up to rounding.
fn vanish(sums: &[Sum]) -> bool {
    let largest = sums.iter().fold(0.0_f64, |largest, sum| largest.max(sum[1]));
    let zero = |sum: &Sum| sum[0].abs() <= CANCELLED[0] * sum[1] + CANCELLED[1] * largest;
    sums.iter().all(zero)
}

/// The representative of the set that `of` belongs to.
fn root(part: &[usize], mut of: usize) -> usize {
    while part[of] != of {
        of = part[of];
    }
    of
}

/// Joins two sets; the smaller representative stays, which keeps the way there short enough for numbers along a curve.
fn join(part: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(part, a), root(part, b));
    part[a.max(b)] = a.min(b);
}
