//! Whole runs of small systems with known solutions.

use super::control::with_step_bounds;
use super::events::Watcher;
use super::integrator::{Point, advance, tableau};
use super::march::March;
use super::run::{Plan, run};
use super::{Group, ImplicitSystem, Stage};
use crate::error::{Cause, Error, SolveError};
use crate::generated::{Action, Column, Event, Every, Integrator, Record, Solve, Table, Trigger};
use crate::observer::{Fired, Observer, Step};
use crate::record::{End, RunRecord};
use std::ops::Range;

/// F(t, y, y') as a plain function, solved by Newton's method with differences for the Jacobian. Globals are (t, y, y').
struct Small {
    residual: fn(f64, &[f64], &[f64]) -> Vec<f64>,
    differential: &'static [bool],
    /// Stages whose time lies here fail.
    forbidden: std::ops::Range<f64>,
    solves: usize,
}

impl Small {
    fn new(differential: &'static [bool], residual: fn(f64, &[f64], &[f64]) -> Vec<f64>) -> Self {
        Self { residual, differential, forbidden: 0.0..0.0, solves: 0 }
    }

    fn newton_step(&self, stage: &Stage<'_>, y: &[f64]) -> Vec<f64> {
        let f = |y: &[f64]| (self.residual)(stage.time, y, &stage.rates(y));
        let (n, now) = (y.len(), f(y));
        let mut rows: Vec<Vec<f64>> = now.iter().map(|r| [vec![0.0; n], vec![-r]].concat()).collect();
        for j in 0..n {
            let mut moved = y.to_vec();
            let h = 1e-7 * (1.0 + y[j].abs());
            moved[j] += h;
            f(&moved).iter().enumerate().for_each(|(i, r)| rows[i][j] = (r - now[i]) / h);
        }
        gauss_jordan(rows)
    }
}

fn gauss_jordan(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs())).unwrap();
        rows.swap(k, pivot);
        let pivot_row: Vec<f64> = rows[k].iter().map(|x| x / rows[k][k]).collect();
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = if i == k { 0.0 } else { row[k] };
            row.iter_mut().zip(&pivot_row).for_each(|(x, p)| *x -= factor * p);
        }
        rows[k] = pivot_row;
    }
    rows.iter().map(|row| row[n]).collect()
}

fn failure(time: f64) -> SolveError {
    let place = String::from("y");
    SolveError {
        cause: Cause::NoConvergence,
        time,
        step: 0.0,
        iterations: 1,
        residual: 1.0,
        place,
        terms: vec![],
    }
}

impl ImplicitSystem for Small {
    fn groups(&self) -> Vec<Group> {
        let group = |(i, &tested): (usize, &bool)| Group { range: i..i + 1, tested };
        self.differential.iter().enumerate().map(group).collect()
    }

    fn algebraic(&self) -> Vec<Range<usize>> {
        (0..self.differential.len()).filter(|&i| !self.differential[i]).map(|i| i..i + 1).collect()
    }

    fn solve_stage(&mut self, stage: &Stage<'_>, y: &mut [f64]) -> Result<usize, SolveError> {
        self.solves += 1;
        if self.forbidden.contains(&stage.time) {
            return Err(failure(stage.time));
        }
        for iteration in 1..=20 {
            let step = self.newton_step(stage, y);
            y.iter_mut().zip(&step).for_each(|(y, step)| *y += step);
            if y.iter().zip(&step).all(|(y, step)| step.abs() <= 1e-11 * (1.0 + y.abs())) {
                return Ok(iteration);
            }
        }
        Err(failure(stage.time))
    }

    fn set_states(&mut self, _: f64, y: &mut [f64], values: &[(usize, f64)]) -> Result<(), SolveError> {
        values.iter().for_each(|&(state, value)| y[state] = value);
        Ok(())
    }

    fn observe(&mut self, point: &Point) -> Vec<f64> {
        [&[point.time], point.values.as_slice(), &point.rates].concat()
    }

    fn sample(&mut self, _: usize, point: &Point, _: &[f64]) -> Vec<Vec<f64>> {
        vec![point.values.clone()]
    }
}

