//! Thin shells against what is known of them in closed form: plates, strips rolled up, balloons, spheres that cave in.

use ansatz::Simulation;
use ansatz::generated::Program;
use ansatz_tests::models::{balloon, cave_in, plate, roll, roll_by_force};
use ansatz_tests::notes::Notes;

/// The rows of the first table of a run.
struct Rows {
    program: &'static Program,
    rows: Vec<Vec<f64>>,
    /// Newton iterations of the whole run.
    iterations: usize,
}

impl Rows {
    fn of(program: &'static Program, values: &[f64]) -> Self {
        let mut simulation = Simulation::new(program, values).expect("the model can be built");
        let mut notes = Notes::default();
        simulation.run(&mut notes, None).expect("the run reaches its end");
        let rows = notes.rows.into_iter().map(|(_, row)| row).collect();
        Self { program, rows, iterations: simulation.record().statistics().iterations }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let columns = self.program.tables[0].columns;
        let position = columns.iter().position(|column| column.name == name).expect("a column of the table");
        self.rows.iter().map(|row| row[position]).collect()
    }

    fn last(&self, name: &str) -> f64 {
        *self.column(name).last().expect("a row")
    }
}

#[track_caller]
fn assert_near(found: f64, expected: f64, error: f64) {
    assert!((found - expected).abs() < error, "{found} instead of {expected}");
}

/// Deflection of the plate, as parts of Kirchhoff's at the centre: at the centre and half-way to the rim.
fn deflection(thickness: f64, size: f64) -> [f64; 2] {
    let values = plate::Parameters { h: thickness, size, ..plate::Parameters::default() }.values();
    let rows = Rows::of(&plate::PROGRAM, &values);
    [rows.last("centre"), rows.last("half_way")]
}

#[test]
fn a_clamped_plate_deflects_as_kirchhoff_says_however_thin_it_is() {
    // The radius is 100: 1e-2, 1e-3 and 1e-4 of it. The thickest one is sheared by 4 (h/R)^2 = 0.04 %.
    for thickness in [1.0, 0.1, 0.01] {
        let [centre, half_way] = deflection(thickness, 5.0);
        assert_near(centre, 1.0, 2.5e-3);
        assert_near(half_way, 0.75_f64.powi(2), 2.5e-3);
    }
}

#[test]
fn the_deflection_of_a_plate_converges_with_the_square_of_the_edges() {
    let errors = [10.0, 5.0, 2.5].map(|size| 1.0 - deflection(0.1, size)[0]);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.8..2.2).contains(&order), "{errors:?}");
    }
}

#[test]
fn a_moment_rolls_a_thin_strip_up_to_a_circle_on_a_coarse_mesh() {
    // Length over thickness is 1000, one edge turns by 18 degrees.
    let rows = Rows::of(&roll::PROGRAM, &roll::Parameters::default().values());
    let tau = std::f64::consts::TAU;
    for (t, turned) in rows.column("t").iter().zip(rows.column("turned")) {
        assert_near(turned, tau * t, 1e-7);
    }
    // The strip is 100 long; Newton's method ends at forces of 1e-10 of those that act.
    assert_near(rows.last("x_end"), 0.0, 1e-5);
    assert_near(rows.last("y_end"), 0.0, 1e-5);
    // Half a turn ends above its start by the diameter 2 L/pi; edges are parabolas of 9 degrees.
    assert_near(rows.column("y_end")[2] / (200.0 / std::f64::consts::PI), 1.0, 1e-3);
}

#[test]
fn tension_and_shear_force_as_unknowns_spare_most_iterations_and_change_nothing() {
    let by_stretch = Rows::of(&roll::PROGRAM, &roll::Parameters::default().values());
    let by_force = Rows::of(&roll_by_force::PROGRAM, &roll_by_force::Parameters::default().values());
    for name in ["turned", "x_end", "y_end", "unturned", "x_arch", "y_arch"] {
        assert_near(by_force.last(name), by_stretch.last(name), 1e-6);
    }
    let [by_stretch, by_force] = [by_stretch.iterations, by_force.iterations];
    assert!(3 * by_force < by_stretch, "{by_force} iterations instead of {by_stretch}");
}

