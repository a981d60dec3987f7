//! Regions that follow bodies: volumes, forces from one to the other, and what happens where bodies meet.

use ansatz::generated::Program;
use ansatz_examples::squeeze_film;
use ansatz_tests::models::{filled_block, refreshed_block};
use ansatz_tests::notes::Notes;

/// All rows of a model's table, some parameters set.
fn rows(program: &'static Program, set: &[(&str, &str)]) -> Vec<Vec<f64>> {
    run(program, set).0
}

/// The same, and how often moving regions were meshed.
fn run(program: &'static Program, set: &[(&str, &str)]) -> (Vec<Vec<f64>>, usize) {
    let set: Vec<_> = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    let values = ansatz::settings::resolve(program, &set).expect("they are parameters");
    let mut notes = Notes::default();
    let mut simulation = ansatz::Simulation::new(program, &values).unwrap_or_else(|error| panic!("{error}"));
    simulation.run(&mut notes, None).unwrap_or_else(|error| panic!("{error}"));
    (notes.rows.into_iter().map(|(_, row)| row).collect(), simulation.system().meshings)
}

#[test]
fn cells_of_a_liquid_go_along_with_the_body_until_an_event_makes_them_anew() {
    let ((moved, once), (renewed, meshings)) =
        (run(&filled_block::PROGRAM, &[]), run(&refreshed_block::PROGRAM, &[]));
    assert_eq!(once, 1, "the block is pressed by a tenth, which its first cells bear");
    assert_eq!(meshings, renewed.len() - 1, "one mesh for each step");
    for (moved, renewed) in moved.iter().zip(&renewed) {
        for (k, (a, b)) in moved.iter().zip(renewed).enumerate() {
            assert!((a - b).abs() <= 1e-3 * b.abs(), "column {k}: {a} on the first cells, {b} on new ones");
        }
    }
}

// The shape of the liquid is that of the start of each step, so its volume drifts with the square of the steps in each, with the steps in all.
#[test]
fn an_enclosed_liquid_keeps_its_volume_as_steps_get_smaller() {
    let drift = |steps: &str| {
        let rows = rows(&filled_block::PROGRAM, &[("steps", steps)]);
        let (first, last) = (&rows[0], &rows[rows.len() - 1]);
        assert!(last[5] < 0.95 * first[5], "the ball is pressed flat: {} of {}", last[5], first[5]);
        (last[1] / first[1] - 1.0).abs()
    };
    let (coarse, fine) = (drift("10"), drift("20"));
    assert!(coarse < 5e-3 && fine < 0.6 * coarse, "{coarse:e}, {fine:e}");
}

#[test]
fn a_liquid_hands_on_the_forces_of_the_body_around_it() {
    for row in &rows(&filled_block::PROGRAM, &[])[1..] {
        let (below, above, held) = (row[2], row[3], row[4]);
        assert!(held > 0.0 && above > 0.0, "the block is pressed: {row:?}");
        assert!((below - above).abs() < 1e-9 * above.abs(), "{below} below, {above} above");
    }
}

#[test]
fn a_squeezed_film_bears_what_lubrication_theory_says() {
    let rows = rows(&squeeze_film::PROGRAM, &[("steps", "50")]);
    let row = &rows[rows.len() - 1];
    let (gap, film, held, exact) = (row[1], row[2], row[3], row[4]);
    assert!((gap - 0.45).abs() < 1e-3, "the disc sank: {gap} mm");
    assert!((film / exact - 1.0).abs() < 0.02, "{film} mN, lubrication theory says {exact} mN");
    assert!((film + held).abs() < 1e-6 * film, "{film} mN on the disc, {held} mN hold it");
}
