//! Nodes shared out among threads: who owns which unknowns and matrix entries, and which elements each thread evaluates for them.

use super::assembly::take_places;
use super::terms::{Layout, Term};
use super::ties::Tied;
use super::unknowns::Unknowns;
use crate::mesh::Mesh;
use std::iter::repeat_n;
use std::ops::Range;
use std::thread;

/// Marks what has no owner yet.
const NOBODY: u32 = u32::MAX;

/// The shares of all threads.
pub struct Shares {
    shares: Vec<Share>,
    /// Owner of each field unknown.
    owners: Vec<u32>,
    unknowns: Runs,
    entries: Runs,
}

/// What one thread does.
struct Share {
    /// Integrals on the batches of elements that reach its unknowns.
    terms: Vec<Term>,
    /// Sums for all unknowns, some of them its own.
    sums: Vec<f64>,
    /// Matrix values, some of them its own; behind them one for all the others.
    values: Vec<f64>,
}

impl Shares {
    /// Shares out the nodes of a mesh among `count` threads, and with them integrals; [`Self::locate`] is to follow.
    pub fn new(count: usize, terms: &[Term], mesh: &Mesh, unknowns: &Unknowns, ties: &[Tied]) -> Self {
        let owners = owners_of_unknowns(unknowns, ties, &owners_of_nodes(count, mesh));
        let share = |owner: usize| Share {
            terms: terms.iter().map(|term| term.part(|u| owners[u as usize] == owner as u32)).collect(),
            sums: vec![0.0; unknowns.length],
            values: Vec::new(),
        };
        Self {
            shares: (0..count).map(share).collect(),
            unknowns: Runs::of(&owners),
            owners,
            entries: Runs::default(),
        }
    }

    /// Looks up where the tangents go: entries of columns that a thread does not own behind all others.
    pub fn locate(&mut self, layout: Layout<'_>) {
        let mut columns = vec![NOBODY; layout.pattern.size()];
        for (&equation, &owner) in layout.equations.iter().zip(&self.owners) {
            if let Some(column) = columns.get_mut(equation as usize) {
                *column = owner;
            }
        }
        let entries = |(k, &owner): (usize, &u32)| repeat_n(owner, layout.pattern.column(k).len());
        let mut owners: Vec<u32> = columns.iter().enumerate().flat_map(entries).chain([0]).collect();
        owners.extend_from_within(..layout.length - owners.len());
        for (owner, share) in self.shares.iter_mut().enumerate() {
            let own = |place: u32| owners[place as usize] == owner as u32;
            share.values = vec![0.0; layout.length + 1];
            for term in &mut share.terms {
                term.locate(layout);
                term.redirect(|place| if own(place) { place } else { layout.length as u32 });
            }
        }
        self.entries = Runs::of(&owners);
    }

    /// Takes the places of the tangents from the same shares of the same cells.
    pub fn take_places(&mut self, from: &mut Self) {
        for (share, from) in self.shares.iter_mut().zip(&mut from.shares) {
            take_places(&mut share.terms, &mut from.terms);
            share.values = std::mem::take(&mut from.values);
        }
        self.entries = std::mem::take(&mut from.entries);
    }

    /// Lets every thread do a job on its terms and adds what belongs to it to `sums` and, unless there are none, `values`.
    pub fn run(
        &mut self,
        sums: &mut [f64],
        values: &mut [f64],
        job: &(impl Fn(&mut [Term], &mut [f64], &mut [f64]) + Sync),
    ) {
        let count = self.shares.len();
        let parts = self.unknowns.deal(count, sums).into_iter().zip(self.entries.deal(count, values));
        let mut work = self.shares.iter_mut().zip(parts);
        thread::scope(|scope| {
            let first = work.next();
            work.for_each(|(share, parts)| drop(scope.spawn(move || share.run(parts, job))));
            first.into_iter().for_each(|(share, parts)| share.run(parts, job));
        });
    }
}

impl Share {
    fn run(
        &mut self,
        (mut sums, mut values): (Own<'_>, Own<'_>),
        job: &impl Fn(&mut [Term], &mut [f64], &mut [f64]),
    ) {
        self.sums.fill(0.0);
        for (start, own) in &values {
            self.values[*start..][..own.len()].fill(0.0);
        }
        self.values.last_mut().into_iter().for_each(|other| *other = 0.0);
        job(&mut self.terms, &mut self.sums, &mut self.values);
        hand_over(&self.sums, &mut sums);
        hand_over(&self.values, &mut values);
    }
}

