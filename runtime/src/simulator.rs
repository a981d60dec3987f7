//! The command line of a compiled model: the same for `ansatz run` and for an executable made by `ansatz build`.

use crate::error::Error;
use crate::generated::Program;
use crate::observer::Both;
use crate::output::progress::{Progress, with_unit};
use crate::output::results::Results;
use crate::output::summary::{Fired, Run};
use crate::settings::{check_end, display, resolve, split, threads, time};
use crate::simulation::Simulation;
use clap::{Arg, ArgAction, ArgMatches, Command};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Runs a compiled model as a program: reads the command line, runs, writes results; errors go to standard error.
///
/// Exit status: 0 when the run reached an outcome, 1 when it gave up or a file could not be written, 2 for a wrong command line or parameter.
pub fn main(program: &'static Program) -> ExitCode {
    let matches = command(program).get_matches();
    match run(program, &matches) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&format!("error: {error}"));
            ExitCode::from(if matches!(error, Error::Parameter(_)) { 2 } else { 1 })
        }
    }
}

/// Writes a line to standard error; where nobody reads that, nothing is lost.
pub fn complain(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr(), "{text}");
}

fn command(program: &'static Program) -> Command {
    let about = match program.doc {
        "" => format!("The model `{}`, a simulator made by Ansatz", program.name),
        doc => doc.to_owned(),
    };
    // Usage shows the name of the model, whatever the file of the program is called.
    Command::new(program.name)
        .bin_name(program.name)
        .about(about)
        .arg(
            Arg::new("set")
                .long("set")
                .value_name("NAME=VALUE")
                .action(ArgAction::Append)
                .help("Sets a parameter, such as --set r=\"1.2 um\""),
        )
        .arg(
            Arg::new("out")
                .long("out")
                .value_name("DIR")
                .help("Folder for the results; results/MODEL if not given"),
        )
        .arg(
            Arg::new("until")
                .long("until")
                .value_name("TIME")
                .allow_hyphen_values(true)
                .help("Ends the run at this time, such as \"50 s\""),
        )
        .arg(
            Arg::new("threads")
                .long("threads")
                .value_name("N")
                .allow_hyphen_values(true)
                .default_value("1")
                .help("Computes on this many threads"),
        )
        .arg(
            Arg::new("no-frames")
                .long("no-frames")
                .action(ArgAction::SetTrue)
                .help("Writes tables only, no field frames and pictures"),
        )
        .arg(Arg::new("quiet").long("quiet").short('q').action(ArgAction::SetTrue).help("Shows no progress"))
        .arg(
            Arg::new("test")
                .long("test")
                .action(ArgAction::SetTrue)
                .help("Checks the model's expectations after the run"),
        )
        .after_help(parameter_list(program))
}

fn default_folder(program: &Program) -> PathBuf {
    ["results", program.name].iter().collect()
}

/// Every parameter with default, range and documentation.
fn parameter_list(program: &Program) -> String {
    let mut text = String::from("Parameters:\n");
    let Ok(values) = resolve(program, &[]) else { return text };
    let mut g = vec![0.0; program.layout.length];
    g[program.layout.parameters[0]..program.layout.parameters[1]].copy_from_slice(&values);
    for (parameter, value) in program.parameters.iter().zip(&values) {
        let shown = |x: f64| display(x / parameter.unit_value);
        let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
        let range = match ((parameter.choices)(&g), (parameter.range)(&g)) {
            (Some(list), _) => {
                format!("  one of {}", list.iter().map(|c| shown(*c)).collect::<Vec<_>>().join(", "))
            }
            (None, (low, high)) if low.is_finite() || high.is_finite() => {
                format!("  {} .. {}{unit}", shown(low), shown(high))
            }
            _ => String::new(),
        };
        let _ = write!(text, "  {:<10} = {}{unit}{range}", parameter.name, shown(*value));
        let _ =
            if parameter.doc.is_empty() { writeln!(text) } else { writeln!(text, "  ({})", parameter.doc) };
    }
    text
}

fn run(program: &'static Program, matches: &ArgMatches) -> Result<(), Error> {
    let settings = matches.get_many::<String>("set").into_iter().flatten();
    let settings = settings.map(|s| split(s)).collect::<Result<Vec<_>, _>>()?;
    let values = resolve(program, &settings)?;
    let until = matches.get_one::<String>("until").map(|t| time(program, t)).transpose()?;
    let threads = matches.get_one::<String>("threads").map(|text| threads(text)).transpose()?;
    let folder = matches.get_one::<String>("out").map_or_else(|| default_folder(program), PathBuf::from);
    let started = Instant::now();
    let mut simulation = Simulation::new(program, &values)?;
    if let Some(threads) = threads {
        simulation.use_threads(threads)?;
    }
    if let Some(until) = until {
        check_end(program, simulation.span(None), until)?;
    }
    let mut results = Results::create(&folder, program)?;
    results.keep_frames(!matches.get_flag("no-frames"));
    let outcome = if matches.get_flag("quiet") {
        simulation.run(&mut results, until)
    } else {
        let mut progress = Progress::new(program, simulation.span(until));
        simulation.run(&mut Both(&mut results, &mut progress), until)
    };
    let mut told = describe(program, &simulation, outcome.as_ref().err());
    told.wall_seconds = started.elapsed().as_secs_f64();
    results.finish(&values, &simulation.system().mesh, &told)?;
    outcome?;
    complain(&format!("outcome: {}; results in {}", told.outcome, folder.display()));
    if matches.get_flag("test") { expectations(program, &simulation) } else { Ok(()) }
}

/// The summary of a run, finished or not.
fn describe(program: &Program, simulation: &Simulation, error: Option<&Error>) -> Run {
    let (record, system) = (simulation.record(), simulation.system());
    let statistics = record.statistics();
    let fired = |event: usize| {
        let mut firings = record.fired().iter().filter(|firing| firing.event == event);
        let first = firings.next()?;
        Some(Fired { event, time: first.time, count: 1 + firings.count() })
    };
    let mut events: Vec<Fired> = (0..program.events.len()).filter_map(fired).collect();
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    Run {
        outcome: record.outcome().into(),
        time: record.times().last().copied().unwrap_or(f64::NAN),
        steps: [statistics.accepted, statistics.rejected],
        iterations: statistics.iterations,
        unknowns: system.unknowns.length,
        equations: system.equation_count(),
        matrix_entries: system.matrix_entries(),
        meshings: system.meshings,
        threads: system.threads().get(),
        events,
        wall_seconds: 0.0,
        error: error.map(ToString::to_string),
    }
}

/// Prints every expectation of the model's tests that read the run.
fn expectations(program: &Program, simulation: &Simulation) -> Result<(), Error> {
    let mut failed = 0;
    for test in program.tests {
        for found in (test.evaluate)(simulation.record()) {
            let verdict = if found.holds { "passed" } else { "FAILED" };
            let numbers = found.numbers.map_or(String::new(), |[value, expected, tolerance]| {
                let [value, expected, tolerance] =
                    [value, expected, tolerance].map(|x| with_unit(x, found.unit));
                format!("  found {value}, expected {expected} within {tolerance}")
            });
            complain(&format!("{verdict}  {}: {}{numbers}  ({})", test.title, found.text, found.place));
            failed += usize::from(!found.holds);
        }
    }
    if failed == 0 {
        Ok(())
    } else {
        Err(Error::Model(format!("{failed} expectations of the model do not hold")))
    }
}
