//! Ties: unknowns that are not solved for because they equal others, or the rates of others.
//!
//! `tie v == dt(u) on D` makes the velocity at each node of a surface that of the body behind it. The tied unknown leaves the equations: its row of the
//! residual is added to that of the other unknown, so that what the fluid does to the surface is done to the body, force for force; its column
//! of the tangent, times d rate / d value, to the other's column.

use super::unknowns::{Unknowns, domain_nodes};
use crate::error::Error;
use crate::generated::Program;
use crate::mesh::Mesh;

/// An unknown that follows another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tied {
    /// The unknown without an equation of its own.
    pub unknown: usize,
    /// What it follows.
    pub partner: usize,
    /// It equals the rate of its partner, else its value.
    pub rate: bool,
}

/// All ties of a program on a mesh, each unknown once.
///
/// # Errors
/// A node where the partner has no value.
pub fn tied_unknowns(program: &Program, mesh: &Mesh, unknowns: &Unknowns) -> Result<Vec<Tied>, Error> {
    let mut ties = Vec::new();
    for tie in program.ties {
        let (field, partner) = (&unknowns.fields[tie.field], &unknowns.fields[tie.partner]);
        for node in domain_nodes(mesh, tie.domain)? {
            let behind = body_node(mesh, node) as usize;
            for component in 0..field.components {
                let Some(unknown) = field.unknown(node as usize, component) else { continue };
                let missing = || {
                    let x = mesh.nodes[node as usize];
                    let [field, partner] = [tie.field, tie.partner].map(|f| program.fields[f].name);
                    Error::Model(format!(
                        "{}: `{field}` is tied to `{partner}`, which has no value at ({:.4}, {:.4})",
                        tie.place, x[0], x[1]
                    ))
                };
                let partner = partner.unknown(behind, component).ok_or_else(missing)?;
                ties.push(Tied { unknown, partner, rate: tie.rate });
            }
        }
    }
    ties.sort_unstable_by_key(|tied| tied.unknown);
    ties.dedup_by_key(|tied| tied.unknown);
    Ok(ties)
}

/// The unknown in whose row stands what acts on `unknown`: its partner where it is tied (`ties` as of [`tied_unknowns`]), else itself.
pub fn bearer(ties: &[Tied], unknown: usize) -> usize {
    ties.binary_search_by_key(&unknown, |tied| tied.unknown).map_or(unknown, |k| ties[k].partner)
}

/// The body's node that a node of a moving region lies on; any other node itself.
fn body_node(mesh: &Mesh, node: u32) -> u32 {
    mesh.links.binary_search_by_key(&node, |link| link[0]).map_or(node, |k| mesh.links[k][1])
}

/// Gives tied unknowns the equations of their partners.
pub fn share_equations(ties: &[Tied], equations: &mut [u32]) {
    for tied in ties {
        equations[tied.unknown] = equations[tied.partner];
    }
}
