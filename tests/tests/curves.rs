//! Fields on paths: which nodes they have, what they share with regions, how they are read and held.

use ansatz::Simulation;
use ansatz_tests::models::whisker;
use ansatz_tests::notes::Notes;

fn ran() -> (Simulation, Notes) {
    let values = whisker::Parameters::default().values();
    let mut simulation = Simulation::new(&whisker::PROGRAM, &values).expect("the model can be built");
    let mut notes = Notes::default();
    simulation.run(&mut notes, None).expect("the run reaches its end");
    (simulation, notes)
}

fn value(notes: &Notes, name: &str) -> f64 {
    let columns = whisker::PROGRAM.tables[0].columns;
    let position = columns.iter().position(|column| column.name == name).expect("a column of the table");
    notes.rows[0].1[position]
}

#[track_caller]
fn assert_near(found: f64, expected: f64, error: f64) {
    assert!((found - expected).abs() < error, "{found} instead of {expected}");
}

#[test]
fn a_curve_that_starts_at_a_corner_of_a_body_shares_its_node() {
    let (_, notes) = ran();
    let frame = &notes.frames[0];
    // Vertices of cells are numbered first, so the shared node leads the frame. Frames approach nodes from inside, by 1e-6 of an edge.
    assert_near(frame.columns[0][0], value(&notes, "corner_u"), 1e-6);
    assert!(frame.columns[0][0].abs() > 0.05, "the body moves its corner");
    assert_eq!(frame.columns[0].len(), 3 * frame.columns[1].len(), "a vector and a scalar at every node");
}

#[test]
fn fields_on_curves_are_held_at_their_ends() {
    let (_, notes) = ran();
    assert_near(value(&notes, "end_c"), 7.0, 1e-12);
    // The largest value over the nodes, each approached from inside.
    assert_near(value(&notes, "end_u"), 0.25, 1e-5);
}

#[test]
fn fields_on_curves_have_means_extremes_and_values_at_points() {
    let (_, notes) = ran();
    // The held end disturbs the linear field by its mass matrix, less from edge to edge.
    assert_near(value(&notes, "middle_c"), 0.75, 2e-3);
    // The lowest point of the parabola is no node.
    assert_near(value(&notes, "lowest"), -1.0, 5e-3);
    // x y on a circle is no parabola of the arc length: edges of 1/4 radian miss it in the third order.
    assert_near(value(&notes, "top"), 5.0, 3e-3);
    assert_near(value(&notes, "total"), 10.0, 1e-3);
    assert_near(value(&notes, "length_of"), std::f64::consts::PI, 2e-4);
}

#[test]
fn derivatives_along_curves_are_those_by_their_arc_length() {
    let (_, notes) = ran();
    // A string of length L = 2 sqrt(2) under tension 1 with load 1: sag L^2/8, slopes L/2 at its ends. Quadratic elements are exact.
    assert_near(value(&notes, "sag"), 1.0, 1e-9);
    assert_near(value(&notes, "slope"), 2.0_f64.sqrt(), 1e-6);
    assert_near(value(&notes, "half_way"), 0.0, 1e-9);
    // The difference of the ends, also where the integrand is seen from inside the body.
    assert_near(value(&notes, "rise"), value(&notes, "risen"), 1e-7);
}

#[test]
fn tangents_and_curvatures_are_those_of_the_curve() {
    let (_, notes) = ran();
    // Half a circle of radius 1, counter-clockwise. Parabolas through arcs of an angle a turn by a (1 - a^2/16); the rest are kinks between
    // them. Here a is up to 0.52.
    assert_near(value(&notes, "turned"), std::f64::consts::PI, 5e-2);
    assert_near(value(&notes, "bend"), 1.0, 3e-2);
    // The left of the right side, which runs upwards, is inside.
    assert_near(value(&notes, "inwards"), -1.0, 1e-12);
}

#[test]
fn current_paths_have_their_own_length_and_normals() {
    let (_, notes) = ran();
    let (moved, risen) = (value(&notes, "moved"), value(&notes, "risen"));
    // The side was 1 mm high and is pulled outwards while its ends come closer: bent, it is longer than the distance of its ends.
    assert!(moved > 1.0 + risen && moved < 1.0, "{moved}");
    // Out of the body is to the right of a path that runs counter-clockwise.
    assert_near(value(&notes, "facing"), moved, 1e-12);
}

#[test]
fn mesh_sizes_hold_at_the_ends_of_paths() {
    let (simulation, _) = ran();
    let mesh = &simulation.system().mesh;
    let lengths = |path: &str| -> Vec<f64> {
        let length = |[a, b]: [u32; 2]| {
            let [a, b] = [a, b].map(|n| mesh.nodes[n as usize]);
            (b[0] - a[0]).hypot(b[1] - a[1])
        };
        mesh.path_edges(path).map(|edge| length([edge.nodes[0], edge.nodes[1]])).collect()
    };
    let (whisker, loose) = (lengths("whisker"), lengths("loose"));
    assert!(whisker[whisker.len() - 1] < 0.15 && whisker[0] > 0.3, "{whisker:?}");
    assert!(loose[0] < 0.15 && loose[loose.len() - 1] > 0.3, "{loose:?}");
}
