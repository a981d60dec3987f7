use super::super::curve::smooth_curves;
use super::super::shapes::{arc, central, circle};
use super::*;

const CORNER: f64 = 0.5;

/// Two discs: master of radius 1 at the origin (nodes 0 to 63), slave of radius 0.5 (nodes 64 to 95) at `center`.
pub(super) fn discs(center: Point, radius: f64) -> (ContactPair, Vec<Point>) {
    let mut positions = circle([0.0; 2], 1.0, 32);
    positions.extend(circle(center, 0.5, 16));
    let master = smooth_curves(&(0..64).collect::<Vec<_>>(), true, false, &positions, CORNER).unwrap();
    let edges: Vec<[usize; 3]> =
        (0..16).map(|e| [64 + 2 * e, 64 + (2 * e + 2) % 32, 64 + 2 * e + 1]).collect();
    let points = (0..16).flat_map(|e| [0.2, 0.5, 0.8].map(|t| SlavePoint::new(e, t, 1.0))).collect();
    let mut pair = ContactPair::new(edges, points, master, (Partner::Facing, radius)).unwrap();
    pair.update(&positions);
    (pair, positions)
}

/// Smooth repulsion that acts at any gap.
fn repulsion(_: usize, gap: f64) -> [f64; 3] {
    let energy = (-4.0 * gap).exp();
    [energy, -4.0 * energy, 16.0 * energy]
}

/// Penalty on overlap.
fn penalty(_: usize, gap: f64) -> [f64; 3] {
    let overlap = gap.min(0.0);
    [0.5 * overlap * overlap, overlap, if gap < 0.0 { 1.0 } else { 0.0 }]
}

fn dense_gradient(pair: &ContactPair) -> Vec<f64> {
    let mut gradient = vec![0.0; 192];
    pair.gradient(&repulsion, |(node, c), value| gradient[2 * node + c] += value);
    gradient
}

#[test]
fn gaps_of_two_discs_are_analytic() {
    let center = [1.3, 0.4];
    let (pair, positions) = discs(center, 0.4);
    let mut found = 0;
    for (gap, point) in pair.gaps().iter().zip(pair.points()) {
        let nodes = pair.edges[point.edge];
        let x = [0, 1].map(|c| (0..3).map(|i| point.shape[i] * positions[nodes[i]][c]).sum::<f64>());
        let exact = x[0].hypot(x[1]) - 1.0;
        // Outward of the slave (from its centre) against outward of the master (from the origin).
        let facing = (x[0] - center[0]) * x[0] + (x[1] - center[1]) * x[1] < 0.0;
        match gap {
            Some(gap) => {
                found += 1;
                assert!((gap.value - exact).abs() < 3e-6);
            }
            None => assert!(!facing || exact > 0.39, "missed at {x:?}"),
        }
    }
    assert!(found > 10);
}

#[test]
fn gradient_and_hessian_are_derivatives_of_the_energy() {
    let (pair, positions) = discs([1.3, 0.4], 0.6);
    let moved = |p: &[Point]| {
        let mut pair = pair.clone();
        pair.update(p);
        pair
    };
    let gradient = dense_gradient(&pair);
    let mut hessian = vec![[0.0; 192]; 192];
    pair.hessian(&repulsion, |(a, c), (b, d), value| hessian[2 * a + c][2 * b + d] += value);
    for i in 0..192 {
        let (node, component) = (i / 2, i % 2);
        let [slope] = central(&positions, (node, component), |p| [moved(p).energy(&repulsion)]);
        assert!((gradient[i] - slope).abs() < 1e-7, "{i}: {} {slope}", gradient[i]);
        let column: [f64; 192] = central(&positions, (node, component), |p| {
            let gradient = dense_gradient(&moved(p));
            std::array::from_fn(|j| gradient[j])
        });
        for j in 0..192 {
            // Entries reach about 30.
            assert!((hessian[j][i] - column[j]).abs() < 1e-6, "{j} {i}: {} {}", hessian[j][i], column[j]);
            assert!((hessian[j][i] - hessian[i][j]).abs() < 1e-12);
        }
    }
}

#[test]
fn forces_of_the_two_sides_cancel() {
    let (pair, _) = discs([1.3, 0.4], 0.6);
    let (mut slave, mut master) = ([0.0; 2], [0.0; 2]);
    pair.gradient(
        &repulsion,
        |(node, c), value| if node < 64 { master[c] += value } else { slave[c] += value },
    );
    assert!(slave[0].abs() > 0.1);
    assert!((0..2).all(|c| (slave[c] + master[c]).abs() < 1e-12));
}

