//! Every rule is exact to its degree, with positive weights at points inside.

use ansatz_elements::{Cell, Quadrature, quadrature};

/// Every rule of the table, each once.
fn rules() -> Vec<Quadrature> {
    let mut rules: Vec<Quadrature> =
        Cell::ALL.iter().flat_map(|&cell| (0..).map_while(move |degree| quadrature(cell, degree))).collect();
    rules.dedup();
    rules
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// Integral of `x^i y^j` over the cell; `j` is 0 on the segment.
fn moment(cell: Cell, i: usize, j: usize) -> f64 {
    match cell {
        Cell::Segment => 1.0 / (i + 1) as f64,
        Cell::Triangle => factorial(i) * factorial(j) / factorial(i + j + 2),
    }
}

#[test]
fn monomials_up_to_the_degree_are_exact() {
    for rule in rules() {
        for i in 0..=rule.degree {
            let last = if rule.cell == Cell::Segment { 0 } else { rule.degree - i };
            for j in 0..=last {
                let power = |x: &[f64]| x[0].powi(i as i32) * x.get(1).map_or(1.0, |y| y.powi(j as i32));
                let sum: f64 = rule.iter().map(|(x, w)| w * power(x)).sum();
                let exact = moment(rule.cell, i, j);
                // A few units in the last place of the measure of the cell.
                assert!((sum - exact).abs() <= 4e-16, "{:?} degree {}: x^{i} y^{j}", rule.cell, rule.degree);
            }
        }
    }
}

#[test]
fn weights_are_positive_and_points_inside() {
    for rule in rules() {
        for (x, w) in rule.iter() {
            assert!(w > 0.0);
            assert!(rule.cell.contains(x, -1e-3), "{x:?} lies on or beyond the boundary");
        }
    }
}

#[test]
fn the_smallest_sufficient_rule_is_chosen() {
    let points = |cell, degree| quadrature(cell, degree).map(|rule| rule.weights.len());
    assert_eq!((0..=12).map(|d| points(Cell::Segment, d)).collect::<Vec<_>>(), {
        let mut counts: Vec<_> = (0..=11).map(|d| Some(d / 2 + 1)).collect();
        counts.push(None);
        counts
    });
    let counts = [Some(1), Some(1), Some(3), Some(6), Some(6), Some(7), Some(12), Some(16), Some(16), None];
    assert_eq!((0..=9).map(|d| points(Cell::Triangle, d)).collect::<Vec<_>>(), counts);
}
