//! The geometry of the dry-contact model, built by hand, is sound and has the areas of closed formulas.

#[path = "common/dry.rs"]
mod common;

use ansatz_geometry::{Geometry, GeometryError};
use common::Dry;
use std::f64::consts::PI;

fn area(geometry: &Geometry, region: usize) -> f64 {
    geometry.boundary(region).expect("closed").area()
}

#[test]
fn the_default_parameters_give_a_sound_geometry() {
    assert_eq!(Dry::default().geometry().check(), []);
}

#[test]
fn the_swept_openings_and_nuclei_stay_sound() {
    for r_g in [0.9, 1.2, 1.8] {
        assert_eq!(Dry { r_g, ..Dry::default() }.geometry().check(), [], "r_g = {r_g}");
    }
    for r_n in [1.0, 2.0, 3.4] {
        assert_eq!(Dry { r_n, ..Dry::default() }.geometry().check(), [], "r_n = {r_n}");
    }
}

#[test]
fn areas_agree_with_closed_formulas() {
    let dry = Dry::default();
    let geometry = dry.geometry();
    let half_disc = |r: f64| PI * r * r / 2.0;
    let ec = (dry.big_l - dry.r_g - dry.h / 2.0) * dry.h + half_disc(dry.h / 2.0);
    // Cavity above z = h/2: half of a disc less the part below the chord through the joint.
    let below = dry.z_c() - dry.h / 2.0;
    let beyond_chord = (dry.big_r.powi(2) * (below / dry.big_r).acos() - below * dry.r_j()) / 2.0;
    let ecm = dry.big_l * (dry.big_h - dry.h / 2.0) - (half_disc(dry.big_r) - beyond_chord);
    let expected = [half_disc(2.7), half_disc(3.0) - half_disc(2.7), ec, ecm];
    for (region, expected) in expected.into_iter().enumerate() {
        let found = area(&geometry, region);
        assert!(
            (found - expected).abs() < 1e-12 * expected.abs(),
            "region {region}: {found}, not {expected}"
        );
    }
}

#[test]
fn regions_contain_their_own_points_only() {
    let geometry = Dry::default().geometry();
    let boundaries: Vec<_> = (0..4).map(|region| geometry.boundary(region).expect("closed")).collect();
    let probes =
        [([0.1, -5.0], 0), ([0.01, -7.85], 1), ([2.85, -5.0], 1), ([1.6, 0.0], 2), ([0.01, 16.0], 3)];
    for (p, owner) in probes {
        let inside: Vec<usize> = (0..4).filter(|&region| boundaries[region].contains(p)).collect();
        assert_eq!(inside, [owner], "at {p:?}");
    }
    assert!(boundaries.iter().all(|boundary| !boundary.contains([0.5, 0.0])), "the gap is in no region");
}

#[test]
fn loops_run_with_the_region_on_their_left() {
    let geometry = Dry::default().geometry();
    for region in 0..4 {
        let boundary = geometry.boundary(region).expect("closed");
        for pieces in &boundary.loops {
            for (piece, next) in pieces.iter().zip(pieces.iter().cycle().skip(1)) {
                assert_eq!(piece.ends[1], next.ends[0]);
                assert_eq!(piece.curve.end(), next.curve.start());
            }
        }
        assert!(boundary.area() > 0.0);
    }
}

#[test]
fn a_patch_larger_than_the_nucleus_is_not_finite() {
    let errors = Dry { a_n: 200.0, ..Dry::default() }.geometry().check();
    let names: Vec<&str> = errors
        .iter()
        .map(|error| match error {
            GeometryError::NotFinite { name, .. } => name.as_str(),
            other => panic!("unexpected: {other}"),
        })
        .collect();
    assert_eq!(names, ["nucleus.side", "nucleus.pull"]);
}

#[test]
fn a_nucleus_that_reaches_the_rim_crosses_it() {
    let errors = Dry { r_n: 4.5, ..Dry::default() }.geometry().check();
    assert!(
        errors.iter().any(|error| matches!(error, GeometryError::Crossing { names, .. }
            if *names == ["nucleus.side".to_string(), "endo.rim".to_string()])),
        "{errors:?}"
    );
}
