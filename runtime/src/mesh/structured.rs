//! Structured meshes of mapped squares, for tests, benchmarks and verification.

use super::Mesh;
use super::assemble::{Draft, assemble};
use super::outline::Chain;
use ansatz_geometry::{Point, point};

/// A square of `nx` x `ny` cells, each cut in two along the diagonal from its lower left corner, with its vertices moved
/// from (s, t) in the unit square to `map(s, t)`; edges are straight. One region `body`; paths `bottom`, `right`, `top`,
/// `left` around it counter-clockwise. `map` must keep the orientation.
pub fn structured_rectangle(nx: usize, ny: usize, map: impl Fn(f64, f64) -> Point) -> Mesh {
    let index = |i: usize, j: usize| j * (nx + 1) + i;
    let grid = (0..=ny).flat_map(|j| (0..=nx).map(move |i| (i, j)));
    let points: Vec<Point> = grid.map(|(i, j)| map(i as f64 / nx as f64, j as f64 / ny as f64)).collect();
    let squares = (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j)));
    let halves = squares.flat_map(|(i, j)| {
        let (low, high) = (index(i, j), index(i + 1, j + 1));
        [([low, index(i + 1, j), high], 0), ([low, high, index(i, j + 1)], 0)]
    });
    let chain = |name: &str, along: Vec<usize>| {
        let middles =
            along.windows(2).map(|pair| point::lerp(points[pair[0]], points[pair[1]], 0.5)).collect();
        Chain { path: name.into(), label: None, points: along, middles, sides: [Some(0), None] }
    };
    let chains = vec![
        chain("bottom", (0..=nx).map(|i| index(i, 0)).collect()),
        chain("right", (0..=ny).map(|j| index(nx, j)).collect()),
        chain("top", (0..=nx).rev().map(|i| index(i, ny)).collect()),
        chain("left", (0..=ny).rev().map(|j| index(0, j)).collect()),
    ];
    let corners = vec![index(0, 0), index(nx, 0), index(nx, ny), index(0, ny)];
    let (cells, regions) = (halves.collect(), vec!["body".into()]);
    assemble(Draft { cells, regions, chains, corners, points: points.clone() })
}
