//! Groups of columns that are eliminated together, merged as long as a model of the time says that it pays.
//!
//! Columns of equal structure form a group without any additional entry. Merging a group into its parent stores and computes
//! with zeros, but saves the assembly of a front and makes the dense blocks larger.

use crate::pattern::Kind;
use crate::tree::{EliminationTree, NONE, postorder};

/// Time of a front that does not depend on its size \[ns\].
const FRONT: f64 = 400.0;
/// Time to clear, assemble and pass on one entry of a front \[ns\].
const ENTRY: f64 = 0.8;
/// Time of one operation in a dense block \[ns\].
pub(crate) const OPERATION: f64 = 0.04;
/// Largest share of additional entries in a front of more than [`SMALL`] columns.
const FILL: f64 = 0.25;
/// Columns up to which additional entries do not matter.
const SMALL: usize = 24;

/// Columns that are eliminated together and how many rows they have below.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    /// Columns.
    pub width: usize,
    /// Rows below the square block of the columns.
    pub below: usize,
}

impl Size {
    /// Floating-point operations of a partial factorisation.
    pub fn operations(self, kind: Kind) -> f64 {
        let (k, m) = (self.width as f64, self.below as f64);
        let lu = k * k * k * (2.0 / 3.0) + 2.0 * k * m * (k + m);
        match kind {
            Kind::Symmetric => 0.5 * lu,
            Kind::Unsymmetric => lu,
        }
    }

    /// Entries of the lower triangle of the columns.
    fn entries(self) -> f64 {
        let (k, m) = (self.width as f64, self.below as f64);
        k * (0.5 * k + m)
    }

    /// Estimated time of assembly and elimination \[ns\].
    pub fn time(self, kind: Kind) -> f64 {
        let rows = (self.width + self.below) as f64;
        FRONT + ENTRY * rows * rows + OPERATION * self.operations(kind)
    }
}

/// Groups of columns in a postorder of their tree.
pub(crate) struct Supernodes {
    /// Node eliminated at every turn.
    pub order: Vec<u32>,
    /// First turn of every group; one more than there are groups.
    pub starts: Vec<u32>,
    /// Parent of every group, [`NONE`] at the roots.
    pub parents: Vec<u32>,
    /// Rows below every group.
    pub below: Vec<u32>,
}

impl Supernodes {
    /// Groups of the columns of a tree.
    pub fn new(tree: &EliminationTree, kind: Kind) -> Self {
        let mut groups = Groups::without_fill(tree);
        groups.merge(kind);
        groups.arrange(tree)
    }

    /// Floating-point operations of a factorisation.
    pub fn operations(&self, kind: Kind) -> f64 {
        let widths = self.starts.windows(2).map(|range| (range[1] - range[0]) as usize);
        let sizes = widths.zip(&self.below).map(|(width, &below)| Size { width, below: below as usize });
        sizes.map(|size| size.operations(kind)).sum()
    }
}

/// Groups while they are merged; a merged group keeps its place in the arrays.
struct Groups {
    /// First turn of every group; one more than there are groups.
    starts: Vec<u32>,
    parents: Vec<u32>,
    sizes: Vec<Size>,
    /// Entries that are not additional zeros.
    entries: Vec<f64>,
    /// Group that a group was merged into, itself if none.
    merged: Vec<u32>,
}

impl Groups {
    /// Chains of columns each of which has the structure of the next and the next itself.
    fn without_fill(tree: &EliminationTree) -> Self {
        let size = tree.order.len();
        let chained = |k: usize| tree.parents[k - 1] == k as u32 && tree.counts[k - 1] == tree.counts[k] + 1;
        let (mut starts, mut group_of) = (vec![0], Vec::with_capacity(size));
        for k in 0..size {
            if k > 0 && !chained(k) {
                starts.push(k as u32);
            }
            group_of.push(starts.len() as u32 - 1);
        }
        starts.push(size as u32);
        let last = |range: &[u32]| range[1] as usize - 1;
        let parent = |range: &[u32]| match tree.parents[last(range)] {
            NONE => NONE,
            parent => group_of[parent as usize],
        };
        let size_of = |range: &[u32]| Size {
            width: (range[1] - range[0]) as usize,
            below: tree.counts[last(range)] as usize - 1,
        };
        let parents: Vec<u32> = starts.windows(2).map(parent).collect();
        let sizes: Vec<Size> = starts.windows(2).map(size_of).collect();
        Self {
            merged: (0..parents.len() as u32).collect(),
            entries: sizes.iter().map(|size| size.entries()).collect(),
            starts,
            parents,
            sizes,
        }
    }

