use super::super::curve::End;
use super::super::shapes::{arc, circle, deformed};
use super::*;
use std::f64::consts::FRAC_PI_2;

fn polar(radius: f64, angle: f64) -> Point {
    [radius * angle.cos(), radius * angle.sin()]
}

fn placed(curve: SmoothCurve, positions: &[Point]) -> Master {
    let mut master = Master::new(vec![curve]);
    master.refit(positions);
    master
}

fn identity(count: usize) -> Vec<usize> {
    (0..count).collect()
}

/// Disc of radius 1, a body inside a closed circle.
fn disc() -> Master {
    let nodes = circle([0.0; 2], 1.0, 32);
    placed(SmoothCurve::closed(&identity(64), &nodes).unwrap(), &nodes)
}

/// Normal of a body that faces the disc from outside.
fn inward(angle: f64) -> Point {
    polar(-1.0, angle)
}

#[test]
fn gaps_to_a_disc_are_signed_distances() {
    for i in 0..200 {
        let angle = 0.0321 * f64::from(i);
        for radius in [0.8, 1.0, 1.3] {
            let found = disc().closest(polar(radius, angle), inward(angle), 0.5).unwrap();
            // The curve is within h^4 / 36 = 2.6e-6 of the circle, with nodes h = 0.098 apart.
            assert!((found.gap - (radius - 1.0)).abs() < 3e-6);
            assert!(dot(found.normal, polar(1.0, angle)) > 1.0 - 1e-9);
        }
    }
}

#[test]
fn no_point_falls_between_spans() {
    let positions: Vec<Point> = circle([0.0; 2], 1.0, 8).into_iter().map(deformed).collect();
    let curve = SmoothCurve::closed(&identity(16), &circle([0.0; 2], 1.0, 8)).unwrap();
    let master = placed(curve.clone(), &positions);
    for span in 0..16 {
        let [x, tangent, _] = curve.evaluate(span, 0.0, &positions);
        let normal = right_of(tangent);
        let point = [x[0] + 0.1 * normal[0], x[1] + 0.1 * normal[1]];
        let found = master.closest(point, normal.map(|c| -c), 0.2).unwrap();
        assert!((found.gap - 0.1).abs() < 1e-12);
    }
}

#[test]
fn the_closest_point_is_the_nearest_of_all_points() {
    let reference = arc([0.0; 2], 1.0, [-1.0, 4.0], 12, 1.1);
    let positions: Vec<Point> = reference.iter().copied().map(deformed).collect();
    let curve = SmoothCurve::open(&identity(25), &reference, [End::Free; 2]).unwrap();
    let master = placed(curve.clone(), &positions);
    for i in 0..100 {
        let angle = -0.8 + 0.045 * f64::from(i);
        let point = deformed(polar(1.15, angle));
        let found = master.closest(point, inward(angle), 0.5).unwrap();
        let mut nearest = f64::INFINITY;
        for span in 0..24 {
            for j in 0..200 {
                let [x, _, _] =
                    curve.evaluate(span, curve.span_length(span) * f64::from(j) / 200.0, &positions);
                let distance = difference(point, x);
                nearest = nearest.min(distance[0].hypot(distance[1]));
            }
        }
        // Points 1e-3 apart along the curve at a distance of 0.15.
        assert!((0.0..1e-5).contains(&(nearest - found.gap)), "{angle}: {} {nearest}", found.gap);
        assert!(dot(difference(point, found.curve[0]), found.curve[1]).abs() < 1e-14);
    }
}

