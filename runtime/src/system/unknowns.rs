//! Numbering of the unknowns: one vector y = (field unknowns, states, functionals), and the equations that remain when held unknowns are taken
//! out.

use crate::error::Error;
use crate::generated::{Domain, Field, Program, Space};
use crate::mesh::Mesh;
use std::ops::Range;

/// No number: a node without unknowns, an unknown without an equation.
pub const NONE: u32 = u32::MAX;

/// Numbers of one field's unknowns.
#[derive(Clone, Debug)]
pub struct FieldNumbers {
    /// First unknown in y.
    pub first: usize,
    /// Components per node.
    pub components: usize,
    /// Nodes of a cell that carry unknowns: 3 (linear) or 6 (quadratic).
    pub nodes_per_cell: usize,
    /// Position of each mesh node in `nodes`, or `NONE`.
    pub position: Vec<u32>,
    /// Mesh nodes that carry unknowns, ascending.
    pub nodes: Vec<u32>,
}

impl FieldNumbers {
    fn new(field: &Field, mesh: &Mesh, first: usize) -> Result<Self, Error> {
        let nodes_per_cell = match field.space {
            Space::P1 => 3,
            Space::P2 => 6,
        };
        let mut carries = vec![false; mesh.nodes.len()];
        for domain in field.domains {
            for element in domain_elements(mesh, *domain)?.concat() {
                let carrying = &element[..field_nodes(element.len(), nodes_per_cell)];
                carrying.iter().for_each(|&n| carries[n as usize] = true);
            }
        }
        let nodes: Vec<u32> = (0..carries.len()).filter(|&n| carries[n]).map(|n| n as u32).collect();
        let mut position = vec![NONE; carries.len()];
        for (i, &node) in nodes.iter().enumerate() {
            position[node as usize] = i as u32;
        }
        Ok(Self { first, components: field.components, nodes_per_cell, position, nodes })
    }

    /// Number of unknowns.
    pub fn count(&self) -> usize {
        self.nodes.len() * self.components
    }

    /// Unknown of a component at a mesh node, if the node carries the field.
    pub fn unknown(&self, node: usize, component: usize) -> Option<usize> {
        let position = self.position[node];
        (position != NONE).then(|| self.first + position as usize * self.components + component)
    }
}

/// All unknowns of a model.
#[derive(Clone, Debug)]
pub struct Unknowns {
    /// Fields, in the program's order.
    pub fields: Vec<FieldNumbers>,
    /// First state in y; the field unknowns end here.
    pub states: usize,
    /// First functional in y.
    pub functionals: usize,
    /// Length of y.
    pub length: usize,
}

impl Unknowns {
    /// Numbers the unknowns of a program on a mesh.
    pub fn new(program: &Program, mesh: &Mesh) -> Result<Self, Error> {
        let mut fields = Vec::new();
        let mut next = 0;
        for field in program.fields {
            let numbers = FieldNumbers::new(field, mesh, next)?;
            next += numbers.count();
            fields.push(numbers);
        }
        let functionals = next + program.states.len();
        Ok(Self { fields, states: next, functionals, length: functionals + program.functionals.len() })
    }

    /// Field, component and mesh node of a field unknown.
    pub fn describe(&self, unknown: usize) -> (usize, usize, usize) {
        let field = self.fields.iter().rposition(|f| f.first <= unknown).unwrap_or(0);
        let numbers = &self.fields[field];
        let local = unknown - numbers.first;
        (field, local % numbers.components, numbers.nodes[local / numbers.components] as usize)
    }
}

/// Cells of a region by name.
pub fn region_cells(mesh: &Mesh, region: &str) -> Result<Range<usize>, Error> {
    let cells = mesh.region_cells(region);
    let missing = || Error::Model(format!("the mesh has no cells in a region `{region}`"));
    if cells.is_empty() { Err(missing()) } else { Ok(cells) }
}

/// Edges `[start, end, middle]` of a path or segment by name; none for the axis of a body that does not touch it.
pub fn path_edges(mesh: &Mesh, path: &str) -> Result<Vec<[u32; 3]>, Error> {
    let edges: Vec<[u32; 3]> = mesh.path_edges(path).map(|edge| edge.nodes).collect();
    let missing = || Error::Model(format!("the mesh has no edges on a path `{path}`"));
    if edges.is_empty() && path != "axis" { Err(missing()) } else { Ok(edges) }
}

/// Nodes of an element that carry a field: an edge has 2 or 3, a cell 3 or 6.
pub fn field_nodes(element_nodes: usize, nodes_per_cell: usize) -> usize {
    match (element_nodes, nodes_per_cell) {
        (3, 3) => 2,
        (3, _) => 3,
        (_, n) => n,
    }
}

/// Node lists of the elements of a domain: by region for cells, all in one list for edges, none for points.
pub fn domain_elements(mesh: &Mesh, domain: Domain) -> Result<Vec<Vec<Vec<u32>>>, Error> {
    match domain {
        Domain::Cells(regions) => regions
            .iter()
            .map(|region| Ok(region_cells(mesh, region)?.map(|c| mesh.cells[c].to_vec()).collect()))
            .collect(),
        Domain::Edges(paths) => {
            let mut edges = Vec::new();
            for path in paths {
                edges.extend(path_edges(mesh, path)?.iter().map(|e| e.to_vec()));
            }
            Ok(vec![edges])
        }
        Domain::Ends(_) => Ok(Vec::new()),
    }
}

/// The node at `path.start` or `path.end`.
fn end_node(mesh: &Mesh, name: &str) -> Result<u32, Error> {
    let (path, end) = name.rsplit_once('.').unwrap_or((name, "start"));
    let edges = path_edges(mesh, path)?;
    let node = if end == "start" { edges.first().map(|e| e[0]) } else { edges.last().map(|e| e[1]) };
    node.ok_or_else(|| Error::Model(format!("the mesh has no point `{name}`")))
}

/// Mesh nodes of a domain, ascending.
pub fn domain_nodes(mesh: &Mesh, domain: Domain) -> Result<Vec<u32>, Error> {
    let mut nodes = match domain {
        Domain::Ends(names) => names.iter().map(|name| end_node(mesh, name)).collect::<Result<_, _>>()?,
        _ => domain_elements(mesh, domain)?.concat().concat(),
    };
    nodes.sort_unstable();
    nodes.dedup();
    Ok(nodes)
}
