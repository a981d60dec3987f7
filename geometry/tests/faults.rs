//! Each kind of fault is found, named in model terms, and found once.

use ansatz_geometry::{
    Geometry, GeometryError, LoopPart, Path, PathBuilder, Point, Region, Turn, intersect_circles,
};
use std::f64::consts::PI;

fn polygon(name: &str, corners: &[Point]) -> Path {
    let start = PathBuilder::from(name, corners[0]);
    let closed = corners[1..].iter().chain(&corners[..1]);
    closed.fold(start, |path, &corner| path.line(None, corner)).build().expect("lines have no faults")
}

fn square(name: &str, low: Point, side: f64) -> Path {
    let [x, y] = low;
    polygon(name, &[low, [x + side, y], [x + side, y + side], [x, y + side]])
}

fn line(name: &str, from: Point, to: Point) -> Path {
    PathBuilder::from(name, from).line(None, to).build().expect("lines have no faults")
}

fn region(name: &str, paths: &[&str]) -> Region {
    Region::new(name, paths.iter().map(|path| LoopPart::path(path)))
}

fn plane(paths: Vec<Path>, regions: Vec<Region>) -> Geometry {
    Geometry { paths, regions, axisymmetric: false }
}

fn only_error(geometry: &Geometry) -> String {
    let errors = geometry.check();
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors[0].to_string()
}

#[test]
fn an_arc_must_end_on_its_circle() {
    let errors =
        PathBuilder::from("bow", [1.0, 0.0]).arc(Some("top"), [0.0, 0.0], Turn::Ccw, [0.0, 1.1]).build();
    let errors = errors.expect_err("1.1 is not 1");
    assert!(
        matches!(&errors[..], [GeometryError::EndOffCircle { name, .. }] if name == "bow.top"),
        "{errors:?}"
    );
}

#[test]
fn circles_apart_have_no_intersection() {
    let error = intersect_circles(([0.0, 0.0], 1.0), ([3.0, 0.0], 1.0), [0.0, 0.0]);
    assert!(matches!(error, Err(GeometryError::CirclesApart { apart: 3.0, .. })));
    let met = intersect_circles(([0.0, -5.0], 4.5), ([4.5, 0.0], 3.0), [4.0, -3.0]).expect("they meet");
    assert!((met[0] - 4.011).abs() < 1e-3 && (met[1] + 2.960).abs() < 1e-3, "{met:?}");
}

