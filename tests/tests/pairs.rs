//! Loads on the surfaces of contact pairs: the forces that they add up to, where they act, and what outputs say about them.

use ansatz::generated::Program;
use ansatz_tests::models::{film, plates, sheet};
use ansatz_tests::notes::Notes;
use ansatz_tests::system;
use std::f64::consts::PI;

/// Columns of the model's table at the start, the field unknowns moved by `shift` (by the reference position).
fn observed(
    program: &'static Program,
    set: &[(&str, &str)],
    shift: impl Fn([f64; 2]) -> [f64; 2],
) -> Vec<f64> {
    let mut system = system(program, set);
    let mut y = system.start().expect("a start");
    for field in system.unknowns.fields.clone() {
        for (k, &node) in field.nodes.iter().enumerate() {
            let shift = shift(system.mesh.nodes[node as usize]);
            (0..2).for_each(|c| y[field.first + 2 * k + c] += shift[c]);
        }
    }
    let g = system.observe(0.0, &y, &vec![0.0; y.len()]);
    program.tables[0].columns.iter().map(|column| (column.value)(&g) / column.unit_value).collect()
}

/// A film whose pressure does not decay.
const UNIFORM: (&str, &str) = ("l", "1e12 mm");

#[track_caller]
fn assert_near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() <= tolerance * exact.abs(), "{found} is not {exact}");
}

#[test]
fn a_uniform_pressure_pushes_with_the_area_across() {
    // A pressure on a closed surface of revolution adds up to P pi R^2 along the axis, R being the rim's radius, also on quadratic edges.
    let [_, ball, bowl, up, faced, thickness, narrowest] =
        observed(&film::PROGRAM, &[UNIFORM], |_| [0.0; 2])[..]
    else {
        panic!("seven columns")
    };
    assert_near(ball, 0.02 * PI, 1e-9);
    assert_near(bowl, -0.02 * PI * 1.44, 1e-9);
    assert_near(up, 0.02 * PI, 1e-9);
    // Half spheres of radii 1 and 1.2 on edges of some 0.4: the areas are exact to the fourth power of the edges.
    assert_near(faced, 2.0 * PI * (1.0 + 1.44), 1e-4);
    assert_near(thickness, 0.2, 1e-3);
    assert_near(narrowest, 0.2, 1e-2);
}

#[test]
fn forces_follow_the_area_as_it_has_moved() {
    // Everything grows by a tenth: areas by 1.21, gaps by 1.1.
    let grown = |x: [f64; 2]| x.map(|x| 0.1 * x);
    let [_, ball, bowl, _, _, thickness, _] = observed(&film::PROGRAM, &[UNIFORM], grown)[..] else {
        panic!("seven columns")
    };
    assert_near(ball, 0.02 * PI * 1.21, 1e-9);
    assert_near(bowl, -0.02 * PI * 1.44 * 1.21, 1e-9);
    assert_near(thickness, 0.22, 1e-3);
}

#[test]
fn each_side_has_its_own_law_per_reference_area() {
    // 0.5 mm apart and 4 mm long, the upper plate with sin(2 g).
    let [up, down, near] = observed(&plates::PROGRAM, &[], |_| [0.0; 2])[..] else { panic!("three columns") };
    assert_near(up, 0.05 * 4.0 * 1.0_f64.sin(), 1e-9);
    assert_near(down, -0.05 * 4.0, 1e-9);
    assert_near(near, 0.5, 1e-12);
    // Stretched to twice the length, the force is that on the reference area.
    let [up, down, _] = observed(&plates::PROGRAM, &[], |x| [x[0], 0.0])[..] else { panic!("three columns") };
    assert_near(up, 0.05 * 4.0 * 1.0_f64.sin(), 1e-9);
    assert_near(down, -0.05 * 4.0, 1e-9);
}

#[test]
fn nothing_acts_beyond_the_search_distance() {
    let apart = |x: [f64; 2]| [0.0, if x[1] > 0.25 { 0.31 } else { 0.0 }];
    assert_eq!(observed(&plates::PROGRAM, &[], apart), [0.0, 0.0, 0.8]);
}

#[test]
fn forces_that_are_there_from_the_start_find_their_equilibrium() {
    for program in [&film::PROGRAM, &plates::PROGRAM] {
        let values = ansatz::settings::resolve(program, &[]).expect("defaults are valid");
        let mut simulation = ansatz::Simulation::new(program, &values).expect("a simulation");
        assert!(!simulation.system().is_symmetric());
        let mut notes = Notes::default();
        simulation.run(&mut notes, None).expect("the run reaches its end");
        let statistics = simulation.record().statistics();
        // Newton's method converges quadratically with an exact tangent.
        assert!(statistics.iterations <= 5 * statistics.accepted.max(1), "{}: {statistics:?}", program.name);
    }
}

#[test]
fn a_sheet_without_a_body_floats_where_the_repulsion_bears_what_presses_it() {
    let values = sheet::Parameters::default().values();
    let mut simulation = ansatz::Simulation::new(&sheet::PROGRAM, &values).expect("the model can be built");
    let mut notes = Notes::default();
    simulation.run(&mut notes, None).expect("it comes to rest");
    let Some((_, row)) = notes.rows.last() else { panic!("a row for the state of rest") };
    let [gap, above, below, moved] = row[..] else { panic!("four columns") };
    // exp(-gap/d_0) = p/P_0; forces of 0.1 MPa on 2 mm^2.
    assert_near(gap, 0.05 * 10.0_f64.ln(), 1e-7);
    assert_near(above, 0.2, 1e-9);
    assert_near(below, -0.2, 1e-7);
    assert!(moved < 0.0, "the block gives way: {moved} mm");
}
