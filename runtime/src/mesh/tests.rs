//! Claims about meshes of the dry-contact geometry, of small ones, and structured ones.

#[path = "../../../geometry/tests/common/dry.rs"]
mod dry;

use super::quality::{least_determinant, position};
use super::*;
use ansatz_geometry::{Curve, Geometry, LoopPart, Path, PathBuilder, Region, Turn, point};
use dry::Dry;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::rc::Rc;

/// The `mesh` block of the dry-contact model.
fn dry_sizing(coarse: f64) -> MeshSizing {
    let nucleus = Place::Path("nucleus".into());
    let rim = Place::Segment("endo".into(), "rim".into());
    let rules = vec![
        SizeRule { size: 0.6 * coarse, on: vec![Place::Everywhere] },
        SizeRule { size: 0.06 * coarse, on: vec![nucleus, rim] },
        SizeRule { size: 0.15 * coarse, on: vec![Place::Region("shell".into())] },
    ];
    MeshSizing { rules, growth: 1.25, quality: 0.3 }
}

fn dry_mesh(coarse: f64) -> Mesh {
    Mesh::generate(&Dry::default().geometry(), &dry_sizing(coarse)).expect("the default model meshes")
}

fn everywhere(size: f64) -> MeshSizing {
    MeshSizing { rules: vec![SizeRule { size, on: vec![Place::Everywhere] }], ..MeshSizing::default() }
}

/// A plane geometry of one region within one path.
fn within(outline: PathBuilder) -> Geometry {
    let outline = outline.build().expect("ends lie on their circles");
    let region = Region::new("body", [LoopPart::path(&outline.name)]);
    Geometry { paths: vec![outline], regions: vec![region], axisymmetric: false }
}

fn polygon(corners: &[Point]) -> PathBuilder {
    let closed = corners[1..].iter().chain(&corners[..1]);
    closed.fold(PathBuilder::from("outline", corners[0]), |path, &corner| path.line(None, corner))
}