/// x'' = -x with x = cos t.
fn oscillator() -> Small {
    Small::new(&[true, true], |_, y, rates| vec![rates[0] - y[1], rates[1] + y[0]])
}

/// Prothero and Robinson: y' = -k (y - sin t) + cos t with y = sin t.
fn prothero_robinson<const K: u32>() -> Small {
    Small::new(&[true], |t, y, rates| vec![rates[0] + f64::from(K) * (y[0] - t.sin()) - t.cos()])
}

/// x' = z, 0 = z + x^3 with x = 1/sqrt(1 + 2 t): index 1.
fn index_one() -> Small {
    Small::new(&[true, false], |_, y, rates| vec![rates[0] - y[1], y[1] + y[0].powi(3)])
}

/// Error at t = 2 after equal steps.
fn error_after(system: &mut Small, integrator: Integrator, start: Vec<f64>, exact: f64, steps: usize) -> f64 {
    let size = 2.0 / steps as f64;
    let mut point = Point { time: 0.0, rates: vec![0.0; start.len()], values: start };
    for _ in 0..steps {
        point = advance(tableau(integrator), system, &point, size, |_| point.values.clone(), &mut 0).unwrap();
    }
    (point.values[0] - exact).abs()
}

fn order(make: fn() -> Small, integrator: Integrator, start: &[f64], exact: f64) -> f64 {
    let error = |steps| error_after(&mut make(), integrator, start.to_vec(), exact, steps);
    (error(40) / error(80)).log2()
}

#[test]
fn the_methods_have_their_order_on_smooth_and_algebraic_problems() {
    let check = |make: fn() -> Small, start: &[f64], exact: f64| {
        let second = order(make, Integrator::Sdirk2, start, exact);
        let first = order(make, Integrator::BackwardEuler, start, exact);
        assert!((second - 2.0).abs() < 0.15, "order {second}");
        assert!((first - 1.0).abs() < 0.15, "order {first}");
    };
    check(oscillator, &[1.0, 0.0], 2f64.cos());
    check(index_one, &[1.0, -1.0], 1.0 / 5f64.sqrt());
}

#[test]
fn stiffness_does_not_cost_accuracy() {
    let error = |make: fn() -> Small| error_after(&mut make(), Integrator::Sdirk2, vec![0.0], 2f64.sin(), 40);
    // The order falls to 1 in the stiff limit, but with a factor of 1/1e4.
    assert!(error(prothero_robinson::<10_000>) < 0.1 * error(prothero_robinson::<1>));
    assert!(order(prothero_robinson::<10_000>, Integrator::BackwardEuler, &[0.0], 2f64.sin()) > 0.9);
}

#[test]
fn a_stiff_component_is_damped_in_one_step() {
    let mut system = Small::new(&[true], |_, y, rates| vec![rates[0] + 1e8 * y[0]]);
    let start = Point { time: 0.0, values: vec![1.0], rates: vec![0.0] };
    for integrator in [Integrator::Sdirk2, Integrator::BackwardEuler] {
        let end = advance(tableau(integrator), &mut system, &start, 1.0, |_| vec![0.0], &mut 0).unwrap();
        assert!(end.values[0].abs() < 1e-6, "{}", end.values[0]);
    }
}

fn settings(end: f64, tolerance: f64, max_step: f64) -> Solve {
    Solve {
        time: Some((0.0, end)),
        integrator: Integrator::Sdirk2,
        max_step,
        min_step: 1e-6,
        step_tolerance: tolerance,
        newton_tolerance: 1e-8,
        newton_iterations: 15,
    }
}

fn plan(settings: Solve, events: &'static [Event]) -> Plan {
    Plan { settings, events, tables: &[], frames: &[] }
}

/// Keeps what it is told.
#[derive(Default)]
struct Notes {
    sizes: Vec<f64>,
    rows: Vec<(usize, Vec<f64>)>,
    frames: Vec<(f64, f64)>,
    fired: Vec<Fired>,
}

