//! Every derivative that the compiler emits is the derivative of what it emits: for all shipped models, at random but valid data.
//!
//! Differences of fourth order with a step of 1e-3 of an element's size have an error of some 1e-13 times the fifth derivative, apart from
//! rounding; 1e-8 of the largest entry leaves room for stiff laws, and a wrong term of any size is seen.

use ansatz::generated::{BATCH, FunctionalKind, Integral, Kernel, Program, Row};
use ansatz_tests::differences::{Difference, assert_agree, derivative};
use ansatz_tests::programs;
use ansatz_tests::sample::{Elements, Random, globals};

const STEP: f64 = 1e-3;
const TOLERANCE: f64 = 1e-8;
/// Batches of 8 elements for each integral: enough to meet each of a few regions.
const SAMPLES: u64 = 6;

/// All results of a kernel, row by row, lane by lane.
fn apply(kernel: Kernel, elements: &Elements, g: &[f64], rows: usize) -> Vec<f64> {
    let mut out = vec![Row::ZERO; rows];
    kernel(&elements.batch(), g, &mut out);
    out.into_iter().flat_map(|row| row.0).collect()
}

/// Every integral of a program with a name, on which the test functions below are tried.
fn integrals(program: &'static Program) -> Vec<(String, &'static Integral)> {
    let balance = program.integrals.iter();
    let functionals = program.functionals.iter().flat_map(|f| match f.kind {
        FunctionalKind::Integral(integrals) => integrals,
        FunctionalKind::Point { .. } => &[],
    });
    let named = |integral: &'static Integral| {
        (format!("{}, {} ({})", program.name, integral.name, integral.place), integral)
    };
    balance.chain(functionals).map(named).collect()
}

/// Calls `claim` with every integral of every model at several data.
fn for_all(claim: impl Fn(&str, &Integral, &Elements, &[f64])) {
    let mut tried = 0;
    for program in programs() {
        for (name, integral) in integrals(program) {
            for seed in 0..SAMPLES {
                let mut random = Random::new(seed);
                let g = globals(program, &mut random);
                let elements = Elements::new(program, integral, &g, &mut random);
                claim(&name, integral, &elements, &g);
                tried += 1;
            }
        }
    }
    assert!(tried > 100, "the models were found");
}

/// Derivative of a kernel's results by each local unknown, one list for each.
fn jacobian(
    kernel: Kernel,
    elements: &Elements,
    g: &[f64],
    rows: usize,
    rates_too: bool,
) -> Vec<Vec<Difference>> {
    let by = |unknown: usize| {
        derivative(STEP, |h| {
            let mut moved = elements.moved(unknown, h);
            if !rates_too {
                moved.rates.clone_from(&elements.rates);
            }
            apply(kernel, &moved, g, rows)
        })
    };
    (0..elements.values.len()).map(by).collect()
}

#[test]
fn a_residual_is_the_derivative_of_its_value() {
    for_all(|name, integral, elements, g| {
        let Some(value) = integral.value else { return };
        let n = elements.values.len();
        let exact = apply(integral.residual, elements, g, n);
        assert_agree(name, &exact, &jacobian(value, elements, g, 1, false).concat(), TOLERANCE);
    });
}

#[test]
fn a_tangent_is_the_derivative_of_its_residual() {
    for_all(|name, integral, elements, g| {
        let n = elements.values.len();
        let columns = jacobian(integral.residual, elements, g, n, true);
        let exact = tangent(integral, elements, g);
        for (column, exact) in columns.iter().zip(&exact) {
            assert_agree(name, exact, column, TOLERANCE);
        }
    });
}

/// The tangent as columns, like [`jacobian`]; zero where the integral has none.
fn tangent(integral: &Integral, elements: &Elements, g: &[f64]) -> Vec<Vec<f64>> {
    let n = elements.values.len();
    let Some(kernel) = integral.tangent else { return vec![vec![0.0; n * BATCH]; n] };
    let rows = if integral.symmetric { n * (n + 1) / 2 } else { n * n };
    let out = apply(kernel, elements, g, n + rows);
    let entry = |i: usize, j: usize| match integral.symmetric {
        true => i.max(j) * (i.max(j) + 1) / 2 + i.min(j),
        false => i * n + j,
    };
    let lanes = |k: usize| out[(n + k) * BATCH..(n + k + 1) * BATCH].iter().copied();
    (0..n).map(|j| (0..n).flat_map(|i| lanes(entry(i, j))).collect()).collect()
}

#[test]
fn a_tangent_kernel_gives_the_same_residual() {
    for_all(|name, integral, elements, g| {
        let Some(kernel) = integral.tangent else { return };
        let n = elements.values.len();
        let rows = if integral.symmetric { n * (n + 1) / 2 } else { n * n };
        let (residual, both) =
            (apply(integral.residual, elements, g, n), apply(kernel, elements, g, n + rows));
        let scale = residual.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // Subexpressions that the tangent shares may be summed in another order.
        let close = residual.iter().zip(&both).all(|(a, b)| (a - b).abs() <= 1e-13 * scale);
        assert!(close, "{name}");
    });
}

