//! The solids of the wet model through the opening, on a coarse mesh, against an independent simulation of the same equations: largest tension
//! 26.4 nN, smallest gap 0.258 um.

use ansatz_models::wet_solids;
use ansatz_tests::notes::Notes;
use std::sync::OnceLock;

/// One run on cells twice as large, until the nucleus is through the narrowest place.
fn passage() -> &'static Notes {
    static RUN: OnceLock<Notes> = OnceLock::new();
    RUN.get_or_init(|| {
        let set = [("coarse".to_owned(), "2".to_owned())];
        let values = ansatz::settings::resolve(&wet_solids::PROGRAM, &set).expect("valid parameters");
        let mut simulation = ansatz::Simulation::new(&wet_solids::PROGRAM, &values).expect("a simulation");
        assert!(!simulation.system().is_symmetric(), "pressures as moved have no energy");
        let mut notes = Notes::default();
        simulation.run(&mut notes, Some(92.0)).expect("the run reaches its end");
        let statistics = simulation.record().statistics();
        // An exact tangent: a handful of factorisations for each step, also in the passage.
        assert!(statistics.iterations < 6 * statistics.accepted, "{statistics:?}");
        notes
    })
}

/// A column of the model's table, in display units.
fn column(name: &str) -> Vec<f64> {
    passage().column(&wet_solids::PROGRAM, name)
}

#[test]
fn the_largest_tension_is_that_of_the_reference() {
    let largest = column("tau").into_iter().fold(0.0, f64::max);
    assert!((largest / 26.4 - 1.0).abs() < 0.01, "{largest} nN");
}

#[test]
fn the_smallest_gap_is_that_of_the_reference() {
    let smallest = column("d_min").into_iter().fold(f64::INFINITY, f64::min);
    assert!((smallest / 0.258 - 1.0).abs() < 0.05, "{smallest} um");
}

#[test]
fn the_nucleus_is_in_balance() {
    // After the start, whose rates are those of the first step.
    let sum = column("tau").into_iter().zip(column("F_c")).zip(column("F_d")).map(|((a, b), c)| a + b + c);
    let largest = sum.skip(1).fold(0.0, |largest: f64, rest| largest.max(rest.abs()));
    assert!(largest < 1e-5, "{largest} nN");
}