fn rectangle(width: f64, height: f64) -> Geometry {
    within(polygon(&[[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]))
}

fn edge_length(mesh: &Mesh, edge: &PathEdge) -> f64 {
    let [a, b, _] = edge.nodes.map(|node| mesh.nodes[node as usize]);
    point::distance(a, b)
}

/// Every edge has two cells or lies on a path, and cells share its middle node.
fn assert_conforming(mesh: &Mesh) {
    let mut edges = BTreeMap::<[u32; 2], Vec<u32>>::new();
    for cell in &mesh.cells {
        for k in 0..3 {
            let (a, b) = (cell[k], cell[(k + 1) % 3]);
            edges.entry([a.min(b), a.max(b)]).or_default().push(cell[3 + k]);
        }
    }
    let on_paths: BTreeMap<[u32; 2], &PathEdge> = mesh
        .paths
        .iter()
        .flat_map(|path| &path.edges)
        .map(|edge| ([edge.nodes[0].min(edge.nodes[1]), edge.nodes[0].max(edge.nodes[1])], edge))
        .collect();
    for (edge, middles) in &edges {
        let sides = on_paths.get(edge).map_or(2, |edge| edge.left.iter().chain(&edge.right).count());
        assert_eq!(middles.len(), sides, "edge {edge:?}");
        assert!(middles.iter().all(|middle| *middle == middles[0]));
    }
    assert!(
        on_paths
            .iter()
            .all(|(key, edge)| edge.left.is_none() && edge.right.is_none() || edges.contains_key(key))
    );
}

#[test]
fn regions_keep_their_exact_area() {
    let geometry = Dry::default().geometry();
    // Quadratic edges deviate from an arc by the fourth power of the angle they span, at most 30 degrees.
    for (coarse, tolerance) in [(2.0, 1e-5), (1.0, 1e-6)] {
        let mesh = dry_mesh(coarse);
        for (region, name) in mesh.regions.iter().enumerate() {
            let exact = geometry.boundary(region).expect("closed").area();
            let error = (mesh.region_area(name) / exact - 1.0).abs();
            assert!(error < tolerance, "{name} at coarse = {coarse}: off by {error:e}");
        }
    }
}

#[test]
fn the_dry_model_gets_well_shaped_cells_at_every_coarseness_and_opening() {
    for coarse in [4.0, 2.0, 1.0] {
        let mesh = dry_mesh(coarse);
        let quality = mesh.quality();
        assert!(quality.smallest > 0.5 && quality.mean > 0.9, "coarse = {coarse}: {quality:?}");
        assert!((0..mesh.cells.len()).all(|cell| least_determinant(&mesh.cell_nodes(cell)) > 0.0));
        assert_conforming(&mesh);
    }
    for r_g in [0.9, 1.2, 1.8] {
        let geometry = Dry { r_g, ..Dry::default() }.geometry();
        let mesh = Mesh::generate(&geometry, &dry_sizing(2.0)).expect("sweeps mesh");
        assert!(mesh.quality().smallest > 0.5, "r_g = {r_g}");
    }
}

#[test]
fn the_number_of_cells_follows_the_sizes() {
    // Equilateral triangles with edge h have the area 0.433 h^2; the far field alone gives 2,640 in the matrix.
    let mesh = dry_mesh(1.0);
    assert!((5500..7000).contains(&mesh.cells.len()), "{}", mesh.cells.len());
    let matrix = mesh.region_cells("ecm").len() as f64;
    let expected = mesh.region_area("ecm") / (0.433 * 0.6 * 0.6);
    assert!((0.9..1.2).contains(&(matrix / expected)), "{matrix} cells, not {expected}");
}

#[test]
fn edges_of_each_path_chain_from_start_to_end_on_its_curve() {
    let geometry = Dry::default().geometry();
    let mesh = dry_mesh(2.0);
    let curves = geometry.paths.iter().flat_map(|path| &path.segments).map(|segment| segment.curve);
    for (segment, curve) in mesh.paths.iter().zip(curves) {
        let at = |node: u32| mesh.nodes[node as usize];
        let (first, last) = (segment.edges[0], segment.edges[segment.edges.len() - 1]);
        assert!(point::distance(at(first.nodes[0]), curve.start()) < 1e-12);
        assert!(point::distance(at(last.nodes[1]), curve.end()) < 1e-12);
        assert!(segment.edges.windows(2).all(|pair| pair[0].nodes[1] == pair[1].nodes[0]));
        for edge in &segment.edges {
            let [a, b, middle] = edge.nodes.map(|node| curve.project(at(node)));
            assert!((middle - 0.5 * (a + b)).abs() < 1e-9, "the middle node halves the arc length");
            assert!(edge.nodes.iter().all(|&node| curve.distance(at(node)) < 1e-12));
        }
    }
}

#[test]
fn path_edges_know_the_cells_beside_them() {
    let mesh = dry_mesh(2.0);
    let region_of =
        |side: Option<CellEdge>| side.map(|side| usize::from(mesh.cell_region[side.cell as usize]));
    for edge in mesh.paths.iter().flat_map(|path| &path.edges) {
        for (side, [a, b]) in [(edge.left, [0, 1]), (edge.right, [1, 0])] {
            let Some(side) = side else { continue };
            let (cell, k) = (mesh.cells[side.cell as usize], usize::from(side.edge));
            let found = [cell[k], cell[(k + 1) % 3], cell[3 + k]];
            assert_eq!(found, [edge.nodes[a], edge.nodes[b], edge.nodes[2]]);
        }
    }
    // Counter-clockwise around the core: core on the left, shell on the right.
    assert!(
        mesh.path_edges("core_wall").all(|e| region_of(e.left) == Some(0) && region_of(e.right) == Some(1))
    );
    assert!(
        mesh.path_edges("endo.rim").all(|e| region_of(e.left).is_none() && region_of(e.right) == Some(2))
    );
    assert!(mesh.path_edges("axis").all(|e| e.nodes.iter().all(|&node| mesh.nodes[node as usize][0] == 0.0)));
    let whole = mesh.path_edges("nucleus").count();
    assert_eq!(whole, mesh.path_edges("nucleus.side").count() + mesh.path_edges("nucleus.pull").count());
    assert_eq!(mesh.path_edges("nowhere").count(), 0);
}

#[test]
fn boundary_nodes_are_smoothly_graded() {
    let mesh = dry_mesh(1.0);
    for path in ["nucleus", "endo", "cavity"] {
        let lengths: Vec<f64> = mesh.path_edges(path).map(|edge| edge_length(&mesh, edge)).collect();
        for pair in lengths.windows(2) {
            let ratio = pair[1].max(pair[0]) / pair[1].min(pair[0]);
            assert!(ratio < 1.35, "{path}: neighbours {pair:?}");
        }
    }
    let rim: Vec<f64> = mesh.path_edges("endo.rim").map(|edge| edge_length(&mesh, edge)).collect();
    let mirrored = rim.iter().zip(rim.iter().rev());
    assert!(mirrored.clone().all(|(a, b)| (a - b).abs() < 1e-9 && (a - 0.06).abs() < 1e-3), "{rim:?}");
}

#[test]
fn the_growth_rate_bounds_the_size_away_from_a_fine_point() {
    let fine = SizeRule { size: 0.01, on: vec![Place::Point([0.0, 0.0])] };
    let sizing = MeshSizing { rules: vec![fine], growth: 1.2, quality: 0.3 };
    let mesh = Mesh::generate(&rectangle(2.0, 1.0), &sizing).expect("meshes");
    for cell in 0..mesh.cells.len() {
        let [a, b, c, ..] = mesh.cell_nodes(cell);
        let longest = point::distance(a, b).max(point::distance(b, c)).max(point::distance(c, a));
        let wanted = 0.01 + 0.2 * point::norm(point::centroid([a, b, c]));
        assert!(longest < 1.8 * wanted, "edge {longest}, not {wanted}");
    }
}

#[test]
fn the_same_input_gives_the_same_mesh() {
    assert_eq!(dry_mesh(2.0), dry_mesh(2.0));
}

#[test]
fn cells_are_grouped_by_region_and_nodes_are_local() {
    let mesh = dry_mesh(1.0);
    assert!(mesh.cell_region.is_sorted());
    let cells: usize = mesh.regions.iter().map(|region| mesh.region_cells(region).len()).sum();
    assert_eq!(cells, mesh.cells.len());
    let spread = mesh
        .cells
        .iter()
        .map(|cell| f64::from(cell[..3].iter().max().unwrap() - cell[..3].iter().min().unwrap()));
    let mean = spread.sum::<f64>() / mesh.cells.len() as f64;
    assert!(mean < 0.05 * mesh.vertex_count as f64, "vertices of a cell are {mean} apart");
}

#[test]
fn located_points_map_back() {
    let mesh = dry_mesh(2.0);
    let locator = Locator::new(&mesh, 0..mesh.cells.len());
    for cell in (0..mesh.cells.len()).step_by(7) {
        let at = [0.2, 0.3];
        let p = position(&mesh.cell_nodes(cell), at);
        let (found, coordinates) = locator.locate(p).expect("inside");
        assert_eq!(found, cell);
        assert!(point::distance(coordinates, at) < 1e-10);
        assert_eq!(mesh.locate(p), Some((found, coordinates)));
    }
    for outside in [[0.5, 0.0], [-1.0, 0.0], [100.0, 0.0], [f64::NAN, 0.0]] {
        assert_eq!(locator.locate(outside), None);
        assert_eq!(mesh.locate(outside), None);
    }
}

#[test]
fn a_full_circle_meshes_even_with_a_coarse_size() {
    let disc = within(PathBuilder::from("rim", [1.0, 0.0]).arc(None, [0.0, 0.0], Turn::Ccw, [1.0, 0.0]));
    let mesh = Mesh::generate(&disc, &everywhere(10.0)).expect("meshes");
    assert_eq!(mesh.path_edges("rim").count(), 12);
    assert!((mesh.region_area("body") / PI - 1.0).abs() < 2e-4);
}

#[test]
fn a_hole_stays_empty_unless_a_region_fills_it() {
    let hole = PathBuilder::from("hole", [1.5, 1.0]).arc(None, [1.0, 1.0], Turn::Ccw, [1.5, 1.0]);
    let mut geometry = rectangle(2.0, 2.0);
    geometry.paths.push(hole.build().expect("on its circle"));
    geometry.regions[0].parts.push(LoopPart::path("hole"));
    let empty = Mesh::generate(&geometry, &everywhere(0.2)).expect("meshes");
    assert!((empty.region_area("body") - (4.0 - PI / 4.0)).abs() < 1e-4);
    assert!(empty.path_edges("hole").all(|edge| edge.left.is_none() && edge.right.is_some()));
    geometry.regions.push(Region::new("plug", [LoopPart::path("hole")]));
    let full = Mesh::generate(&geometry, &everywhere(0.2)).expect("meshes");
    assert!((full.region_area("body") + full.region_area("plug") - 4.0).abs() < 1e-12);
    assert_conforming(&full);
}

#[test]
fn a_layer_thinner_than_the_size_is_refined_until_its_cells_are_good() {
    let layer = Mesh::generate(&rectangle(1.0, 0.02), &everywhere(0.5)).expect("meshes");
    assert!(layer.quality().smallest >= 0.3);
    assert!((layer.region_area("body") - 0.02).abs() < 1e-15);
}

#[test]
fn two_curves_between_the_same_points_enclose_cells() {
    let lens = within(PathBuilder::from("lens", [0.0, 0.0]).line(None, [1.0, 0.0]).arc(
        None,
        [0.5, -0.5],
        Turn::Ccw,
        [0.0, 0.0],
    ));
    let mesh = Mesh::generate(&lens, &everywhere(2.0)).expect("meshes");
    assert!((mesh.region_area("body") - (PI / 8.0 - 0.25)).abs() < 1e-4);
}

#[test]
fn a_corner_too_sharp_for_the_quality_is_reported_with_what_is_possible() {
    let wedge = within(polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.05]]));
    let error = Mesh::generate(&wedge, &everywhere(0.2)).expect_err("3 degrees");
    let MeshError::Quality { region, at, found, .. } = &error else { panic!("{error}") };
    assert!(region == "body" && at[0] < 0.1 && *found < 0.3, "{error}");
    let sizing = MeshSizing { quality: 0.05, ..everywhere(0.2) };
    assert!(Mesh::generate(&wedge, &sizing).is_ok());
}

