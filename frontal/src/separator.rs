//! Small sets of nodes that separate a graph in two parts of about the same size.
//!
//! Pairs of neighbours are drawn together until the graph is small; there a separator is found by growing one part from a node far out, and on the
//! way back to the whole graph it is made smaller, node by node, as of Fiduccia and Mattheyses. Hendrickson and Rothberg (1998),
//! *Improving the run time and quality of nested dissection ordering*, SIAM J. Sci. Comput. 20.

use crate::pattern::Graph;
use std::collections::BinaryHeap;

/// Nodes of a graph that is not drawn together any further.
const COARSEST: usize = 100;
/// A graph that shrinks by less than this factor is not drawn together any further either.
const SHRINKS: f64 = 0.9;
/// Nodes from which the first part is grown on the coarsest graph.
const TRIALS: usize = 8;
/// Largest share of the nodes on one side.
const LARGEST_SIDE: f64 = 0.58;
/// Moves without a better separator after which a pass ends.
const PATIENCE: usize = 80;
/// Passes over a separator.
const PASSES: usize = 6;

/// Where a node belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Left,
    Right,
    Separator,
}

impl Part {
    fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
            Self::Separator => Self::Separator,
        }
    }
}

/// A graph whose nodes, and edges, stand for several.
pub(crate) struct Weighted {
    graph: Graph,
    weights: Vec<u32>,
    /// Weight of each of the graph's edges.
    edges: Vec<u32>,
}

/// The part of every node: a separator that is light, and two sides of similar weight without an edge between them.
pub(crate) fn separate(whole: &Weighted) -> Vec<Part> {
    let mut levels: Vec<(Weighted, Vec<u32>)> = Vec::new();
    loop {
        let finest = levels.last().map_or(whole, |(coarse, _)| coarse);
        if finest.graph.size() <= COARSEST {
            break;
        }
        let (coarse, group_of) = finest.drawn_together();
        if coarse.graph.size() as f64 > SHRINKS * finest.graph.size() as f64 {
            break;
        }
        levels.push((coarse, group_of));
    }
    let mut parts = levels.last().map_or(whole, |(coarse, _)| coarse).first_separator();
    for k in (0..levels.len()).rev() {
        let finer = if k == 0 { whole } else { &levels[k - 1].0 };
        parts = levels[k].1.iter().map(|&group| parts[group as usize]).collect();
        Cut::new(finer, &mut parts).improve();
    }
    parts
}

impl Weighted {
    /// A graph with edges of weight one.
    pub fn new(graph: Graph, weights: Vec<u32>) -> Self {
        Self { edges: vec![1; graph.neighbours.len()], graph, weights }
    }

    fn total(&self) -> u32 {
        self.weights.iter().sum()
    }

