//! Contact pairs of a program on a mesh: surfaces from its paths, gaps at the current displacement, energies of the gap.

use super::globals::quadrature_points;
use super::unknowns::{FieldNumbers, NONE, Unknowns};
use crate::contact::{ContactPair, Point, SlavePoint, smooth_curves};
use crate::error::Error;
use crate::generated::{Pair, PairIntegral, Program};
use crate::mesh::Mesh;
use crate::solve::sparse::{MatrixKind, SparsePattern};
use ansatz_elements::Element;
use std::f64::consts::FRAC_PI_6;

/// Degree of the quadrature on slave edges: 4 points.
const DEGREE: usize = 7;
/// Surfaces are smooth across vertices that turn by less than this.
const CORNER: f64 = FRAC_PI_6;
/// How far contact may move, in lengths of the longest slave edge, before the matrix pattern is made again.
const MARGIN: f64 = 4.0;
/// Samples for the gap beyond which all laws vanish.
const SAMPLES: usize = 64;

/// Whether a tangent has the part W'(g) Hess g, by which surfaces that turn and slide while they press can make it indefinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// The exact tangent.
    Kept,
    /// Only W''(g) grad g (grad g)^T: safer far from the solution, not quadratic near it.
    Dropped,
}

/// One direction of a pair: the points of one surface against the curves of the other.
struct Side {
    pair: ContactPair,
    /// Reference position of each point.
    x: Vec<Point>,
    /// Slave edges.
    edges: Vec<[usize; 3]>,
    /// Master nodes that the matrix pattern couples to each slave edge.
    potential: Vec<Vec<usize>>,
}

/// A contact pair on a mesh.
pub struct PairOn {
    sides: Vec<Side>,
    /// With whether each is integrated over both sides.
    integrals: Vec<&'static PairIntegral>,
    displacement: usize,
    search: f64,
    /// Gap beyond which every law is zero.
    reach: f64,
    margin: f64,
    positions: Vec<Point>,
    /// The gaps are those of `positions`.
    updated: bool,
}

/// Pairs of a program; `g` holds parameters and constants.
pub fn prepare(program: &'static Program, mesh: &Mesh, g: &[f64]) -> Result<Vec<PairOn>, Error> {
    let on = |(k, pair)| PairOn::new(program, k, pair, mesh, g);
    program.pairs.iter().enumerate().map(on).collect()
}

impl PairOn {
    fn new(
        program: &'static Program,
        number: usize,
        pair: &'static Pair,
        mesh: &Mesh,
        g: &[f64],
    ) -> Result<Self, Error> {
        let integrals: Vec<&PairIntegral> =
            program.pair_integrals.iter().filter(|i| i.pair == number).collect();
        let search = (pair.search)(g);
        let (first, second) = (chains(mesh, pair.first)?, chains(mesh, pair.second)?);
        let mut sides = vec![Side::new(program, mesh, &first, &second, search)?];
        if integrals.iter().any(|i| i.both) {
            sides.push(Side::new(program, mesh, &second, &first, search)?);
        }
        let edges = sides.iter().flat_map(|side| &side.edges);
        let longest = edges.map(|e| distance(mesh.nodes[e[0]], mesh.nodes[e[1]])).fold(0.0, f64::max);
        Ok(Self {
            reach: reach(&integrals, search, g),
            sides,
            integrals,
            displacement: pair.displacement,
            search,
            margin: MARGIN * longest,
            positions: mesh.nodes.clone(),
            updated: false,
        })
    }

    /// Whether any law acts on it; else it is only looked at.
    pub fn acts(&self) -> bool {
        !self.integrals.is_empty()
    }

    /// Finds the gaps at the displacement in y; does nothing where they are known already.
    pub fn update(&mut self, mesh: &Mesh, unknowns: &Unknowns, y: &[f64]) {
        let field = &unknowns.fields[self.displacement];
        let mut moved = !self.updated;
        for (k, &node) in field.nodes.iter().enumerate() {
            let u = &y[field.first + 2 * k..][..2];
            let x = mesh.nodes[node as usize];
            let position = [x[0] + u[0], x[1] + u[1]];
            moved |= std::mem::replace(&mut self.positions[node as usize], position) != position;
        }
        if !moved {
            return;
        }
        self.updated = true;
        self.sides.iter_mut().for_each(|side| side.pair.update(&self.positions));
    }