#[test]
fn a_path_without_region_gets_edges_without_cells() {
    let mut geometry = rectangle(1.0, 1.0);
    let tip = PathBuilder::from("tip", [0.5, 1.0]).arc(None, [0.5, 2.0], Turn::Ccw, [1.5, 2.0]);
    geometry.paths.push(tip.build().expect("on its circle"));
    let mesh = Mesh::generate(&geometry, &everywhere(0.1)).expect("meshes");
    let tip: Vec<&PathEdge> = mesh.path_edges("tip").collect();
    assert_eq!(tip.len(), 16);
    assert!(tip.iter().all(|edge| edge.left.is_none() && edge.right.is_none()));
    assert!(tip.iter().all(|edge| (edge.nodes[2] as usize) >= mesh.vertex_count));
    let arc = geometry.paths[1].segments[0].curve;
    assert!(matches!(arc, Curve::Arc { .. }));
    assert!(tip.iter().all(|edge| edge.nodes.iter().all(|&n| arc.distance(mesh.nodes[n as usize]) < 1e-12)));
}

#[test]
fn corners_of_the_geometry_are_nodes() {
    let geometry = Dry::default().geometry();
    let mesh = dry_mesh(2.0);
    let vertices = ansatz_geometry::Vertices::of(&geometry);
    for (vertex, &node) in vertices.points.iter().zip(&mesh.corners) {
        assert_eq!(mesh.nodes[node as usize], *vertex);
        assert_eq!(mesh.nearest_node(*vertex), Some(node));
    }
}

