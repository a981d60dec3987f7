//! What a kernel costs, per element: counted, not measured.

use super::{Job, Kernel, POINT, PRELUDE};
use crate::lower::FieldInput;

/// Operations in units of one addition (a multiplication with addition counts 2, a division 8, `exp` 24) and storage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Cost {
    pub points: usize,
    /// Once per batch of elements.
    pub prelude: usize,
    /// Per point: map to the element and its inverse.
    pub geometry: usize,
    /// Per point: values and gradients of fields.
    pub interpolation: usize,
    /// Per point: the law.
    pub point: usize,
    /// Per point: products with test and trial functions.
    pub accumulation: usize,
    /// Named values of the law.
    pub temporaries: usize,
    /// Read and written per element.
    pub bytes: usize,
}

impl Cost {
    /// Counts a kernel.
    pub fn of(kernel: &Kernel) -> Cost {
        let n = kernel.unknowns();
        let rates = kernel.inputs.iter().any(|input| input.rate);
        let values = kernel.inputs.iter().any(|input| !input.rate);
        let read = 2 * kernel.geometry.nodes().len() + n * (usize::from(rates) + usize::from(values));
        Cost {
            points: kernel.rule.weights.len(),
            prelude: kernel.schedule.cost(PRELUDE) as usize,
            geometry: geometry(kernel),
            interpolation: kernel
                .inputs
                .iter()
                .map(|input| 2 * kernel.use_of(input.input.field).nodes())
                .sum(),
            point: kernel.schedule.cost(POINT) as usize,
            accumulation: accumulation(kernel),
            temporaries: kernel.schedule.statements(PRELUDE).len() + kernel.schedule.statements(POINT).len(),
            bytes: 8 * (read + kernel.rows()),
        }
    }

    /// All operations of an element.
    pub fn operations(&self) -> usize {
        self.points * (self.geometry + self.interpolation + self.point + self.accumulation)
    }
}

fn geometry(kernel: &Kernel) -> usize {
    let nodes = kernel.geometry.nodes().len();
    let dimension = kernel.cell.dimension();
    let coordinates = kernel.coordinates.iter().filter(|&&read| read).count();
    let jacobian = 2 * nodes * (2 * dimension + coordinates);
    let gradients =
        |one: &super::FieldUse| if kernel.needs_gradients(one.field) { 6 * one.nodes() } else { 0 };
    jacobian + 16 + kernel.uses.iter().map(gradients).sum::<usize>()
}

fn accumulation(kernel: &Kernel) -> usize {
    let nodes = |input: &FieldInput| kernel.use_of(input.field).nodes();
    let rows = |tests: usize| 2 * tests;
    match &kernel.job {
        Job::Value(_) => 1,
        Job::Residual(flux) => flux.iter().map(|(test, _)| rows(nodes(test))).sum(),
        Job::Columns(columns) => columns.iter().flatten().map(|(test, _)| rows(nodes(test))).sum(),
        Job::Tangent(flux, tangent) => {
            let residual: usize = flux.iter().map(|(test, _)| rows(nodes(test))).sum();
            let entries = tangent.entries.iter().flatten().flatten().count();
            let columns: usize = tangent.trials.iter().map(nodes).max().unwrap_or(0) * 2 * entries;
            let half = if tangent.symmetric { 1 } else { 2 };
            let blocks: usize = tangent.tests.iter().map(|test| nodes(test) * kernel.unknowns() * half).sum();
            residual + columns + blocks
        }
    }
}
