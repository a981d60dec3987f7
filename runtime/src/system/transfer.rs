//! From one mesh to the next: cells of regions that follow bodies go along or are made anew, and so does everything that was known there.
//!
//! Unknowns of bodies, states and functionals stay what they are; those of moving regions take the values that the old mesh has at the places of
//! the new nodes, or at the nearest old node where the region has just come.

use super::System;
use super::functionals::FunctionalOn;
use super::unknowns::{FieldNumbers, Unknowns};
use crate::error::Error;
use crate::generated::Domain;
use crate::mesh::{Follower, Locator, Mesh, MeshError};
use ansatz_elements::Element;
use ansatz_geometry::point;

/// What each unknown on a new mesh is made of: unknowns on the old one with weights.
#[derive(Clone, Debug)]
pub struct Transfer {
    first: Vec<usize>,
    parts: Vec<(usize, f64)>,
}

impl Transfer {
    /// A vector over the old unknowns as one over the new ones.
    pub fn apply(&self, old: &[f64]) -> Vec<f64> {
        let sum = |range: &[usize]| self.parts[range[0]..range[1]].iter().map(|&(k, w)| w * old[k]).sum();
        self.first.windows(2).map(sum).collect()
    }

    fn new() -> Self {
        Self { first: vec![0], parts: Vec::new() }
    }

    /// The next new unknown.
    fn push(&mut self, parts: impl IntoIterator<Item = (usize, f64)>) {
        self.parts.extend(parts);
        self.first.push(self.parts.len());
    }

    fn push_same(&mut self, old: std::ops::Range<usize>) {
        old.for_each(|k| self.push([(k, 1.0)]));
    }
}

impl System {
    /// Whether some regions follow bodies.
    pub fn has_moving_regions(&self) -> bool {
        !self.program.moving.is_empty()
    }

    /// Whether a field lives on a region that follows bodies.
    pub fn moves(&self, field: usize) -> bool {
        let lives = |region: &str| {
            let mut domains = self.program.fields[field].domains.iter();
            domains.any(|domain| matches!(domain, Domain::Cells(regions) if regions.contains(&region)))
        };
        self.program.moving.iter().any(|moving| lives(moving.region))
    }

    /// Lets moving regions follow bodies displaced as in y, and goes on from there: their cells go along, or are made anew where they would lose
    /// their shape, and in any case if `anew`. How unknowns go along.
    ///
    /// # Errors
    /// Bodies that run into each other.
    pub fn follow_bodies(&mut self, y: &[f64], anew: bool) -> Result<Transfer, Error> {
        let mesh_error = |e: MeshError| Error::Mesh(e.to_string());
        let mut followers = std::mem::take(&mut self.followers);
        let moved = if anew { None } else { self.moved(&mut followers, y).map_err(mesh_error)? };
        let same_cells = moved.is_some();
        let mesh = moved.map_or_else(|| self.meshed_anew(&mut followers, y).map_err(mesh_error), Ok)?;
        let parameters = self.program.layout.parameters;
        let parameters = self.g[parameters[0]..parameters[1]].to_vec();
        let mut old =
            std::mem::replace(self, Self::without_pattern(self.program, &parameters, mesh, followers)?);
        self.threads = old.threads;
        self.share_out();
        let transfer = self.transfer(&old.mesh, &old.unknowns);
        let y = transfer.apply(y);
        if same_cells {
            self.keep_pattern(&mut old);
        } else {
            self.rebuild_pattern(&y)?;
        }
        self.meshings = old.meshings + usize::from(!same_cells);
        self.take_over(&old, &y)?;
        Ok(transfer)
    }

    /// The mesh whose cells have gone along; none where some cannot.
    fn moved(&self, followers: &mut [Follower], y: &[f64]) -> Result<Option<Mesh>, MeshError> {
        let mut mesh = self.mesh.clone();
        for (follower, moving) in followers.iter_mut().zip(self.program.moving) {
            let positions = self.positions(moving.displacement, y);
            if !follower.advance(&mut mesh, &positions)? {
                return Ok(None);
            }
        }
        Ok(Some(mesh))
    }

    fn meshed_anew(&self, followers: &mut [Follower], y: &[f64]) -> Result<Mesh, MeshError> {
        let mut mesh = self.mesh.bodies();
        for (follower, moving) in followers.iter_mut().zip(self.program.moving) {
            follower.attach(&mut mesh, &self.positions(moving.displacement, y))?;
        }
        Ok(mesh)
    }

