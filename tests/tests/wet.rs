//! The wet model through the opening on a coarse mesh, against an independent simulation of the same equations: largest tension 27.2 nN, smallest gap
//! 0.258 um, centre through at 89.9 s; the membrane caves in before that. And the whole baseline, against what the model states of itself.

use ansatz::observer::Observer;
use ansatz_models::wet_contact;
use ansatz_tests::notes::Notes;
use std::sync::OnceLock;

/// One run on cells twice as large, until the nucleus is through the narrowest place.
fn passage() -> &'static Notes {
    static RUN: OnceLock<Notes> = OnceLock::new();
    RUN.get_or_init(|| {
        let set = [("coarse".to_owned(), "2".to_owned())];
        let values = ansatz::settings::resolve(&wet_contact::PROGRAM, &set).expect("valid parameters");
        let mut notes = Notes::default();
        let mut simulation = ansatz::Simulation::new(&wet_contact::PROGRAM, &values).expect("a simulation");
        simulation.run(&mut notes, Some(92.0)).unwrap_or_else(|error| panic!("{error}"));
        notes
    })
}

/// A column of one of the model's tables, in display units.
fn column(name: &str) -> Vec<f64> {
    passage().column(&wet_contact::PROGRAM, name)
}

fn largest(values: Vec<f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn the_largest_tension_is_that_of_the_reference() {
    let tau = largest(column("tau"));
    assert!((tau / 27.2 - 1.0).abs() < 0.02, "{tau} nN");
}

#[test]
fn the_smallest_gap_is_that_of_the_reference() {
    let gap = column("d_min").into_iter().fold(f64::INFINITY, f64::min);
    assert!((gap / 0.258 - 1.0).abs() < 0.03, "{gap} um");
}

#[test]
fn the_centre_passes_the_opening_when_that_of_the_reference_does() {
    let (t, z) = (column("t"), column("z_cen"));
    let k = z.iter().position(|&z| z > 0.0).expect("it passes");
    let passed = t[k - 1] - z[k - 1] * (t[k] - t[k - 1]) / (z[k] - z[k - 1]);
    assert!((passed - 89.9).abs() < 1.0, "{passed} s");
}

#[test]
fn the_cytosol_keeps_its_volume() {
    let swell = largest(column("swell").into_iter().map(f64::abs).collect());
    assert!(swell < 1e-3, "{swell:e}");
}

#[test]
fn suction_makes_the_membrane_cave_in_and_the_pressure_of_the_film_outweighs_its_friction() {
    let (t, down, cave) = (column("t"), column("p_down"), column("cave"));
    let lowest = (0..t.len()).min_by(|&a, &b| down[a].total_cmp(&down[b])).expect("rows");
    assert!((down[lowest] / -32.0 - 1.0).abs() < 0.1, "{} Pa", down[lowest]);
    assert!((t[lowest] - 78.0).abs() < 2.0, "{} s", t[lowest]);
    assert!(down[lowest + 4] > 0.5 * down[lowest], "the membrane gives way: {} Pa", down[lowest + 4]);
    assert!(cave[lowest + 4] < cave[lowest], "{} um after {} um", cave[lowest + 4], cave[lowest]);
    let at = t.iter().position(|&t| t >= 88.0).expect("it runs past 88 s");
    let ratio = column("F_press")[at] / column("F_visc")[at];
    assert!((7.0..14.0).contains(&ratio), "{ratio}");
}

#[test]
fn the_nucleus_is_in_balance_with_fibre_film_drag_and_fluid() {
    let [tau, film, drag, fluid] = ["tau", "F_c", "F_d", "F_f"].map(column);
    // After the start, whose rates are those of the first step.
    for k in 1..tau.len() {
        let rest = tau[k] + film[k] + drag[k] + fluid[k];
        assert!(rest.abs() < 1e-4 * tau[k].abs().max(1.0), "{rest} nN in row {k}");
    }
}

/// Observer of a run of which only the record counts.
struct Silent;

impl Observer for Silent {}

// The default mesh, some 25,000 unknowns: three minutes.
#[test]
fn the_whole_baseline_is_what_the_model_says_of_itself() {
    let mut simulation = wet_contact::simulation(&wet_contact::Parameters::default()).expect("a simulation");
    assert_eq!(simulation.run(&mut Silent, None).expect("it runs to its end"), "completed");
    let found: Vec<_> =
        wet_contact::PROGRAM.tests.iter().flat_map(|test| (test.evaluate)(simulation.record())).collect();
    assert!(found.len() >= 5, "volume, outcome, tension, gap, passage");
    for expectation in found {
        assert!(expectation.holds, "{}: {:?}", expectation.text, expectation.numbers);
    }
}
