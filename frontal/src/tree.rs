//! The elimination tree: which columns of the factor depend on which, and how long they are.
//!
//! Liu (1990), *The role of elimination trees in sparse factorization*, SIAM J. Matrix Anal. Appl. 11; column counts after Gilbert,
//! Ng and Peyton (1994), *An efficient algorithm to compute row and column counts for sparse Cholesky factorization*, ibid. 15.

use crate::pattern::{Graph, inverse};

/// No parent.
pub(crate) const NONE: u32 = u32::MAX;

/// Elimination tree of a graph whose nodes are eliminated in a postorder of the tree.
pub(crate) struct EliminationTree {
    /// Node eliminated at every turn.
    pub order: Vec<u32>,
    /// Parent of every turn, [`NONE`] at the roots.
    pub parents: Vec<u32>,
    /// Entries in every column of the factor, the diagonal included.
    pub counts: Vec<u32>,
}

impl EliminationTree {
    /// The tree of the elimination in some order, which is replaced by an equivalent postorder.
    pub fn new(graph: &Graph, order: &[u32]) -> Self {
        let parents = parents(graph, order, &inverse(order));
        let post = postorder(&parents, |_| 0);
        let turn = inverse(&post);
        let order: Vec<u32> = post.iter().map(|&k| order[k as usize]).collect();
        let renumbered = |&k: &u32| match parents[k as usize] {
            NONE => NONE,
            parent => turn[parent as usize],
        };
        let parents: Vec<u32> = post.iter().map(renumbered).collect();
        let place = inverse(&order);
        let counts = column_counts(graph, &order, &place, &parents);
        Self { order, parents, counts }
    }
}

/// Parent of every turn: the first later turn that its elimination connects it with.
fn parents(graph: &Graph, order: &[u32], place: &[u32]) -> Vec<u32> {
    let mut parents = vec![NONE; order.len()];
    let mut ancestors = vec![NONE; order.len()];
    for (turn, &node) in order.iter().enumerate() {
        for &neighbour in graph.around(node as usize) {
            let mut k = place[neighbour as usize] as usize;
            while k < turn {
                let next = std::mem::replace(&mut ancestors[k], turn as u32);
                if next == NONE {
                    parents[k] = turn as u32;
                    break;
                }
                k = next as usize;
            }
        }
    }
    parents
}

/// Nodes of a forest, children before parents, children of one parent by ascending `key` and then number.
///
/// Parents have larger numbers than their children.
pub(crate) fn postorder(parents: &[u32], key: impl Fn(usize) -> i64) -> Vec<u32> {
    let size = parents.len();
    let mut siblings: Vec<u32> = (0..size as u32).collect();
    siblings.sort_by_key(|&k| (parents[k as usize], key(k as usize), k));
    let first = |parent: u32| siblings.partition_point(|&k| parents[k as usize] < parent);
    let mut order = Vec::with_capacity(size);
    // descending depth-first search, reversed at the end
    let mut stack: Vec<u32> = siblings[first(NONE)..].to_vec();
    while let Some(node) = stack.pop() {
        order.push(node);
        let children = siblings[first(node)..].iter().take_while(|&&k| parents[k as usize] == node);
        stack.extend(children);
    }
    order.reverse();
    order
}

/// Lengths of the columns, from the leaves of the row subtrees.
fn column_counts(graph: &Graph, order: &[u32], place: &[u32], parents: &[u32]) -> Vec<u32> {
    let size = order.len();
    let mut counts = vec![0_i64; size];
    // earliest descendant of every turn; a turn without earlier ones is a leaf
    let mut first: Vec<u32> = (0..size as u32).collect();
    for k in 0..size {
        counts[k] += i64::from(first[k] == k as u32);
        if parents[k] != NONE {
            let parent = parents[k] as usize;
            first[parent] = first[parent].min(first[k]);
        }
    }
    let mut latest_first = vec![NONE; size];
    let mut previous_leaf = vec![NONE; size];
    let mut ancestors: Vec<u32> = (0..size as u32).collect();
    for k in 0..size {
        if parents[k] != NONE {
            counts[parents[k] as usize] -= 1;
        }
        for &neighbour in graph.around(order[k] as usize) {
            let row = place[neighbour as usize] as usize;
            let is_leaf = row > k && (latest_first[row] == NONE || first[k] > latest_first[row]);
            if !is_leaf {
                continue;
            }
            latest_first[row] = first[k];
            counts[k] += 1;
            let previous = std::mem::replace(&mut previous_leaf[row], k as u32);
            if previous != NONE {
                counts[common_ancestor(&mut ancestors, previous)] -= 1;
            }
        }
        if parents[k] != NONE {
            ancestors[k] = parents[k];
        }
    }
    for k in 0..size {
        if parents[k] != NONE {
            counts[parents[k] as usize] += counts[k];
        }
    }
    counts.into_iter().map(|count| count as u32).collect()
}

/// Root of the part of the tree walked so far that holds a turn; shortens the paths it follows.
fn common_ancestor(ancestors: &mut [u32], turn: u32) -> usize {
    let mut root = turn as usize;
    while ancestors[root] as usize != root {
        root = ancestors[root] as usize;
    }
    let mut k = turn as usize;
    while ancestors[k] as usize != root {
        k = std::mem::replace(&mut ancestors[k], root as u32) as usize;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::{Kind, Pattern};

    /// Structure of every column by eliminating nodes one after the other.
    fn eliminate(graph: &Graph, order: &[u32]) -> Vec<Vec<usize>> {
        let size = order.len();
        let place = inverse(order);
        let mut columns = vec![vec![false; size]; size];
        for node in 0..size {
            for &other in graph.around(node) {
                columns[place[node] as usize][place[other as usize] as usize] = true;
            }
        }
        for k in 0..size {
            let below: Vec<usize> = (k + 1..size).filter(|&i| columns[k][i]).collect();
            for &i in &below {
                below.iter().filter(|&&j| j != i).for_each(|&j| columns[i][j] = true);
            }
        }
        let column = |k: usize| (k + 1..size).filter(|&i| columns[k][i]).collect();
        (0..size).map(column).collect()
    }

    #[test]
    fn parents_and_counts_are_those_of_explicit_elimination() {
        // arrows, rings and a separate pair, in an order that is no postorder
        let starts = [0, 3, 5, 7, 9, 11, 12, 12, 13, 13, 13];
        let rows = [3, 6, 1, 4, 8, 5, 7, 6, 8, 6, 7, 8, 9];
        let graph = Graph::of(Pattern { kind: Kind::Symmetric, starts: &starts, rows: &rows });
        let tree = EliminationTree::new(&graph, &[4, 0, 2, 9, 1, 8, 3, 7, 5, 6]);
        let columns = eliminate(&graph, &tree.order);
        for (k, column) in columns.iter().enumerate() {
            assert_eq!(tree.counts[k] as usize, column.len() + 1, "column {k}");
            let parent = column.first().map_or(NONE, |&p| p as u32);
            assert_eq!(tree.parents[k], parent, "column {k}");
        }
    }
}
