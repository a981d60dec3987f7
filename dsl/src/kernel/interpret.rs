//! Runs a kernel on one element in plain arithmetic: the meaning of a kernel, against which emitted code can be held.

use super::{Flux, Input, Job, Kernel, Tangent};
use crate::lower::{Derivative, FieldInput, Lowering, SymbolKind};
use crate::scalar::eval;
use ansatz_elements::Element;
use std::f64::consts::TAU;

/// One element: geometry nodes, local unknowns and their rates.
#[derive(Clone, Debug, Default)]
#[allow(missing_docs)]
pub struct ElementData {
    pub nodes: Vec<[f64; 2]>,
    pub values: Vec<f64>,
    pub rates: Vec<f64>,
}

/// Values and in-plane derivatives of a field's basis functions at a point.
struct Basis {
    values: Vec<f64>,
    gradients: Vec<[f64; 2]>,
    /// Derivatives by the arc length of an edge.
    along: Vec<f64>,
}

impl Basis {
    fn read(&self, node: usize, derivative: Option<Derivative>) -> f64 {
        match derivative {
            None => self.values[node],
            Some(Derivative::Coordinate(direction)) => self.gradients[node][direction],
            Some(Derivative::Along) => self.along[node],
        }
    }
}

/// The kernel's output rows; `globals` gives parameters, states, tables and the like.
pub fn run(
    kernel: &Kernel,
    lowering: &Lowering<'_>,
    element: &ElementData,
    globals: &dyn Fn(SymbolKind) -> f64,
) -> Vec<f64> {
    let mut out = vec![0.0; kernel.rows()];
    let roots = kernel.job.roots();
    for (xi, weight) in kernel.rule.iter() {
        let map = Map::new(kernel, element, xi);
        let bases: Vec<Basis> = kernel.uses.iter().map(|one| map.basis(one.element, xi)).collect();
        let hoop = if kernel.axisymmetric { TAU * map.x[0] } else { 1.0 };
        let interpolated = |input: Input| interpolate(kernel, &bases, element, input);
        let values = eval(&lowering.pool, &roots, &|symbol| match lowering.symbols.kind(symbol) {
            SymbolKind::Field(input) => interpolated(Input { input, rate: false }),
            SymbolKind::FieldRate(input) => interpolated(Input { input, rate: true }),
            SymbolKind::Coordinate(axis) => map.x[axis],
            SymbolKind::Tangent(axis) => map.tangent()[axis],
            SymbolKind::Curvature(axis) => map.curvature(element)[axis],
            SymbolKind::Weight => weight * map.measure * hoop,
            kind => globals(kind),
        });
        accumulate(kernel, &bases, &values, &mut out);
    }
    out
}

/// Position, Jacobian and measure at a point of the element.
struct Map {
    x: [f64; 2],
    /// `d x_i / d xi_j`, rows i.
    jacobian: [[f64; 2]; 2],
    measure: f64,
}

impl Map {
    fn new(kernel: &Kernel, element: &ElementData, xi: &[f64]) -> Map {
        let (values, gradients) = tabulate(kernel.geometry, xi);
        let mut map = Map { x: [0.0; 2], jacobian: [[0.0; 2]; 2], measure: 0.0 };
        for (node, x) in element.nodes.iter().enumerate() {
            for (axis, x) in x.iter().enumerate() {
                map.x[axis] += values[node] * x;
                for (row, d) in map.jacobian[axis].iter_mut().zip(&gradients[node]) {
                    *row += d * x;
                }
            }
        }
        let [[a, b], [c, d]] = map.jacobian;
        map.measure = if xi.len() == 2 { a * d - b * c } else { a.hypot(c) };
        map
    }

    fn basis(&self, element: &Element, xi: &[f64]) -> Basis {
        let (values, reference) = tabulate(element, xi);
        let [[a, b], [c, d]] = self.jacobian;
        let pulled = |g: &Vec<f64>| match g.as_slice() {
            &[g0, g1] => [(d * g0 - c * g1) / self.measure, (a * g1 - b * g0) / self.measure],
            _ => [0.0; 2],
        };
        let along = reference.iter().map(|g| g[0] / self.measure).collect();
        Basis { values, gradients: reference.iter().map(pulled).collect(), along }
    }

    /// Unit tangent of an edge.
    fn tangent(&self) -> [f64; 2] {
        [0, 1].map(|axis: usize| self.jacobian[axis][0] / self.measure)
    }

