//! Derivatives against differences, and the size of the kernel that matters most.

use crate::scalar::schedule::Schedule;
use crate::scalar::*;

use super::*;

/// Every operator, applied to two inputs, with points inside its domain and away from kinks.
fn samples(pool: &mut Pool) -> Vec<(Id, Vec<[f64; 2]>)> {
    let [x, y] = [0, 1].map(|s| pool.input(Symbol(s)));
    let mut samples = Vec::new();
    for op in Unary::ALL {
        let points = match op {
            Unary::Sqrt | Unary::Ln => vec![[0.3, 0.0], [2.0, 0.0]],
            _ => vec![[0.3, 0.0], [-0.7, 0.0]],
        };
        samples.push((pool.unary(op, x), points));
    }
    for op in Binary::ALL {
        let points = match op {
            Binary::Pow => vec![[0.3, 1.7], [2.0, -0.6]],
            _ => vec![[0.3, 1.7], [-0.7, 0.4], [1.1, -0.9]],
        };
        samples.push((pool.binary(op, x, y), points));
    }
    for (n, d) in [(-2, 3), (1, 3), (-1, 2), (5, 2), (1, 5), (3, 1), (-2, 1), (40, 1)] {
        samples.push((pool.power(x, Rational::new(n, d).unwrap()), vec![[0.9, 0.0], [1.2, 0.0]]));
    }
    let (square, sine) = (pool.square(x), pool.unary(Unary::Sin, y));
    for relation in Relation::ALL {
        samples.push((pool.select(relation, x, y, square, sine), vec![[0.3, 0.9], [0.9, 0.3]]));
    }
    samples
}

fn at(pool: &Pool, roots: &[Id], point: &[f64]) -> Vec<f64> {
    eval(pool, roots, &|s| point[s.0 as usize])
}

/// Central difference of the roots in one symbol; the error is about 1e-9 for values, slopes and third derivatives near 1.
fn difference(pool: &Pool, roots: &[Id], point: &[f64], k: usize) -> Vec<f64> {
    let step = 1e-5;
    let [above, below] = [step, -step].map(|h| {
        let mut moved = point.to_vec();
        moved[k] += h;
        at(pool, roots, &moved)
    });
    above.iter().zip(below).map(|(a, b)| (a - b) / (2.0 * step)).collect()
}

fn assert_close(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() < 1e-7 * expected.abs().max(1.0),
        "{what}: {found} instead of {expected}"
    );
}

#[test]
fn every_operator_has_its_first_derivatives() {
    let mut pool = Pool::new();
    for (root, points) in samples(&mut pool) {
        for k in [0, 1] {
            let forward = derivative(&mut pool, &[root], Symbol(k))[0];
            let reverse = gradient(&mut pool, root, &[Symbol(k)])[0];
            for point in &points {
                let expected = difference(&pool, &[root], point, k as usize)[0];
                let found = at(&pool, &[forward, reverse], point);
                assert_close(found[0], expected, &format!("{:?} in {k}", pool.node(root)));
                assert_close(found[1], expected, &format!("{:?} in {k}, backwards", pool.node(root)));
            }
        }
    }
}

#[test]
fn every_operator_has_its_second_derivatives() {
    let mut pool = Pool::new();
    let symbols = [Symbol(0), Symbol(1)];
    for (root, points) in samples(&mut pool) {
        let slopes = gradient(&mut pool, root, &symbols);
        let curvatures = hessian(&mut pool, root, &symbols);
        for point in &points {
            let found = at(&pool, &curvatures, point);
            for (n, (i, j)) in [(0, 0), (1, 0), (1, 1)].into_iter().enumerate() {
                let expected = difference(&pool, &slopes[i..=i], point, j)[0];
                assert_close(found[n], expected, &format!("{:?} in {i} and {j}", pool.node(root)));
            }
        }
    }
}

#[test]
fn a_direction_sums_the_slopes_times_the_rates() {
    let mut pool = Pool::new();
    let [x, y, v, w] = [0, 1, 2, 3].map(|s| pool.input(Symbol(s)));
    let root = pool.mul(x, y);
    let moved = along(&mut pool, root, &[(Symbol(0), v), (Symbol(1), w)]);
    let (a, b) = (pool.mul(y, v), pool.mul(x, w));
    assert_eq!(moved, pool.add(a, b));
    assert_eq!(along(&mut pool, root, &[]), pool.zero());
}

#[test]
fn derivatives_stop_at_arms_that_are_not_taken() {
    let mut pool = Pool::new();
    let x = pool.input(Symbol(0));
    let zero = pool.zero();
    let root = pool.sqrt(x);
    let power = pool.mul(x, root);
    let guarded = pool.select(Relation::Less, zero, x, power, zero);
    let mut roots = gradient(&mut pool, guarded, &[Symbol(0)]);
    roots.extend(hessian(&mut pool, guarded, &[Symbol(0)]));
    assert_eq!(at(&pool, &roots, &[-1.0]), [0.0, 0.0]);
}

#[test]
fn powers_above_one_have_a_slope_at_zero() {
    let mut pool = Pool::new();
    let x = pool.input(Symbol(0));
    let power = pool.power(x, Rational::new(3, 2).unwrap());
    let slope = gradient(&mut pool, power, &[Symbol(0)]);
    assert_eq!(at(&pool, &slope, &[0.0]), [0.0]);
}

