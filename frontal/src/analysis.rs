//! Everything about a factorisation that does not depend on values.

use crate::error::Error;
use crate::ordering::{Effort, best_supernodes};
use crate::pattern::{Graph, Kind, Pattern, inverse};
use crate::schedule::Schedule;
use crate::supernodes::{OPERATION, Size, Supernodes};
use crate::tree::NONE;
use std::ops::Range;

/// Time of a thorough analysis for each unknown \[ns\].
const DISSECTION: f64 = 6000.0;
/// It is tried once factorisations took so many times longer than it would: where a quarter is saved, that many more pay for it.
const PAYS: f64 = 4.0;

/// Rows of the blocks below the diagonal come in multiples of this, so that vectors have no remainder.
pub(crate) const PADDING: usize = 8;

/// Elimination order, structure of the factors and the memory they need.
#[derive(Clone, Debug)]
pub struct Analysis {
    pub(crate) kind: Kind,
    effort: Effort,
    pub(crate) order: Vec<u32>,
    pub(crate) fronts: Vec<Front>,
    /// Rows below all fronts, as turns of elimination.
    pub(crate) rows: Vec<u32>,
    /// For every entry of `rows`, where it lies in the parent: in its columns, or in its rows below.
    pub(crate) targets: Vec<u32>,
    pub(crate) children: Vec<u32>,
    /// Entry of the matrix and place in the front it goes to.
    pub(crate) entries: Vec<(u32, u32)>,
    /// Numbers in the factors.
    pub(crate) values: usize,
    operations: f64,
}

/// One dense step of the elimination: some columns, and the rows below that they update.
///
/// Its numbers are the square block of the columns, the rows below, and for LU the columns on the right, transposed; all
/// three column after column. What is left for the rows below is its remainder.
#[derive(Clone, Debug)]
pub(crate) struct Front {
    /// First column.
    pub first: usize,
    /// Number of columns.
    pub width: usize,
    /// Range in [`Analysis::rows`].
    pub rows: Range<usize>,
    /// Range in [`Analysis::children`].
    pub children: Range<usize>,
    /// Range in [`Analysis::entries`].
    pub entries: Range<usize>,
    /// Range in the values of the factors.
    pub values: Range<usize>,
    /// Rows below that are columns of the parent.
    pub passed: usize,
}

impl Front {
    /// Rows below.
    pub fn below(&self) -> usize {
        self.rows.len()
    }

    /// Rows below, padding included.
    pub fn padded(&self) -> usize {
        self.below().next_multiple_of(PADDING)
    }

    /// Numbers in the remainder.
    pub fn remainder(&self) -> usize {
        self.padded() * self.below()
    }
}

impl Analysis {
    /// Orders a pattern and finds the structure of its factors.
    ///
    /// `weak` lists the unknowns without a diagonal entry, such as the pressures of an incompressible flow.
    ///
    /// # Errors
    /// [`Error::NoEquations`], [`Error::TooLarge`].
    ///
    /// # Panics
    /// When the pattern names rows beyond its size.
    pub fn new(pattern: Pattern<'_>, weak: &[u32]) -> Result<Self, Error> {
        Self::with_effort(pattern, weak, Effort::Quick)
    }

    /// As [`Self::new`], with nested dissection where that takes fewer operations: the better order for many factorisations.
    ///
    /// # Errors
    /// As [`Self::new`].
    ///
    /// # Panics
    /// As [`Self::new`].
    pub fn thorough(pattern: Pattern<'_>, weak: &[u32]) -> Result<Self, Error> {
        Self::with_effort(pattern, weak, Effort::Thorough)
    }

    fn with_effort(pattern: Pattern<'_>, weak: &[u32], effort: Effort) -> Result<Self, Error> {
        if pattern.size() == 0 {
            return Err(Error::NoEquations);
        }
        let graph = Graph::of(pattern);
        let supernodes = best_supernodes(&graph, pattern.kind, weak, effort)?;
        let analysis = Self::from_supernodes(pattern, &graph, supernodes)?;
        Ok(Self { effort, ..analysis })
    }