#[test]
fn faulty_sizes_and_geometries_are_reported() {
    let square = rectangle(1.0, 1.0);
    let generate = |sizing: &MeshSizing| Mesh::generate(&square, sizing).expect_err("faulty").to_string();
    assert!(generate(&everywhere(0.0)).contains("the mesh size 0 on everywhere"));
    assert!(generate(&everywhere(f64::NAN)).contains("not a positive length"));
    assert!(generate(&everywhere(1e-9)).contains("edges on `outline`"));
    assert!(generate(&MeshSizing { growth: 1.0, ..everywhere(0.1) }).contains("`growth = 1.25`"));
    let lost = SizeRule { size: 0.1, on: vec![Place::Segment("outline".into(), "lid".into())] };
    assert!(generate(&MeshSizing { rules: vec![lost], ..everywhere(0.1) }).contains("`outline.lid`"));
    let tie = within(polygon(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]));
    assert!(
        matches!(Mesh::generate(&tie, &everywhere(0.1)), Err(MeshError::Geometry(errors)) if errors.len() == 1)
    );
}

#[test]
fn a_structured_rectangle_has_its_cells_and_paths() {
    // Cook's membrane.
    let mesh = structured_rectangle(4, 3, |s, t| [48.0 * s, 44.0 * s + t * (44.0 - 28.0 * s)]);
    assert_eq!((mesh.cells.len(), mesh.vertex_count, mesh.nodes.len()), (24, 20, 63));
    assert!((mesh.region_area("body") - 48.0 * 30.0).abs() < 1e-10);
    assert_conforming(&mesh);
    for (path, edges, start) in [
        ("bottom", 4, [0.0, 0.0]),
        ("right", 3, [48.0, 44.0]),
        ("top", 4, [48.0, 60.0]),
        ("left", 3, [0.0, 44.0]),
    ] {
        let along: Vec<&PathEdge> = mesh.path_edges(path).collect();
        assert_eq!(along.len(), edges);
        assert_eq!(mesh.nodes[along[0].nodes[0] as usize], start);
        assert!(along.iter().all(|edge| edge.left.is_some() && edge.right.is_none()));
    }
}