#[test]
fn only_facing_surfaces_count() {
    // A shell between radii 0.9 and 1: from inside the shell, near its inner face, a body outside sees the outer face.
    let (outer, inner) = (circle([0.0; 2], 1.0, 32), circle([0.0; 2], 0.9, 32));
    let positions: Vec<Point> = outer.iter().chain(&inner).copied().collect();
    let reversed: Vec<usize> = (64..128).rev().collect();
    let curves = [identity(64), reversed].map(|nodes| SmoothCurve::closed(&nodes, &positions).unwrap());
    let mut master = Master::new(curves.to_vec());
    master.refit(&positions);
    let from_outside = master.closest(polar(0.92, 0.3), inward(0.3), 0.5).unwrap();
    assert!(from_outside.location.curve == 0 && (from_outside.gap + 0.08).abs() < 3e-6);
    let from_inside = master.closest(polar(0.92, 0.3), polar(1.0, 0.3), 0.5).unwrap();
    assert!(from_inside.location.curve == 1 && (from_inside.gap + 0.02).abs() < 3e-6);
}

#[test]
fn nothing_is_found_beyond_the_radius_or_the_ends() {
    assert!(disc().closest(polar(1.6, 0.3), inward(0.3), 0.5).is_none());
    let nodes = arc([0.0; 2], 1.0, [0.0, 1.0], 6, 1.0);
    let master = placed(SmoothCurve::open(&identity(13), &nodes, [End::Free; 2]).unwrap(), &nodes);
    assert!(master.closest(polar(1.1, 0.01), inward(0.01), 0.5).is_some());
    assert!(master.closest(polar(1.1, -0.01), inward(-0.01), 0.5).is_none());
    assert!(master.closest(polar(1.1, 1.01), inward(1.01), 0.5).is_none());
    assert!(master.closest([f64::NAN; 2], inward(0.5), 0.5).is_none());
}

#[test]
fn points_on_the_axis_are_found_on_a_curve_that_crosses_it() {
    let nodes = arc([0.0; 2], 1.0, [-FRAC_PI_2, FRAC_PI_2], 12, 1.0);
    let nodes: Vec<Point> = nodes.iter().map(|&[x, y]| [if x < 1e-15 { 0.0 } else { x }, y]).collect();
    let master = placed(SmoothCurve::open(&identity(25), &nodes, [End::Axis; 2]).unwrap(), &nodes);
    for (point, normal) in [([0.0, -1.2], [0.0, 1.0]), ([0.0, 1.2], [0.0, -1.0]), ([1e-9, -1.2], [0.0, 1.0])]
    {
        let found = master.closest(point, normal, 0.5).unwrap();
        assert!((found.gap - 0.2).abs() < 1e-5, "{}", found.gap);
    }
}

#[test]
fn nodes_near_a_box_are_those_of_its_spans() {
    let master = disc();
    let near = master.nodes_near(Bounds::of([polar(1.0, 0.0)]).grown(1e-3));
    assert_eq!(near, [0, 1, 2, 3, 61, 62, 63]);
}

#[test]
fn the_nearest_point_may_face_away_or_be_an_end() {
    let reference = arc([0.0; 2], 1.0, [0.0, 1.0], 6, 1.0);
    let master = placed(SmoothCurve::open(&identity(13), &reference, [End::Free; 2]).unwrap(), &reference);
    let turned_away = master.nearest(polar(1.1, 0.5), 0.5).unwrap();
    assert!(!turned_away.end && (turned_away.gap - 0.1).abs() < 1e-5);
    for (point, end) in [([0.9, -0.2], [1.0, 0.0]), (polar(1.0, 1.2), polar(1.0, 1.0))] {
        let found = master.nearest(point, 0.5).unwrap();
        let distance = difference(point, end);
        assert!(found.end && (found.gap - distance[0].hypot(distance[1])).abs() < 1e-5);
        assert!((dot(found.normal, distance) - found.gap).abs() < 1e-5);
    }
    assert!(master.nearest([0.9, -0.2], 0.2).is_none());
    // On its way around the end the distance is continuous.
    let gap = |angle: f64| master.nearest(polar(1.1, angle), 0.5).unwrap().gap;
    assert!((gap(1e-7) - gap(-1e-7)).abs() < 1e-6);
}
