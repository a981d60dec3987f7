//! Unknowns that have the same neighbours, such as the components of a vector at a node, drawn together: an ordering of the
//! smaller graph takes less time and is one of all unknowns.

use crate::pattern::Graph;

/// A graph of groups of nodes that have the same neighbours, each other included.
pub(crate) struct Quotient {
    /// The groups; two are neighbours where their members are.
    pub graph: Graph,
    /// Nodes of the groups one after another, ascending in each.
    members: Vec<u32>,
    /// Start of every group in the members.
    starts: Vec<u32>,
}

impl Quotient {
    /// Groups of the nodes of a graph, in the order of their first members.
    pub fn new(graph: &Graph) -> Self {
        let size = graph.size();
        let keys: Vec<u64> = (0..size).map(|node| key(graph, node)).collect();
        let mut group_of = vec![u32::MAX; size];
        let (mut members, mut starts) = (Vec::with_capacity(size), vec![0]);
        for node in 0..size {
            if group_of[node] != u32::MAX {
                continue;
            }
            let group = starts.len() as u32 - 1;
            members.push(node as u32);
            group_of[node] = group;
            for &other in graph.around(node) {
                let twin = other as usize;
                let alike = twin > node && group_of[twin] == u32::MAX && keys[twin] == keys[node];
                if alike && are_twins(graph, node, twin) {
                    members.push(other);
                    group_of[twin] = group;
                }
            }
            starts.push(members.len() as u32);
        }
        let mut quotient = Self { graph: Graph { starts: vec![0], neighbours: Vec::new() }, members, starts };
        for group in 0..quotient.starts.len() - 1 {
            let first = quotient.members[quotient.starts[group] as usize] as usize;
            for &other in graph.around(first) {
                let neighbour = group_of[other as usize];
                // a group is a neighbour through its first member
                if quotient.members[quotient.starts[neighbour as usize] as usize] == other {
                    quotient.graph.neighbours.push(neighbour);
                }
            }
            quotient.graph.starts.push(quotient.graph.neighbours.len() as u32);
        }
        quotient
    }

    /// Members of a group.
    pub fn members(&self, group: usize) -> &[u32] {
        &self.members[self.starts[group] as usize..self.starts[group + 1] as usize]
    }

    /// Number of members of every group.
    pub fn weights(&self) -> Vec<u32> {
        self.starts.windows(2).map(|range| range[1] - range[0]).collect()
    }

    /// The nodes in the order of their groups.
    pub fn expand(&self, order: &[u32]) -> Vec<u32> {
        order.iter().flat_map(|&group| self.members(group as usize)).copied().collect()
    }
}

/// A number that nodes with the same neighbours share.
fn key(graph: &Graph, node: usize) -> u64 {
    let spread = |node: u32| (u64::from(node) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mix = |sum: u64, &node: &u32| sum.wrapping_add(spread(node) ^ (spread(node) >> 29));
    graph.around(node).iter().chain([&(node as u32)]).fold(0, mix)
}

/// Whether two neighbours have the same other neighbours.
fn are_twins(graph: &Graph, a: usize, b: usize) -> bool {
    let others =
        |node| graph.around(node).iter().filter(|&&other| other as usize != a && other as usize != b);
    others(a).eq(others(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::{Kind, Pattern};

    #[test]
    fn components_at_a_node_are_one_group() {
        // a chain of three nodes with two unknowns each, numbered component by component
        let near = |k: u32, l: u32| (k % 3).abs_diff(l % 3) <= 1;
        let rows: Vec<u32> = (0..6).flat_map(|k| (0..6).filter(move |&l| near(k, l))).collect();
        let counts = (0..6).map(|k| (0..6).filter(|&l| near(k, l)).count() as u32);
        let starts: Vec<u32> = std::iter::once(0)
            .chain(counts.scan(0, |sum, n| {
                *sum += n;
                Some(*sum)
            }))
            .collect();
        let graph = Graph::of(Pattern { kind: Kind::Unsymmetric, starts: &starts, rows: &rows });
        let quotient = Quotient::new(&graph);
        assert_eq!(
            (quotient.weights(), quotient.graph.neighbours.as_slice()),
            (vec![2; 3], [1, 0, 2, 1].as_slice())
        );
        assert_eq!(quotient.expand(&[2, 0, 1]), [2, 5, 0, 3, 1, 4]);
    }
}
