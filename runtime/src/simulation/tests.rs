//! A model small enough to solve by hand, written as a compiler would emit it:
//! u' + u = 0 on the unit square with u = 1 at the start, so u = exp(-t); s' + s = Z with Z = integral of u and s = 0, so s = t exp(-t).

use super::Simulation;
use crate::error::Error;
use crate::generated::{
    Action, Batch, Column, Domain, Event, Every, Field, FrameColumn, Frames, Functional, FunctionalKind,
    Geometry, Integral, Integrator, Layout, MeshSizing, Observable, ObservableKind, PointFunction,
    PointInput, Program, Record, Row, Solve, Space, Start, State, StateSystem, Table, Trigger, Use,
};
use crate::mesh::structured_rectangle;
use crate::observer::{Both, Frame, Observer};

type Rows = [Row];

const BODY: Domain = Domain::Cells(&["body"]);

fn area(batch: &Batch<'_>, lane: usize) -> f64 {
    let x = |i: usize| batch.nodes[i][lane];
    0.5 * ((x(2) - x(0)) * (x(5) - x(1)) - (x(4) - x(0)) * (x(3) - x(1)))
}

/// Entry of the mass matrix of a linear triangle over its area.
fn mass(i: usize, j: usize) -> f64 {
    if i == j { 1.0 / 6.0 } else { 1.0 / 12.0 }
}

/// Mass matrix times values or rates.
fn weighted(batch: &Batch<'_>, rows: &Rows, out: &mut Rows) {
    for (i, row) in out.iter_mut().enumerate().take(3) {
        let sum = |lane: usize| (0..3).map(|j| mass(i, j) * rows[j][lane]).sum::<f64>();
        *row = Row::from_fn(|lane| area(batch, lane) * sum(lane));
    }
}

/// Lower triangle of the mass matrix times a factor.
fn mass_tangent(batch: &Batch<'_>, factor: f64, out: &mut Rows) {
    let entries = (0..3).flat_map(|i| (0..=i).map(move |j| (i, j)));
    for ((i, j), row) in entries.zip(out) {
        *row = Row::from_fn(|lane| factor * area(batch, lane) * mass(i, j));
    }
}

fn decay(batch: &Batch<'_>, _: &[f64], out: &mut Rows) {
    weighted(batch, batch.values, out);
}

fn decay_tangent(batch: &Batch<'_>, g: &[f64], out: &mut Rows) {
    decay(batch, g, out);
    mass_tangent(batch, 1.0, &mut out[3..]);
}

fn change(batch: &Batch<'_>, _: &[f64], out: &mut Rows) {
    weighted(batch, batch.rates, out);
}

fn change_tangent(batch: &Batch<'_>, g: &[f64], out: &mut Rows) {
    change(batch, g, out);
    mass_tangent(batch, batch.alpha, &mut out[3..]);
}

fn total(batch: &Batch<'_>, _: &[f64], out: &mut Rows) {
    let mean = |lane: usize| (0..3).map(|j| batch.values[j][lane]).sum::<f64>() / 3.0;
    out[0] = Row::from_fn(|lane| area(batch, lane) * mean(lane));
}

fn total_variation(batch: &Batch<'_>, _: &[f64], out: &mut Rows) {
    out[..3].fill(Row::from_fn(|lane| area(batch, lane) / 3.0));
}

const INTEGRAL_OF_U: Integral = Integral {
    name: "integral of u",
    place: "model:1",
    block: 0,
    domain: BODY,
    uses: &[Use { field: 0 }],
    rates: true,
    symmetric: true,
    value: Some(total),
    residual: total_variation,
    tangent: None,
    global_tangent: None,
};

/// Globals: limit, time, s, s', Z, Z', integral of u.
const LAYOUT: Layout = Layout {
    parameters: [0, 1],
    measures: [1, 1],
    constants: [1, 1],
    time: 1,
    states: [2, 3],
    state_rates: [3, 4],
    functionals: [4, 5],
    functional_rates: [5, 6],
    observables: [6, 7],
    length: 7,
};

