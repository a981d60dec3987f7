//! What a kernel costs, per element: counted, not measured.

use super::{FieldUse, Job, Kernel, POINT, PRELUDE};
use crate::lower::FieldInput;
use ansatz_elements::Cell;

/// Arithmetic of the core to which [`Cost::nanoseconds`] refers \[flop/ns\]: 16 flops in a cycle of 3.1 GHz.
pub const FLOPS_PER_NS: f64 = 50.0;
/// Traffic of that core with memory \[byte/ns\].
pub const BYTES_PER_NS: f64 = 20.0;

/// Operations in units of one addition (a multiplication with addition counts 2, a division 8, `exp` 24) and storage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Cost {
    pub points: usize,
    /// Once per batch of elements.
    pub prelude: usize,
    /// Once per element with straight edges: its map and the inverse. (Curved elements have this at every point.)
    pub map: usize,
    /// Per point: coordinates, measure, gradients of basis functions.
    pub geometry: usize,
    /// Per point: values and gradients of fields.
    pub interpolation: usize,
    /// Per point: the law.
    pub point: usize,
    /// Per point: products with test and trial functions.
    pub accumulation: usize,
    /// Named values of the law.
    pub temporaries: usize,
    /// Read and written per element, if nothing that neighbours share is in a cache: coordinates, unknowns, and what is added to.
    pub bytes: usize,
}

impl Cost {
    /// Counts a kernel.
    pub fn of(kernel: &Kernel) -> Cost {
        Cost {
            points: kernel.rule.weights.len(),
            prelude: kernel.schedule.cost(PRELUDE) as usize,
            map: map(kernel),
            geometry: geometry(kernel),
            interpolation: kernel
                .inputs
                .iter()
                .map(|input| 2 * kernel.use_of(input.input.field).nodes())
                .sum(),
            point: kernel.schedule.cost(POINT) as usize,
            accumulation: accumulation(kernel),
            temporaries: kernel.schedule.statements(PRELUDE).len() + kernel.schedule.statements(POINT).len(),
            bytes: bytes(kernel),
        }
    }

    /// All operations of an element with straight edges.
    pub fn operations(&self) -> usize {
        self.map + self.points * (self.geometry + self.interpolation + self.point + self.accumulation)
    }

    /// Operations per byte.
    pub fn intensity(&self) -> f64 {
        self.operations() as f64 / self.bytes as f64
    }

    /// Least time on a core with [`FLOPS_PER_NS`] and [`BYTES_PER_NS`] \[ns\]: the greater of arithmetic and traffic.
    pub fn nanoseconds(&self) -> f64 {
        (self.operations() as f64 / FLOPS_PER_NS).max(self.bytes as f64 / BYTES_PER_NS)
    }
}

/// Jacobian; determinant and inverse of a triangle, length of an edge.
fn map(kernel: &Kernel) -> usize {
    let jacobian = 2 * kernel.geometry.nodes().len() * 2 * kernel.cell.dimension();
    jacobian + if kernel.cell == Cell::Triangle { 17 } else { 11 }
}

fn geometry(kernel: &Kernel) -> usize {
    let coordinates = kernel.coordinates.iter().filter(|&&read| read).count();
    let weight = if kernel.axisymmetric { 3 } else { 1 };
    let of_path = 12 * kernel.tangent.iter().chain(&kernel.curvature).filter(|&&read| read).count();
    let per_node = if kernel.cell == Cell::Triangle { 6 } else { 1 };
    let gradients =
        |one: &FieldUse| if kernel.needs_gradients(one.field) { per_node * one.nodes() } else { 0 };
    2 * kernel.geometry.nodes().len() * coordinates
        + weight
        + of_path
        + kernel.uses.iter().map(gradients).sum::<usize>()
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
            let slopes: usize = tangent.trials.iter().map(nodes).max().unwrap_or(0) * 2 * entries;
            let products = |test: &FieldInput| 2 * columns_of(kernel, test, tangent.symmetric);
            residual + slopes + tangent.tests.iter().map(products).sum::<usize>()
        }
    }
}

/// Entries of a tangent that a test works on, over all its nodes.
fn columns_of(kernel: &Kernel, test: &FieldInput, symmetric: bool) -> usize {
    let one = kernel.use_of(test.field);
    let row = |node: usize| one.first + node * one.components + test.component;
    (0..one.nodes()).map(|node| if symmetric { row(node) + 1 } else { kernel.unknowns() }).sum()
}

/// Coordinates; number and value (and rate) of each unknown; entries of the residual and of the matrix, read and written, the latter with
/// their places.
fn bytes(kernel: &Kernel) -> usize {
    let n = kernel.unknowns();
    let interpolated = [false, true].map(|rate| kernel.inputs.iter().any(|input| input.rate == rate));
    let read = interpolated.into_iter().filter(|&read| read).count();
    let written = match kernel.job {
        Job::Value(_) => 0,
        Job::Residual(_) | Job::Columns(_) => 16 * kernel.rows(),
        Job::Tangent(..) => 16 * n + 20 * (kernel.rows() - n),
    };
    16 * kernel.geometry.nodes().len() + (4 + 8 * read) * n + written
}
