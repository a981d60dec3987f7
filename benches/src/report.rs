//! One benchmark as one JSON line, with the keys that the peers' lines have.

use crate::assembly::{Assembly, Kind};
use crate::clock::{Clock, time_on};
use crate::compiler::stages;
use crate::flow::Flow;
use crate::solves::Solve;
use ansatz::Simulation;
use ansatz::observer::Observer;
use ansatz_models::{dry_contact, wet_contact};
use serde_json::{Value, json};
use std::num::NonZeroUsize;
use std::path::Path;

/// Corrections of the size of cells towards a wanted number of them.
const CORRECTIONS: usize = 4;

/// P1 on n x n x 2 triangles: nanoseconds per element of residual and tangent, the tangent with its residual and the insertion. Like
/// all times, computing time on one thread and time on the clock on several.
///
/// # Errors
/// None with the shipped models.
pub fn assembly(n: usize, kind: Kind, threads: NonZeroUsize) -> Result<Value, String> {
    let clock = Clock::start();
    let mut problem = Assembly::new(n, kind).map_err(|e| e.to_string())?;
    let setup = clock.seconds();
    problem.system.use_threads(threads).map_err(|e| e.to_string())?;
    let checks = problem.checks().map_err(|e| e.to_string())?;
    let unknowns = problem.unknowns();
    let mut probe = problem.probe().map_err(|e| e.to_string())?;
    let elements = 2 * n * n;
    let residual = time_on(threads.get(), || drop(std::hint::black_box(probe.residual())));
    let tangent = time_on(threads.get(), || probe.assemble());
    let per_element = |seconds: f64| seconds / elements as f64 * 1e9;
    let kind = if kind == Kind::Axisymmetric { "axi" } else { "ps" };
    Ok(json!({
        "problem": "P1", "kind": kind, "peer": "ansatz", "n_elements": elements, "n_dofs": unknowns,
        "threads": threads, "setup_s": setup,
        "res_ns_el": per_element(residual), "tan_ns_el": per_element(tangent),
        "E": checks.energy, "Rv": checks.residual, "Kvw": checks.tangent,
    }))
}

/// P2 on n x n x 2 triangles: the whole solve.
///
/// # Errors
/// If Newton's method does not converge.
pub fn cook(n: usize, threads: NonZeroUsize) -> Result<Value, String> {
    solve("P2", &["tip_ux", "tip_uy"], threads, || Solve::cook(n))
}

/// P3, flow past a cylinder on the mesh `dfg_LEVEL.msh` in a folder: the whole solve.
///
/// # Errors
/// If there is no such file, or if Newton's method does not converge.
pub fn past_cylinder(level: usize, folder: &Path) -> Result<Value, String> {
    let file = folder.join(format!("dfg_{level}.msh"));
    let mesh =
        std::fs::read_to_string(&file).map_err(|e| format!("cannot read `{}`: {e}", file.display()))?;
    flow("dfg", || Flow::past_cylinder(&mesh))
}

/// P3, lid-driven cavity at Reynolds number 1000 on n x n x 2 triangles: the whole solve.
///
/// # Errors
/// If Newton's method does not converge.
pub fn cavity(n: usize) -> Result<Value, String> {
    flow("cavity", || Flow::cavity(n))
}

fn flow(case: &str, setup: impl Fn() -> Result<Flow, ansatz::Error>) -> Result<Value, String> {
    let clock = Clock::start();
    let mut prepared = setup().map_err(|e| e.to_string())?;
    let setup = clock.seconds();
    let clock = Clock::start();
    let solved = prepared.run().map_err(|e| e.to_string())?;
    let run = clock.seconds();
    let mut line = json!({
        "problem": "P3", "case": case, "peer": "ansatz", "n_elements": prepared.cells(), "n_dofs": prepared.unknowns(),
        "total_its": solved.iterations,
    });
    let one_assembly = prepared.assembly().map_err(|e| e.to_string())?;
    add_times(&mut line, [setup, run, one_assembly], solved.iterations);
    for (name, value) in solved.results {
        line[name] = json!(value);
    }
    Ok(line)
}

/// P4 on n x n x 2 triangles: the whole solve.
///
/// # Errors
/// If Newton's method does not converge.
pub fn sphere(n: usize) -> Result<Value, String> {
    solve("P4a", &["uz", "force"], NonZeroUsize::MIN, || Solve::sphere(n))
}