#[test]
fn curvatures_count_from_the_curved_reference() {
    let rows = Rows::of(&roll::PROGRAM, &roll::Parameters::default().values());
    let quarter = std::f64::consts::FRAC_PI_2;
    // Edges are parabolas of 3 degrees.
    assert_near(rows.last("unturned") / -quarter, 1.0, 1e-4);
    // The arch of radius 100 starts level and lies straight now: its end is no higher than its start.
    assert_near(rows.last("x_arch") / (100.0 * quarter), 1.0, 1e-4);
    assert_near(rows.last("y_arch"), 0.0, 1e-5);
}

/// Energy per volume of equibiaxial stretch of the compressible neo-Hookean law, where the stretch of the thickness makes it least, by the
/// stretch; G = 1 and nu = 0.3.
fn tension(stretch: f64) -> f64 {
    let bulk = 2.0 / 3.0 * 1.3 / 0.4;
    let slopes = |l3: f64| {
        let (j, square) = (stretch * stretch * l3, 2.0 * stretch * stretch + l3 * l3);
        let by_j = -square / 3.0 * j.powf(-5.0 / 3.0) + bulk * (j - 1.0);
        let shape = j.powf(-2.0 / 3.0);
        [2.0 * shape * stretch + by_j * 2.0 * stretch * l3, shape * l3 + by_j * stretch * stretch]
    };
    // The slope by l3 grows with l3.
    let (mut low, mut high) = (0.05, 1.5);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if slopes(middle)[1] > 0.0 { high = middle } else { low = middle }
    }
    slopes(low)[0]
}

#[test]
fn a_balloon_has_the_pressure_of_its_stretch_past_the_largest_pressure() {
    let given = balloon::Parameters::default();
    let rows = Rows::of(&balloon::PROGRAM, &given.values());
    let (stretches, pressures) = (rows.column("stretch"), rows.column("p"));
    // The first row stands before the skin pulls.
    for (&stretch, &pressure) in stretches.iter().zip(&pressures).skip(1) {
        let rubber = given.h / (given.R * stretch * stretch) * tension(stretch);
        let skin = 2.0 * given.gamma / (given.R * stretch);
        assert_near(pressure / (rubber + skin), 1.0, 1e-3);
    }
    let largest = pressures.iter().copied().fold(0.0, f64::max);
    assert!(largest > 1.1 * pressures[pressures.len() - 1] && stretches[stretches.len() - 1] > 1.9);
}

#[test]
fn areas_and_means_over_the_current_surface_are_those_of_the_moved_sphere() {
    let rows = Rows::of(&balloon::PROGRAM, &balloon::Parameters::default().values());
    let (stretch, radius) = (rows.last("stretch"), 10.0 * rows.last("stretch"));
    assert_near(rows.last("area") / (4.0 * std::f64::consts::PI * radius * radius), 1.0, 1e-4);
    assert_near(rows.last("swollen") / stretch.powi(3), 1.0, 1e-4);
    assert_near(rows.last("mean_stretch"), stretch, 1e-6);
}

#[test]
fn a_sphere_caves_in_near_the_classical_pressure() {
    for flaw in [0.02, 0.005] {
        let values = cave_in::Parameters { flaw, ..cave_in::Parameters::default() }.values();
        let rows = Rows::of(&cave_in::PROGRAM, &values);
        let lowest = rows.column("part").into_iter().fold(0.0, f64::min);
        assert_near(lowest, -1.0, 0.05);
        // It snaps to a dent of many thicknesses (10 nm) and holds little pressure then.
        assert!(rows.last("dent").abs() > 0.5 && rows.last("part").abs() < 0.1, "{:?}", rows.rows.last());
    }
}