/// Stretches of a vector with one owner each, one after another from its first number on.
#[derive(Default)]
struct Runs(Vec<(Range<usize>, u32)>);

/// Stretches of a vector that belong to one owner, and where they begin.
type Own<'a> = Vec<(usize, &'a mut [f64])>;

impl Runs {
    /// Stretches of numbers with these owners.
    fn of(owners: &[u32]) -> Self {
        let mut end = 0;
        let run = |run: &[u32]| {
            let start = end;
            end += run.len();
            (start..end, run[0])
        };
        Self(owners.chunk_by(|a, b| a == b).map(run).collect())
    }

    /// Hands a vector out to its owners; nothing of an empty one.
    fn deal<'a>(&self, owners: usize, mut vector: &'a mut [f64]) -> Vec<Own<'a>> {
        let mut parts: Vec<Own<'a>> = (0..owners).map(|_| Vec::new()).collect();
        for (range, owner) in &self.0 {
            let Some((own, rest)) = vector.split_at_mut_checked(range.len()) else { break };
            parts[*owner as usize].push((range.start, own));
            vector = rest;
        }
        parts
    }
}

fn hand_over(from: &[f64], to: &mut Own<'_>) {
    for (start, own) in to {
        own.iter_mut().zip(&from[*start..]).for_each(|(sum, number)| *sum += number);
    }
}

/// Owner of each node: cells of every region are split evenly along their order, which keeps neighbours together, and a node belongs to the first cell
/// at it. Nodes of paths without cells are split along their numbers.
fn owners_of_nodes(count: usize, mesh: &Mesh) -> Vec<u32> {
    let mut owners = vec![NOBODY; mesh.nodes.len()];
    let mut cells = mesh.cells.iter();
    for region in mesh.cell_region.chunk_by(|a, b| a == b) {
        for (k, cell) in cells.by_ref().take(region.len()).enumerate() {
            for &node in cell {
                let owner = &mut owners[node as usize];
                *owner = (*owner).min((k * count / region.len()) as u32);
            }
        }
    }
    let nodes = owners.len();
    for (k, owner) in owners.iter_mut().enumerate().filter(|(_, owner)| **owner == NOBODY) {
        *owner = (k * count / nodes) as u32;
    }
    owners
}

/// Owner of each field unknown; tied ones belong to the owners of their partners, whose columns they share.
fn owners_of_unknowns(unknowns: &Unknowns, ties: &[Tied], of_nodes: &[u32]) -> Vec<u32> {
    let of_field = unknowns.fields.iter().flat_map(|field| {
        field.nodes.iter().flat_map(|&node| repeat_n(of_nodes[node as usize], field.components))
    });
    let mut owners: Vec<u32> = of_field.collect();
    ties.iter().for_each(|tied| owners[tied.unknown] = owners[tied.partner]);
    owners
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::structured_rectangle;

    #[test]
    fn nodes_are_shared_out_evenly_with_short_seams() {
        let mesh = structured_rectangle(24, 24, |x, y| [x, y]);
        let owners = owners_of_nodes(3, &mesh);
        for owner in 0..3 {
            let own = owners.iter().filter(|&&of| of == owner).count() as f64;
            assert!((own / owners.len() as f64 - 1.0 / 3.0).abs() < 0.05, "{own} nodes");
            let reached = mesh.cells.iter().filter(|cell| cell.iter().any(|&n| owners[n as usize] == owner));
            // Two straight cuts through the square touch 2 * 48 cells on either side.
            let seam = reached.count() as f64 - mesh.cells.len() as f64 / 3.0;
            assert!(seam < 96.0, "{seam} cells are evaluated twice");
        }
    }

    #[test]
    fn stretches_go_to_their_owners() {
        let mut vector = [1.0, 2.0, 3.0, 4.0];
        let runs = Runs::of(&[1, 1, 0, 1]);
        let parts = runs.deal(2, &mut vector);
        assert_eq!(parts, [vec![(2, &mut [3.0][..])], vec![(0, &mut [1.0, 2.0][..]), (3, &mut [4.0][..])]]);
    }
}
