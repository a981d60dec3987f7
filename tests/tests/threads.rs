//! Threads change how long a run takes and nothing else.

use ansatz::Simulation;
use ansatz::system::{Probe, StageProblem, System};
use ansatz_benches::assembly::{Assembly, Kind};
use ansatz_benches::solves::Solve;
use ansatz_models::{dry_contact, wet_contact};
use std::num::NonZeroUsize;

/// Numbers of threads to compare; one first.
fn threads() -> [NonZeroUsize; 3] {
    [1, 2, 3].map(|threads| NonZeroUsize::new(threads).expect("not zero"))
}

/// Bits of everything that an assembly makes: residual, matrix, forces.
fn bits(mut probe: Probe<'_>) -> Vec<u64> {
    probe.assemble();
    let tangent = probe.sparse_tangent().2.to_vec();
    [tangent, probe.residual()].concat().into_iter().map(f64::to_bits).collect()
}

/// Bits at the start of a model, with its fields disturbed and everything in motion.
fn bits_at_start(system: &mut System) -> Vec<u64> {
    let start = system.start().expect("a start");
    let disturbed: Vec<f64> = start.iter().zip(0..).map(|(y, k)| y + 1e-3 * f64::from(k).sin()).collect();
    let problem = StageProblem { time: 0.0, alpha: 2.0, base: &start };
    bits(system.probe(&problem, &disturbed).expect("the states have a solution"))
}

#[track_caller]
fn assert_same_bits(mut assemble: impl FnMut(NonZeroUsize) -> Vec<u64>) {
    let [one, two, three] = threads().map(&mut assemble);
    assert!(one.len() > 1000 && one == two && one == three);
}

#[test]
fn an_assembly_has_the_same_bits_on_any_number_of_threads() {
    let mut cylinder = Assembly::new(32, Kind::Axisymmetric).unwrap();
    assert_same_bits(|threads| {
        cylinder.system.use_threads(threads).unwrap();
        bits(cylinder.probe().unwrap())
    });
}

// Several regions, contact, functionals and states; in the wet model pressures, rates, and fields that are tied to others as well.
#[test]
fn so_has_that_of_coupled_models() {
    let dry = dry_contact::simulation(&dry_contact::Parameters { coarse: 2.0, ..Default::default() });
    let wet = wet_contact::simulation(&wet_contact::Parameters { coarse: 2.0, ..Default::default() });
    for mut system in [dry, wet].map(|made| made.map(Simulation::into_system).unwrap()) {
        assert!(
            system.mesh.cells.len() >= 3 * 256,
            "{} cells are too few for threads",
            system.mesh.cells.len()
        );
        assert_same_bits(|threads| {
            system.use_threads(threads).unwrap();
            bits_at_start(&mut system)
        });
    }
}

// Factors differ by the order of sums in large products, solutions by rounding times the condition of the last tangent.
#[test]
fn a_run_ends_at_the_same_place_on_any_number_of_threads() {
    let solved = threads().map(|threads| {
        let mut problem = Solve::cook(20).unwrap();
        problem.use_threads(threads).unwrap();
        problem.run().unwrap()
    });
    for other in &solved[1..] {
        assert_eq!(other.iterations, solved[0].iterations);
        for (found, on_one) in other.results.iter().zip(&solved[0].results) {
            assert!((found / on_one - 1.0).abs() < 1e-11, "{found:e} instead of {on_one:e}");
        }
    }
}
