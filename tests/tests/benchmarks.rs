//! Numbers on which several other codes agree to 11 digits, on the same meshes.

use ansatz_benches::assembly::{Assembly, Kind};
use ansatz_benches::solves::Solve;

/// Asserts that a number agrees with a published one to 10 digits.
#[track_caller]
fn assert_digits(what: &str, found: f64, published: f64) {
    assert!((found / published - 1.0).abs() < 1e-10, "{what}: {found:.13}, published {published:.13}");
}

#[test]
fn energy_variation_and_tangent_of_a_neo_hookean_square() {
    let mut square = Assembly::new(32, Kind::PlaneStrain).unwrap();
    let checks = square.checks().unwrap();
    assert_digits("E", checks.energy, 0.11169755021996);
    assert_digits("R(v)", checks.residual, 0.34088465617615);
    assert_digits("K(v, w)", checks.tangent, 3.3229104804891);
}

#[test]
fn energy_variation_and_tangent_of_a_neo_hookean_cylinder() {
    let mut cylinder = Assembly::new(32, Kind::Axisymmetric).unwrap();
    let checks = cylinder.checks().unwrap();
    assert_digits("E", checks.energy, 0.098173825680912);
    assert_digits("R(v)", checks.residual, 1.0007109402214);
    assert_digits("K(v, w)", checks.tangent, 16.584346262591);
}

#[test]
fn the_tip_of_cooks_membrane() {
    let published = [
        (16, [-6.81414652157, 7.80198490661]),
        (32, [-6.86538153171, 7.83118246974]),
        (64, [-6.88775010984, 7.84315363821]),
    ];
    for (n, [x, y]) in published {
        let solved = Solve::cook(n).unwrap().run().unwrap();
        assert_eq!(solved.iterations.len(), 4, "four load steps");
        assert_digits("u_x", solved.results[1], x);
        assert_digits("u_y", solved.results[2], y);
    }
}

#[test]
fn a_sphere_pressed_into_a_cylinder() {
    let solved = Solve::sphere(32).unwrap().run().unwrap();
    assert_digits("u_z", solved.results[1], -0.0992305911404);
    assert_digits("force", solved.results[2], 0.0276600934954);
}