#[test]
fn straight_elements_need_their_geometry_only_once() {
    for_all(|name, integral, elements, g| {
        let n = elements.values.len();
        let [once, everywhere] =
            [true, false].map(|straight| apply(integral.residual, &elements.straightened(straight), g, n));
        let scale = everywhere.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // The Jacobian is the same at all points but for roundings of the nodes, and stiff laws amplify strains.
        let close = once.iter().zip(&everywhere).all(|(a, b)| (a - b).abs() <= 1e-11 * scale);
        assert!(close, "{name}");
    });
}

#[test]
fn derivatives_by_states_and_functionals_are_those_of_the_residual() {
    for program in programs() {
        for (name, integral) in integrals(program) {
            let Some(by_globals) = &integral.global_tangent else { continue };
            let mut random = Random::new(7);
            let g = globals(program, &mut random);
            let elements = Elements::new(program, integral, &g, &mut random);
            let n = elements.values.len();
            let exact = apply(by_globals.kernel, &elements, &g, n * by_globals.slots.len());
            let (states, functionals) = scalar_slots(program);
            let slots = [states, functionals].concat();
            let moved = by_globals.slots.iter().map(|&k| slots[k]).flat_map(|slot| {
                derivative(STEP, |h| {
                    apply(integral.residual, &elements, &with_rate(program, &g, slot, h, elements.alpha), n)
                })
            });
            assert_agree(&name, &exact, &moved.collect::<Vec<_>>(), TOLERANCE);
        }
    }
}

/// Globals with one state or functional moved by `by`, and its rate by `alpha` times that.
fn with_rate(program: &Program, g: &[f64], slot: usize, by: f64, alpha: f64) -> Vec<f64> {
    let layout = program.layout;
    let mut moved = g.to_vec();
    moved[slot] += by;
    let (of, rates) = match slot >= layout.functionals[0] {
        true => (layout.functionals[0], layout.functional_rates[0]),
        false => (layout.states[0], layout.state_rates[0]),
    };
    moved[slot - of + rates] += alpha * by;
    moved
}

/// Slots of the states and of the functionals.
fn scalar_slots(program: &Program) -> (Vec<usize>, Vec<usize>) {
    let layout = program.layout;
    ((layout.states[0]..layout.states[1]).collect(), (layout.functionals[0]..layout.functionals[1]).collect())
}

/// Matrix of derivatives of `rows` results by scalars, row by row.
fn by_scalars(
    program: &Program,
    g: &[f64],
    slots: &[usize],
    alpha: f64,
    function: impl Fn(&[f64]) -> Vec<f64>,
) -> Vec<Difference> {
    let column = |&slot: &usize| {
        let step = STEP * g[slot].abs().max(0.1);
        derivative(step, |h| function(&with_rate(program, g, slot, h, alpha)))
    };
    let columns: Vec<Vec<Difference>> = slots.iter().map(column).collect();
    let rows = function(g).len();
    (0..rows).flat_map(|i| columns.iter().map(move |column| column[i])).collect()
}

#[test]
fn the_equations_of_the_states_have_exact_derivatives_on_every_branch() {
    for program in programs() {
        let Some(system) = &program.state_system else { continue };
        let (states, functionals) = scalar_slots(program);
        let g = globals(program, &mut Random::new(3));
        for branch in 0..1_usize << system.switches.min(6) {
            let switches: Vec<bool> = (0..system.switches).map(|k| branch >> k & 1 == 1).collect();
            let residual = |g: &[f64]| {
                let mut out = vec![0.0; states.len()];
                (system.residual)(g, &switches, &mut out);
                out
            };
            for (slots, exact) in [(&states, system.jacobian), (&functionals, system.sensitivity)] {
                let mut found = vec![0.0; states.len() * slots.len()];
                exact(&g, &switches, 1.7, &mut found);
                let differences = by_scalars(program, &g, slots, 1.7, residual);
                for (row, place) in system.places.iter().enumerate() {
                    let of = row * slots.len()..(row + 1) * slots.len();
                    let what = format!("{} {place} {switches:?}", program.name);
                    assert_agree(&what, &found[of.clone()], &differences[of], TOLERANCE);
                }
            }
        }
    }
}

#[test]
fn loads_on_functionals_have_exact_derivatives() {
    for program in programs() {
        let Some(couplings) = &program.couplings else { continue };
        let (states, functionals) = scalar_slots(program);
        let slots = [states, functionals].concat();
        let g = globals(program, &mut Random::new(5));
        let coefficients = |g: &[f64]| {
            let mut out = vec![0.0; couplings.terms.len()];
            (couplings.coefficients)(g, &mut out);
            out
        };
        let mut exact = vec![0.0; couplings.terms.len() * slots.len()];
        (couplings.derivatives)(&g, 2.3, &mut exact);
        assert_agree(program.name, &exact, &by_scalars(program, &g, &slots, 2.3, coefficients), TOLERANCE);
    }
}