/// The axisymmetric neo-Hookean energy `G/2 (J^(-2/3) tr(F^T F) - 3) + K/2 (J - 1)^2` with `F = [[f0, 0, f1], [0, f4, 0], [f2, 0, f3]]`;
/// `G` and `K` are symbols 5 and 6. The determinant is expanded along the first row.
fn neo_hookean(pool: &mut Pool) -> Id {
    let f = [0, 1, 2, 3, 4].map(|s| pool.input(Symbol(s)));
    let [shear, bulk] = [5, 6].map(|s| pool.input(Symbol(s)));
    let (one, three, half) = (pool.one(), pool.constant(3.0), pool.constant(0.5));
    let (a, b) = (pool.product([f[4], f[3], f[0]]), pool.product([f[4], f[2], f[1]]));
    let det = pool.sub(a, b);
    let power = pool.power(det, Rational::new(-2, 3).unwrap());
    let trace = pool.dot(&f, &f);
    let invariant = pool.mul(power, trace);
    let isochoric = pool.sub(invariant, three);
    let dilation = pool.sub(det, one);
    let volumetric = pool.square(dilation);
    let (shear, bulk) = (pool.mul(half, shear), pool.mul(half, bulk));
    pool.dot(&[shear, bulk], &[isochoric, volumetric])
}

const F: [Symbol; 5] = [Symbol(0), Symbol(1), Symbol(2), Symbol(3), Symbol(4)];

#[test]
fn the_neo_hookean_tangent_is_exact() {
    let mut pool = Pool::new();
    let energy = neo_hookean(&mut pool);
    let stress = gradient(&mut pool, energy, &F);
    let tangent = hessian(&mut pool, energy, &F);
    let states = [
        [1.0, 0.0, 0.0, 1.0, 1.0],
        [1.2, 0.3, -0.1, 0.8, 1.1],
        [0.7, -0.4, 0.2, 1.5, 0.6],
        [2.0, 0.5, 0.5, 0.6, 1.3],
    ];
    for state in states {
        let point: Vec<f64> = state.into_iter().chain([1.3, 2.1]).collect();
        let found = at(&pool, &[stress.clone(), tangent.clone()].concat(), &point);
        let (slopes, curvatures) = found.split_at(5);
        for i in 0..5 {
            assert_close(slopes[i], difference(&pool, &[energy], &point, i)[0], "stress");
            let row = difference(&pool, &stress, &point, i);
            for j in 0..=i {
                assert_close(curvatures[i * (i + 1) / 2 + j], row[j], "tangent");
            }
        }
    }
}

/// Operations, and their cost in additions (a division counts 8, the cube root 24), for energy, stress and the 15 distinct entries of
/// the tangent. The form written by hand, `v C^T + C v^T` plus a sparse part, needs about 100.
#[test]
fn the_neo_hookean_kernel_is_small() {
    let mut pool = Pool::new();
    let energy = neo_hookean(&mut pool);
    let mut roots = vec![energy];
    roots.extend(gradient(&mut pool, energy, &F));
    roots.extend(hessian(&mut pool, energy, &F));
    let roots = lower_powers(&mut pool, &roots);
    let operations = reachable(&pool, &roots).into_iter().filter(|&id| pool.node(id).cost() > 0).count();
    let schedule = Schedule::new(&pool, &roots, &|s| u8::from(s.0 < 5));
    println!(
        "{operations} operations, cost {} per call and {} per point",
        schedule.cost(0),
        schedule.cost(1)
    );
    assert!(operations <= 140 && schedule.cost(1) <= 170);
}

#[test]
fn edge_pushing_agrees_with_differentiating_twice() {
    let mut pool = Pool::new();
    let energy = neo_hookean(&mut pool);
    let stress = gradient(&mut pool, energy, &F);
    let full: Vec<Id> = F.iter().flat_map(|&s| derivative(&mut pool, &stress, s)).collect();
    let tangent = hessian(&mut pool, energy, &F);
    let point = [1.2, 0.3, -0.1, 0.8, 1.1, 1.3, 2.1];
    let (expected, found) = (at(&pool, &full, &point), at(&pool, &tangent, &point));
    for i in 0..5 {
        for j in 0..=i {
            let (a, b) = (found[i * (i + 1) / 2 + j], expected[5 * i + j]);
            assert!((a - b).abs() < 1e-13 * b.abs().max(1.0)); // a few dozen roundings
        }
    }
    assert_eq!(is_symmetric(&pool, &full), Symmetry::Probed);
}

#[test]
fn symmetry_is_seen_in_structure_then_in_values() {
    let mut pool = Pool::new();
    let [x, y] = [0, 1].map(|s| pool.input(Symbol(s)));
    assert_eq!(is_symmetric(&pool, &[x, y, y, x]), Symmetry::Structural);
    let [sin, cos] = [Unary::Sin, Unary::Cos].map(|op| pool.unary(op, x));
    let squares = pool.dot(&[sin, cos], &[sin, cos]);
    let one = pool.one();
    assert_eq!(is_symmetric(&pool, &[x, squares, one, y]), Symmetry::Probed);
    assert_eq!(is_symmetric(&pool, &[x, y, one, y]), Symmetry::None);
    assert_eq!(is_symmetric(&pool, &[x, y]), Symmetry::None);
}

#[test]
fn the_same_calls_give_the_same_ids() {
    let run = || {
        let mut pool = Pool::new();
        let energy = neo_hookean(&mut pool);
        (hessian(&mut pool, energy, &F), pool.len())
    };
    assert_eq!(run(), run());
}