    /// Gap at every point; the search distance where nothing faces it.
    pub fn gaps(&self) -> impl Iterator<Item = f64> + '_ {
        let gaps = self.sides.iter().flat_map(|side| side.pair.gaps());
        gaps.map(|gap| gap.as_ref().map_or(self.search, |g| g.value))
    }

    /// Groups of unknowns that contact may couple until the surfaces have moved by the margin, around the last update.
    pub fn couplings(&mut self, unknowns: &Unknowns) -> Vec<Vec<u32>> {
        let field = &unknowns.fields[self.displacement];
        let radius = self.reach + self.margin;
        let mut groups = Vec::new();
        for side in &mut self.sides {
            side.potential = side.pair.potential_nodes(&self.positions, radius);
            for (edge, masters) in side.edges.iter().zip(&side.potential).filter(|(_, m)| !m.is_empty()) {
                let nodes = edge.iter().chain(masters);
                groups.push(nodes.flat_map(|&n| unknowns_of(field, n)).map(|u| u as u32).collect());
            }
        }
        groups
    }

    /// Whether the couplings of the last [`PairOn::couplings`] hold those of the present gaps.
    pub fn covered(&self) -> bool {
        self.sides.iter().all(|side| side.pair.covered(&side.potential, self.reach.max(f64::MIN_POSITIVE)))
    }

    /// Adds the residual of the integrals of wanted blocks.
    pub fn add_residual(
        &self,
        unknowns: &Unknowns,
        g: &[f64],
        wanted: &dyn Fn(usize) -> bool,
        residual: &mut [f64],
    ) {
        let field = &unknowns.fields[self.displacement];
        for (integral, side) in self.integrals_on_sides().filter(|(i, _)| wanted(i.block)) {
            let law = |point: usize, gap: f64| (integral.law)(gap, side.x[point], g);
            side.pair.gradient(&law, |(node, component), value| {
                if let Some(unknown) = field.unknown(node, component) {
                    residual[unknown] += value;
                }
            });
        }
    }

    /// Adds residual and tangent of all integrals; `values` has a spare last entry.
    pub fn add_tangent(
        &self,
        unknowns: &Unknowns,
        g: &[f64],
        matrix: (&SparsePattern, &[u32]),
        curvature: Curvature,
        residual: &mut [f64],
        values: &mut [f64],
    ) {
        self.add_residual(unknowns, g, &|_| true, residual);
        let (pattern, equations) = matrix;
        let field = &unknowns.fields[self.displacement];
        let equation = |(node, component)| {
            let unknown = field.unknown(node, component)?;
            Some(equations[unknown]).filter(|&e| e != NONE)
        };
        for (integral, side) in self.integrals_on_sides() {
            let law = |point: usize, gap: f64| {
                let [energy, force, stiffness] = (integral.law)(gap, side.x[point], g);
                [energy, if curvature == Curvature::Kept { force } else { 0.0 }, stiffness]
            };
            side.pair.hessian(&law, |row, column, value| {
                let (Some(row), Some(column)) = (equation(row), equation(column)) else { return };
                if pattern.kind() == MatrixKind::Symmetric && row < column {
                    return;
                }
                if let Some(position) = pattern.position(row, column) {
                    values[position] += value;
                }
            });
        }
    }

    fn integrals_on_sides(&self) -> impl Iterator<Item = (&'static PairIntegral, &Side)> {
        self.integrals.iter().flat_map(|&integral| {
            let sides = if integral.both { &self.sides[..] } else { &self.sides[..1] };
            sides.iter().map(move |side| (integral, side))
        })
    }
}

impl Side {
    fn new(
        program: &Program,
        mesh: &Mesh,
        slave: &[Vec<[usize; 3]>],
        master: &[Vec<[usize; 3]>],
        search: f64,
    ) -> Result<Self, Error> {
        let edges: Vec<[usize; 3]> = slave.iter().flatten().copied().collect();
        let mut points = Vec::new();
        let mut x = Vec::new();
        for (number, edge) in edges.iter().enumerate() {
            let nodes = edge.map(|n| n as u32);
            for (local, position, size) in quadrature_points(mesh, Element::P2_SEGMENT, &nodes, DEGREE) {
                points.push(SlavePoint::new(number, local[0], size * (program.weight)(position)));
                x.push(position);
            }
        }
        let contact = |e: crate::contact::ContactError| Error::Model(e.to_string());
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
        let pair = ContactPair::new(edges.clone(), points, curves, search).map_err(contact)?;
        let potential = vec![Vec::new(); edges.len()];
        Ok(Self { pair, x, edges, potential })
    }
}

/// Unknowns of both components at a node.
fn unknowns_of(field: &FieldNumbers, node: usize) -> impl Iterator<Item = usize> + '_ {
    (0..2).filter_map(move |component| field.unknown(node, component))
}

/// Gap beyond which all laws are zero, up to the search distance.
fn reach(integrals: &[&PairIntegral], search: f64, g: &[f64]) -> f64 {
    let acts = |gap: f64| integrals.iter().any(|i| (i.law)(gap, [0.0; 2], g) != [0.0; 3]);
    let gap = |k: usize| search * k as f64 / SAMPLES as f64;
    (1..=SAMPLES).rev().find(|&k| acts(gap(k))).map_or(0.0, |k| gap((k + 1).min(SAMPLES)))
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Edges `[start, end, middle]` of a surface with the body on their left, as chains of edges that follow each other.
fn chains(mesh: &Mesh, paths: &[&str]) -> Result<Vec<Vec<[usize; 3]>>, Error> {
    let mut chains: Vec<Vec<[usize; 3]>> = Vec::new();
    for path in paths {
        let mut edges = Vec::new();
        for edge in mesh.path_edges(path) {
            let [start, end, middle] = edge.nodes.map(|n| n as usize);
            match (edge.left, edge.right) {
                (Some(_), None) => edges.push([start, end, middle]),
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
        "the contact surface `{path}` has bodies on both sides or on none; a surface in contact bounds one body"
    ))
}