fn solve(
    problem: &str,
    results: &[&str],
    threads: NonZeroUsize,
    setup: impl Fn() -> Result<Solve, ansatz::Error>,
) -> Result<Value, String> {
    let clock = Clock::start();
    let mut prepared = setup().map_err(|e| e.to_string())?;
    let setup = clock.seconds();
    prepared.use_threads(threads).map_err(|e| e.to_string())?;
    let clock = Clock::on(threads.get());
    let solved = prepared.run().map_err(|e| e.to_string())?;
    let run = clock.seconds();
    let mut line = json!({
        "problem": problem, "peer": "ansatz", "n_elements": prepared.cells(), "n_dofs": prepared.unknowns(), "threads": threads,
        "its": solved.iterations, "total_its": solved.total,
    });
    let one_assembly = prepared.assembly().map_err(|e| e.to_string())?;
    add_times(&mut line, [setup, run, one_assembly], solved.total);
    // The first column of the tables is the time.
    for (name, value) in results.iter().zip(solved.results.iter().skip(1)) {
        line[name] = json!(value);
    }
    Ok(line)
}

/// Adds the times of setting up, of the run and of one assembly \[s\]. The run does not tell its parts: assembly is timed by itself, and `solve_s`
/// is all the rest.
fn add_times(line: &mut Value, [setup, run, one_assembly]: [f64; 3], iterations: usize) {
    let assembly = iterations as f64 * one_assembly;
    let times = [
        ("setup_s", setup),
        ("assembly_s", assembly),
        ("solve_s", run - assembly),
        ("run_s", run),
        ("total_s", setup + run),
        ("per_it_ms", run / iterations as f64 * 1e3),
        ("per_it_asm_ms", one_assembly * 1e3),
    ];
    for (name, value) in times {
        line[name] = json!(value);
    }
}

/// Seconds of each stage of the compiler, for the file of a model or for a shipped model by the name of its folder.
///
/// # Errors
/// What the compiler says about the model.
pub fn compiler(model: &str) -> Result<Value, String> {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(model).join("model.ansatz");
    let file = if shipped.exists() { &shipped } else { Path::new(model) };
    let mut line = json!({ "problem": "compile", "kind": model, "peer": "ansatz" });
    let times = stages(file)?;
    line["total_s"] = json!(times.iter().map(|(_, seconds)| seconds).sum::<f64>());
    for (stage, seconds) in times {
        line[stage] = json!(seconds);
    }
    Ok(line)
}

/// A run of a shipped model, `dry` or `wet`, on about so many triangles to a time \[s\], by default to its end.
///
/// # Errors
/// If there is no such model, or if the run fails.
pub fn model(
    name: &str,
    elements: usize,
    until: Option<f64>,
    threads: NonZeroUsize,
) -> Result<Value, String> {
    let mut coarse = 1.0;
    for _ in 0..CORRECTIONS {
        let cells = prepare(name, coarse)?.system().mesh.cells.len();
        // Twice the size of the cells makes about a quarter of them; less where short boundaries ask for small ones.
        coarse *= (cells as f64 / elements as f64).sqrt();
    }
    run(name, coarse, until, threads)
}

/// A run of a shipped model, `dry` or `wet`, to a time \[s\], by default to its end, its cells `coarse` times as large as the model's.
///
/// # Errors
/// If there is no such model, or if the run fails.
pub fn run(name: &str, coarse: f64, until: Option<f64>, threads: NonZeroUsize) -> Result<Value, String> {
    struct Quiet;
    impl Observer for Quiet {}
    let clock = Clock::start();
    let mut simulation = prepare(name, coarse)?;
    let setup = clock.seconds();
    simulation.use_threads(threads).map_err(|e| e.to_string())?;
    let clock = Clock::on(threads.get());
    let outcome = simulation.run(&mut Quiet, until).map_err(|e| e.to_string())?;
    let run = clock.seconds();
    let statistics = simulation.record().statistics();
    let system = simulation.system();
    Ok(json!({
        "problem": "model", "kind": name, "peer": "ansatz", "n_elements": system.mesh.cells.len(),
        "n_dofs": system.equation_count(), "matrix_entries": system.matrix_entries(), "threads": threads,
        "outcome": outcome, "reached": simulation.record().times().last(), "steps": statistics.accepted, "rejected": statistics.rejected,
        "total_its": statistics.iterations, "setup_s": setup, "run_s": run, "total_s": setup + run,
        "per_it_ms": run / statistics.iterations as f64 * 1e3,
    }))
}

fn prepare(name: &str, coarse: f64) -> Result<Simulation, String> {
    let simulation = match name {
        "dry" => dry_contact::simulation(&dry_contact::Parameters { coarse, ..Default::default() }),
        "wet" => wet_contact::simulation(&wet_contact::Parameters { coarse, ..Default::default() }),
        _ => return Err(format!("`{name}` is neither `dry` nor `wet`")),
    };
    simulation.map_err(|e| e.to_string())
}
