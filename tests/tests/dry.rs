//! The dry-contact model through the whole transmigration, against an independent simulation of the same equations on other meshes
//! (`data/dry_baseline.csv`, with the bands in which a correct simulator lies).

use ansatz::Error;
use ansatz::generated::Program;
use ansatz::observer::{Observer, Step};
use ansatz_models::dry_contact;
use std::sync::OnceLock;

/// Values of the model's table at every accepted step.
#[derive(Default)]
struct Steps {
    rows: Vec<Vec<f64>>,
}

impl Observer for Steps {
    fn step(&mut self, step: &Step<'_>) -> Result<(), Error> {
        let columns = PROGRAM.tables[0].columns;
        let row: Vec<f64> = columns.iter().map(|c| (c.value)(step.globals) / c.unit_value).collect();
        self.rows.push(row);
        Ok(())
    }
}

static PROGRAM: &Program = &dry_contact::PROGRAM;

struct Passage {
    steps: Steps,
    outcome: &'static str,
    events: Vec<(&'static str, f64)>,
}

/// One run serves all tests.
fn passage() -> &'static Passage {
    static RUN: OnceLock<Passage> = OnceLock::new();
    RUN.get_or_init(|| {
        let parameters = dry_contact::Parameters::default();
        let mut simulation = dry_contact::simulation(&parameters).expect("the default model can be built");
        let mut steps = Steps::default();
        let outcome = simulation.run(&mut steps, None).expect("the run reaches its end");
        let fired = simulation.record().fired().iter();
        let events = fired.map(|f| (PROGRAM.events[f.event].name, f.time)).collect();
        Passage { steps, outcome, events }
    })
}

impl Passage {
    fn column(&self, name: &str) -> Vec<f64> {
        let k = PROGRAM.tables[0].columns.iter().position(|c| c.name == name).expect("the table has it");
        self.steps.rows.iter().map(|row| row[k]).collect()
    }

    /// (time, value) of the largest value between two times.
    fn largest(&self, name: &str, from: f64, to: f64) -> (f64, f64) {
        let points = self.column("t").into_iter().zip(self.column(name));
        let inside = points.filter(|(t, _)| (from..=to).contains(t));
        inside.max_by(|a, b| a.1.total_cmp(&b.1)).expect("there are steps between these times")
    }

    fn smallest(&self, name: &str, from: f64, to: f64) -> (f64, f64) {
        let points = self.column("t").into_iter().zip(self.column(name));
        let inside = points.filter(|(t, _)| (from..=to).contains(t));
        inside.min_by(|a, b| a.1.total_cmp(&b.1)).expect("there are steps between these times")
    }

    fn at(&self, name: &str, time: f64) -> f64 {
        interpolate(&self.column("t"), &self.column(name), time)
    }

    fn event(&self, name: &str) -> f64 {
        self.events.iter().find(|(n, _)| *n == name).expect("the event fires").1
    }
}

fn interpolate(times: &[f64], values: &[f64], time: f64) -> f64 {
    let k = times.partition_point(|t| *t < time).clamp(1, times.len() - 1);
    let s = ((time - times[k - 1]) / (times[k] - times[k - 1])).clamp(0.0, 1.0);
    values[k - 1] + s * (values[k] - values[k - 1])
}

fn within(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} +- {tolerance}");
}

#[test]
fn the_nucleus_gets_through() {
    assert_eq!(passage().outcome, "completed");
}

#[test]
fn it_first_touches_at_25_seconds_and_lets_go_at_124() {
    within(passage().event("contact_made"), 25.0, 0.6);
    within(passage().event("contact_lost"), 123.8, 1.0);
}

#[test]
fn it_speeds_up_stalls_and_breaks_through() {
    let run = passage();
    within(run.largest("v_n", 10.0, 40.0).1, 4.26, 0.02 * 4.26);
    let (stalled, slowest) = run.smallest("v_n", 30.0, 70.0);
    within(slowest, 3.12, 0.02 * 3.12);
    assert!((48.0..57.0).contains(&stalled), "the stall is at {stalled} s");
    within(run.event("breakthrough"), 85.58, 0.5);
    let (peak, fastest) = run.largest("v_n", 70.0, 120.0);
    within(fastest, 10.22, 0.02 * 10.22);
    within(peak, 88.1, 0.7);
}

#[test]
fn motors_and_bonds_follow_the_fibre() {
    let run = passage();
    within(run.at("eta", 50.0), 0.878, 1e-3);
    within(run.largest("eta", 0.0, 250.0).1, 0.8796, 1e-3);
    within(run.largest("bound", 0.0, 250.0).1, 0.458, 5e-3);
}

#[test]
fn tension_peaks_goes_slack_and_recovers() {
    let run = passage();
    within(run.largest("tau", 0.0, 90.0).1, 22.85, 0.01 * 22.85);
    assert!(run.largest("tau", 93.5, 106.0).1 <= 1e-9, "the fibre is slack in between");
    within(run.largest("tau", 110.0, 250.0).1, 7.05, 0.01 * 7.05);
    within(run.at("tau", 250.0), 5.37, 0.01 * 5.37);
    within(run.at("z_cen", 250.0), 11.98, 0.01 * 11.98);
}

#[test]
fn forces_on_the_nucleus_balance_at_every_step() {
    let run = passage();
    let forces = ["tau", "F_c", "F_d"].map(|name| run.column(name));
    for (k, time) in run.column("t").iter().enumerate() {
        let sum: f64 = forces.iter().map(|force| force[k]).sum();
        assert!(sum.abs() <= 1e-6, "{sum} nN are left at {time} s");
    }
}

#[test]
fn a_soft_roof_comes_down_to_the_nucleus() {
    let parameters = dry_contact::Parameters { G_ecm: 0.1, coarse: 2.0, ..Default::default() };
    let mut simulation = dry_contact::simulation(&parameters).expect("the model can be built");
    let outcome = simulation.run(&mut Steps::default(), None).expect("the run reaches its end");
    assert_eq!(outcome, "roof_contact");
}

#[test]
fn tension_follows_the_reference_over_the_whole_run() {
    let text = include_str!("../data/dry_baseline.csv");
    let number = |field: &str| field.parse::<f64>().expect("the file holds numbers");
    let reference: Vec<(f64, f64)> = text
        .lines()
        .skip(1)
        .map(|line| {
            let mut fields = line.split(',').map(number);
            (fields.next().expect("a time"), fields.next().expect("a tension"))
        })
        .collect();
    let run = passage();
    let (times, tau) = (run.column("t"), run.column("tau"));
    let rms = |shift: f64| {
        let square = |(t, reference): &(f64, f64)| (interpolate(&times, &tau, t + shift) - reference).powi(2);
        (reference.iter().map(square).sum::<f64>() / reference.len() as f64).sqrt()
    };
    let best = (-10..=10).map(|k| rms(f64::from(k) * 0.05)).fold(f64::INFINITY, f64::min);
    assert!(best <= 0.1, "rms difference {best} nN");
}
