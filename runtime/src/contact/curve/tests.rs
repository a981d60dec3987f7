use super::super::shapes::{arc, circle, deformed};
use super::*;

const FREE: [End; 2] = [End::Free; 2];

fn identity(count: usize) -> Vec<usize> {
    (0..count).collect()
}

fn free(reference: &[Point]) -> SmoothCurve {
    SmoothCurve::open(&identity(reference.len()), reference, FREE).unwrap()
}

fn distance(a: Point, b: Point) -> f64 {
    let d = difference(a, b);
    d[0].hypot(d[1])
}

/// Greatest distance of a curve from the unit circle, over `count` points of each span.
fn deviation(curve: &SmoothCurve, positions: &[Point]) -> f64 {
    let mut greatest = 0.0_f64;
    for span in 0..curve.span_count() {
        for i in 0..=10 {
            let [x, _, _] = curve.evaluate(span, curve.span_length(span) * f64::from(i) / 10.0, positions);
            greatest = greatest.max((x[0].hypot(x[1]) - 1.0).abs());
        }
    }
    greatest
}

/// Greatest distance of the parabolas of the quadratic edges from the unit circle.
fn edge_deviation(nodes: &[Point]) -> f64 {
    let mut greatest = 0.0_f64;
    for edge in nodes.windows(3).step_by(2) {
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            let shape = [(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)];
            let x = [0, 1].map(|c| (0..3).map(|j| shape[j] * edge[j][c]).sum::<f64>());
            greatest = greatest.max((x[0].hypot(x[1]) - 1.0).abs());
        }
    }
    greatest
}

#[test]
fn cubics_are_reproduced_on_any_spacing() {
    let knots = [0.0, 0.3, 0.6, 1.0, 1.4, 1.45, 1.5, 2.1, 2.7];
    let reference = knots.map(|t| [0.0, t]);
    let cubic = |t: f64| [1.0 - t + 0.5 * t * t - 0.3 * t * t * t, 2.0 + t - t * t + 0.2 * t * t * t];
    let positions = knots.map(cubic);
    let curve = free(&reference);
    // Spans that do not reach beyond the ends.
    for (span, start) in knots.into_iter().enumerate().take(6).skip(2) {
        for part in [0.0, 0.4, 1.0] {
            let offset = part * curve.span_length(span);
            let [x, _, _] = curve.evaluate(span, offset, &positions);
            assert!(distance(x, cubic(start + offset)) < 1e-13);
        }
    }
}

#[test]
fn graded_arcs_are_met_as_well_as_by_the_edges_themselves() {
    for growth in [1.0, 1.1, 1.25, 0.8] {
        let nodes = arc([0.0; 2], 1.0, [0.2, 2.0], 10, growth);
        let (smooth, edges) = (deviation(&free(&nodes), &nodes), edge_deviation(&nodes));
        assert!(smooth < 1.3 * edges, "growth {growth}: {smooth:e}, edges {edges:e}");
    }
}

#[test]
fn deviation_falls_with_the_fourth_power_of_the_spacing() {
    let error = |edges| {
        let nodes = arc([0.0; 2], 1.0, [0.2, 2.0], edges, 1.1_f64.powf(10.0 / edges as f64));
        deviation(&free(&nodes), &nodes)
    };
    let ratio = error(10) / error(20);
    assert!((12.0..20.0).contains(&ratio), "{ratio}");
}

#[test]
fn a_free_curve_starts_and_ends_at_its_end_nodes() {
    let reference = arc([0.0; 2], 1.0, [0.2, 2.0], 3, 1.2);
    let positions: Vec<Point> = reference.iter().copied().map(deformed).collect();
    let curve = free(&reference);
    assert!(distance(curve.evaluate(0, 0.0, &positions)[0], positions[0]) < 1e-14);
    assert!(distance(curve.evaluate(5, curve.span_length(5), &positions)[0], positions[6]) < 1e-14);
}

/// Greatest jump of position, tangent and second derivative where spans meet.
fn jump(curve: &SmoothCurve, positions: &[Point]) -> f64 {
    let count = curve.span_count();
    let joints = if curve.is_closed() { count } else { count - 1 };
    let mut greatest = 0.0_f64;
    for span in 0..joints {
        let before = curve.evaluate(span, curve.span_length(span), positions);
        let after = curve.evaluate((span + 1) % count, 0.0, positions);
        for (a, b) in before.into_iter().zip(after) {
            greatest = greatest.max(distance(a, b));
        }
    }
    greatest
}

