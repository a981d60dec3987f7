//! The order of elimination: approximate minimum degree or nested dissection, with unknowns that have no pivot of their own put off.

use crate::dissection::nested_dissection;
use crate::error::Error;
use crate::pattern::{Graph, Kind, inverse};
use crate::quotient::Quotient;
use crate::supernodes::Supernodes;
use crate::tree::EliminationTree;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// Neighbours after which an unknown without a diagonal entry may be eliminated.
const NEIGHBOURS: usize = 8;

/// What may be spent on an order of elimination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Minimum degree.
    Quick,
    /// Nested dissection too, which takes several times as long.
    Thorough,
}

/// Groups of columns in the order that takes the fewest operations.
///
/// # Errors
/// [`Error::TooLarge`].
pub(crate) fn best_supernodes(
    graph: &Graph,
    kind: Kind,
    weak: &[u32],
    effort: Effort,
) -> Result<Supernodes, Error> {
    let supernodes =
        |order| Supernodes::new(&EliminationTree::new(graph, &put_off(graph, order, weak)), kind);
    let quotient = Quotient::new(graph);
    // Minimum degree counts groups: it may where they are all of one size.
    let alike = quotient.weights().windows(2).all(|pair| pair[0] == pair[1]);
    let order =
        if alike { quotient.expand(&minimum_degree(&quotient.graph)?) } else { minimum_degree(graph)? };
    let by_degree = supernodes(order);
    if effort == Effort::Quick {
        return Ok(by_degree);
    }
    let dissected = supernodes(quotient.expand(&nested_dissection(&quotient.graph, &quotient.weights())?));
    Ok(if dissected.operations(kind) < by_degree.operations(kind) { dissected } else { by_degree })
}

/// Approximate minimum degree.
///
/// # Errors
/// [`Error::TooLarge`].
pub(crate) fn minimum_degree(graph: &Graph) -> Result<Vec<u32>, Error> {
    let size = graph.size();
    let columns = SymbolicSparseColMatRef::new_checked(size, size, &graph.starts, None, &graph.neighbours);
    let (mut order, mut place) = (vec![0; size], vec![0; size]);
    let request = amd::order_maybe_unsorted_scratch::<u32>(size, graph.neighbours.len());
    let mut memory = MemBuffer::try_new(request).map_err(|_| Error::TooLarge)?;
    let stack = MemStack::new(&mut memory);
    amd::order_maybe_unsorted(&mut order, &mut place, columns, Default::default(), stack)
        .map_err(|_| Error::TooLarge)?;
    Ok(order)
}

/// Moves every unknown of `weak`, whose diagonal entry is zero, behind those that fill its diagonal.
///
/// Such unknowns are the pressures and multipliers of saddle points. Eliminating a neighbour leaves a pivot; eliminating
/// several leaves one of the right size.
pub(crate) fn put_off(graph: &Graph, order: Vec<u32>, weak: &[u32]) -> Vec<u32> {
    if weak.is_empty() {
        return order;
    }
    let place = inverse(&order);
    let mut is_weak = vec![false; order.len()];
    weak.iter().for_each(|&node| is_weak[node as usize] = true);
    let mut keys: Vec<(u32, u32)> = place.iter().map(|&turn| (turn, 0)).collect();
    let mut turns = Vec::new();
    for &node in weak {
        let strong = graph.around(node as usize).iter().filter(|&&other| !is_weak[other as usize]);
        turns.clear();
        turns.extend(strong.map(|&other| place[other as usize]));
        turns.sort_unstable();
        if let Some(&turn) = turns.get(NEIGHBOURS.min(turns.len()).wrapping_sub(1)) {
            let own = place[node as usize];
            if turn > own {
                keys[node as usize] = (turn, own + 1);
            }
        }
    }
    let mut order = order;
    order.sort_unstable_by_key(|&node| keys[node as usize]);
    order
}
