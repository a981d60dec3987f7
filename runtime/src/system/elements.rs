//! Elements of one integral's domain in batches of [`BATCH`], structure of arrays, ready for emitted kernels.

use super::unknowns::{Unknowns, path_edges, region_cells};
use crate::error::Error;
use crate::generated::{BATCH, Batch, Domain, Use};
use crate::mesh::Mesh;

/// Lanes of one scalar quantity.
pub type Row = [f64; BATCH];

struct Header {
    region: usize,
    /// Elements in the batch; the last one is repeated in further lanes.
    count: usize,
}

/// The batches of a domain with the unknowns of some fields.
pub struct Elements {
    headers: Vec<Header>,
    /// Coordinate rows per batch.
    coordinate_rows: usize,
    coordinates: Vec<Row>,
    /// Local unknowns per element.
    local: usize,
    unknowns: Vec<[u32; BATCH]>,
}

/// Buffers for the values of a batch.
#[derive(Default)]
pub struct Gathered {
    values: Vec<Row>,
    rates: Vec<Row>,
}

impl Elements {
    /// Elements of `domain`, with local unknowns use by use, node by node, component by component.
    pub fn new(mesh: &Mesh, unknowns: &Unknowns, domain: Domain, uses: &[Use]) -> Result<Self, Error> {
        let groups = element_nodes(mesh, domain)?;
        let nodes_per_element = if matches!(domain, Domain::Cells(_)) { 6 } else { 3 };
        let mut set = Self {
            headers: Vec::new(),
            coordinate_rows: 2 * nodes_per_element,
            coordinates: Vec::new(),
            local: 0,
            unknowns: Vec::new(),
        };
        for (region, group) in groups.iter().enumerate() {
            for chunk in group.chunks(BATCH) {
                set.push_batch(mesh, unknowns, region, chunk, uses)?;
            }
        }
        set.local = if set.headers.is_empty() { 0 } else { set.unknowns.len() / set.headers.len() };
        Ok(set)
    }

    fn push_batch(
        &mut self,
        mesh: &Mesh,
        unknowns: &Unknowns,
        region: usize,
        chunk: &[Vec<u32>],
        uses: &[Use],
    ) -> Result<(), Error> {
        let lanes: [&[u32]; BATCH] = std::array::from_fn(|lane| chunk[lane.min(chunk.len() - 1)].as_slice());
        for node in 0..lanes[0].len() {
            for axis in 0..2 {
                self.coordinates.push(lanes.map(|nodes| mesh.nodes[nodes[node] as usize][axis]));
            }
        }
        for used in uses {
            let field = &unknowns.fields[used.field];
            let carrying = field_nodes(lanes[0].len(), field.nodes_per_cell);
            for node in 0..carrying {
                for component in 0..field.components {
                    let mut row = [0; BATCH];
                    for (number, nodes) in row.iter_mut().zip(lanes) {
                        let unknown = field.unknown(nodes[node] as usize, component);
                        let missing =
                            || Error::Model("an integral reaches beyond the regions of its field".into());
                        *number = unknown.ok_or_else(missing)? as u32;
                    }
                    self.unknowns.push(row);
                }
            }
        }
        self.headers.push(Header { region, count: chunk.len() });
        Ok(())
    }

    /// Local unknowns per element.
    pub fn local(&self) -> usize {
        self.local
    }

    /// Number of batches.
    pub fn batches(&self) -> usize {
        self.headers.len()
    }

    /// Elements in a batch.
    pub fn count(&self, batch: usize) -> usize {
        self.headers[batch].count
    }

    /// Unknown of each local unknown and lane.
    pub fn unknowns(&self, batch: usize) -> &[[u32; BATCH]] {
        &self.unknowns[batch * self.local..(batch + 1) * self.local]
    }

    /// Unknown lists of all elements, one after another.
    pub fn element_unknowns(&self) -> impl Iterator<Item = Vec<u32>> + '_ {
        (0..self.batches()).flat_map(move |batch| {
            (0..self.count(batch)).map(move |lane| self.unknowns(batch).iter().map(|row| row[lane]).collect())
        })
    }

    /// The batch as kernels see it, with values and rates gathered from y and its rate.
    pub fn gather<'a>(
        &'a self,
        batch: usize,
        y: &[f64],
        rates: &[f64],
        alpha: f64,
        buffer: &'a mut Gathered,
    ) -> Batch<'a> {
        buffer.values.clear();
        buffer.rates.clear();
        for row in self.unknowns(batch) {
            buffer.values.push(row.map(|u| y[u as usize]));
            buffer.rates.push(row.map(|u| rates[u as usize]));
        }
        let rows = self.coordinate_rows;
        Batch {
            region: self.headers[batch].region,
            nodes: &self.coordinates[batch * rows..(batch + 1) * rows],
            values: &buffer.values,
            rates: &buffer.rates,
            alpha,
        }
    }
}

/// Nodes of an element that carry a field: an edge has 2 or 3, a cell 3 or 6.
fn field_nodes(element_nodes: usize, nodes_per_cell: usize) -> usize {
    match (element_nodes, nodes_per_cell) {
        (3, 3) => 2,
        (3, _) => 3,
        (_, n) => n,
    }
}

/// Node lists of the elements, by region for cells.
fn element_nodes(mesh: &Mesh, domain: Domain) -> Result<Vec<Vec<Vec<u32>>>, Error> {
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
    }
}
