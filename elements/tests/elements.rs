//! Every element is a nodal basis that reproduces the polynomials of its degree.

use ansatz_elements::{Cell, Element, quadrature};

fn values(element: &Element, x: &[f64]) -> Vec<f64> {
    let mut values = vec![f64::NAN; element.nodes().len()];
    element.evaluate(x, &mut values);
    values
}

fn gradients(element: &Element, x: &[f64]) -> Vec<f64> {
    let mut gradients = vec![f64::NAN; element.nodes().len() * element.cell.dimension()];
    element.gradients(x, &mut gradients);
    gradients
}

/// Each element with some points inside its cell.
fn samples() -> impl Iterator<Item = (&'static Element, Vec<Vec<f64>>)> {
    Element::ALL.iter().map(|&element| {
        let rule = quadrature(element.cell, 5).expect("every cell has a rule of degree 5");
        (element, rule.iter().map(|(x, _)| x.to_vec()).collect())
    })
}

#[test]
fn basis_function_i_is_one_at_node_i_only() {
    for element in Element::ALL {
        for (i, node) in element.nodes().iter().enumerate() {
            for (j, value) in values(element, node).into_iter().enumerate() {
                assert_eq!(value, f64::from(u8::from(i == j)), "{} {:?}", element.name, element.cell);
            }
        }
    }
}

#[test]
fn values_sum_to_one_and_gradients_to_zero() {
    for (element, points) in samples() {
        for x in points {
            assert!((values(element, &x).iter().sum::<f64>() - 1.0).abs() < 1e-15);
            let dimension = element.cell.dimension();
            for j in 0..dimension {
                let sum: f64 = gradients(element, &x).iter().skip(j).step_by(dimension).sum();
                assert!(sum.abs() < 1e-14);
            }
        }
    }
}

#[test]
fn gradients_are_the_slopes_of_the_values() {
    let step = 1e-3; // central differences are exact for quadratics, up to rounding / step
    for (element, points) in samples() {
        let dimension = element.cell.dimension();
        for x in points {
            let exact = gradients(element, &x);
            for j in 0..dimension {
                let shifted = |h: f64| {
                    let mut y = x.clone();
                    y[j] += h;
                    values(element, &y)
                };
                for (i, (up, down)) in shifted(step).iter().zip(shifted(-step)).enumerate() {
                    let slope = (up - down) / (2.0 * step);
                    assert!((slope - exact[i * dimension + j]).abs() < 1e-11);
                }
            }
        }
    }
}

#[test]
fn interpolation_reproduces_polynomials_of_the_degree() {
    for (element, points) in samples() {
        let polynomial = |x: &[f64]| {
            let linear: f64 = x.iter().zip([1.7, -0.6]).map(|(x, c)| c * x).sum::<f64>() + 0.3;
            linear.powi(element.degree as i32)
        };
        for x in points {
            let interpolated: f64 =
                element.nodes().iter().zip(values(element, &x)).map(|(node, v)| v * polynomial(node)).sum();
            assert!((interpolated - polynomial(&x)).abs() < 1e-14);
        }
    }
}

#[test]
fn nodes_are_counted_by_vertex_and_edge() {
    for element in Element::ALL {
        let [per_vertex, per_edge, per_face] = element.nodes_per_entity;
        let faces = usize::from(element.cell == Cell::Triangle);
        let count = per_vertex * element.cell.vertices().len()
            + per_edge * element.cell.edges().len()
            + per_face * faces;
        assert_eq!(count, element.nodes().len());
    }
}

#[test]
fn the_nodes_of_an_edge_are_those_of_the_segment_on_it() {
    for element in Element::ALL {
        let trace = Element::find(element.name, Cell::Segment).unwrap();
        for (&[a, b], nodes) in element.cell.edges().iter().zip(element.edge_nodes) {
            let (a, b) = (element.cell.vertices()[a], element.cell.vertices()[b]);
            assert_eq!(nodes.len(), trace.nodes().len());
            for (s, &node) in trace.nodes().iter().zip(*nodes) {
                for ((a, b), x) in a.iter().zip(b).zip(element.nodes()[node]) {
                    assert_eq!(a + s[0] * (b - a), *x);
                }
            }
        }
    }
}

#[test]
fn elements_are_found_by_name_and_cell() {
    assert_eq!(Element::find("P2", Cell::Triangle).map(|e| e.vtk_type), Some(22));
    assert!(Element::find("P9", Cell::Triangle).is_none());
}
