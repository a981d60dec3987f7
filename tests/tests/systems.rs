//! The tangent of whole discretised models is the derivative of their residual: integrals, contact, states and functionals together.

use ansatz::generated::{ObservableKind, Program};
use ansatz::system::{StageProblem, System};
use ansatz_models::{dry_contact, wet_contact};
use ansatz_tests::differences::{assert_agree, derivative};
use ansatz_tests::models::{channel, coupled, film, plates};
use ansatz_tests::notes::Notes;
use ansatz_tests::sample::Random;
use ansatz_tests::system;

/// Asserts that the tangent times a random direction is the change of the residual along it, at the start displaced by `shift` (by the reference
/// position) and a little at random. The step is 1e-4 of the displacements; kinks of contact and states are further away than that.
fn tangent_is_exact(program: &'static Program, set: &[(&str, &str)], shift: impl Fn([f64; 2]) -> [f64; 2]) {
    let mut system = system(program, set);
    let base = system.start().expect("a start");
    let problem = StageProblem { time: 0.3, alpha: 3.0, base: &base };
    let (mut y, mut random) = (base.clone(), Random::new(1));
    for field in system.unknowns.fields.clone() {
        for (k, &node) in field.nodes.iter().enumerate() {
            let shift = shift(system.mesh.nodes[node as usize]);
            for component in 0..field.components {
                let shift = if field.components == 2 { shift[component] } else { 0.0 };
                y[field.first + k * field.components + component] += shift + 0.01 * random.signed();
            }
        }
    }
    assert!(program.pair_integrals.is_empty() || smallest_gap(&mut system, &y) < -0.01, "contact is closed");
    let mut probe = system.probe(&problem, &y).expect("the states can be solved for");
    let free: Vec<bool> =
        (0..y.len()).map(|i| i < base.len() - scalars(program) && probe.is_free(i)).collect();
    let direction: Vec<f64> = free.iter().map(|&free| if free { random.signed() } else { 0.0 }).collect();
    probe.assemble();
    let exact = of_free(&free, probe.tangent_times(&direction));
    let differences = derivative(1e-4, |h| {
        let moved: Vec<f64> = y.iter().zip(&direction).map(|(y, d)| y + h * d).collect();
        let mut probe = system.probe(&problem, &moved).expect("the states can be solved for");
        of_free(&free, probe.residual())
    });
    assert_agree(program.name, &exact, &differences, 1e-7);
}

/// The smallest gap that the model observes.
fn smallest_gap(system: &mut System, y: &[f64]) -> f64 {
    let observables = system.program.observables;
    let gap = observables.iter().position(|o| matches!(o.kind, ObservableKind::PairMin(..)));
    let slot = system.program.layout.observables[0] + gap.expect("a smallest gap");
    system.observe(0.0, y, &vec![0.0; y.len()])[slot]
}

/// States and functionals of a model.
fn scalars(program: &Program) -> usize {
    program.states.len() + program.functionals.len()
}

fn of_free(free: &[bool], all: Vec<f64>) -> Vec<f64> {
    all.into_iter().zip(free).filter_map(|(x, &free)| free.then_some(x)).collect()
}

#[test]
fn with_states_and_functionals_in_loads() {
    tangent_is_exact(&coupled::PROGRAM, &[], |x| [0.02 * x[0], -0.05 * x[1]]);
    tangent_is_exact(&ansatz_examples::relaxation::PROGRAM, &[], |x| [0.0, 0.01 * x[1]]);
}

#[test]
fn a_coupled_model_runs_to_its_end() {
    let parameters = coupled::Parameters::default();
    let mut simulation = coupled::simulation(&parameters).expect("a simulation");
    let mut notes = Notes::default();
    assert_eq!(simulation.run(&mut notes, None).expect("it converges"), "finished");
    let statistics = simulation.record().statistics();
    let stages = 2 * (statistics.accepted + statistics.rejected);
    assert!(statistics.iterations <= 2 * stages, "an exact tangent needs few iterations: {statistics:?}");
    let opening = |t: f64| 1.0 - 0.8 * (-t / 2.0).exp();
    // The top moves so little that the channels open nearly as if alone.
    let (_, last) = notes.rows.last().expect("rows");
    assert!((last[2] - opening(2.0)).abs() < 0.05, "{last:?}");
}

#[test]
fn of_incompressible_flow() {
    tangent_is_exact(&channel::PROGRAM, &[], |x| [x[1], -x[0]]);
    tangent_is_exact(&ansatz_examples::pipe_flow::PROGRAM, &[], |x| [x[0], 10.0 * x[1]]);
    tangent_is_exact(&ansatz_examples::lid_driven_cavity::PROGRAM, &[], |x| [x[1], -x[0]]);
}

#[test]
fn with_contact_that_is_closed() {
    let down = |x: [f64; 2]| [0.0, if x[1] > 0.0 { -0.1 } else { 0.0 }];
    tangent_is_exact(&ansatz_examples::indentation::PROGRAM, &[("coarse", "4")], down);
}

#[test]
fn with_loads_on_the_surfaces_of_a_pair() {
    let bent = |x: [f64; 2]| [0.03 * x[0] * x[1], 0.02 * x[0] * x[0] - 0.04 * x[1]];
    tangent_is_exact(&film::PROGRAM, &[("q", "0.6"), ("tilt", "0.7")], bent);
    tangent_is_exact(&plates::PROGRAM, &[("k", "0.5")], bent);
}

#[test]
fn of_the_dry_model_and_its_variants() {
    // The nucleus, a ball of 3 um about (0, -5) um, comes up until it has reached the rim.
    let up = |x: [f64; 2]| [0.0, if x[0].hypot(x[1] + 5.0) < 3.1 { 1.1 } else { 0.0 }];
    for program in ansatz_models::PROGRAMS {
        tangent_is_exact(program, &[("coarse", "4")], up);
    }
}

#[test]
fn steps_follow_fields_with_rates_and_not_what_follows_from_them() {
    let with_rates = |program: &Program| -> Vec<&str> {
        program.fields.iter().filter(|field| field.differential).map(|field| field.name).collect()
    };
    assert_eq!(with_rates(&wet_contact::PROGRAM), ["u", "v"], "neither rotation, thickness nor pressure");
    assert_eq!(with_rates(&dry_contact::PROGRAM), ["u"]);
    assert!(with_rates(&ansatz_tests::models::patch_plane::PROGRAM).is_empty(), "nothing moves in time");
}
