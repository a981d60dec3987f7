use super::super::tests::discs;
use super::*;
use crate::contact::Partner;
use crate::contact::shapes::central;
use std::f64::consts::TAU;

/// Weight of a length at a radius x.
fn ring([x, _]: Point) -> f64 {
    TAU * x
}

/// A smooth law without any symmetry, with its derivatives.
fn law(_: usize, gap: f64, [a, b]: Point) -> Traction {
    let decay = (-2.0 * gap).exp();
    let flux = [decay * (a + 0.3 * a * b), decay * (2.0 * b - 0.1 * a)];
    let by_gap = flux.map(|f| -2.0 * f);
    [flux, by_gap, [decay * (1.0 + 0.3 * b), -0.1 * decay], [0.3 * decay * a, 2.0 * decay]]
}

fn dense_work(pair: &ContactPair, area: Area) -> [f64; 192] {
    let mut work = [0.0; 192];
    pair.add_work(area, &|k, gap, normal| law(k, gap, normal)[0], |(node, c), value| {
        work[2 * node + c] += value;
    });
    work
}

#[test]
fn the_tangent_is_the_derivative_of_the_work_over_the_nodes_of_both_surfaces() {
    let (pair, positions) = discs([1.3, 0.4], 0.6);
    for area in [Area::Reference, Area::Current(|_| 1.0), Area::Current(ring)] {
        let mut tangent = vec![0.0; 192 * 192];
        pair.add_work_tangent(area, &law, |(a, c), (b, d), value| {
            tangent[192 * (2 * a + c) + 2 * b + d] += value
        });
        let mut largest = [0.0_f64; 2];
        for column in 0..192 {
            let (node, component) = (column / 2, column % 2);
            let difference = central(&positions, (node, component), |p| {
                let mut moved = pair.clone();
                moved.update(p);
                dense_work(&moved, area)
            });
            let of_surface = usize::from(node >= 64);
            for (row, slope) in difference.into_iter().enumerate() {
                largest[of_surface] = largest[of_surface].max(slope.abs());
                let found = tangent[192 * row + column];
                // Central differences of step 1e-6 are exact to some 1e-8.
                assert!((found - slope).abs() < 1e-7, "{area:?} {row} {column}: {found} {slope}");
            }
        }
        assert!(largest.iter().all(|&l| l > 0.1), "both surfaces move the force: {largest:?}");
    }
}

#[test]
fn only_the_slave_bears_the_force() {
    let (pair, _) = discs([1.3, 0.4], 0.6);
    let work = dense_work(&pair, Area::Reference);
    assert!(work[..128].iter().all(|&f| f == 0.0) && work[128..].iter().any(|&f| f.abs() > 0.1));
}

#[test]
fn measures_as_moved_grow_with_the_surface() {
    let (mut pair, mut positions) = discs([0.0, 0.0], 0.7);
    pair.partner = Partner::Nearest;
    pair.update(&positions);
    let lengths = |pair: &ContactPair, weight| pair.integral(Area::Current(weight), &|_, _, _| 1.0);
    let before = lengths(&pair, |_| 1.0);
    positions[64..].iter_mut().for_each(|node| *node = node.map(|x| 1.1 * x));
    pair.update(&positions);
    assert!((lengths(&pair, |_| 1.0) / before - 1.1).abs() < 1e-12);
    // The disc lies evenly around 0, where the second weight is 3.
    assert!((lengths(&pair, |[x, y]| 3.0 + x - 2.0 * y) / before - 3.3).abs() < 1e-12);
    for c in 0..2 {
        let closed = pair.integral(Area::Current(|_| 1.0), &|_, _, normal| normal[c]);
        assert!(closed.abs() < 1e-12, "{closed}");
    }
}

#[test]
fn nothing_acts_on_points_without_a_partner() {
    let (pair, _) = discs([1.8, 0.0], 0.25);
    assert!(pair.gaps().iter().all(Option::is_none));
    pair.add_work(Area::Reference, &|_, _, _| [1.0; 2], |_, _| panic!("nothing is near"));
    pair.add_work_tangent(Area::Reference, &law, |_, _, _| panic!("nothing is near"));
    assert_eq!(pair.integral(Area::Reference, &|_, _, _| 1.0), 0.0);
}