#[test]
fn functionals_at_points_have_exact_derivatives() {
    for program in programs() {
        for functional in program.functionals {
            let FunctionalKind::Point { function, .. } = &functional.kind else { continue };
            let mut random = Random::new(11);
            let g = globals(program, &mut random);
            let inputs: Vec<f64> = function.inputs.iter().map(|_| 0.1 * random.signed()).collect();
            let value = |inputs: &[f64]| {
                let mut out = vec![0.0; function.outputs];
                (function.evaluate)(0, [1.2, 0.4], inputs, &g, &mut out);
                out
            };
            let by = |k: usize| {
                derivative(STEP, |h| {
                    let mut moved = inputs.clone();
                    moved[k] += h;
                    value(&moved)[..1].to_vec()
                })
            };
            let differences: Vec<Difference> = (0..inputs.len()).flat_map(by).collect();
            assert_agree(functional.name, &value(&inputs)[1..], &differences, TOLERANCE);
        }
    }
}

#[test]
fn laws_of_the_gap_have_exact_derivatives_open_and_closed() {
    for program in programs() {
        for law in program.pair_integrals {
            let g = globals(program, &mut Random::new(13));
            for gap in [-0.2, -0.01, 0.01, 0.2] {
                let [_, first, second] = (law.law)(gap, [1.0, 0.3], &g);
                let moved = derivative(1e-3 * gap, |h| (law.law)(gap + h, [1.0, 0.3], &g)[..2].to_vec());
                assert_agree(law.name, &[first, second], &moved, TOLERANCE);
            }
        }
    }
}

#[test]
fn loads_on_pairs_have_exact_derivatives_by_gap_normal_and_globals() {
    for program in programs() {
        let (states, layout) = (program.states.len(), program.layout);
        for load in program.pair_loads {
            let g = globals(program, &mut Random::new(13));
            let law = |[gap, a, b]: [f64; 3], g: &[f64]| {
                let mut out = [[0.0; 2]; 4];
                (load.law)(gap, [a, b], [1.0, 0.3], g, &mut out);
                out
            };
            for gap in [-0.2, 0.05, 0.2, 0.9] {
                let at = [gap, 0.6, -0.8];
                for along in 0..3 {
                    let moved = derivative(1e-3 * gap, |h| {
                        let mut moved = at;
                        moved[along] += h;
                        law(moved, &g)[0].to_vec()
                    });
                    assert_agree(load.name, &law(at, &g)[1 + along], &moved, TOLERANCE);
                }
                let Some(tangent) = &load.global_tangent else { continue };
                let (alpha, mut columns) = (3.0, vec![[0.0; 2]; tangent.slots.len()]);
                (tangent.law)(gap, [0.6, -0.8], [1.0, 0.3], &g, alpha, &mut columns);
                for (slot, exact) in tangent.slots.iter().zip(columns) {
                    let [value, rate] = match slot.checked_sub(states) {
                        None => [layout.states[0], layout.state_rates[0]].map(|first| first + slot),
                        Some(k) => [layout.functionals[0], layout.functional_rates[0]].map(|first| first + k),
                    };
                    let moved = derivative(1e-3, |h| {
                        let mut moved = g.clone();
                        moved[value] += h;
                        moved[rate] += alpha * h;
                        law(at, &moved)[0].to_vec()
                    });
                    assert_agree(load.name, &exact, &moved, TOLERANCE);
                }
            }
        }
    }
}

#[test]
fn energies_have_symmetric_tangents_and_a_stress_without_energy_has_not() {
    for program in programs() {
        let energies = program.integrals.iter().filter(|i| i.name.contains("energy"));
        energies.for_each(|energy| assert!(energy.symmetric, "{}: {}", program.name, energy.name));
    }
    let printed = &ansatz_models::dry_printed::PROGRAM;
    let stress = printed.integrals.iter().find(|i| i.name.contains("elasticity")).expect("the stress");
    assert!(!stress.symmetric);
}

#[test]
fn only_a_stress_without_energy_coupled_fields_and_loads_that_follow_a_surface_make_the_matrix_unsymmetric() {
    for program in programs() {
        let mut values = ansatz::settings::resolve(program, &[]).expect("defaults are valid");
        if let Some(coarse) = program.parameters.iter().position(|p| p.name == "coarse") {
            values[coarse] = 4.0;
        }
        let simulation = ansatz::Simulation::new(program, &values).expect("the defaults give a mesh");
        let symmetric = simulation.system().is_symmetric();
        let flows = program.fields.iter().any(|field| field.name == "v");
        let follows = !program.pair_loads.is_empty() || ["plate", "balloon"].contains(&program.name);
        let unsymmetric = flows || follows || ["dry_printed", "coupled", "whisker"].contains(&program.name);
        assert_eq!(symmetric, !unsymmetric, "{}", program.name);
    }
}