impl Observer for Notes {
    fn step(&mut self, step: &Step<'_>) -> Result<(), Error> {
        self.sizes.push(step.size);
        Ok(())
    }
    fn row(&mut self, table: usize, values: &[f64]) -> Result<(), Error> {
        self.rows.push((table, values.to_vec()));
        Ok(())
    }
    fn wants_frames(&self) -> bool {
        true
    }
    fn frame(&mut self, frame: crate::observer::Frame) -> Result<(), Error> {
        self.frames.push((frame.time, frame.columns[0][0]));
        Ok(())
    }
    fn fired(&mut self, event: &Fired) -> Result<(), Error> {
        self.fired.push(event.clone());
        Ok(())
    }
}

fn run_small(system: &mut Small, plan: Plan, start: &[f64]) -> (RunRecord, Notes) {
    let mut notes = Notes::default();
    let record = run(system, plan, start.to_vec(), &mut notes).unwrap();
    (record, notes)
}

#[test]
fn the_error_follows_the_tolerance() {
    let error = |tolerance: f64| {
        let (record, notes) =
            run_small(&mut oscillator(), plan(settings(10.0, tolerance, 1.0), &[]), &[1.0, 0.0]);
        let worst = record.steps().iter().map(|g| (g[1] - g[0].cos()).abs()).fold(0.0, f64::max);
        (worst, notes.sizes.len())
    };
    let ((coarse, few), (fine, many)) = (error(1e-4), error(1e-6));
    // Local errors of a tolerance add up over 10 radians in steps of a tenth or so.
    assert!(coarse < 1e-2 && fine < 1e-3 && coarse / fine > 10.0, "{coarse} {fine}");
    assert!(few < 150 && many < 700, "{few} {many}");
}

#[test]
fn robertson_reaches_its_slow_phase_in_few_steps() {
    let mut system = Small::new(&[true, true, false], |_, y, rates| {
        let (slow, fast, quadratic) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
        vec![rates[0] + slow - fast, rates[1] - slow + fast + quadratic, y[0] + y[1] + y[2] - 1.0]
    });
    let (record, notes) = run_small(&mut system, plan(settings(40.0, 1e-4, 5.0), &[]), &[1.0, 0.0, 0.0]);
    let end = record.steps().last().unwrap();
    // Reference: y(40) = (0.7158271, 9.185535e-6, 0.2841637), Hairer and Wanner, Solving ODEs II, IV.10.
    assert!((end[1] - 0.715_827_1).abs() < 1e-3 && (end[2] / 9.185_535e-6 - 1.0).abs() < 1e-2, "{end:?}");
    assert!((end[1] + end[2] + end[3] - 1.0).abs() < 1e-12);
    assert!(notes.sizes.len() < 150, "{}", notes.sizes.len());
}

/// Tension of a stress fibre on stretching bonds [nN] from their stretch [um].
fn tension(stretch: f64) -> f64 {
    let (stiffness, thermal, most, area) = (0.15, 1.381e-8 * 310.0, 5000.0, 4.0);
    let energy = 0.5 * stiffness * stretch * stretch - 5.0 * thermal;
    most / (1.0 + (-energy / thermal).exp()) * stiffness * stretch * area
}

#[test]
fn a_stress_fibre_against_drag_follows_the_reference_mostly_in_the_largest_steps() {
    // Activation eta and bond stretch d: S1, and S2 with S11 for v_A = tau/kappa, v_C = 0, in nN, um, s.
    let mut system = Small::new(&[true, true], |t, y, rates| {
        let part = tension(y[1]) / 100.0;
        let activation = (1.0 - y[0]) * 0.1 * (-t / 100.0).exp() - 0.01 * (y[0] - part);
        vec![rates[0] - activation, part + 0.1 * (part - y[0]) + rates[1]]
    });
    let (record, notes) = run_small(&mut system, plan(settings(200.0, 1e-4, 1.0), &[]), &[0.0, 0.0]);
    let reference =
        [(5.0, 3.405), (10.0, 5.356), (20.0, 7.113), (50.0, 7.923), (100.0, 7.529), (200.0, 6.149)];
    for (time, expected) in reference {
        let found = tension(record.at(time)[2]);
        assert!((found / expected - 1.0).abs() < 1e-3, "tau({time}) = {found}, not {expected}");
    }
    let largest = notes.sizes.iter().filter(|size| **size == 1.0).count();
    assert!(notes.sizes.len() < 280 && largest > 180, "{} {largest}", notes.sizes.len());
}