    /// Neighbours of a node with the weights of the edges to them.
    fn edges_of(&self, node: usize) -> impl Iterator<Item = (u32, u32)> + '_ {
        let range = self.graph.starts[node] as usize..self.graph.starts[node + 1] as usize;
        range.map(|k| (self.graph.neighbours[k], self.edges[k]))
    }

    /// The graph of pairs of neighbours along heavy edges, and the pair of every node.
    fn drawn_together(&self) -> (Self, Vec<u32>) {
        let size = self.graph.size();
        let mut group_of = vec![u32::MAX; size];
        let mut firsts: Vec<(u32, u32)> = Vec::new();
        // Nodes with few neighbours first: they have the least choice.
        let mut turns: Vec<u32> = (0..size as u32).collect();
        turns.sort_by_key(|&node| self.graph.around(node as usize).len());
        for node in turns {
            if group_of[node as usize] != u32::MAX {
                continue;
            }
            let free =
                self.edges_of(node as usize).filter(|(other, _)| group_of[*other as usize] == u32::MAX);
            let lightest = |other: u32| std::cmp::Reverse((self.weights[other as usize], other));
            let mate = free
                .max_by_key(|&(other, weight)| (weight, lightest(other)))
                .map_or(node, |(other, _)| other);
            let group = firsts.len() as u32;
            group_of[node as usize] = group;
            group_of[mate as usize] = group;
            firsts.push((node, mate));
        }
        (self.grouped(&firsts, &group_of), group_of)
    }

    /// The graph of groups of one or two nodes.
    fn grouped(&self, groups: &[(u32, u32)], group_of: &[u32]) -> Self {
        let (mut graph, mut edges) = (Graph { starts: vec![0], neighbours: Vec::new() }, Vec::new());
        let mut place = vec![u32::MAX; groups.len()];
        let mut weights = Vec::with_capacity(groups.len());
        for (group, &(first, second)) in groups.iter().enumerate() {
            let begin = graph.neighbours.len();
            let members = if first == second { &[first][..] } else { &[first, second] };
            weights.push(members.iter().map(|&node| self.weights[node as usize]).sum());
            for (other, weight) in members.iter().flat_map(|&node| self.edges_of(node as usize)) {
                let neighbour = group_of[other as usize];
                if neighbour as usize == group {
                    continue;
                }
                let known = &mut place[neighbour as usize];
                if *known == u32::MAX || (*known as usize) < begin {
                    *known = edges.len() as u32;
                    graph.neighbours.push(neighbour);
                    edges.push(weight);
                } else {
                    edges[*known as usize] += weight;
                }
            }
            graph.starts.push(graph.neighbours.len() as u32);
        }
        Self { graph, weights, edges }
    }

    /// The best of some separators, each found by growing one side from a node until it has half of the weight.
    fn first_separator(&self) -> Vec<Part> {
        let size = self.graph.size();
        let mut best: Option<((u32, u32), Vec<Part>)> = None;
        for trial in 0..TRIALS.min(size) {
            let seed = self.farthest_from(trial * size / TRIALS.min(size));
            let mut parts = self.grown_from(seed);
            let mut cut = Cut::new(self, &mut parts);
            cut.improve();
            let cost = cut.cost();
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, parts));
            }
        }
        best.map_or(Vec::new(), |(_, parts)| parts)
    }

    /// The last node of a walk that goes outwards from one.
    fn farthest_from(&self, node: usize) -> usize {
        let mut last = node;
        self.outwards(node, |node| {
            last = node;
            true
        });
        last
    }

    /// Visits nodes by their distance from one, then all that it is not connected with, as long as `visit` wants more.
    fn outwards(&self, from: usize, mut visit: impl FnMut(usize) -> bool) {
        let size = self.graph.size();
        let (mut seen, mut queue, mut next) = (vec![false; size], Vec::with_capacity(size), 0);
        for start in std::iter::once(from).chain(0..size) {
            if !std::mem::replace(&mut seen[start], true) {
                queue.push(start);
            }
            while let Some(&node) = queue.get(next) {
                next += 1;
                if !visit(node) {
                    return;
                }
                for &other in self.graph.around(node) {
                    if !std::mem::replace(&mut seen[other as usize], true) {
                        queue.push(other as usize);
                    }
                }
            }
        }
    }

    /// Half of the weight around a node on the left, and the nodes of the other half that it touches between them.
    fn grown_from(&self, seed: usize) -> Vec<Part> {
        let mut parts = vec![Part::Right; self.graph.size()];
        let (half, mut grown) = (self.total() / 2, 0);
        self.outwards(seed, |node| {
            parts[node] = Part::Left;
            grown += self.weights[node];
            grown < half
        });
        for node in 0..parts.len() {
            let touches = self.graph.around(node).iter().any(|&other| parts[other as usize] == Part::Left);
            if parts[node] == Part::Right && touches {
                parts[node] = Part::Separator;
            }
        }
        parts
    }
}

/// A separator that is being improved.
struct Cut<'a> {
    whole: &'a Weighted,
    parts: &'a mut [Part],
    left: u32,
    right: u32,
    separator: u32,
}

/// A node that went from the separator to a side, and how many others it drew into the separator.
struct Move {
    node: u32,
    to: Part,
    drawn: usize,
}

impl<'a> Cut<'a> {
    fn new(whole: &'a Weighted, parts: &'a mut [Part]) -> Self {
        let mut cut = Self { whole, parts, left: 0, right: 0, separator: 0 };
        for node in 0..cut.parts.len() {
            *cut.side(cut.parts[node]) += whole.weights[node];
        }
        cut
    }

    fn side(&mut self, part: Part) -> &mut u32 {
        match part {
            Part::Left => &mut self.left,
            Part::Right => &mut self.right,
            Part::Separator => &mut self.separator,
        }
    }

    /// Weight of the separator; among equals the difference of the sides.
    fn cost(&self) -> (u32, u32) {
        (self.separator, self.left.abs_diff(self.right))
    }

    fn put(&mut self, node: u32, part: Part) {
        let (node, weight) = (node as usize, self.whole.weights[node as usize]);
        let before = std::mem::replace(&mut self.parts[node], part);
        *self.side(before) -= weight;
        *self.side(part) += weight;
    }