const fn program(solve: fn(&[f64]) -> Solve) -> Program {
    Program {
        name: "decay",
        doc: "",
        source_hash: "",
        base_scales: [1.0; 6],
        base_units: ["m", "s", "kg", "K", "mol", "A"],
        axisymmetric: false,
        layout: LAYOUT,
        parameters: &[],
        geometry: |_| Ok(Geometry::default()),
        sizing: |_| MeshSizing::default(),
        measures: &[],
        weight: |_| 1.0,
        constants: |_| {},
        fields: &[Field {
            name: "u",
            components: 1,
            component_names: &[""],
            space: Space::P1,
            domains: &[Domain::Cells(&["body"])],
            unit: "1",
            differential: true,
            start: |_, _, out| out[0] = 1.0,
        }],
        states: &[State {
            name: "s",
            unit: "1",
            start: Start::Fixed,
            value: |_| 0.0,
            bounds: |_| (f64::NEG_INFINITY, f64::INFINITY),
        }],
        functionals: &[Functional { name: "Z", unit: "1", kind: FunctionalKind::Integral(&[INTEGRAL_OF_U]) }],
        blocks: &["decay"],
        ties: &[],
        moving: &[],
        gap_sizes: &[],
        holds: &[],
        integrals: &[
            Integral { value: None, residual: decay, tangent: Some(decay_tangent), ..INTEGRAL_OF_U },
            Integral { value: None, residual: change, tangent: Some(change_tangent), ..INTEGRAL_OF_U },
        ],
        pairs: &[],
        pair_integrals: &[],
        pair_loads: &[],
        couplings: None,
        state_system: Some(StateSystem {
            switches: 0,
            places: &["model:2"],
            differential: &[true],
            algebraic_equations: &[false],
            switch: |_, _| {},
            residual: |g, _, out| out[0] = g[3] + g[2] - g[4],
            jacobian: |_, _, alpha, out| out[0] = 1.0 + alpha,
            sensitivity: |_, _, _, out| out[0] = -1.0,
        }),
        observables: &[Observable {
            name: "integral of u",
            unit: "1",
            kind: ObservableKind::Integral(&[INTEGRAL_OF_U]),
        }],
        events: &[Event {
            name: "halved",
            doc: "half is gone",
            trigger: Trigger::When { condition: |g| g[0] - g[6], duration: |_| 0.0, also: |_| 1.0 },
            actions: &[Action::Stop],
        }],
        solve,
        tables: &[Table {
            file: "history.csv",
            every: Every::Time(|_| 0.1),
            columns: &[
                Column { name: "t", unit: "s", unit_value: 1.0, value: |g| g[1] },
                Column { name: "s", unit: "%", unit_value: 0.01, value: |g| g[2] },
            ],
        }],
        frames: &[Frames {
            domain: Domain::Cells(&["body"]),
            every: Every::Time(|_| 0.25),
            columns: &[FrameColumn { name: "u", unit: "1", unit_value: 1.0, components: 1, offset: 0 }],
            function: PointFunction {
                inputs: &[PointInput { field: 0, component: 0, derivative: None, rate: false }],
                outputs: 1,
                regions: &["body"],
                evaluate: |_, _, inputs, _, out| out[0] = inputs[0],
            },
        }],
        tests: &[],
    }
}

const SOLVE: Solve = Solve {
    time: Some((0.0, 2.0)),
    integrator: Integrator::Sdirk2,
    max_step: 0.2,
    min_step: 1e-6,
    step_tolerance: 1e-5,
    newton_tolerance: 1e-10,
    newton_iterations: 10,
};

static DECAY: Program = program(|_| SOLVE);
static REST: Program = program(|_| Solve { time: None, ..SOLVE });

#[derive(Default)]
struct Notes {
    cells: usize,
    rows: Vec<Vec<f64>>,
    frames: Vec<Frame>,
}

impl Observer for Notes {
    fn begin(&mut self, mesh: &crate::mesh::Mesh) -> Result<(), Error> {
        self.cells = mesh.cells.len();
        Ok(())
    }
    fn row(&mut self, _: usize, values: &[f64]) -> Result<(), Error> {
        self.rows.push(values.to_vec());
        Ok(())
    }
    fn wants_frames(&self) -> bool {
        true
    }
    fn frame(&mut self, frame: Frame) -> Result<(), Error> {
        self.frames.push(frame);
        Ok(())
    }
}

/// An observer of nothing.
struct Silent;

impl Observer for Silent {}

/// Told of a frame though it wants none, it stops the run.
struct NoFrames;

impl Observer for NoFrames {
    fn frame(&mut self, _: Frame) -> Result<(), Error> {
        Err(Error::Model("a frame that nobody wants".into()))
    }
}

fn simulation(program: &'static Program, limit: f64) -> Simulation {
    Simulation::on_mesh(program, &[limit], structured_rectangle(3, 3, |x, y| [x, y])).unwrap()
}

#[test]
fn frames_are_sampled_where_an_observer_wants_them() {
    assert_eq!(simulation(&DECAY, 0.0).run(&mut NoFrames, None).unwrap(), "finished");
    let mut notes = Notes::default();
    let both = simulation(&DECAY, 0.0).run(&mut Both(&mut notes, &mut Silent), None).unwrap();
    assert_eq!((both, notes.frames.len()), ("finished", 9));
}

#[test]
fn fields_states_and_outputs_follow_the_known_solution() {
    let (mut decay, mut notes) = (simulation(&DECAY, 0.0), Notes::default());
    assert_eq!(decay.run(&mut notes, None).unwrap(), "finished");
    assert_eq!((notes.cells, notes.rows.len(), notes.frames.len()), (18, 21, 9));
    for row in &notes.rows {
        assert!((row[1] - 100.0 * row[0] * (-row[0]).exp()).abs() < 0.02, "{row:?}");
    }
    for frame in &notes.frames {
        let exact = (-frame.time).exp();
        assert!(frame.columns[0].iter().all(|u| (u - exact).abs() < 2e-4), "t = {}", frame.time);
    }
    assert!(decay.record().steps().iter().all(|g| (g[6] - g[4]).abs() < 1e-12), "observable and functional");
}

