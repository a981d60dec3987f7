//! Elements of one integral's domain in batches of [`BATCH`], structure of arrays, ready for emitted kernels.

use super::unknowns::{Unknowns, domain_elements, field_nodes};
use crate::error::Error;
use crate::generated::{BATCH, Batch, Domain, Integral, Row};
use crate::mesh::Mesh;
use ansatz_elements::Element;

/// Greatest distance of a middle node from the middle of a straight edge, in roundings of its coordinates.
const ROUNDINGS: f64 = 4.0;

#[derive(Clone)]
struct Header {
    region: usize,
    straight: bool,
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
    reads_rates: bool,
}

/// Buffers for the values of a batch.
pub struct Gathered {
    values: Vec<Row>,
    rates: Vec<Row>,
}

impl Elements {
    /// Elements of the domain of `integral`, with local unknowns use by use, node by node, component by component.
    pub fn new(mesh: &Mesh, unknowns: &Unknowns, integral: &Integral) -> Result<Self, Error> {
        let groups = domain_elements(mesh, integral.domain)?;
        let geometry = geometry(integral.domain);
        let mut set = Self {
            headers: Vec::new(),
            coordinate_rows: 2 * geometry.nodes().len(),
            coordinates: Vec::new(),
            local: 0,
            unknowns: Vec::new(),
            reads_rates: integral.rates,
        };
        for (region, group) in groups.iter().enumerate() {
            for chunk in group.chunks(BATCH) {
                set.push_batch(mesh, unknowns, integral, chunk)?;
                let straight = chunk.iter().all(|nodes| is_straight(mesh, geometry, nodes));
                set.headers.push(Header { region, straight, count: chunk.len() });
            }
        }
        set.local = if set.headers.is_empty() { 0 } else { set.unknowns.len() / set.headers.len() };
        Ok(set)
    }

    fn push_batch(
        &mut self,
        mesh: &Mesh,
        unknowns: &Unknowns,
        integral: &Integral,
        chunk: &[Vec<u32>],
    ) -> Result<(), Error> {
        let lanes: [&[u32]; BATCH] = std::array::from_fn(|lane| chunk[lane.min(chunk.len() - 1)].as_slice());
        for node in 0..lanes[0].len() {
            for axis in 0..2 {
                self.coordinates.push(Row(lanes.map(|nodes| mesh.nodes[nodes[node] as usize][axis])));
            }
        }
        for used in integral.uses {
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
        Ok(())
    }

    /// The batches that have some unknown of those asked for.
    pub fn part(&self, wanted: impl Fn(u32) -> bool) -> Self {
        let is_wanted = |batch: &usize| self.unknowns(*batch).as_flattened().iter().any(|&u| wanted(u));
        let batches: Vec<usize> = (0..self.batches()).filter(is_wanted).collect();
        Self {
            headers: batches.iter().map(|&batch| self.headers[batch].clone()).collect(),
            coordinate_rows: self.coordinate_rows,
            coordinates: batches.iter().flat_map(|&batch| self.nodes(batch)).copied().collect(),
            local: self.local,
            unknowns: batches.iter().flat_map(|&batch| self.unknowns(batch)).copied().collect(),
            reads_rates: self.reads_rates,
        }
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

    /// Reference coordinates of the geometry nodes.
    fn nodes(&self, batch: usize) -> &[Row] {
        &self.coordinates[batch * self.coordinate_rows..(batch + 1) * self.coordinate_rows]
    }

    /// Unknown lists of all elements, one after another.
    pub fn element_unknowns(&self) -> impl Iterator<Item = Vec<u32>> + '_ {
        (0..self.batches()).flat_map(move |batch| {
            (0..self.count(batch)).map(move |lane| self.unknowns(batch).iter().map(|row| row[lane]).collect())
        })
    }

    /// Buffers of the size that [`Self::gather`] needs.
    pub fn buffers(&self) -> Gathered {
        let rates = if self.reads_rates { self.local } else { 0 };
        Gathered { values: vec![Row::ZERO; self.local], rates: vec![Row::ZERO; rates] }
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
        collect(y, self.unknowns(batch), &mut buffer.values);
        collect(rates, self.unknowns(batch), &mut buffer.rates);
        let header = &self.headers[batch];
        Batch {
            region: header.region,
            nodes: self.nodes(batch),
            straight: header.straight,
            values: &buffer.values,
            rates: &buffer.rates,
            alpha,
        }
    }
}

/// Fills rows with the numbers at given places of a vector.
fn collect(vector: &[f64], places: &[[u32; BATCH]], rows: &mut [Row]) {
    for (row, places) in rows.iter_mut().zip(places) {
        for lane in 0..BATCH {
            row[lane] = vector[places[lane] as usize];
        }
    }
}

/// The element whose nodes carry the geometry.
pub fn geometry(domain: Domain) -> &'static Element {
    match domain {
        Domain::Cells(_) => Element::P2_TRIANGLE,
        Domain::Edges(_) | Domain::Ends(_) => Element::P2_SEGMENT,
    }
}

/// Whether the middle node of every edge lies in its middle.
fn is_straight(mesh: &Mesh, geometry: &Element, nodes: &[u32]) -> bool {
    let x = |local: usize, axis: usize| mesh.nodes[nodes[local] as usize][axis];
    geometry.edge_nodes.iter().all(|edge| match **edge {
        [a, b, middle] => (0..2).all(|axis| {
            let (a, b) = (x(a, axis), x(b, axis));
            (x(middle, axis) - 0.5 * (a + b)).abs() <= ROUNDINGS * f64::EPSILON * a.abs().max(b.abs())
        }),
        _ => true,
    })
}