#[test]
fn gap_and_force_are_continuous_as_a_point_slides_across_nodes() {
    let samples = |count: usize| {
        let slide = |i: usize| {
            let angle = 0.3 + 0.4 * i as f64 / count as f64;
            let (pair, _) = discs([1.45 * angle.cos(), 1.45 * angle.sin()], 0.3);
            let gap = pair.gaps()[24].unwrap_or_else(|| pair.gaps()[23].unwrap());
            (gap.value, gap.normal, dense_gradient(&pair))
        };
        (0..=count).map(slide).collect::<Vec<_>>()
    };
    // Greatest change of the energy's gradient between neighbouring samples: halves with the step if continuous.
    let change = |count| {
        let states = samples(count);
        let distance = |pair: &[(f64, Point, Vec<f64>)]| {
            let (a, b) = (&pair[0].1, &pair[1].1);
            (a[0] - b[0]).hypot(a[1] - b[1]).max((pair[0].0 - pair[1].0).abs())
        };
        states.windows(2).map(distance).fold(0.0, f64::max)
    };
    let ratio = change(60) / change(120);
    assert!((1.9..2.1).contains(&ratio), "{ratio}");
}

#[test]
fn results_repeat_to_the_last_bit() {
    let (mut pair, positions) = discs([1.3, 0.4], 0.6);
    let first = dense_gradient(&pair);
    let away: Vec<Point> = positions.iter().map(|x| [x[0] + 0.1, 1.2 * x[1]]).collect();
    pair.update(&away);
    pair.update(&positions);
    assert_eq!(first, dense_gradient(&pair));
}

#[test]
fn patterns_cover_motion_within_their_radius_only() {
    let (mut pair, mut positions) = discs([1.45, 0.0], 0.6);
    let potential = pair.potential_nodes(&positions, 0.2, (0.0, 0.0));
    assert!(pair.covered(&potential, 0.0) && pair.covered(&potential, 0.1));
    assert!(potential.iter().any(Vec::is_empty) && potential.iter().any(|nodes| nodes.len() > 6));
    for (y, covered) in [(0.05, true), (0.6, false)] {
        for node in &mut positions[64..] {
            node[1] += y;
            node[0] -= 0.5 * y * y;
        }
        pair.update(&positions);
        assert_eq!(pair.covered(&potential, 0.1), covered);
    }
}

#[test]
fn open_gaps_cost_nothing_under_a_penalty() {
    let (pair, _) = discs([1.6, 0.0], 0.6);
    assert!(pair.gaps().iter().any(Option::is_some));
    pair.hessian(&penalty, |_, _, _| panic!("a gap is open"));
    assert_eq!(pair.energy(&penalty), 0.0);
    let (pair, _) = discs([1.45, 0.0], 0.6);
    assert!(pair.energy(&penalty) > 0.0);
}

#[test]
fn surfaces_that_share_an_edge_and_useless_radii_are_refused() {
    let nodes = arc([0.0; 2], 1.0, [0.0, 2.0], 4, 1.0);
    let curves = smooth_curves(&[0, 1, 2, 3, 4], false, false, &nodes, CORNER).unwrap();
    let pair = |edge, radius| {
        ContactPair::new(
            vec![edge],
            vec![SlavePoint::new(0, 0.5, 1.0)],
            curves.clone(),
            (Partner::Facing, radius),
        )
        .map(|_| ())
    };
    assert_eq!(pair([2, 4, 3], 0.1), Err(ContactError::SelfContact { edge: 0 }));
    assert_eq!(pair([4, 6, 5], 0.1), Ok(()));
    assert_eq!(pair([4, 6, 5], 0.0), Err(ContactError::Radius { radius: 0.0 }));
}

/// Energy of a level slave, 0.8 wide, that overlaps a level master by `overlap`, where waves of height `wave` and length 0.4 stand on the master.
fn energy_on_waves(overlap: f64, wave: f64) -> f64 {
    let count = 65;
    let ripple = |x: f64| wave * (x * std::f64::consts::TAU / 0.4).cos();
    let mut positions: Vec<Point> =
        (0..count).map(|i| 1.6 - 0.05 * i as f64).map(|x| [x, ripple(x)]).collect();
    let master = smooth_curves(&(0..count).collect::<Vec<_>>(), false, false, &positions, CORNER).unwrap();
    positions.extend([[-0.4, -overlap], [0.4, -overlap], [0.0, -overlap]]);
    let points = (0..80).map(|k| SlavePoint::new(0, (k as f64 + 0.5) / 80.0, 1.0)).collect();
    let edges = vec![[count, count + 1, count + 2]];
    let mut pair = ContactPair::new(edges, points, master, (Partner::Facing, 1.0)).unwrap();
    pair.update(&positions);
    pair.energy(&penalty)
}

#[test]
fn points_that_overlap_deeper_than_a_sixth_of_a_wave_drive_waves_on_the_master() {
    // W changes by (1 - (2 pi g / length)^2) wave^2 / 4 for each point: crests are nearer to deep points than the level is
    let length_over_two_pi = 0.4 / std::f64::consts::TAU;
    let change = |overlap: f64| energy_on_waves(overlap, 1e-3) - energy_on_waves(overlap, 0.0);
    for part in [0.5, 1.5] {
        let expected = 80.0 * (1.0 - part * part) * 1e-6 / 4.0;
        let found = change(part * length_over_two_pi);
        assert!((found / expected - 1.0).abs() < 0.05, "{found} is not {expected}");
    }
}