    fn from_supernodes(pattern: Pattern<'_>, graph: &Graph, supernodes: Supernodes) -> Result<Self, Error> {
        let place = inverse(&supernodes.order);
        let mut analysis = Self {
            kind: pattern.kind,
            effort: Effort::Quick,
            fronts: fronts(&supernodes),
            rows: Vec::with_capacity(supernodes.below.iter().map(|&m| m as usize).sum()),
            targets: Vec::new(),
            children: Vec::new(),
            entries: Vec::new(),
            values: 0,
            operations: 0.0,
            order: supernodes.order,
        };
        analysis.list_children(&supernodes.parents);
        analysis.find_rows(graph, &place);
        analysis.values = analysis.fronts.last().map_or(0, |front| front.values.end);
        if analysis.values > u32::MAX as usize * PADDING {
            return Err(Error::TooLarge);
        }
        analysis.find_targets();
        analysis.place_entries(pattern, &place);
        let size = |front: &Front| Size { width: front.width, below: front.below() };
        analysis.operations = analysis.fronts.iter().map(|f| size(f).operations(pattern.kind)).sum();
        Ok(analysis)
    }

    /// Number of equations.
    pub fn size(&self) -> usize {
        self.order.len()
    }

    /// What is factored.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Original number of the equation to eliminate at each turn.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Numbers stored in the factors, padding included.
    pub fn factor_entries(&self) -> usize {
        self.values
    }

    /// Floating-point operations of a factorisation.
    pub fn operations(&self) -> f64 {
        self.operations
    }

    /// Whether so many factorisations took so long that a better order, if there is one, would soon have paid for itself. It depends on counted
    /// operations, not on times.
    pub(crate) fn deserves_effort(&self, factorisations: usize) -> bool {
        let spent = factorisations as f64 * self.operations * OPERATION;
        self.effort == Effort::Quick && spent > PAYS * DISSECTION * self.size() as f64
    }

    /// Bytes that this analysis and the factors take at most, on some number of threads.
    pub fn memory(&self, threads: usize) -> usize {
        let stacks = Schedule::new(self, threads).stacks;
        let numbers = self.values + stacks.as_flattened().iter().sum::<usize>();
        let indices = self.rows.len() + self.targets.len() + 2 * self.entries.len();
        8 * numbers + 4 * indices + std::mem::size_of::<Front>() * self.fronts.len()
    }