    /// Derivative of the tangent of a quadratic edge by its arc length.
    fn curvature(&self, element: &ElementData) -> [f64; 2] {
        let [a, b, m] = [0, 1, 2].map(|node: usize| element.nodes[node]);
        let second =
            [0, 1].map(|axis: usize| 4.0 * (a[axis] + b[axis] - 2.0 * m[axis]) / self.measure.powi(2));
        let tangent = self.tangent();
        let part = tangent[0] * second[0] + tangent[1] * second[1];
        [0, 1].map(|axis: usize| second[axis] - part * tangent[axis])
    }
}

/// Basis functions and their reference gradients at a point.
pub fn tabulate(element: &Element, xi: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let nodes = element.nodes().len();
    let mut values = vec![0.0; nodes];
    let mut gradients = vec![0.0; nodes * xi.len()];
    element.evaluate(xi, &mut values);
    element.gradients(xi, &mut gradients);
    (values, gradients.chunks(xi.len()).map(<[f64]>::to_vec).collect())
}

fn interpolate(kernel: &Kernel, bases: &[Basis], element: &ElementData, Input { input, rate }: Input) -> f64 {
    let (one, basis) = use_and_basis(kernel, bases, input);
    let unknowns = if rate { &element.rates } else { &element.values };
    let at = |node| unknowns[one.first + node * one.components + input.component];
    (0..one.nodes()).map(|node| at(node) * basis.read(node, input.derivative)).sum()
}

fn use_and_basis<'a>(
    kernel: &'a Kernel,
    bases: &'a [Basis],
    input: FieldInput,
) -> (&'a super::FieldUse, &'a Basis) {
    let position = kernel.uses.iter().position(|one| one.field == input.field).unwrap_or(0);
    (&kernel.uses[position], &bases[position])
}

/// Unknowns and basis values through which an input depends on the unknowns.
fn spread(kernel: &Kernel, bases: &[Basis], input: FieldInput) -> Vec<(usize, f64)> {
    let (one, basis) = use_and_basis(kernel, bases, input);
    let unknown = |node| one.first + node * one.components + input.component;
    (0..one.nodes()).map(|node| (unknown(node), basis.read(node, input.derivative))).collect()
}

fn accumulate(kernel: &Kernel, bases: &[Basis], values: &[f64], out: &mut [f64]) {
    let n = kernel.unknowns();
    match &kernel.job {
        Job::Value(_) => out[0] += values[0],
        Job::Residual(flux) => add_flux(kernel, bases, flux, values, &mut out[..n]),
        Job::Columns(columns) => {
            let mut rest = values;
            for (column, out) in columns.iter().zip(out.chunks_mut(n)) {
                let (here, after) = rest.split_at(column.len());
                add_flux(kernel, bases, column, here, out);
                rest = after;
            }
        }
        Job::Tangent(flux, tangent) => {
            let (fluxes, entries) = values.split_at(flux.len());
            let (residual, matrix) = out.split_at_mut(n);
            add_flux(kernel, bases, flux, fluxes, residual);
            add_tangent(kernel, bases, tangent, entries, matrix);
        }
    }
}

fn add_flux(kernel: &Kernel, bases: &[Basis], flux: &[Flux], values: &[f64], out: &mut [f64]) {
    for ((test, _), value) in flux.iter().zip(values) {
        for (row, basis) in spread(kernel, bases, *test) {
            out[row] += value * basis;
        }
    }
}

fn add_tangent(kernel: &Kernel, bases: &[Basis], tangent: &Tangent, entries: &[f64], matrix: &mut [f64]) {
    let mut entries = entries.iter();
    for (test, row) in tangent.tests.iter().zip(&tangent.entries) {
        for (trial, _) in tangent.trials.iter().zip(row).filter(|(_, entry)| entry.is_some()) {
            let Some(value) = entries.next() else { return };
            for (i, p) in spread(kernel, bases, *test) {
                for (j, q) in spread(kernel, bases, *trial) {
                    if let Some(position) = position(kernel, tangent.symmetric, i, j) {
                        matrix[position] += p * value * q;
                    }
                }
            }
        }
    }
}

/// Where entry (i, j) is stored; `None` above the diagonal of a symmetric matrix.
fn position(kernel: &Kernel, symmetric: bool, i: usize, j: usize) -> Option<usize> {
    match symmetric {
        false => Some(i * kernel.unknowns() + j),
        true => (j <= i).then(|| i * (i + 1) / 2 + j),
    }
}