#[test]
fn a_slow_problem_goes_at_the_largest_step_after_a_short_start() {
    let mut system = Small::new(&[true], |_, y, rates| vec![rates[0] + (y[0] - 1.0) / 50.0]);
    let (_, notes) = run_small(&mut system, plan(settings(250.0, 1e-4, 1.0), &[]), &[0.0]);
    assert!(notes.sizes.len() < 265, "{}", notes.sizes.len());
}

#[test]
fn a_failed_solve_halves_the_step_and_gives_up_at_the_smallest() {
    let mut system = oscillator();
    system.forbidden = 3.05..3.3;
    let smooth = settings(5.0, 1.0, 0.5);
    let (record, notes) = run_small(&mut system, plan(smooth, &[]), &[1.0, 0.0]);
    let error = record.failure().expect("there is no way past the gap");
    assert_eq!(record.outcome(), "diverged");
    let rejected = record.statistics().rejected;
    assert!((18..25).contains(&rejected), "{rejected} halvings lead from 0.5 to 1e-6");
    assert!(error.time < 3.05 && error.time > 3.0499 && error.step < 2e-6, "{} {}", error.time, error.step);
    assert_eq!(record.steps().len(), notes.sizes.len() + 1, "what was done is kept");
}

const ALWAYS: fn(&[f64]) -> f64 = |_| 1.0;
const AT_ONCE: fn(&[f64]) -> f64 = |_| 0.0;

const fn when(
    name: &'static str,
    condition: fn(&[f64]) -> f64,
    duration: fn(&[f64]) -> f64,
    actions: &'static [Action],
) -> Event {
    Event { name, doc: "", trigger: Trigger::When { condition, duration, also: ALWAYS }, actions }
}

static CROSSING: [Event; 2] =
    [when("downwards", |g| -g[1], AT_ONCE, &[]), when("rested", |g| 0.5 - g[1].abs(), |_| 0.7, &[])];

#[test]
fn events_are_located_inside_steps_and_durations_kept() {
    let (record, notes) =
        run_small(&mut oscillator(), plan(settings(6.0, 1e-6, 0.5), &CROSSING), &[1.0, 0.0]);
    let quarter = std::f64::consts::FRAC_PI_2;
    let crossing = record.event_time("downwards").unwrap();
    assert!((crossing - quarter).abs() < 5e-4, "{crossing}");
    // |cos t| < 1/2 from pi/3 on, for pi/3 > 0.7.
    let rested = record.event_time("rested").unwrap();
    assert!((rested - (2.0 / 3.0 * quarter + 0.7)).abs() < 1e-3, "{rested}");
    assert_eq!(notes.fired.len(), 3, "the second passage through zero rests as well");
}

static STOP: [Event; 1] = [when("downwards", |g| -g[1], AT_ONCE, &[Action::Stop])];

#[test]
fn a_stop_ends_the_run_at_the_event() {
    let (record, _) = run_small(&mut oscillator(), plan(settings(6.0, 1e-4, 0.5), &STOP), &[1.0, 0.0]);
    let end = record.steps().last().unwrap();
    assert!(matches!(record.end(), End::Stopped(0)));
    assert_eq!(record.outcome(), "downwards");
    assert_eq!(record.event_time("downwards"), Some(end[0]));
    // The interpolation that located the event and the step that ends there differ by its error.
    assert!(end[1].abs() < 1e-3, "{}", end[1]);
}

static BOUNCE: [Event; 1] = [when("bounce", |g| -g[1], AT_ONCE, &[Action::Set(1, |g| -g[2])])];

