//! Who eliminates which fronts, and where their remainders wait.
//!
//! Separate subtrees of fronts are independent: every thread gets some, and the fronts above them follow on one thread, the
//! large ones with the help of the others.

use crate::analysis::Analysis;
use crate::supernodes::Size;
use std::ops::Range;

/// How often a subtree is split in the search for a good distribution, for each thread.
const SPLITS: usize = 16;
/// Work above the subtrees counts this much more, for only parts of it are shared.
const ABOVE: f64 = 0.7;

/// Distribution of the fronts over sites, each with two stacks of remainders.
#[derive(Clone, Debug)]
pub(crate) struct Schedule {
    /// Fronts of every site in order; the last site follows when the others are done.
    pub sites: Vec<Vec<u32>>,
    /// Where the remainder of every front waits for its parent.
    pub places: Vec<Place>,
    /// Numbers on the stacks of every site.
    pub stacks: Vec<[usize; 2]>,
}

/// A place for a remainder.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Place {
    pub site: usize,
    /// The parity of the front's depth: while a front is assembled, the remainders of its children lie on top of one stack
    /// and its own grows on the other.
    pub stack: usize,
    pub offset: usize,
}

impl Schedule {
    /// Fronts for some threads; everything on the last site if there is one thread only.
    pub fn new(analysis: &Analysis, threads: usize) -> Self {
        let count = analysis.fronts.len();
        let mut places = vec![Place::default(); count];
        for (k, front) in analysis.fronts.iter().enumerate().rev() {
            let stack = 1 - places[k].stack;
            analysis.children(front).for_each(|child| places[child].stack = stack);
        }
        let shares = if threads > 1 { Subtrees::new(analysis).distribute(threads) } else { Vec::new() };
        places.iter_mut().for_each(|place| place.site = shares.len());
        for (site, share) in shares.iter().enumerate() {
            for subtree in share {
                places[subtree.clone()].iter_mut().for_each(|place| place.site = site);
            }
        }
        let mut sites = vec![Vec::new(); shares.len() + 1];
        places.iter().enumerate().for_each(|(k, place)| sites[place.site].push(k as u32));
        let mut schedule = Self { stacks: vec![[0; 2]; sites.len()], sites, places };
        schedule.place_remainders(analysis);
        schedule
    }

    fn place_remainders(&mut self, analysis: &Analysis) {
        let mut tops = vec![[0; 2]; self.sites.len()];
        for (k, front) in analysis.fronts.iter().enumerate() {
            let Place { site, stack, .. } = self.places[k];
            if let Some(child) = analysis.children(front).find(|&child| self.places[child].site == site) {
                tops[site][1 - stack] = self.places[child].offset;
            }
            self.places[k].offset = tops[site][stack];
            tops[site][stack] += front.remainder();
            self.stacks[site][stack] = self.stacks[site][stack].max(tops[site][stack]);
        }
    }
}

/// Disjoint subtrees, and the work on the fronts above them.
struct Subtrees<'a> {
    analysis: &'a Analysis,
    /// First front of the subtree that ends with every front.
    begin: Vec<usize>,
    /// Work on the whole subtree of every front.
    work: Vec<f64>,
    roots: Vec<usize>,
    above: f64,
}

impl<'a> Subtrees<'a> {
    /// The whole trees.
    fn new(analysis: &'a Analysis) -> Self {
        let count = analysis.fronts.len();
        let (mut begin, mut work, mut is_root) =
            (Vec::with_capacity(count), vec![0.0; count], vec![true; count]);
        for (k, front) in analysis.fronts.iter().enumerate() {
            begin.push(analysis.children(front).next().map_or(k, |child| begin[child]));
            work[k] = Size { width: front.width, below: front.below() }.time(analysis.kind);
            for child in analysis.children(front) {
                work[k] += work[child];
                is_root[child] = false;
            }
        }
        let roots = (0..count).filter(|&k| is_root[k]).collect();
        Self { analysis, begin, work, roots, above: 0.0 }
    }

    /// Subtrees for every thread, split as far as it shortens the estimated time.
    fn distribute(mut self, threads: usize) -> Vec<Vec<Range<usize>>> {
        let (mut best, mut shortest) = (Vec::new(), f64::INFINITY);
        for _ in 0..SPLITS * threads {
            let (shares, longest) = self.deal(threads);
            let time = longest + ABOVE * self.above;
            if time < shortest {
                (best, shortest) = (shares, time);
            }
            if !self.split_largest() {
                break;
            }
        }
        best
    }

    /// The largest subtree first, each to the thread with the least work so far; also the most work of a thread.
    fn deal(&self, threads: usize) -> (Vec<Vec<Range<usize>>>, f64) {
        let mut roots = self.roots.clone();
        roots.sort_by(|&a, &b| self.work[b].total_cmp(&self.work[a]).then(a.cmp(&b)));
        let (mut shares, mut loads) = (vec![Vec::new(); threads], vec![0.0; threads]);
        for root in roots {
            let least = (0..threads).fold(0, |least, k| if loads[k] < loads[least] { k } else { least });
            shares[least].push(self.begin[root]..root + 1);
            loads[least] += self.work[root];
        }
        (shares, loads.into_iter().fold(0.0, f64::max))
    }

    /// Replaces the largest subtree by those of its children.
    fn split_largest(&mut self) -> bool {
        let largest = (0..self.roots.len())
            .max_by(|&a, &b| self.work[self.roots[a]].total_cmp(&self.work[self.roots[b]]));
        let Some(largest) = largest else { return false };
        let root = self.roots.swap_remove(largest);
        let children = self.analysis.children(&self.analysis.fronts[root]);
        let below: f64 = children.clone().map(|child| self.work[child]).sum();
        self.above += self.work[root] - below;
        self.roots.extend(children);
        true
    }
}