#[test]
fn a_run_stops_at_its_event_or_at_the_time_asked_for() {
    let mut decay = simulation(&DECAY, 0.5);
    assert_eq!(decay.run(&mut Notes::default(), None).unwrap(), "halved");
    let time = decay.record().event_time("halved").unwrap();
    assert!((time - std::f64::consts::LN_2).abs() < 2e-4, "{time}");
    assert_eq!(decay.run(&mut Notes::default(), Some(0.3)).unwrap(), "finished");
    assert_eq!(decay.record().times().last(), Some(&0.3));
}

#[test]
fn a_model_without_time_is_solved_once() {
    let (mut rest, mut notes) = (simulation(&REST, 0.0), Notes::default());
    assert_eq!(rest.run(&mut notes, None).unwrap(), "finished");
    assert!(rest.record().steps()[0][6].abs() < 1e-12);
    assert_eq!((notes.rows.len(), notes.frames.len()), (1, 1));
}

/// x' = -x from 1 and w = x^2; at x = 1/2 an event sets x to 2.
static STATES: Program = Program {
    layout: Layout {
        states: [2, 4],
        state_rates: [4, 6],
        functionals: [6, 6],
        functional_rates: [6, 6],
        observables: [6, 6],
        length: 6,
        ..LAYOUT
    },
    fields: &[],
    states: &[
        State { name: "x", unit: "1", start: Start::Fixed, value: |_| 1.0, bounds: |_| EVERYWHERE },
        State { name: "w", unit: "1", start: Start::Solved, value: |_| 0.0, bounds: |_| EVERYWHERE },
    ],
    functionals: &[],
    blocks: &[],
    integrals: &[],
    state_system: Some(StateSystem {
        switches: 0,
        places: &["model:1", "model:2"],
        differential: &[true, false],
        algebraic_equations: &[false, true],
        switch: |_, _| {},
        residual: |g, _, out| out.copy_from_slice(&[g[4] + g[2], g[3] - g[2] * g[2]]),
        jacobian: |g, _, alpha, out| out.copy_from_slice(&[1.0 + alpha, 0.0, -2.0 * g[2], 1.0]),
        sensitivity: |_, _, _, _| {},
    }),
    observables: &[],
    events: &[Event {
        name: "halved",
        doc: "",
        trigger: Trigger::When { condition: |g| 0.5 - g[2], duration: |_| 0.0, also: |_| 1.0 },
        actions: &[Action::Set(0, |_| 2.0)],
    }],
    tables: &[],
    frames: &[],
    ..program(|_| SOLVE)
};

const EVERYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

#[test]
fn states_alone_run_and_follow_at_once_when_one_is_set() {
    let mut states = Simulation::new(&STATES, &[0.0]).unwrap();
    assert_eq!(states.run(&mut Notes::default(), None).unwrap(), "finished");
    let record = states.record();
    let jump = record.event_time("halved").unwrap();
    assert!((jump - std::f64::consts::LN_2).abs() < 1e-4, "{jump}");
    let after = record.steps().iter().find(|g| g[2] > 1.5).unwrap();
    assert!(after[1] == jump && (after[3] - 4.0).abs() < 1e-12, "{after:?}");
    let end = record.steps().last().unwrap();
    // Local errors up to 1e-5 in each of some 100 steps, damped by the decay.
    assert!((end[2] - 2.0 * (jump - 2.0).exp()).abs() < 1e-3, "{end:?}");
}

/// Why a run of this program cannot start.
fn refusal(program: &'static Program) -> String {
    let refused = Simulation::on_mesh(program, &[0.0], structured_rectangle(1, 1, |x, y| [x, y]));
    refused.err().map_or_else(String::new, |error| error.to_string())
}

#[test]
fn settings_with_which_no_run_can_start_are_refused() {
    static BACKWARDS: Program = program(|_| Solve { time: Some((2.0, 1.0)), ..SOLVE });
    static NO_TIME: Program = program(|_| Solve { time: Some((0.0, f64::NAN)), ..SOLVE });
    static NO_STEP: Program = program(|_| Solve { max_step: 0.0, ..SOLVE });
    static NO_TOLERANCE: Program = program(|_| Solve { newton_tolerance: 0.0, ..SOLVE });
    static NO_ITERATION: Program = program(|_| Solve { newton_iterations: 0, ..SOLVE });
    static NO_INTERVAL: Program = Program {
        events: &[Event { name: "beat", doc: "", trigger: Trigger::Every(|g| g[0]), actions: &[] }],
        ..program(|_| SOLVE)
    };
    let claims: [(&'static Program, &str); 6] = [
        (&BACKWARDS, "after it starts"),
        (&NO_TIME, "after it starts"),
        (&NO_STEP, "`max: 0`"),
        (&NO_TOLERANCE, "`tolerance: 0`"),
        (&NO_ITERATION, "`iterations`"),
        (&NO_INTERVAL, "`beat` would fire every 0"),
    ];
    for (program, words) in claims {
        let message = refusal(program);
        assert!(message.contains(words), "{words}: {message}");
    }
    assert_eq!(refusal(&DECAY), "");
}