#[test]
fn a_ball_bounces_by_setting_its_velocity() {
    let mut ball = Small::new(&[true, true], |_, y, rates| vec![rates[0] - y[1], rates[1] + 1.0]);
    let (record, notes) = run_small(&mut ball, plan(settings(8.0, 1e-4, 0.3), &BOUNCE), &[0.5, 0.0]);
    let bounces: Vec<f64> = notes.fired.iter().map(|f| f.time).collect();
    assert_eq!(bounces.len(), 4, "{bounces:?}");
    // SDIRK2 and quadratic interpolation are exact for a parabola; bounces are located to 1e-6 of a step.
    for (k, time) in bounces.iter().enumerate() {
        assert!((time - (1 + 2 * k) as f64).abs() < 1e-5, "{bounces:?}");
    }
    let energy = |g: &Vec<f64>| g[1] + 0.5 * g[2] * g[2];
    assert!(record.steps().iter().all(|g| (energy(g) - 0.5).abs() < 1e-5));
    assert!((record.at(2.0)[1] - 0.5).abs() < 1e-5);
}

static RESET: [Event; 2] = [
    Event { name: "reset", doc: "", trigger: Trigger::Every(|_| 1.3), actions: &[Action::Set(0, |_| 2.0)] },
    when("high", |g| g[1] - 1.9, AT_ONCE, &[]),
];

#[test]
fn a_periodic_reset_happens_on_time_and_its_jump_turns_conditions_true() {
    let mut decay = Small::new(&[true], |_, y, rates| vec![rates[0] + y[0]]);
    let (record, notes) = run_small(&mut decay, plan(settings(3.0, 1e-5, 0.5), &RESET), &[1.0]);
    let times: Vec<(usize, f64)> = notes.fired.iter().map(|f| (f.event, f.time)).collect();
    assert_eq!(times, vec![(0, 1.3), (1, 1.3), (0, 2.6), (1, 2.6)]);
    let end = record.steps().last().unwrap();
    assert!((end[1] - 2.0 * (-0.4f64).exp()).abs() < 1e-4, "{}", end[1]);
    assert!((record.at(1.3)[1] - (-1.3f64).exp()).abs() < 1e-4, "before the jump");
}

const fn column(name: &'static str, unit_value: f64, value: fn(&[f64]) -> f64) -> Column {
    Column { name, unit: "", unit_value, value }
}

const fn quarterly(file: &'static str, columns: &'static [Column]) -> Table {
    Table { file, every: Every::Time(|_| 0.25), columns }
}

/// The kinks in the second table ask for lines there.
static TABLES: [Table; 2] = [
    quarterly("motion.csv", &[column("t", 1.0, |g| g[0]), column("x", 1.0, |g| g[1])]),
    quarterly(
        "forces.csv",
        &[column("minus_force", 1e-3, |g| 1e-3 * g[4]), column("sawtooth", 1.0, |g| (40.0 * g[1]).fract())],
    ),
];

#[test]
fn output_needs_time_between() {
    static AT_ONCE: [Table; 1] = [Table { file: "a.csv", every: Every::Time(|_| 0.0), columns: &[] }];
    let with_table = Plan { tables: &AT_ONCE, ..plan(settings(6.0, 1e-4, 0.5), &[]) };
    let failed = run(&mut oscillator(), with_table, vec![1.0, 0.0], &mut Notes::default()).err();
    let message = failed.map(|error| error.to_string()).unwrap_or_default();
    assert!(message.contains("`a.csv`") && message.contains("every step"), "{message}");
}

#[test]
fn rows_come_on_time_with_balances_kept_across_tables() {
    let with_table = Plan { tables: &TABLES, ..plan(settings(6.0, 1e-4, 0.5), &[]) };
    let (_, notes) = run_small(&mut oscillator(), with_table, &[1.0, 0.0]);
    let (motion, forces): (Vec<_>, Vec<_>) = notes.rows.into_iter().partition(|(table, _)| *table == 0);
    assert_eq!((motion.len(), forces.len()), (25, 25));
    for (k, ((_, motion), (_, forces))) in motion.into_iter().zip(forces).enumerate() {
        let (t, x, minus_force) = (motion[0], motion[1], forces[0]);
        assert!((t - 0.25 * k as f64).abs() < 1e-12);
        assert!((x - t.cos()).abs() < 5e-3, "{x} at {t}");
        // x'' = -x holds in every stage, hence in every row after the start, where the rate is measured by a tiny step.
        assert!((x + minus_force).abs() < if k == 0 { 1e-3 } else { 1e-9 }, "{x}, {minus_force} at {t}");
    }
}

