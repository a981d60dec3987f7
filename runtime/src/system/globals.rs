//! The globals: parameters, measures, constants, time, states, functionals, observables in one array.

use super::elements::geometry;
use super::unknowns::domain_elements;
use crate::error::Error;
use crate::generated::{Domain, Program};
use crate::mesh::Mesh;
use ansatz_elements::{Cell, Element, quadrature};

/// Degree of the rule for measures: exact for 2 pi r on curved quadratic cells.
const MEASURE_DEGREE: usize = 6;

/// Globals with parameters, measures and constants filled in.
pub fn constants(program: &Program, parameters: &[f64], mesh: &Mesh) -> Result<Vec<f64>, Error> {
    let mut g = vec![0.0; program.layout.length];
    g[program.layout.parameters[0]..program.layout.parameters[1]].copy_from_slice(parameters);
    for (slot, measure) in (program.layout.measures[0]..).zip(program.measures) {
        g[slot] = domain_measure(mesh, measure.domain, program.weight)?;
    }
    (program.constants)(&mut g);
    Ok(g)
}

/// Reference measure of a domain: integral of `weight` over its cells or edges; zero for points.
pub fn domain_measure(mesh: &Mesh, domain: Domain, weight: fn([f64; 2]) -> f64) -> Result<f64, Error> {
    let element = geometry(domain);
    let elements = domain_elements(mesh, domain)?.concat();
    Ok(elements.iter().map(|nodes| integral(mesh, element, nodes, weight)).sum())
}

fn integral(mesh: &Mesh, element: &Element, nodes: &[u32], weight: fn([f64; 2]) -> f64) -> f64 {
    quadrature_points(mesh, element, nodes, MEASURE_DEGREE).map(|(_, x, w)| w * weight(x)).sum()
}

/// Quadrature points of a curved element: local coordinates, position, and weight times the size of the area or length element.
pub fn quadrature_points<'a>(
    mesh: &'a Mesh,
    element: &'a Element,
    nodes: &'a [u32],
    degree: usize,
) -> impl Iterator<Item = (Vec<f64>, [f64; 2], f64)> + 'a {
    let rule = quadrature(element.cell, degree);
    let points: Vec<(Vec<f64>, f64)> =
        rule.iter().flat_map(|r| r.iter()).map(|(x, w)| (x.to_vec(), w)).collect();
    points.into_iter().map(move |(local, w)| {
        let (x, size) = position_and_size(mesh, element, nodes, &local);
        (local, x, w * size)
    })
}

fn position_and_size(mesh: &Mesh, element: &Element, nodes: &[u32], local: &[f64]) -> ([f64; 2], f64) {
    let dimension = element.cell.dimension();
    let mut values = vec![0.0; nodes.len()];
    let mut gradients = vec![0.0; nodes.len() * dimension];
    element.evaluate(local, &mut values);
    element.gradients(local, &mut gradients);
    let mut x = [0.0; 2];
    let mut tangents = [[0.0; 2]; 2];
    for (k, &node) in nodes.iter().enumerate() {
        let position = mesh.nodes[node as usize];
        for i in 0..2 {
            x[i] += values[k] * position[i];
            for d in 0..dimension {
                tangents[d][i] += gradients[k * dimension + d] * position[i];
            }
        }
    }
    let size = match element.cell {
        Cell::Segment => tangents[0][0].hypot(tangents[0][1]),
        Cell::Triangle => tangents[0][0] * tangents[1][1] - tangents[0][1] * tangents[1][0],
    };
    (x, size)
}
