//! `run.json`: everything about a run that is not a field or a table: model, parameters, mesh, solver statistics, events, outcome.

use crate::error::Error;
use crate::generated::Program;
use crate::mesh::Mesh;
use serde::Serialize;
use std::path::Path;

/// How a run went.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Name of the outcome, such as `completed`.
    pub outcome: String,
    /// Time reached [internal units].
    pub time: f64,
    /// Accepted and rejected steps.
    pub steps: [usize; 2],
    /// Newton iterations, one factorisation each.
    pub iterations: usize,
    /// Unknowns, equations of the sparse solver, entries of its matrix.
    pub unknowns: usize,
    /// Equations of the sparse solver.
    pub equations: usize,
    /// Stored entries of its matrix.
    pub matrix_entries: usize,
    /// How often moving regions were meshed, the first time included.
    pub meshings: usize,
    /// Threads that assembled and factored it.
    pub threads: usize,
    /// Events in the order in which they fired first.
    pub events: Vec<Fired>,
    /// Wall-clock time \[s\].
    pub wall_seconds: f64,
    /// Why it ended early.
    pub error: Option<String>,
}

/// An event that fired in a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fired {
    /// Index into the program's events.
    pub event: usize,
    /// When it fired first [internal units].
    pub time: f64,
    /// How often it fired.
    pub count: usize,
}

#[derive(Serialize)]
struct Summary<'a> {
    model: &'a str,
    outcome: &'a str,
    error: Option<&'a str>,
    time: Quantity<'a>,
    events: Vec<Event<'a>>,
    parameters: Vec<Parameter<'a>>,
    mesh: MeshStatistics,
    solver: Solver,
    versions: Versions<'a>,
}

#[derive(Serialize)]
struct Quantity<'a> {
    value: f64,
    unit: &'a str,
}

#[derive(Serialize)]
struct Event<'a> {
    name: &'a str,
    /// When it fired first.
    time: f64,
    unit: &'a str,
    /// How often it fired.
    count: usize,
    documentation: &'a str,
    /// The texts of its warnings; absent if it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    message: Option<String>,
}

#[derive(Serialize)]
struct Parameter<'a> {
    name: &'a str,
    value: f64,
    unit: &'a str,
    documentation: &'a str,
}

#[derive(Serialize)]
struct MeshStatistics {
    cells: usize,
    nodes: usize,
    smallest_quality: f64,
    mean_quality: f64,
    /// How often moving regions were meshed, the first time included, where there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    meshings: Option<usize>,
}

#[derive(Serialize)]
struct Solver {
    unknowns: usize,
    equations: usize,
    matrix_entries: usize,
    steps: usize,
    rejected_steps: usize,
    newton_iterations: usize,
    threads: usize,
    wall_seconds: f64,
}

#[derive(Serialize)]
struct Versions<'a> {
    ansatz: &'a str,
    model_sha256: &'a str,
}

/// Writes the file. `parameters` are internal values in the program's order.
pub fn write(
    path: &Path,
    program: &Program,
    parameters: &[f64],
    mesh: &Mesh,
    run: &Run,
) -> Result<(), Error> {
    let unit = program.base_units[2];
    let quality = mesh.quality();
    let summary = Summary {
        model: program.name,
        outcome: &run.outcome,
        error: run.error.as_deref(),
        time: Quantity { value: run.time, unit },
        events: run.events.iter().map(|fired| event(program, *fired)).collect(),
        parameters: program
            .parameters
            .iter()
            .zip(parameters)
            .map(|(p, v)| Parameter {
                name: p.name,
                value: v / p.unit_value,
                unit: p.unit,
                documentation: p.doc,
            })
            .collect(),
        mesh: MeshStatistics {
            cells: mesh.cells.len(),
            nodes: mesh.nodes.len(),
            smallest_quality: quality.smallest,
            mean_quality: quality.mean,
            meshings: (!program.moving.is_empty()).then_some(run.meshings),
        },
        solver: Solver {
            unknowns: run.unknowns,
            equations: run.equations,
            matrix_entries: run.matrix_entries,
            steps: run.steps[0],
            rejected_steps: run.steps[1],
            newton_iterations: run.iterations,
            threads: run.threads,
            wall_seconds: run.wall_seconds,
        },
        versions: Versions { ansatz: env!("CARGO_PKG_VERSION"), model_sha256: program.source_hash },
    };
    let text = serde_json::to_string_pretty(&summary).map_err(|e| super::cannot_write(path, &e))?;
    std::fs::write(path, text + "\n").map_err(|e| super::cannot_write(path, &e))
}

fn event(program: &Program, Fired { event, time, count }: Fired) -> Event<'_> {
    let declared = &program.events[event];
    let warnings: Vec<&str> = super::warnings(declared).collect();
    Event {
        name: declared.name,
        time,
        unit: program.base_units[2],
        count,
        documentation: declared.doc,
        message: (!warnings.is_empty()).then(|| warnings.join("; ")),
    }
}
