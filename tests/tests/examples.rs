//! The examples do what their tests claim, and the same in every run.

use ansatz::Simulation;
use ansatz::generated::{Program, Record};
use ansatz_tests::notes::Notes;

fn ran(program: &'static Program) -> (Simulation, Notes) {
    let values = ansatz::settings::resolve(program, &[]).expect("defaults are valid");
    let mut simulation = Simulation::new(program, &values).expect("the example can be built");
    let mut notes = Notes::default();
    simulation.run(&mut notes, None).unwrap_or_else(|error| panic!("{}: {error}", program.name));
    (simulation, notes)
}

#[test]
fn every_example_keeps_its_promises() {
    for program in ansatz_examples::PROGRAMS {
        let (simulation, notes) = ran(program);
        assert!(!program.tests.is_empty() && !notes.rows.is_empty() && !notes.frames.is_empty());
        for test in program.tests {
            for found in (test.evaluate)(simulation.record()) {
                assert!(found.holds, "{}, {}: {} {:?}", program.name, test.title, found.text, found.numbers);
            }
        }
    }
}

#[test]
fn two_runs_agree_bit_by_bit() {
    // States and events in one model, contact in the other.
    for program in [&ansatz_examples::relaxation::PROGRAM, &ansatz_examples::indentation::PROGRAM] {
        let bits = |(simulation, notes): (Simulation, Notes)| {
            let steps = simulation.record().steps().concat();
            let rows = notes.rows.into_iter().flat_map(|(_, values)| values);
            let frames = notes.frames.into_iter().flat_map(|frame| frame.columns.concat());
            steps.into_iter().chain(rows).chain(frames).map(f64::to_bits).collect::<Vec<_>>()
        };
        let (first, second) = (bits(ran(program)), bits(ran(program)));
        assert!(first.len() > 1000 && first == second, "{}", program.name);
    }
}