#[test]
fn an_inverted_curved_cell_is_never_left() {
    // Two arcs that touch without an angle: near the cusp curved edges would cross.
    let cusp: Path = PathBuilder::from("cusp", [0.0, 0.0])
        .arc(None, [0.0, 1.0], Turn::Ccw, [1.0, 1.0])
        .line(None, [2.0, 0.0])
        .line(None, [0.0, 0.0])
        .build()
        .expect("on its circle");
    let region = Region::new("body", [LoopPart::path("cusp")]);
    let geometry = Geometry { paths: vec![cusp], regions: vec![region], axisymmetric: false };
    let mesh = Mesh::generate(&geometry, &MeshSizing { quality: 1e-4, ..everywhere(0.2) }).expect("accepted");
    assert!((0..mesh.cells.len()).all(|cell| least_determinant(&mesh.cell_nodes(cell)) > 0.0));
}

/// Two plates of width 4 with a channel of height 1 between them.
fn channel_between_plates() -> Geometry {
    let plate = |name: &str, low: f64, high: f64| {
        let path = PathBuilder::from(name, [0.0, low]).line(Some("low"), [4.0, low]).line(None, [4.0, high]);
        path.line(Some("high"), [0.0, high]).line(None, [0.0, low]).build().expect("lines")
    };
    let end =
        |name: &str, x: f64| PathBuilder::from(name, [x, 0.0]).line(None, [x, 1.0]).build().expect("a line");
    let paths =
        vec![plate("floor", -1.0, 0.0), plate("ceiling", 1.0, 2.0), end("inlet", 0.0), end("outlet", 4.0)];
    let channel = ["inlet", "outlet"].map(LoopPart::path).into_iter();
    let channel = channel.chain([LoopPart::segment("floor", "high"), LoopPart::segment("ceiling", "low")]);
    let regions = vec![
        Region::new("below", [LoopPart::path("floor")]),
        Region::new("above", [LoopPart::path("ceiling")]),
        Region::new("channel", channel),
    ];
    Geometry { paths, regions, axisymmetric: false }
}

/// Mesh of the channel with its upper wall displaced by `u(x)`.
fn followed(u: impl Fn(f64) -> f64) -> Result<(Mesh, Vec<Point>), MeshError> {
    followed_with(u, Vec::new())
}

/// The same with sizes from the gap.
fn followed_with(u: impl Fn(f64) -> f64, films: Vec<FilmSize>) -> Result<(Mesh, Vec<Point>), MeshError> {
    let (mesh, positions, _) = following(u, films)?;
    Ok((mesh, positions))
}

/// The same with what follows.
fn following(
    u: impl Fn(f64) -> f64,
    films: Vec<FilmSize>,
) -> Result<(Mesh, Vec<Point>, Follower), MeshError> {
    let (geometry, sizing) = (channel_between_plates(), everywhere(0.5));
    let mut mesh = Mesh::generate_bodies(&geometry, &sizing, &["channel"])?;
    let positions = upper_wall_moved(&mesh, u);
    let mut follower = Follower::new(&geometry, 2, &sizing, films)?;
    follower.attach(&mut mesh, &positions)?;
    Ok((mesh, positions, follower))
}

/// Places of the bodies' nodes with the upper wall displaced by `u(x)`.
fn upper_wall_moved(mesh: &Mesh, u: impl Fn(f64) -> f64) -> Vec<Point> {
    let moved = |&[x, y]: &Point| [x, if y > 0.0 { y * (1.0 + u(x)) } else { y }];
    mesh.nodes[..mesh.body_nodes].iter().map(moved).collect()
}

