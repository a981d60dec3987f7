//! What must hold for any elastic solid, on unstructured meshes and from the law to the solution.

use ansatz::generated::{BATCH, Integral, Kernel, Program, Row};
use ansatz_tests::models::{named_axis, patch_axi, patch_plane, squashed_at_once, turek_csm1};
use ansatz_tests::notes::Notes;
use ansatz_tests::sample::{Elements, Random, globals};

/// The largest deviation from the uniform deformation at any time, which the model writes into its table.
fn deviation(program: &'static Program, values: &[f64]) -> f64 {
    let mut simulation = ansatz::Simulation::new(program, values).expect("the model can be built");
    assert!(simulation.system().mesh.cells.len() > 20, "there is an inside");
    let mut notes = Notes::default();
    simulation.run(&mut notes, None).expect("the run reaches its end");
    assert!(notes.rows.len() > 4);
    notes.rows.iter().map(|(_, row)| row[0]).fold(0.0, f64::max)
}

// The displacements are up to 2 mm: 1e-12 mm leaves rounding of some 2000 units in the last place.
#[test]
fn a_uniform_deformation_of_the_boundary_goes_on_inside() {
    let plane = deviation(&patch_plane::PROGRAM, &patch_plane::Parameters::default().values());
    assert!(plane < 1e-12, "{plane:e}");
    let axisymmetric = deviation(&patch_axi::PROGRAM, &patch_axi::Parameters::default().values());
    assert!(axisymmetric < 1e-12, "{axisymmetric:e}");
}

// 3 mm at once turn the cells below the plate inside out: the first instant is reached along a ramp.
#[test]
fn what_is_held_from_the_start_is_in_equilibrium_in_the_first_row() {
    for d in ["0.5 mm", "3 mm"] {
        let program = &squashed_at_once::PROGRAM;
        let values = ansatz::settings::resolve(program, &[("d".into(), d.into())]).expect("in range");
        let mut simulation = ansatz::Simulation::new(program, &values).expect("the model can be built");
        let mut notes = Notes::default();
        simulation.run(&mut notes, None).expect("the run reaches its end");
        let [(_, first), .., (_, last)] = &notes.rows[..] else { panic!("{} rows", notes.rows.len()) };
        for (first, last) in first.iter().zip(last) {
            assert!(*last > 0.1 && (first / last - 1.0).abs() < 1e-7, "{first} at first, {last} in the end");
        }
    }
}

#[test]
fn nothing_leaves_the_axis_whatever_path_leads_along_it() {
    let values = named_axis::Parameters::default().values();
    let mut simulation =
        ansatz::Simulation::new(&named_axis::PROGRAM, &values).expect("the model can be built");
    let mut notes = Notes::default();
    simulation.run(&mut notes, None).expect("the run reaches its end");
    let (_, last) = notes.rows.last().expect("a row for every step");
    // Nodes are approached from inside, by 1e-6 of the way to the centre of a cell.
    assert!(last[0] < 1e-6 * last[1], "{last:?}");
    assert!(last[1] > 0.1, "the load moves the body");
}

// Found: -7.1857 mm and -66.0920 mm with 822 triangles, 0.018 % and 0.012 % short; -7.18705 mm and -66.0990 mm with 2,838.
#[test]
fn a_flag_hangs_as_turek_and_hron_found() {
    let values = turek_csm1::Parameters::default().values();
    let mut simulation =
        ansatz::Simulation::new(&turek_csm1::PROGRAM, &values).expect("the model can be built");
    let mut notes = Notes::default();
    simulation.run(&mut notes, None).expect("it comes to rest");
    let (_, tip) = notes.rows.last().expect("a row for the state of rest");
    for (found, published) in tip.iter().zip([-7.187, -66.10]) {
        assert!((found / published - 1.0).abs() < 1e-3, "{found} mm, published {published} mm");
    }
}

/// An elasticity energy with random elements of moderate strain.
fn energy(program: &'static Program) -> (&'static Integral, Kernel, Elements, Vec<f64>) {
    let integral =
        program.integrals.iter().find(|i| i.name.contains("elasticity")).expect("an elasticity block");
    let value = integral.value.expect("it is an energy");
    let mut random = Random::new(1);
    let g = globals(program, &mut random);
    let elements = Elements::new(program, integral, &g, &mut random);
    (integral, value, elements, g)
}

fn values(kernel: Kernel, elements: &Elements, g: &[f64], rows: usize) -> Vec<Row> {
    let mut out = vec![Row::ZERO; rows];
    kernel(&elements.batch(), g, &mut out);
    out
}

/// Adds a function of the deformed position to every node's displacement.
fn moved(elements: &Elements, by: impl Fn([f64; 2]) -> [f64; 2]) -> Elements {
    let mut displacements = elements.values.clone();
    for (position, displacement) in elements.nodes.chunks(2).zip(displacements.chunks_mut(2)) {
        for lane in 0..BATCH {
            let shift = by([0, 1].map(|i: usize| position[i][lane] + displacement[i][lane]));
            (0..2).for_each(|i| displacement[i][lane] += shift[i]);
        }
    }
    Elements {
        nodes: elements.nodes.clone(),
        values: displacements,
        rates: elements.rates.clone(),
        ..*elements
    }
}

#[track_caller]
fn assert_same(a: &[Row], b: &[Row]) {
    let numbers = |rows: &[Row]| -> Vec<f64> { rows.iter().flat_map(|row| row.0).collect() };
    let (a, b) = (numbers(a), numbers(b));
    let scale = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(scale > 1e-3, "the elements are strained");
    let close = a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-12 * scale);
    assert!(close, "{a:?}\n{b:?}");
}

#[test]
fn a_turn_leaves_the_energy_and_turns_the_forces() {
    let (integral, value, elements, g) = energy(&patch_plane::PROGRAM);
    let (sine, cosine) = 0.7_f64.sin_cos();
    let turn = |x: [f64; 2]| [cosine * x[0] - sine * x[1], sine * x[0] + cosine * x[1]];
    let turned = moved(&elements, |x| [turn(x)[0] - x[0] + 3.0, turn(x)[1] - x[1] - 1.0]);
    assert_same(&values(value, &elements, &g, 1), &values(value, &turned, &g, 1));
    let forces = values(integral.residual, &elements, &g, 12);
    let expected: Vec<Row> = forces
        .chunks(2)
        .flat_map(|f| [0, 1].map(|i| Row::from_fn(|lane| turn([f[0][lane], f[1][lane]])[i])))
        .collect();
    assert_same(&expected, &values(integral.residual, &turned, &g, 12));
}

#[test]
fn a_shift_along_the_axis_leaves_the_energy_and_the_forces_of_the_dry_model() {
    let (integral, value, elements, g) = energy(&ansatz_models::dry_contact::PROGRAM);
    let shifted = moved(&elements, |_| [0.0, 2.5]);
    assert_same(&values(value, &elements, &g, 1), &values(value, &shifted, &g, 1));
    assert_same(&values(integral.residual, &elements, &g, 12), &values(integral.residual, &shifted, &g, 12));
}
