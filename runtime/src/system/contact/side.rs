//! One direction of a contact pair on a mesh: the points of one surface against the smooth curves of the other.

use crate::contact::{ContactError, ContactPair, Partner, Point, SlavePoint, Surface, smooth_curves};
use crate::error::Error;
use crate::generated::Program;
use crate::mesh::{CellEdge, Mesh};
use ansatz_elements::{Cell, quadrature};
use std::f64::consts::FRAC_PI_6;

/// Degree of the quadrature on slave edges: 4 points.
const DEGREE: usize = 7;
/// Surfaces are smooth across vertices that turn by less than this.
const CORNER: f64 = FRAC_PI_6;

/// One direction of a pair: the points of one surface against the curves of the other.
pub(super) struct Side {
    pub(super) pair: ContactPair,
    /// Reference position of each point.
    pub(super) x: Vec<Point>,
    /// Slave edges.
    pub(super) edges: Vec<[usize; 3]>,
    /// Master nodes that the matrix pattern couples to each slave edge.
    pub(super) potential: Vec<Vec<usize>>,
}

impl Side {
    /// Chains of slave edges, body on the left, against those of the master.
    pub(super) fn new(
        program: &Program,
        mesh: &Mesh,
        slave: &[Vec<[usize; 3]>],
        master: &[Vec<[usize; 3]>],
        reach: (Partner, f64),
    ) -> Result<Self, Error> {
        let edges: Vec<[usize; 3]> = slave.iter().flatten().copied().collect();
        let mut points = Vec::new();
        let mut x = Vec::new();
        // There is a rule for every degree up to one above this.
        let rule = quadrature(Cell::Segment, DEGREE);
        let rule: Vec<_> = rule.iter().flat_map(|rule| rule.iter()).collect();
        for (number, edge) in edges.iter().enumerate() {
            for (t, weight) in &rule {
                let point = SlavePoint::new(number, t[0], *weight);
                let Surface { position, tangent } = point.surface(*edge, &mesh.nodes);
                let length = tangent[0].hypot(tangent[1]);
                points.push(SlavePoint { measure: weight * length * (program.weight)(position), ..point });
                x.push(position);
            }
        }
        let contact = |e: ContactError| Error::Model(e.to_string());
        let mut curves = Vec::new();
        for chain in master {
            let closed = chain.first().map(|e| e[0]) == chain.last().map(|e| e[1]);
            let mut nodes: Vec<usize> = chain.iter().flat_map(|e| [e[0], e[2]]).collect();
            if !closed {
                nodes.extend(chain.last().map(|e| e[1]));
            }
            let smooth = smooth_curves(&nodes, closed, program.axisymmetric, &mesh.nodes, CORNER);
            curves.extend(smooth.map_err(contact)?);
        }
        let pair = ContactPair::new(edges.clone(), points, curves, reach).map_err(contact)?;
        let potential = vec![Vec::new(); edges.len()];
        Ok(Self { pair, x, edges, potential })
    }
}

/// Edges `[start, end, middle]` of a surface with the body on their left, as chains of edges that follow each other.
///
/// # Errors
/// If a path has no edges, or edges with a body made of these regions on both sides.
pub(super) fn chains(mesh: &Mesh, paths: &[&str], regions: &[&str]) -> Result<Vec<Vec<[usize; 3]>>, Error> {
    let in_body = |side: &CellEdge| {
        let region = mesh.cell_region[side.cell as usize] as usize;
        regions.contains(&mesh.regions[region].as_str())
    };
    let mut chains: Vec<Vec<[usize; 3]>> = Vec::new();
    for path in paths {
        let mut edges = Vec::new();
        for edge in mesh.path_edges(path) {
            let [start, end, middle] = edge.nodes.map(|n| n as usize);
            match (edge.left.filter(in_body), edge.right.filter(in_body)) {
                // A path that bounds no body acts as if it had one on its left.
                (Some(_), None) | (None, None) => edges.push([start, end, middle]),
                (None, Some(_)) => edges.insert(0, [end, start, middle]),
                _ => return Err(inner_surface(path)),
            }
        }
        if edges.is_empty() {
            return Err(Error::Model(format!("the contact surface `{path}` has no edges")));
        }
        append(&mut chains, edges);
    }
    Ok(chains)
}

/// Continues the chain that ends where these edges start, else begins one; cuts where edges do not follow each other.
fn append(chains: &mut Vec<Vec<[usize; 3]>>, edges: Vec<[usize; 3]>) {
    for edge in edges {
        match chains.iter_mut().find(|chain| chain.last().is_some_and(|last| last[1] == edge[0])) {
            Some(chain) => chain.push(edge),
            None => chains.push(vec![edge]),
        }
    }
}

fn inner_surface(path: &str) -> Error {
    Error::Model(format!(
        "the contact surface `{path}` has bodies on both sides; a surface in contact bounds at most one"
    ))
}