    /// Takes the pattern and all that depends on it from a system with the same cells.
    fn keep_pattern(&mut self, old: &mut Self) {
        std::mem::swap(&mut self.pattern, &mut old.pattern);
        std::mem::swap(&mut self.solver, &mut old.solver);
        std::mem::swap(&mut self.pairs, &mut old.pairs);
        std::mem::swap(&mut self.values, &mut old.values);
        std::mem::swap(&mut self.diagonal, &mut old.diagonal);
        self.factored = old.factored;
        self.assembly.take_places(&mut old.assembly);
        let [new, old] = [self, old].map(|s| s.functionals.iter_mut().flat_map(FunctionalOn::terms_mut));
        new.zip(old).for_each(|(new, old)| new.take_places(old));
    }

    /// Places of the bodies' nodes. Paths that bound no body, such as an outlet, stretch between their ends.
    fn positions(&self, displacement: usize, y: &[f64]) -> Vec<[f64; 2]> {
        let bodies = &self.mesh;
        let field = &self.unknowns.fields[displacement];
        let moved = |node: u32| [0, 1].map(|c| field.unknown(node as usize, c).map_or(0.0, |u| y[u]));
        let nodes = (0..bodies.body_nodes as u32).zip(&bodies.nodes);
        let mut positions: Vec<[f64; 2]> = nodes.map(|(node, &x)| point::add(x, moved(node))).collect();
        for path in bodies.paths.iter().filter(|path| path.seen_from.is_none()) {
            let [Some(first), Some(last)] = [path.edges.first(), path.edges.last()] else { continue };
            let ends = [first.nodes[0], last.nodes[1]];
            let [start, end] = ends.map(|node| bodies.nodes[node as usize]);
            for node in path.edges.iter().flat_map(|edge| edge.nodes) {
                if field.unknown(node as usize, 0).is_none() {
                    let x = bodies.nodes[node as usize];
                    let along =
                        point::distance(x, start) / (point::distance(x, start) + point::distance(x, end));
                    positions[node as usize] =
                        point::add(x, point::lerp(moved(ends[0]), moved(ends[1]), along));
                }
            }
        }
        positions
    }

    /// Keeps what the solution has learnt; y are the unknowns on the new mesh.
    fn take_over(&mut self, old: &Self, y: &[f64]) -> Result<(), Error> {
        let layout = self.program.layout;
        self.g[layout.time] = old.g[layout.time];
        for [start, end] in [layout.states, layout.state_rates, layout.functionals, layout.functional_rates] {
            self.g[start..end].copy_from_slice(&old.g[start..end]);
        }
        self.forces.clone_from(&old.forces);
        (self.indefinite, self.stable_pivots, self.stabiliser) =
            (old.indefinite, old.stable_pivots, old.stabiliser);
        if old.levels.as_ref().is_some_and(|levels| levels.is_empty()) {
            self.levels = Some(Vec::new());
            return Ok(());
        }
        self.fix_levels(y)
    }

    fn transfer(&self, old: &Mesh, before: &Unknowns) -> Transfer {
        let mut transfer = Transfer::new();
        for (k, (new, from)) in self.unknowns.fields.iter().zip(&before.fields).enumerate() {
            if self.moves(k) {
                interpolate(&self.mesh, new, old, from, &mut transfer);
            } else {
                transfer.push_same(from.first..from.first + from.count());
            }
        }
        transfer.push_same(before.states..before.length);
        transfer
    }
}

/// Values of a field at the nodes of a new mesh from those on an old one.
fn interpolate(mesh: &Mesh, new: &FieldNumbers, old: &Mesh, from: &FieldNumbers, into: &mut Transfer) {
    let locator = Locator::new(old, old.body_cells..old.cells.len());
    let element = if from.nodes_per_cell == 3 { Element::P1_TRIANGLE } else { Element::P2_TRIANGLE };
    let mut basis = vec![0.0; from.nodes_per_cell];
    for &node in &new.nodes {
        let x = mesh.nodes[node as usize];
        let sources: Vec<(u32, f64)> = match locator.locate(x) {
            Some((cell, local)) => {
                element.evaluate(&local, &mut basis);
                old.cells[cell].iter().copied().zip(basis.iter().copied()).collect()
            }
            None => nearest(old, from, x).into_iter().map(|node| (node, 1.0)).collect(),
        };
        for component in 0..new.components {
            let unknown = |&(node, w): &(u32, f64)| Some((from.unknown(node as usize, component)?, w));
            into.push(sources.iter().filter_map(unknown));
        }
    }
}

/// The node closest to `x` among those that carry a field.
fn nearest(mesh: &Mesh, field: &FieldNumbers, x: [f64; 2]) -> Option<u32> {
    let far = |node: &u32| point::distance(mesh.nodes[*node as usize], x);
    field.nodes.iter().copied().min_by(|a, b| far(a).total_cmp(&far(b)))
}