#[test]
fn a_region_between_bodies_takes_the_shape_that_they_leave_it() {
    let (mesh, positions) = followed(|x| 0.1 * x).expect("there is room");
    assert_conforming(&mesh);
    assert!((mesh.region_area("channel") - 4.8).abs() < 1e-12, "{}", mesh.region_area("channel"));
    assert!((mesh.region_area("above") - 4.0).abs() < 1e-12, "bodies keep their reference shape");
    assert!(!mesh.links.is_empty());
    for [moving, body] in &mesh.links {
        assert_eq!(mesh.nodes[*moving as usize], positions[*body as usize]);
    }
    let wall = |name: &str| mesh.path_edges(name).count();
    assert!(wall("ceiling.low") > 0 && wall("ceiling.low") == wall("channel/ceiling.low"));
    assert!(mesh.path_edges("channel/outlet").all(|edge| edge.left.is_some() != edge.right.is_some()));
    let bodies = mesh.bodies();
    assert_eq!((bodies.cells.len(), bodies.regions.len()), (mesh.body_cells, 2));
}

#[test]
fn cells_go_along_with_the_bodies_around_them() {
    let (mesh, _, mut follower) = following(|_| 0.0, Vec::new()).expect("there is room");
    let (mut moved, positions) = (mesh.clone(), upper_wall_moved(&mesh, |x| 0.1 * x));
    assert!(follower.advance(&mut moved, &positions).expect("there is room"), "the cells bear it");
    assert_conforming(&moved);
    assert_eq!(moved.cells, mesh.cells);
    assert!((moved.region_area("channel") - 4.8).abs() < 1e-12, "{}", moved.region_area("channel"));
    for [moving, body] in &moved.links {
        assert_eq!(moved.nodes[*moving as usize], positions[*body as usize]);
    }
    assert!(moved.quality().smallest > 0.3);
    let back = upper_wall_moved(&mesh, |_| 0.0);
    assert!(follower.advance(&mut moved, &back).expect("there is room"));
    let off = |(a, b): (&Point, &Point)| ansatz_geometry::point::distance(*a, *b);
    let furthest = moved.nodes.iter().zip(&mesh.nodes).map(off).fold(0.0, f64::max);
    assert!(furthest < 1e-12, "back where they were but for {furthest:e}");
}

#[test]
fn cells_that_would_become_too_flat_or_too_large_for_a_film_stay_where_they_are() {
    let (mesh, _, mut follower) = following(|_| 0.0, vec![on_walls(|gap| gap / 4.0)]).expect("there is room");
    for (u, why) in [(4.0, "stretched to five times their height"), (-0.35, "a film of two thirds")] {
        let mut moved = mesh.clone();
        let positions = upper_wall_moved(&mesh, |_| u);
        assert!(!follower.advance(&mut moved, &positions).expect("sizes are positive"), "{why}");
        assert_eq!(moved, mesh, "{why}");
    }
}

/// `size(gap)` on both walls of the channel.
fn on_walls(size: impl Fn(f64) -> f64 + 'static) -> FilmSize {
    FilmSize { surfaces: [vec!["ceiling.low"], vec!["floor.high"]], at: [true, true], size: Rc::new(size) }
}

#[test]
fn cells_in_a_film_are_as_small_as_its_gap_asks() {
    let cells = |films| followed_with(|x| -0.2 * x, films).expect("there is room").0;
    let in_film = |mesh: &Mesh| mesh.cells.len() - mesh.body_cells;
    let (plain, fine) = (cells(Vec::new()), cells(vec![on_walls(|gap| gap / 4.0)]));
    assert_conforming(&fine);
    assert!(2 * in_film(&fine) > 3 * in_film(&plain), "{} and {}", in_film(&fine), in_film(&plain));
    assert_eq!(fine.body_cells, plain.body_cells, "bodies keep their cells");
    assert_eq!(in_film(&cells(vec![on_walls(|_| 10.0)])), in_film(&plain), "a size is an upper bound");
}

#[test]
fn a_film_without_a_positive_size_is_refused() {
    let error = followed_with(|_| 0.0, vec![on_walls(|gap| gap - 1.0)]).expect_err("no size");
    assert!(matches!(error, MeshError::BadFilmSize { .. }), "{error}");
}

#[test]
fn bodies_that_run_into_each_other_leave_no_region() {
    let error = followed(|x| -0.4 * x).expect_err("they cross").to_string();
    assert!(error.contains("`channel`"), "{error}");
}