    /// How much lighter the separator gets when a node of it goes to a side.
    fn gain(&self, node: u32, to: Part) -> i64 {
        let drawn =
            self.whole.graph.around(node as usize).iter().filter(|&&o| self.parts[o as usize] == to.other());
        let weight = |node: u32| i64::from(self.whole.weights[node as usize]);
        weight(node) - drawn.map(|&other| weight(other)).sum::<i64>()
    }

    /// Passes until one changes nothing.
    fn improve(&mut self) {
        for _ in 0..PASSES {
            let before = self.cost();
            self.pass();
            if self.cost() >= before {
                break;
            }
        }
    }

    /// Moves nodes out of the separator, the most profitable first and each once; goes back to the best separator met.
    fn pass(&mut self) {
        let limit = (LARGEST_SIDE * f64::from(self.whole.total())) as u32;
        let mut moved = vec![false; self.parts.len()];
        let mut heap = BinaryHeap::new();
        let offers = |cut: &Self, node: u32| {
            [Part::Left, Part::Right].map(|to| (cut.gain(node, to), node, to == Part::Left))
        };
        for node in (0..self.parts.len() as u32).filter(|&node| self.parts[node as usize] == Part::Separator)
        {
            heap.extend(offers(self, node));
        }
        let (mut moves, mut drawn): (Vec<Move>, Vec<u32>) = (Vec::new(), Vec::new());
        let (mut best, mut kept) = (self.cost(), 0);
        while let Some((gain, node, left)) = heap.pop() {
            let to = if left { Part::Left } else { Part::Right };
            if self.parts[node as usize] != Part::Separator || moved[node as usize] {
                continue;
            }
            let present = self.gain(node, to);
            if present != gain {
                if present < gain {
                    heap.push((present, node, left));
                }
                continue;
            }
            if *self.side(to) + self.whole.weights[node as usize] > limit {
                continue;
            }
            moved[node as usize] = true;
            self.put(node, to);
            let begin = drawn.len();
            for &other in self.whole.graph.around(node as usize) {
                if self.parts[other as usize] == to.other() {
                    self.put(other, Part::Separator);
                    drawn.push(other);
                }
            }
            moves.push(Move { node, to, drawn: drawn.len() - begin });
            for &other in &drawn[begin..] {
                heap.extend(offers(self, other));
                // what is left of that side around it is less: its neighbours may go the same way at a smaller price
                for &next in self.whole.graph.around(other as usize) {
                    if self.parts[next as usize] == Part::Separator && !moved[next as usize] {
                        heap.push((self.gain(next, to), next, left));
                    }
                }
            }
            if self.cost() < best {
                (best, kept) = (self.cost(), moves.len());
            } else if moves.len() > kept + PATIENCE {
                break;
            }
        }
        for Move { node, to, drawn: count } in moves.drain(kept..).rev() {
            for other in drawn.split_off(drawn.len() - count) {
                self.put(other, to.other());
            }
            self.put(node, Part::Separator);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `n` by `n` nodes.
    fn grid(n: usize) -> Graph {
        let (mut starts, mut neighbours) = (vec![0], Vec::new());
        for k in 0..n * n {
            let (i, j) = (k % n, k / n);
            let near = [
                (j > 0).then(|| k - n),
                (i > 0).then(|| k - 1),
                (i + 1 < n).then_some(k + 1),
                (j + 1 < n).then_some(k + n),
            ];
            neighbours.extend(near.into_iter().flatten().map(|k| k as u32));
            starts.push(neighbours.len() as u32);
        }
        Graph { starts, neighbours }
    }

    #[test]
    fn a_grid_is_separated_by_about_one_line() {
        for n in [15, 60] {
            let whole = Weighted::new(grid(n), vec![1; n * n]);
            let parts = separate(&whole);
            let count = |part| parts.iter().filter(|&&p| p == part).count();
            // a diagonal would have n nodes too, but none can have fewer with sides like these
            assert!(count(Part::Separator) <= n + n / 4, "{n}: {}", count(Part::Separator));
            assert!(count(Part::Left).max(count(Part::Right)) as f64 <= LARGEST_SIDE * (n * n) as f64);
        }
    }

    #[test]
    fn no_edge_leads_from_side_to_side() {
        let whole = Weighted::new(grid(40), vec![1; 1600]);
        let parts = separate(&whole);
        for node in 0..1600 {
            let across = |&&other: &&u32| {
                parts[node] != Part::Separator && parts[other as usize] == parts[node].other()
            };
            assert_eq!(whole.graph.around(node).iter().find(across), None);
        }
    }
}