#[test]
fn a_stationary_plan_is_one_solve() {
    let mut system = Small::new(&[false], |_, y, _| vec![y[0] * y[0] - 2.0]);
    let stationary =
        Plan { tables: &TABLES_OF_ONE, ..plan(Solve { time: None, ..settings(0.0, 1e-4, 1.0) }, &[]) };
    let (record, notes) = run_small(&mut system, stationary, &[1.0]);
    assert!((record.steps()[0][1] - 2f64.sqrt()).abs() < 1e-12);
    assert_eq!((notes.rows.len(), record.outcome()), (1, "finished"));
}

static TABLES_OF_ONE: [Table; 1] =
    [Table { file: "result.csv", every: Every::Step, columns: &[column("x", 1.0, |g| g[1])] }];

#[test]
fn a_watcher_of_nothing_never_acts() {
    assert_eq!(Watcher::new(&[], 0.0, &[]).next_act(), None);
}

#[test]
fn predictions_of_a_parabola_cost_no_correction() {
    let mut system = Small::new(&[true, true], |_, y, rates| vec![rates[0] - y[1], rates[1] + 1.0]);
    let mut march = March::new(&mut system, settings(5.0, 1e-4, 0.5), 0.0, vec![0.5, 0.0]).unwrap();
    for _ in 0..2 {
        let proposal = march.propose(&mut system, 5.0).unwrap();
        march.accept(proposal);
    }
    let proposal = march.propose(&mut system, 5.0).unwrap();
    assert!(proposal.iterations <= 4, "{}", proposal.iterations);
}

/// Number of steps until t = 10, at most 1, the smallest of them, and the largest error relative to the end, of what grows from zero.
fn growth_from_rest(
    residual: fn(f64, &[f64], &[f64]) -> Vec<f64>,
    exact: fn(f64) -> f64,
) -> (usize, f64, f64) {
    let (record, notes) =
        run_small(&mut Small::new(&[true], residual), plan(settings(10.0, 1e-4, 1.0), &[]), &[0.0]);
    let error = record.steps().iter().map(|g| (g[1] - exact(g[0])).abs() / exact(10.0)).fold(0.0, f64::max);
    (notes.sizes.len(), notes.sizes.iter().copied().fold(f64::INFINITY, f64::min), error)
}

#[test]
fn what_starts_or_wakes_from_rest_does_not_need_the_smallest_steps() {
    let check = |residual: fn(f64, &[f64], &[f64]) -> Vec<f64>, exact: fn(f64) -> f64, most: usize| {
        let (steps, smallest, error) = growth_from_rest(residual, exact);
        assert!(
            steps <= most && smallest > 1e-4 && error < 1e-4,
            "{steps} steps from {smallest}, error {error}"
        );
    };
    check(|t, _, rates| vec![rates[0] - t], |t| t * t / 2.0, 30);
    check(|t, _, rates| vec![rates[0] - t * t], |t| t.powi(3) / 3.0, 150);
    check(|t, _, rates| vec![rates[0] - (t - 3.3).max(0.0)], |t| (t - 3.3).max(0.0).powi(2) / 2.0, 30);
    check(
        |t, _, rates| vec![rates[0] - (t - 3.3).max(0.0).powi(2)],
        |t| (t - 3.3).max(0.0).powi(3) / 3.0,
        120,
    );
}

#[test]
fn a_start_that_cannot_be_solved_ends_at_the_smallest_step() {
    let mut system = oscillator();
    system.forbidden = 0.0..1.0;
    let unbounded = Solve { min_step: 0.0, max_step: f64::INFINITY, ..settings(10.0, 1e-4, 1.0) };
    let error = March::new(&mut system, with_step_bounds(unbounded), 0.0, vec![1.0, 0.0]).err().unwrap();
    assert!(error.step < 1e-6 && system.solves < 15, "{} {}", error.step, system.solves);
}
