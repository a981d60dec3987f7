//! Nested dissection: a graph falls apart when a separator is taken out, which is eliminated last, and so do the parts.
//!
//! George (1973), *Nested dissection of a regular finite element mesh*, SIAM J. Numer. Anal. 10.

use crate::error::Error;
use crate::ordering::minimum_degree;
use crate::pattern::Graph;
use crate::separator::{Part, Weighted, separate};

/// Nodes up to which a part is ordered by minimum degree.
const LEAF: usize = 120;

/// The order of elimination of a graph whose nodes stand for `weights` unknowns each.
///
/// # Errors
/// [`Error::TooLarge`].
pub(crate) fn nested_dissection(graph: &Graph, weights: &[u32]) -> Result<Vec<u32>, Error> {
    // From the last node backwards: the separator of a part before those of its own parts.
    let mut backwards = Vec::with_capacity(graph.size());
    let mut parts = vec![(0..graph.size() as u32).collect::<Vec<u32>>()];
    let mut local = vec![u32::MAX; graph.size()];
    while let Some(nodes) = parts.pop() {
        let part = induced(graph, &nodes, &mut local);
        if nodes.len() <= LEAF {
            let order = minimum_degree(&part)?;
            backwards.extend(order.iter().rev().map(|&k| nodes[k as usize]));
            continue;
        }
        let weights = nodes.iter().map(|&node| weights[node as usize]).collect();
        let sides = separate(&Weighted::new(part, weights));
        let on =
            |side: Part| nodes.iter().zip(&sides).filter(move |(_, s)| **s == side).map(|(&node, _)| node);
        let halves = [on(Part::Left).collect::<Vec<u32>>(), on(Part::Right).collect()];
        if halves.iter().any(Vec::is_empty) {
            // Nothing separates it, as where all nodes are neighbours.
            let order = minimum_degree(&induced(graph, &nodes, &mut local))?;
            backwards.extend(order.iter().rev().map(|&k| nodes[k as usize]));
            continue;
        }
        backwards.extend(on(Part::Separator));
        parts.extend(halves);
    }
    backwards.reverse();
    Ok(backwards)
}

/// The graph of some nodes and the edges between them; `local` is scratch, `u32::MAX` everywhere.
fn induced(graph: &Graph, nodes: &[u32], local: &mut [u32]) -> Graph {
    nodes.iter().enumerate().for_each(|(k, &node)| local[node as usize] = k as u32);
    let mut part = Graph { starts: vec![0], neighbours: Vec::new() };
    for &node in nodes {
        let inside = graph.around(node as usize).iter().map(|&other| local[other as usize]);
        part.neighbours.extend(inside.filter(|&other| other != u32::MAX));
        part.starts.push(part.neighbours.len() as u32);
    }
    nodes.iter().for_each(|&node| local[node as usize] = u32::MAX);
    part
}