    /// Merges children into parents, from the leaves to the roots.
    fn merge(&mut self, kind: Kind) {
        for (parent, children) in self.children().into_iter().enumerate() {
            for child in children {
                let child = child as usize;
                if let Some(size) = self.worthwhile(child, parent, kind) {
                    self.merged[child] = parent as u32;
                    self.sizes[parent] = size;
                    self.entries[parent] += self.entries[child];
                }
            }
        }
    }

    /// Children of every group, those with the most rows first.
    fn children(&self) -> Vec<Vec<u32>> {
        let mut children = vec![Vec::new(); self.parents.len()];
        for (child, &parent) in self.parents.iter().enumerate().filter(|(_, parent)| **parent != NONE) {
            children[parent as usize].push(child as u32);
        }
        for list in &mut children {
            list.sort_by_key(|&child| std::cmp::Reverse(self.sizes[child as usize].below));
        }
        children
    }

    /// Size after a merger that pays.
    fn worthwhile(&self, child: usize, parent: usize, kind: Kind) -> Option<Size> {
        let (a, b) = (self.sizes[child], self.sizes[parent]);
        let both = Size { width: a.width + b.width, below: b.below };
        let zeros = both.entries() - self.entries[child] - self.entries[parent];
        let few = both.width <= SMALL || zeros <= FILL * both.entries();
        (few && both.time(kind) <= a.time(kind) + b.time(kind)).then_some(both)
    }

    /// Numbers what is left so that the largest remainders are passed on first, and its columns after each other.
    fn arrange(mut self, tree: &EliminationTree) -> Supernodes {
        for group in (0..self.merged.len()).rev() {
            self.merged[group] = self.merged[self.merged[group] as usize];
        }
        let kept: Vec<u32> =
            (0..self.merged.len() as u32).filter(|&g| self.merged[g as usize] == g).collect();
        let mut number = vec![NONE; self.merged.len()];
        kept.iter().enumerate().for_each(|(new, &old)| number[old as usize] = new as u32);
        let parent = |&group: &u32| match self.parents[group as usize] {
            NONE => NONE,
            parent => number[self.merged[parent as usize] as usize],
        };
        let parents: Vec<u32> = kept.iter().map(parent).collect();
        let sizes: Vec<Size> = kept.iter().map(|&group| self.sizes[group as usize]).collect();
        let post = postorder(&parents, urgency(&parents, &sizes));
        let mut members = vec![Vec::new(); kept.len()];
        for (group, &into) in self.merged.iter().enumerate() {
            members[number[into as usize] as usize].push(group);
        }
        let turn = crate::pattern::inverse(&post);
        let (mut order, mut starts) = (Vec::with_capacity(tree.order.len()), vec![0]);
        for &group in &post {
            for &member in &members[group as usize] {
                let turns = self.starts[member] as usize..self.starts[member + 1] as usize;
                order.extend_from_slice(&tree.order[turns]);
            }
            starts.push(order.len() as u32);
        }
        let renumbered = |&group: &u32| match parents[group as usize] {
            NONE => NONE,
            parent => turn[parent as usize],
        };
        let below = post.iter().map(|&group| sizes[group as usize].below as u32).collect();
        Supernodes { order, starts, parents: post.iter().map(renumbered).collect(), below }
    }
}

/// Key by which siblings are visited so that few remainders wait at a time (Liu 1986, *On the storage requirement in the
/// out-of-core multifrontal method*, ACM Trans. Math. Softw. 12): the largest difference between peak and remainder first.
fn urgency(parents: &[u32], sizes: &[Size]) -> impl Fn(usize) -> i64 + use<> {
    let remainder = |k: usize| (sizes[k].below * sizes[k].below) as i64;
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); sizes.len()];
    let mut peaks = vec![0_i64; sizes.len()];
    for k in 0..sizes.len() {
        let mut mine = std::mem::take(&mut children[k]);
        mine.sort_by_key(|&c| (remainder(c) - peaks[c], c));
        let mut waiting = 0;
        for c in mine {
            peaks[k] = peaks[k].max(waiting + peaks[c]);
            waiting += remainder(c);
        }
        peaks[k] = peaks[k].max(waiting + remainder(k));
        if parents[k] != NONE {
            children[parents[k] as usize].push(k);
        }
    }
    let keys: Vec<i64> = (0..sizes.len()).map(|k| remainder(k) - peaks[k]).collect();
    move |k| keys[k]
}