    /// Children of a front, in order.
    pub(crate) fn children(&self, front: &Front) -> impl DoubleEndedIterator<Item = usize> + Clone + use<'_> {
        self.children[front.children.clone()].iter().map(|&child| child as usize)
    }

    fn list_children(&mut self, parents: &[u32]) {
        let mut lists: Vec<u32> =
            (0..parents.len() as u32).filter(|&k| parents[k as usize] != NONE).collect();
        lists.sort_by_key(|&k| (parents[k as usize], k));
        let mut begin = 0;
        for (k, front) in self.fronts.iter_mut().enumerate() {
            let count = lists[begin..].iter().take_while(|&&c| parents[c as usize] == k as u32).count();
            front.children = begin..begin + count;
            begin += count;
        }
        self.children = lists;
    }

    /// Rows below every front: those of its children and those of the matrix.
    fn find_rows(&mut self, graph: &Graph, place: &[u32]) {
        let mut seen = vec![NONE; self.order.len()];
        for k in 0..self.fronts.len() {
            let (begin, front) = (self.rows.len(), &self.fronts[k]);
            let end = front.first + front.width;
            let mut add = |rows: &mut Vec<u32>, row: u32| {
                if row as usize >= end && seen[row as usize] != k as u32 {
                    seen[row as usize] = k as u32;
                    rows.push(row);
                }
            };
            for &node in &self.order[front.first..end] {
                graph
                    .around(node as usize)
                    .iter()
                    .for_each(|&other| add(&mut self.rows, place[other as usize]));
            }
            for &child in &self.children[front.children.clone()] {
                for k in self.fronts[child as usize].rows.clone() {
                    let row = self.rows[k];
                    add(&mut self.rows, row);
                }
            }
            self.rows[begin..].sort_unstable();
            let blocks = if self.kind == Kind::Symmetric { 1 } else { 2 };
            let offset = if k == 0 { 0 } else { self.fronts[k - 1].values.end };
            let front = &mut self.fronts[k];
            front.rows = begin..self.rows.len();
            let length = front.width * (front.width + blocks * front.padded());
            front.values = offset..offset + length.next_multiple_of(PADDING);
        }
    }

    /// Where the rows of every remainder lie in the parent.
    fn find_targets(&mut self) {
        let mut local = vec![0; self.order.len()];
        self.targets = vec![0; self.rows.len()];
        for k in 0..self.fronts.len() {
            let front = &self.fronts[k];
            let (first, end) = (front.first, front.first + front.width);
            let below = self.rows[front.rows.clone()].iter();
            below.enumerate().for_each(|(i, &row)| local[row as usize] = i as u32);
            for child in front.children.clone() {
                let child = &mut self.fronts[self.children[child] as usize];
                let rows = &self.rows[child.rows.clone()];
                child.passed = rows.partition_point(|&row| (row as usize) < end);
                for (target, &row) in self.targets[child.rows.clone()].iter_mut().zip(rows) {
                    let row = row as usize;
                    *target = if row < end { (row - first) as u32 } else { local[row] };
                }
            }
        }
    }

    /// Where the entries of the matrix go.
    fn place_entries(&mut self, pattern: Pattern<'_>, place: &[u32]) {
        let mut front_of = vec![0_u32; self.order.len()];
        for (k, front) in self.fronts.iter().enumerate() {
            front_of[front.first..front.first + front.width].fill(k as u32);
        }
        let owner = |row: usize, column: usize| front_of[place[row].min(place[column]) as usize] as usize;
        // In the order of elimination, fronts and entries that belong together are near each other in memory.
        let mut next = vec![0; self.fronts.len() + 1];
        for_each_by_turn(pattern, &self.order, |_, row, column| next[owner(row, column) + 1] += 1);
        for (k, front) in self.fronts.iter_mut().enumerate() {
            next[k + 1] += next[k];
            front.entries = next[k]..next[k + 1];
        }
        let mut entries = vec![(0, 0); pattern.rows.len()];
        for_each_by_turn(pattern, &self.order, |position, row, column| {
            let k = owner(row, column);
            let target = self.position(&self.fronts[k], place[row] as usize, place[column] as usize);
            entries[next[k]] = (position as u32, target as u32);
            next[k] += 1;
        });
        self.entries = entries;
    }

    /// Position among the values of a front of an entry that belongs to it.
    fn position(&self, front: &Front, row: usize, column: usize) -> usize {
        let (row, column) = match self.kind {
            Kind::Symmetric => (row.max(column), row.min(column)),
            Kind::Unsymmetric => (row, column),
        };
        let (first, width, padded) = (front.first, front.width, front.padded());
        let below =
            |turn: usize| self.rows[front.rows.clone()].partition_point(|&other| (other as usize) < turn);
        match (row < first + width, column < first + width) {
            (true, true) => row - first + (column - first) * width,
            (false, _) => width * width + below(row) + (column - first) * padded,
            (true, false) => width * (width + padded) + below(column) + (row - first) * padded,
        }
    }
}

/// Calls `visit(position, row, column)` for every entry, columns in the order of their elimination.
fn for_each_by_turn(pattern: Pattern<'_>, order: &[u32], mut visit: impl FnMut(usize, usize, usize)) {
    for &column in order {
        let column = column as usize;
        pattern.column(column).for_each(|position| visit(position, pattern.rows[position] as usize, column));
    }
}

/// Fronts of which only the columns are known.
fn fronts(supernodes: &Supernodes) -> Vec<Front> {
    let front = |range: &[u32]| Front {
        first: range[0] as usize,
        width: (range[1] - range[0]) as usize,
        rows: 0..0,
        children: 0..0,
        entries: 0..0,
        values: 0..0,
        passed: 0,
    };
    supernodes.starts.windows(2).map(front).collect()
}
