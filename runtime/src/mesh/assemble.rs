//! Turns straight triangles and divided paths into a numbered mesh of quadratic cells.

use super::hilbert::hilbert_index;
use super::outline::Chain;
use super::quality::least_determinant;
use super::{CellEdge, Mesh, MeshPath, PathEdge};
use ansatz_geometry::{Point, point};
use std::collections::BTreeMap;

/// What a mesh is assembled from; all indices refer to `points`.
pub(crate) struct Draft {
    /// Positions of the vertices.
    pub(crate) points: Vec<Point>,
    /// Vertices of each triangle, counter-clockwise, and its region.
    pub(crate) cells: Vec<([usize; 3], u16)>,
    /// Region names.
    pub(crate) regions: Vec<String>,
    /// Divided paths.
    pub(crate) chains: Vec<Chain>,
    /// Points at the vertices of the geometry.
    pub(crate) corners: Vec<usize>,
}

/// Marks a point without a node number yet.
const UNSEEN: u32 = u32::MAX;

/// Numbers vertices, adds mid-edge nodes and links paths to cells.
pub(crate) fn assemble(mut draft: Draft) -> Mesh {
    sort_cells(&mut draft.cells, &draft.points);
    let number = number_vertices(&draft);
    let node = |point: usize| number[point];
    let mut mesh = Mesh {
        nodes: ordered(&draft.points, &number),
        vertex_count: 0,
        cells: draft
            .cells
            .iter()
            .map(|(cell, _)| [node(cell[0]), node(cell[1]), node(cell[2]), 0, 0, 0])
            .collect(),
        cell_region: draft.cells.iter().map(|&(_, region)| region).collect(),
        regions: draft.regions,
        paths: Vec::new(),
        corners: draft.corners.into_iter().map(node).collect(),
        body_cells: draft.cells.len(),
        body_nodes: 0,
        links: Vec::new(),
    };
    mesh.vertex_count = mesh.nodes.len();
    let cell_edges = add_middles(&mut mesh);
    for chain in &draft.chains {
        let edges = chain
            .edges()
            .zip(&chain.middles)
            .map(|(edge, &middle)| path_edge(&mut mesh, &cell_edges, edge.map(node), middle));
        let edges = edges.collect();
        let (path, label) = (chain.path.clone(), chain.label.clone());
        mesh.paths.push(MeshPath { path, label, seen_from: None, edges });
    }
    mesh.body_nodes = mesh.nodes.len();
    straighten(&mut mesh);
    mesh
}

/// Sorts cells by region, then along a Hilbert curve.
fn sort_cells(cells: &mut [([usize; 3], u16)], points: &[Point]) {
    let bounds = point::bounds(points);
    cells.sort_by_cached_key(|(cell, region)| {
        let centroid = point::centroid(cell.map(|v| points[v]));
        (*region, hilbert_index(centroid, bounds), *cell)
    });
}

/// Node number of each point in the order in which cells, then paths and corners without cells use them.
fn number_vertices(draft: &Draft) -> Vec<u32> {
    let mut number = vec![UNSEEN; draft.points.len()];
    let mut next = 0;
    let in_cells = draft.cells.iter().flat_map(|(cell, _)| cell);
    let on_paths = draft.chains.iter().flat_map(|chain| &chain.points);
    for &point in in_cells.chain(on_paths).chain(&draft.corners) {
        if number[point] == UNSEEN {
            number[point] = next;
            next += 1;
        }
    }
    number
}

/// Positions by node number; points without one are left out.
fn ordered(points: &[Point], number: &[u32]) -> Vec<Point> {
    let mut pairs: Vec<(u32, Point)> = number.iter().copied().zip(points.iter().copied()).collect();
    pairs.retain(|&(node, _)| node != UNSEEN);
    pairs.sort_by_key(|&(node, _)| node);
    pairs.into_iter().map(|(_, p)| p).collect()
}

/// Cell and local edge by start and end vertex in the cell's own direction.
type CellEdges = BTreeMap<[u32; 2], CellEdge>;

/// Adds a node in the middle of every edge.
fn add_middles(mesh: &mut Mesh) -> CellEdges {
    let mut edges = CellEdges::new();
    for cell in 0..mesh.cells.len() {
        for edge in 0..3 {
            let [a, b] = [mesh.cells[cell][edge], mesh.cells[cell][(edge + 1) % 3]];
            mesh.cells[cell][3 + edge] = match edges.get(&[b, a]) {
                Some(twin) => mesh.cells[twin.cell as usize][3 + usize::from(twin.edge)],
                None => {
                    mesh.nodes.push(point::lerp(mesh.nodes[a as usize], mesh.nodes[b as usize], 0.5));
                    mesh.nodes.len() as u32 - 1
                }
            };
            edges.insert([a, b], CellEdge { cell: cell as u32, edge: edge as u8 });
        }
    }
    edges
}

/// Links an edge of a path to its cells and puts its middle node on the curve.
fn path_edge(mesh: &mut Mesh, edges: &CellEdges, [a, b]: [u32; 2], on_curve: Point) -> PathEdge {
    let (left, right) = (edges.get(&[a, b]).copied(), edges.get(&[b, a]).copied());
    let middle = match left.or(right) {
        Some(side) => mesh.cells[side.cell as usize][3 + usize::from(side.edge)],
        None => {
            mesh.nodes.push(on_curve);
            mesh.nodes.len() as u32 - 1
        }
    };
    mesh.nodes[middle as usize] = on_curve;
    PathEdge { nodes: [a, b, middle], left, right }
}

/// Moves mid-edge nodes of cells that are turned over towards the straight edge, half-way each time.
fn straighten(mesh: &mut Mesh) {
    let mut suspects: Vec<usize> = (0..mesh.cells.len()).collect();
    for _ in 0..f64::MANTISSA_DIGITS {
        suspects.retain(|&cell| least_determinant(&mesh.cell_nodes(cell)) <= 0.0);
        if suspects.is_empty() {
            return;
        }
        for &cell in &suspects {
            let nodes = mesh.cells[cell].map(|node| node as usize);
            for edge in 0..3 {
                let straight = point::lerp(mesh.nodes[nodes[edge]], mesh.nodes[nodes[(edge + 1) % 3]], 0.5);
                let middle = &mut mesh.nodes[nodes[3 + edge]];
                *middle = point::lerp(*middle, straight, 0.5);
            }
        }
        suspects = (0..mesh.cells.len()).collect();
    }
}
