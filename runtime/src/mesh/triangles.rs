//! Meshes from straight triangles made elsewhere.

use super::Mesh;
use super::assemble::{Draft, assemble};
use super::outline::Chain;
use ansatz_geometry::{Point, point};
use std::collections::BTreeMap;

/// One region of straight triangles (counter-clockwise) over `points`, with named edges on its boundary in any order and direction. Edges of
/// one name that follow each other become one path, in the direction in which the region lies left of it.
///
/// Edges of no triangle are left out.
pub fn mesh_of_triangles(
    region: &str,
    points: Vec<Point>,
    triangles: &[[usize; 3]],
    edges: &[(String, [usize; 2])],
) -> Mesh {
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let sides: std::collections::BTreeSet<[usize; 2]> = sides.collect();
    let mut named: BTreeMap<&str, BTreeMap<usize, usize>> = BTreeMap::new();
    for (name, [a, b]) in edges {
        for [from, to] in [[*a, *b], [*b, *a]] {
            if sides.contains(&[from, to]) {
                named.entry(name).or_default().insert(from, to);
            }
        }
    }
    let paths = named.into_iter().flat_map(|(name, next)| chains(next).into_iter().map(move |c| (name, c)));
    let chains = paths.map(|(name, along)| {
        let middle = |pair: &[usize]| point::lerp(points[pair[0]], points[pair[1]], 0.5);
        let middles = along.windows(2).map(middle).collect();
        Chain { path: name.into(), label: None, points: along, middles, sides: [Some(0), None] }
    });
    let chains = chains.collect();
    let cells = triangles.iter().map(|&triangle| (triangle, 0)).collect();
    assemble(Draft { cells, regions: vec![region.into()], chains, corners: Vec::new(), points })
}

/// Follows edges from point to point, open chains first.
fn chains(mut next: BTreeMap<usize, usize>) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    while let Some((&any, _)) = next.first_key_value() {
        let open = next.keys().find(|start| next.values().all(|end| end != *start));
        let mut along = vec![open.copied().unwrap_or(any)];
        while let Some(to) = along.last().and_then(|from| next.remove(from)) {
            along.push(to);
        }
        found.push(along);
    }
    found
}
