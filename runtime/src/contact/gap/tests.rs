use super::super::curve::End;
use super::super::projection::Master;
use super::super::shapes::{arc, central, deformed};
use super::*;
use std::f64::consts::FRAC_PI_2;

/// A slave edge (nodes 13, 14, 15) at angle `at` and distance `apart` of a half circle of 13 nodes, all deformed.
struct Scene {
    curve: SmoothCurve,
    positions: Vec<Point>,
}

const SLAVE: [usize; 3] = [13, 14, 15];
const SHAPE: [f64; 3] = [0.28, -0.12, 0.84];

impl Scene {
    fn new(at: f64, apart: f64, end: End) -> Self {
        let master = arc([0.0; 2], 1.0, [-FRAC_PI_2, 1.5], 6, 1.1);
        let curve = SmoothCurve::open(&(0..13).collect::<Vec<_>>(), &master, [end, End::Free]).unwrap();
        let slave = [at + 0.05, at - 0.05, at].map(|a| [(1.0 + apart) * a.cos(), (1.0 + apart) * a.sin()]);
        let positions = master.into_iter().chain(slave).map(deformed).collect();
        Self { curve, positions }
    }

    fn gap(&self, positions: &[Point]) -> Gap {
        let mut master = Master::new(vec![self.curve.clone()]);
        master.refit(positions);
        let [x, normal] = [SHAPE, [0.5, -0.5, 0.0]]
            .map(|weights| [0, 1].map(|c| (0..3).map(|i| weights[i] * positions[SLAVE[i]][c]).sum::<f64>()));
        let facing = [normal[1], -normal[0]];
        let inward = if dot(facing, x) < 0.0 { facing } else { facing.map(|c| -c) };
        let projection = master.closest(x, inward, 0.5).unwrap();
        Gap::new(SLAVE, SHAPE, &self.curve, &projection)
    }

    /// Gradient over all 32 coordinates.
    fn gradient(&self, positions: &[Point]) -> [f64; 32] {
        let gap = self.gap(positions);
        let mut gradient = [0.0; 32];
        for (node, derivative) in gap.nodes().iter().zip(gap.gradient()) {
            for c in 0..2 {
                gradient[2 * node + c] += derivative[c];
            }
        }
        gradient
    }

    /// Hessian over all 32 coordinates.
    fn hessian(&self) -> [[f64; 32]; 32] {
        let gap = self.gap(&self.positions);
        let mut hessian = [[0.0; 32]; 32];
        for (i, a) in gap.nodes().iter().enumerate() {
            for (j, b) in gap.nodes().iter().enumerate() {
                for (c, d) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    hessian[2 * a + c][2 * b + d] += gap.hessian((i, c), (j, d));
                }
            }
        }
        hessian
    }
}

/// Inside and outside, in the middle, near a free end, near an end on the axis or free there.
fn scenes() -> Vec<Scene> {
    let places = [(0.1, 0.1), (0.13, -0.15), (1.44, 0.1), (-1.5, -0.1), (-1.53, 0.2)];
    places
        .into_iter()
        .flat_map(|(at, apart)| [End::Free, End::Axis].map(|end| Scene::new(at, apart, end)))
        .collect()
}

#[test]
fn the_gradient_is_the_derivative_of_the_gap() {
    for scene in scenes() {
        let gradient = scene.gradient(&scene.positions);
        for (i, derivative) in gradient.into_iter().enumerate() {
            let [difference] = central(&scene.positions, (i / 2, i % 2), |p| [scene.gap(p).value]);
            assert!((derivative - difference).abs() < 1e-8, "{i}: {derivative} {difference}");
        }
    }
}

#[test]
fn the_hessian_is_the_derivative_of_the_gradient() {
    for scene in scenes() {
        let hessian = scene.hessian();
        for (i, row) in hessian.into_iter().enumerate() {
            let differences = central(&scene.positions, (i / 2, i % 2), |p| scene.gradient(p));
            for (value, difference) in row.into_iter().zip(differences) {
                // Second derivatives reach about 10 here.
                assert!((value - difference).abs() < 1e-7, "{i}: {value} {difference}");
            }
        }
    }
}

#[test]
fn rigid_motions_leave_the_gap_alone() {
    for (at, apart) in [(0.1, 0.1), (0.13, -0.15), (1.44, 0.1)] {
        let scene = Scene::new(at, apart, End::Free);
        let (gradient, hessian) = (scene.gradient(&scene.positions), scene.hessian());
        let along = |motion: &dyn Fn(Point) -> Point| -> Vec<f64> {
            scene.positions.iter().copied().flat_map(motion).collect()
        };
        for c in 0..2 {
            let translation = along(&|_| [1.0 - c as f64, c as f64]);
            let sum: f64 = gradient.iter().zip(&translation).map(|(g, v)| g * v).sum();
            assert!(sum.abs() < 1e-14);
            for row in hessian {
                assert!(row.iter().zip(&translation).map(|(h, v)| h * v).sum::<f64>().abs() < 1e-12);
            }
        }
        // grad(R q) = R grad(q): to first order in the angle, H J q = J grad with J the quarter turn.
        let rotation = along(&|[x, y]| [-y, x]);
        let power: f64 = gradient.iter().zip(&rotation).map(|(g, v)| g * v).sum();
        assert!(power.abs() < 1e-13);
        for (i, row) in hessian.iter().enumerate() {
            let turned = if i % 2 == 0 { -gradient[i + 1] } else { gradient[i - 1] };
            let product: f64 = row.iter().zip(&rotation).map(|(h, v)| h * v).sum();
            assert!((product - turned).abs() < 1e-12);
        }
    }
}

#[test]
fn at_an_end_of_the_curve_the_derivatives_are_those_of_the_distance_to_it() {
    let scene = Scene::new(1.7, 0.2, End::Free);
    let gap = |positions: &[Point]| {
        let mut master = Master::new(vec![scene.curve.clone()]);
        master.refit(positions);
        let x = [0, 1].map(|c| (0..3).map(|i| SHAPE[i] * positions[SLAVE[i]][c]).sum::<f64>());
        let projection = master.nearest(x, 1.0).unwrap();
        assert!(projection.end);
        Gap::new(SLAVE, SHAPE, &scene.curve, &projection)
    };
    let exact = gap(&scene.positions);
    let dense = |gap: &Gap| {
        let mut gradient = [0.0; 32];
        for (node, derivative) in gap.nodes().iter().zip(gap.gradient()) {
            (0..2).for_each(|c| gradient[2 * node + c] += derivative[c]);
        }
        gradient
    };
    for column in 0..32 {
        let coordinate = (column / 2, column % 2);
        let [slope] = central(&scene.positions, coordinate, |p| [gap(p).value]);
        assert!((dense(&exact)[column] - slope).abs() < 1e-8);
        let bends = central(&scene.positions, coordinate, |p| dense(&gap(p)));
        let mut row = [0.0; 32];
        for (i, a) in exact.nodes().iter().enumerate() {
            for (j, _) in exact.nodes().iter().enumerate().filter(|(_, b)| **b == coordinate.0) {
                (0..2).for_each(|c| row[2 * a + c] += exact.hessian((i, c), (j, coordinate.1)));
            }
        }
        assert!(row.iter().zip(bends).all(|(found, bend)| (found - bend).abs() < 1e-7));
    }
}