#[test]
fn a_gap_is_reported_once_with_both_ends() {
    let open = vec![
        line("a", [0.0, 0.0], [1.0, 0.0]),
        line("b", [1.0, 0.0], [0.0, 1.0]),
        line("c", [0.0, 0.9], [0.0, 0.0]),
    ];
    let message = only_error(&plane(open, vec![region("wedge", &["a", "b", "c"])]));
    for part in ["region `wedge`", "gap of 1.000e-1", "(0, 1) of `b`", "(0, 0.9) of `c`"] {
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn a_loop_open_on_the_axis_is_told_so() {
    let cap = PathBuilder::from("cap", [0.0, -1.0]).arc(None, [0.0, 0.0], Turn::Ccw, [0.0, 1.0]).build();
    let paths = vec![cap.expect("on its circle")];
    let open = Geometry { paths, regions: vec![region("ball", &["cap"])], axisymmetric: true };
    assert!(only_error(&open).ends_with("add `axis` to the loop"));
}

#[test]
fn the_axis_needs_an_axisymmetric_model() {
    let loops = vec![Region::new("box", [LoopPart::path("a"), LoopPart::Axis])];
    assert!(only_error(&plane(vec![square("a", [0.0, 0.0], 1.0)], loops)).contains("`axis`"));
}

#[test]
fn unknown_parts_are_named() {
    let loops = vec![Region::new("box", [LoopPart::segment("a", "lid")])];
    assert!(only_error(&plane(vec![square("a", [0.0, 0.0], 1.0)], loops)).contains("`a.lid`"));
}

#[test]
fn three_ends_in_one_point_branch() {
    let paths = vec![square("a", [0.0, 0.0], 1.0), line("spike", [0.0, 0.0], [-1.0, -1.0])];
    let errors = plane(paths, vec![region("box", &["a", "spike"])]).check();
    assert!(
        errors.iter().any(|error| matches!(error, GeometryError::Branch { at: [0.0, 0.0], .. })),
        "{errors:?}"
    );
}

#[test]
fn a_bow_tie_crosses_itself() {
    let tie = polygon("tie", &[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    let errors = plane(vec![tie], vec![region("box", &["tie"])]).check();
    assert!(
        matches!(&errors[..], [GeometryError::Crossing { at, .. }] if (at[0] - 0.5).abs() + (at[1] - 0.5).abs() < 1e-12),
        "{errors:?}"
    );
}

#[test]
fn an_end_in_the_middle_of_another_path_is_a_crossing() {
    let paths = vec![square("a", [0.0, 0.0], 2.0), polygon("b", &[[2.0, 1.0], [3.0, 0.5], [3.0, 1.5]])];
    assert!(
        only_error(&plane(paths, vec![region("left", &["a"]), region("right", &["b"])]))
            .contains("share an end")
    );
}

#[test]
fn curves_that_run_along_each_other_are_reported() {
    let paths = vec![square("a", [0.0, 0.0], 1.0), square("b", [1.0, 0.5], 1.0)];
    let errors = plane(paths, vec![region("left", &["a"]), region("right", &["b"])]).check();
    assert!(errors.iter().any(|error| matches!(error, GeometryError::Coincident { .. })), "{errors:?}");
}

#[test]
fn nested_regions_overlap_unless_the_inner_is_a_hole() {
    let paths = vec![square("outer", [0.0, 0.0], 3.0), square("inner", [1.0, 1.0], 1.0)];
    let nested = plane(paths.clone(), vec![region("sea", &["outer"]), region("isle", &["inner"])]);
    assert!(only_error(&nested).starts_with("regions `sea` and `isle` overlap"));
    let holed = plane(paths, vec![region("sea", &["inner", "outer"]), region("isle", &["inner"])]);
    assert_eq!(holed.check(), []);
    let sea = holed.boundary(0).expect("closed");
    assert_eq!(sea.area(), 8.0);
    assert!(!sea.contains([1.5, 1.5]) && sea.contains([0.5, 1.5]));
}

#[test]
fn points_left_of_the_axis_are_reported() {
    let bulge = PathBuilder::from("bulge", [1.0, 1.0])
        .arc(None, [0.5, 0.5], Turn::Ccw, [1.0, 0.0])
        .line(None, [1.0, 1.0]);
    let paths = vec![bulge.build().expect("on its circle")];
    let geometry = Geometry { paths, regions: vec![region("lens", &["bulge"])], axisymmetric: true };
    let expected = 0.5 - 0.5_f64.sqrt();
    assert!(matches!(&geometry.check()[..], [GeometryError::NegativeRadius { name, r }]
            if name == "bulge" && (r - expected).abs() < 1e-15));
}

#[test]
fn curves_without_length_or_with_a_nan_are_all_reported() {
    let paths = vec![
        line("dot", [1.0, 1.0], [1.0, 1.0]),
        line("lost", [f64::NAN, 0.0], [1.0, 0.0]),
        square("a", [0.0, 0.0], 1.0),
    ];
    let errors = plane(paths, vec![region("box", &["a"])]).check();
    assert!(
        matches!(&errors[..], [GeometryError::ZeroLength { name: dot, .. }, GeometryError::NotFinite { name: lost, .. }]
            if dot == "dot" && lost == "lost"),
        "{errors:?}"
    );
}

#[test]
fn a_path_without_region_is_allowed() {
    let paths = vec![square("a", [0.0, 0.0], 1.0), line("tip", [0.5, 0.5], [2.0, 2.0])];
    assert_eq!(plane(paths, vec![region("box", &["a"])]).check(), []);
}

#[test]
fn a_full_circle_bounds_a_disc() {
    let rim = PathBuilder::from("rim", [1.0, 0.0]).arc(None, [0.0, 0.0], Turn::Cw, [1.0, 0.0]).build();
    let disc = plane(vec![rim.expect("on its circle")], vec![region("disc", &["rim"])]);
    assert_eq!(disc.check(), []);
    let boundary = disc.boundary(0).expect("closed");
    assert!((boundary.area() - PI).abs() < 1e-14);
    assert!(
        boundary.contains([-0.9, 0.0]) && boundary.contains([0.0, -0.99]) && !boundary.contains([0.8, 0.8])
    );
}

#[test]
fn curves_tangent_at_a_shared_end_do_not_cross() {
    // Three parts of one outline, smooth at every joint, as round rims are.
    let pill = PathBuilder::from("pill", [0.0, -1.0])
        .line(None, [2.0, -1.0])
        .arc(None, [2.0, 0.0], Turn::Ccw, [2.0, 1.0])
        .line(None, [0.0, 1.0])
        .arc(None, [0.0, 0.0], Turn::Ccw, [0.0, -1.0]);
    let geometry = plane(vec![pill.build().expect("on their circles")], vec![region("pill", &["pill"])]);
    assert_eq!(geometry.check(), []);
    let area = geometry.boundary(0).expect("closed").area();
    assert!((area - (PI + 4.0)).abs() < 1e-14);
}
