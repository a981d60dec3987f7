//! Interpreted kernels against differences, and against the numbers on which finite element codes agree.

use super::interpret::{ElementData, run};
use super::{Kernel, Kernels, kernels};
use crate::diagnostic::{Sink, render};
use crate::eval::defaults;
use crate::form::{self, Forms};
use crate::lower::SymbolKind;
use crate::model::Model;
use crate::source::SourceMap;

/// The checked model of a text.
fn model(text: &str) -> Model {
    let (mut sources, mut sink) = (SourceMap::new(), Sink::new());
    let main = sources.add("test.ansatz", text);
    let program =
        crate::resolve::assemble(main, &mut sources, &mut |_, _| Err(String::from("no files")), &mut sink);
    let model = crate::check::check(&program, &sources, &mut sink);
    model.unwrap_or_else(|| panic!("{}", render(&sink.finish(), &sources)))
}

/// A model on the unit square with these physics; coordinates are called `x` and `y` in every frame.
fn on_square(frame: &str, items: &str) -> Model {
    model(&format!(
        "model square;\nuse std::solid::{{F}};\ncoordinates {frame}(x, y);\nunits um, s, nN;\n\
         geometry {{ path rim = from (0, 0) line bottom to (1 um, 0) line right to (1 um, 1 um) line top to (0, 1 um) line left to (0, 0);\n\
         region square = loop(rim); }}\nmesh {{ size = 1 um; }}\nsolve {{ nonlinear = newton(tolerance: 1e-8, iterations: 15); }}\n{items}\n"
    ))
}

const NEO_HOOKEAN: &str = "field u: Vector[Length] in P2 on square = 0;\n\
    param G = 1 kPa; param K = 10 kPa;\n\
    fn Psi(F: Tensor) -> Energy/Volume = G/2*(det(F)^(-2/3)*tr(transpose(F)*F) - 3) + K/2*(det(F) - 1)^2;\n\
    physics elasticity { energy Psi(F(u)) on square; }";

/// Kernels of the only term, and parameters.
fn kernels_of<'m>(model: &'m Model) -> (Forms<'m>, Kernels, Vec<f64>) {
    let mut forms = form::build(model).unwrap_or_else(|problems| panic!("{problems:?}"));
    let parameters = defaults(&mut forms.lowering);
    let term = forms.terms[0].clone();
    let kernels = kernels(&mut forms.lowering, &term, "term");
    (forms, kernels, parameters)
}

fn evaluate(forms: &Forms<'_>, kernel: &Kernel, element: &ElementData, parameters: &[f64]) -> Vec<f64> {
    run(kernel, &forms.lowering, element, &|kind| match kind {
        SymbolKind::Parameter(param) => parameters[param.0],
        SymbolKind::Alpha => 0.7,
        _ => 1.0,
    })
}

type Field = fn(f64, f64) -> [f64; 2];

const U: Field =
    |x, y| [0.05 * x + 0.1 * x * y - 0.05 * x * x, 0.02 * y + 0.08 * y * y - 0.1 * x * y + 0.05 * x * x];
const V: Field = |x, y| [x * y + 0.2 * x, x * x - 0.5 * y * y];
const W: Field = |x, y| [x - 0.3 * x * x, x * y + y];

/// Six nodes of each triangle of the unit square cut n x n x 2 along the diagonals (0,0)-(1,1).
fn triangles(n: usize) -> Vec<Vec<[f64; 2]>> {
    let h = 1.0 / n as f64;
    let middle = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    let six = |[a, b, c]: [[f64; 2]; 3]| vec![a, b, c, middle(a, b), middle(b, c), middle(c, a)];
    let mut all = Vec::new();
    for k in 0..n * n {
        let (x, y) = ((k % n) as f64 * h, (k / n) as f64 * h);
        all.push(six([[x, y], [x + h, y], [x + h, y + h]]));
        all.push(six([[x, y], [x + h, y + h], [x, y + h]]));
    }
    all
}

fn at_nodes(nodes: &[[f64; 2]], field: Field) -> Vec<f64> {
    nodes.iter().flat_map(|&[x, y]| field(x, y)).collect()
}

/// `v^T K w` with the lower triangle of K by rows.
fn quadratic(lower: &[f64], v: &[f64], w: &[f64]) -> f64 {
    let at = |i: usize, j: usize| lower[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
    (0..v.len()).map(|i| (0..w.len()).map(|j| v[i] * at(i, j) * w[j]).sum::<f64>()).sum()
}

/// Energy, R(v) and K(v, w) of the benchmark.
fn benchmark(frame: &str, scale: f64) -> [f64; 3] {
    let model = on_square(frame, NEO_HOOKEAN);
    let (forms, kernels, parameters) = kernels_of(&model);
    let (value, tangent) = (kernels.value.unwrap(), kernels.tangent.unwrap());
    let mut sums = [0.0; 3];
    for nodes in triangles(32) {
        let (values, v, w) = (at_nodes(&nodes, U), at_nodes(&nodes, V), at_nodes(&nodes, W));
        let element = ElementData { nodes, values, rates: Vec::new() };
        let rows = evaluate(&forms, &tangent, &element, &parameters);
        sums[0] += evaluate(&forms, &value, &element, &parameters)[0];
        sums[1] += rows[..12].iter().zip(&v).map(|(r, v)| r * v).sum::<f64>();
        sums[2] += quadratic(&rows[12..], &v, &w);
    }
    sums.map(|sum| sum / scale)
}

fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= tolerance * b.abs().max(1e-3), "{found:?} is not {expected:?}");
    }
}

