//! `model!` in Rust programs.

use ansatz::observer::Observer;
use ansatz_tests::notes::Notes;

ansatz::model! {
    /// A cube under its own weight.
    model cube;
    use std::solid::{F, neo_hooke};
    coordinates plane_strain(x, y);
    param a = 1 m in 0.1 m .. 10 m;
    param weight_density = 10 [kN/m^3];
    geometry {
        path edge   = from (0, 0) m line bottom to (a, 0) line to (a, a) line top to (0, a) line to (0, 0) m;
        region body = loop(edge);
    }
    mesh { size = a/4; }
    field u: Vector[Length] in P2 on body = 0;
    physics weight {
        energy neo_hooke(F(u), 1 MPa, 0.3) on body;
        load u.y with -weight_density on body;          // comments are no tokens
        hold u = 0 on edge.bottom;
    }
    let sink = -mean(u.y on edge.top);
    output { table "sink.csv" every step: sink; }
}

ansatz::model! {
    model decay;
    state s: Number = 1;
    physics rest { dt(s)*(1 s) == -s; }
    solve { time = 0 s .. 1 s; }
    output { table "decay.csv" every 1 s: s; }
}

struct Quiet;
impl Observer for Quiet {}

#[test]
fn a_model_between_braces_is_a_module() {
    let parameters = cube::Parameters { a: 2.0, ..Default::default() };
    let mut simulation = cube::simulation(&parameters).unwrap();
    assert_eq!(simulation.run(&mut Quiet, None).unwrap(), "finished");
    let error =
        cube::simulation(&cube::Parameters { a: 20.0, ..Default::default() }).err().expect("out of range");
    assert!(error.to_string().contains("`a` = 20 m is out of its range"), "{error}");
}

#[test]
fn a_model_without_a_field_has_states_alone() {
    let mut simulation = decay::simulation(&decay::Parameters::default()).expect("a simulation");
    let mut notes = Notes::default();
    assert_eq!(simulation.run(&mut notes, None).expect("it converges"), "finished");
    // Fifty steps of a method of second order, each as exact as the tolerance of a step asks for.
    let end = *notes.column(&decay::PROGRAM, "s").last().expect("a row at the end");
    assert!((end - (-1.0_f64).exp()).abs() < 1e-4, "{end}");
}