#[test]
fn curves_are_twice_continuously_differentiable() {
    let open = arc([0.0; 2], 1.0, [0.2, 2.0], 5, 1.25);
    let closed = circle([0.0; 2], 1.0, 8);
    let positions = |nodes: &[Point]| nodes.iter().copied().map(deformed).collect::<Vec<_>>();
    assert!(jump(&free(&open), &positions(&open)) < 1e-12);
    let curve = SmoothCurve::closed(&identity(16), &closed).unwrap();
    assert_eq!(curve.span_count(), 16);
    assert!(jump(&curve, &positions(&closed)) < 1e-12);
}

#[test]
fn an_end_on_the_axis_continues_as_its_mirror_image() {
    let nodes = arc([0.0; 2], 1.0, [-std::f64::consts::FRAC_PI_2, 1.0], 6, 1.1);
    let curve = SmoothCurve::open(&identity(13), &nodes, [End::Axis, End::Free]).unwrap();
    let [x, tangent, curvature] = curve.evaluate(0, 0.0, &nodes);
    assert!(x[0].abs() < 1e-15 && tangent[1].abs() < 1e-14 && curvature[0].abs() < 1e-13);
    assert!(deviation(&curve, &nodes) < 1.3 * edge_deviation(&nodes));
}

#[test]
fn stencils_give_the_point_and_its_derivatives_from_six_nodes() {
    let reference = arc([0.0; 2], 1.0, [-std::f64::consts::FRAC_PI_2, 1.0], 6, 1.1);
    let positions: Vec<Point> = reference.iter().copied().map(deformed).collect();
    let curve = SmoothCurve::open(&identity(13), &reference, [End::Axis, End::Free]).unwrap();
    for span in 0..12 {
        let offset = 0.3 * curve.span_length(span);
        let mut sums = [[0.0; 2]; 3];
        for NodeWeight { node, weights } in curve.stencil(span, offset) {
            for (sum, weight) in sums.iter_mut().zip(weights) {
                *sum = [0, 1].map(|c| sum[c] + weight[c] * positions[node][c]);
            }
        }
        assert!(curve.stencil(span, offset).count() <= 6);
        for (sum, value) in sums.into_iter().zip(curve.evaluate(span, offset, &positions)) {
            assert!(distance(sum, value) < 1e-12);
        }
    }
}

#[test]
fn chains_are_cut_at_corners() {
    let square =
        [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 1.0], [0.5, 1.0], [0.0, 1.0], [0.0, 0.5]];
    let corner = 30_f64.to_radians();
    let curves = smooth_curves(&identity(8), true, false, &square, corner).unwrap();
    assert_eq!(curves.len(), 4);
    assert_eq!(curves[3].nodes(0).collect::<Vec<_>>(), [0, 6, 7]);
    let open = smooth_curves(&identity(7), false, false, &square, corner).unwrap();
    assert_eq!(open.iter().map(SmoothCurve::span_count).collect::<Vec<_>>(), [2, 2, 2]);
    let round = smooth_curves(&identity(16), true, false, &circle([0.0; 2], 1.0, 8), corner).unwrap();
    assert!(round.len() == 1 && round[0].is_closed());
}

#[test]
fn chains_are_mirrored_at_the_axis_unless_that_makes_a_corner() {
    let quarter = [-std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2];
    let starts = |nodes: &[Point], axisymmetric| {
        let chain = identity(nodes.len());
        smooth_curves(&chain, false, axisymmetric, nodes, 0.5).unwrap()[0].ends_on_axis() == [true; 2]
    };
    assert!(starts(&arc([0.0; 2], 1.0, quarter, 6, 1.0), true));
    assert!(!starts(&arc([0.0; 2], 1.0, quarter, 6, 1.0), false));
    assert!(!starts(&arc([0.5, 0.0], 1.0, quarter, 6, 1.0), true));
    assert!(!starts(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]], true), "a cone keeps its tip");
}

#[test]
fn impossible_curves_are_refused() {
    let nodes = [[1.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
    let refused =
        |nodes: &[usize], reference: &[Point], ends| SmoothCurve::open(nodes, reference, ends).unwrap_err();
    assert_eq!(refused(&[0, 2], &nodes, FREE), ContactError::TooFewNodes { count: 2 });
    assert_eq!(refused(&[0, 1, 2], &nodes, FREE), ContactError::CoincidentNodes { nodes: [0, 1] });
    let off = refused(&[0, 1, 2], &[[1.0, 0.0], [1.5, 0.0], [2.0, 0.0]], [End::Axis, End::Free]);
    assert_eq!(off, ContactError::NotOnAxis { node: 0 });
}