#[test]
fn plane_strain_neo_hookean_has_the_numbers_on_which_finite_element_codes_agree() {
    let expected = [0.11169755021996, 0.34088465617615, 3.3229104804891];
    assert_close(&benchmark("plane_strain", 1.0), &expected, 1e-11);
}

#[test]
fn axisymmetric_neo_hookean_has_the_numbers_on_which_finite_element_codes_agree() {
    let expected = [0.098173825680912, 1.0007109402214, 16.584346262591];
    assert_close(&benchmark("axisymmetric", std::f64::consts::TAU), &expected, 1e-11);
}

/// A triangle with one curved edge, and fields on it.
fn curved() -> ElementData {
    let nodes = vec![[0.3, 0.1], [1.2, 0.2], [0.4, 0.9], [0.75, 0.12], [0.9, 0.7], [0.35, 0.5]];
    let (values, rates) = (at_nodes(&nodes, U), at_nodes(&nodes, V));
    ElementData { nodes, values, rates }
}

/// Central differences of `f` by the local unknowns; with weight `alpha` also by the rates.
fn differences(element: &ElementData, alpha: f64, f: &dyn Fn(&ElementData) -> Vec<f64>) -> Vec<Vec<f64>> {
    let step = 1e-5;
    let n = element.values.len();
    let mut columns = Vec::new();
    for j in 0..n {
        let moved = |h: f64| {
            let mut moved = element.clone();
            moved.values[j] += h;
            moved.rates[j] += alpha * h;
            f(&moved)
        };
        columns.push(moved(step).iter().zip(moved(-step)).map(|(a, b)| (a - b) / (2.0 * step)).collect());
    }
    columns
}

#[test]
fn the_variation_is_the_derivative_of_the_energy_also_on_curved_cells() {
    for frame in ["plane_strain", "axisymmetric"] {
        let model = on_square(frame, NEO_HOOKEAN);
        let (forms, kernels, parameters) = kernels_of(&model);
        let (value, residual) = (kernels.value.unwrap(), kernels.residual.unwrap());
        let slopes =
            differences(&curved(), 0.0, &|element| evaluate(&forms, &value, element, &parameters)).concat();
        // Central differences with step 1e-5 are right to about 1e-10 here.
        assert_close(&evaluate(&forms, &residual, &curved(), &parameters), &slopes, 1e-6);
    }
}

/// Physics whose tangents are checked: what is special about each stands in its name.
const TERMS: &[(&str, &str)] = &[
    ("an energy", NEO_HOOKEAN),
    (
        "a load with rates, symmetric",
        "field u: Vector[Length] in P2 on square = 0; param c = 2 [nN*s/um^4]; physics drag { load u with -c*dt(u) on square; }",
    ),
    (
        "a frozen factor, unsymmetric",
        "field u: Vector[Length] in P2 on square = 0; param k = 2 [nN/um^4];\n\
         physics p { energy k*frozen(u.x)*u.y on square; }",
    ),
    (
        "a weak form of two fields of different order, unsymmetric",
        "field u: Vector[Length] in P2 on square = 0; field p: Pressure in P1 on square = 0; param k = 2 [um^2/(kPa*s)];\n\
         physics darcy { residual test(p)*dt(det(F(u))) + k*dot(grad(p), grad(test(p))) on square; }\n\
         physics solid { load det(F(u)) with p on square; }",
    ),
    (
        "an edge",
        "field u: Vector[Length] in P2 on square = 0; param c = 2 [nN*s/um^3]; physics drag { load u with -c*norm(u)/(1 um)*dt(u) on rim.right; }",
    ),
];

#[test]
fn tangents_are_derivatives_of_residuals_by_values_and_rates() {
    let alpha = 0.7;
    for (what, items) in TERMS {
        for frame in ["plane_strain", "axisymmetric"] {
            let model = on_square(frame, items);
            let (forms, kernels, parameters) = kernels_of(&model);
            let (residual, tangent) = (kernels.residual.unwrap(), kernels.tangent.unwrap());
            let mut element = curved();
            element.nodes.truncate(residual.geometry.nodes().len());
            let n = residual.unknowns();
            let wave = |k: usize| (1.0 + k as f64).sin() * 0.1;
            element.values = (0..n).map(wave).collect();
            element.rates = (0..n).map(|k| wave(2 * k + 1)).collect();
            let columns =
                differences(&element, alpha, &|element| evaluate(&forms, &residual, element, &parameters));
            let rows = evaluate(&forms, &tangent, &element, &parameters);
            assert_close(&rows[..n], &evaluate(&forms, &residual, &element, &parameters), 1e-14);
            let symmetric = tangent.rows() < n + n * n;
            let at = |i: usize, j: usize| if symmetric { i * (i + 1) / 2 + j } else { i * n + j };
            for i in 0..n {
                for j in (0..n).filter(|&j| !symmetric || j <= i) {
                    let (found, expected) = (rows[n + at(i, j)], columns[j][i]);
                    assert!(
                        (found - expected).abs() < 1e-6,
                        "{what}, {frame}: K[{i}, {j}] = {found}, differences give {expected}"
                    );
                }
            }
            assert_eq!(symmetric, !what.contains("unsymmetric") && !what.contains("edge"), "{what}");
        }
    }
}
