//! The command line of a compiled model: the same for `ansatz run` and for an executable made by `ansatz build`.

use crate::error::Error;
use crate::generated::Program;
use crate::observer::{Both, Observer};
use crate::output::progress::Progress;
use crate::output::results::Results;
use crate::settings::{display, resolve, split};
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
            eprintln!("error: {error}");
            ExitCode::from(if matches!(error, Error::Parameter(_)) { 2 } else { 1 })
        }
    }
}

fn command(program: &'static Program) -> Command {
    Command::new(program.name)
        .about(if program.doc.is_empty() { "A simulator made by Ansatz" } else { program.doc })
        .arg(Arg::new("set").long("set").value_name("NAME=VALUE").action(ArgAction::Append).help("Sets a parameter, such as --set r=\"1.2 um\""))
        .arg(Arg::new("out").long("out").value_name("DIR").default_value(default_folder(program)).help("Folder for the results"))
        .arg(Arg::new("until").long("until").value_name("TIME").help("Ends the run at this time, such as \"50 s\""))
        .arg(Arg::new("no-frames").long("no-frames").action(ArgAction::SetTrue).help("Writes tables only, no field frames and pictures"))
        .arg(Arg::new("quiet").long("quiet").short('q').action(ArgAction::SetTrue).help("Shows no progress"))
        .arg(Arg::new("test").long("test").action(ArgAction::SetTrue).help("Checks the model's expectations after the run"))
        .after_help(parameter_list(program))
}

fn default_folder(program: &Program) -> String {
    format!("results/{}", program.name)
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
            (Some(list), _) => format!("  one of {}", list.iter().map(|c| shown(*c)).collect::<Vec<_>>().join(", ")),
            (None, (low, high)) if low.is_finite() || high.is_finite() => format!("  {} .. {}{unit}", shown(low), shown(high)),
            _ => String::new(),
        };
        let _ = write!(text, "  {:<10} = {}{unit}{range}", parameter.name, shown(*value));
        let _ = if parameter.doc.is_empty() { writeln!(text) } else { writeln!(text, "  ({})", parameter.doc) };
    }
    text
}

fn run(program: &'static Program, matches: &ArgMatches) -> Result<(), Error> {
    let settings = matches.get_many::<String>("set").into_iter().flatten().map(|s| split(s)).collect::<Result<Vec<_>, _>>()?;
    let values = resolve(program, &settings)?;
    let folder = PathBuf::from(matches.get_one::<String>("out").cloned().unwrap_or_else(|| default_folder(program)));
    let until = matches.get_one::<String>("until").map(|t| crate::settings::time(program, t)).transpose()?;
    let mut results = Results::create(&folder, program)?;
    results.keep_frames(!matches.get_flag("no-frames"));
    let started = Instant::now();
    let mut simulation = Simulation::new(program, &values)?;
    let span = simulation.span(until);
    let outcome = if matches.get_flag("quiet") {
        simulation.run(&mut results, until)
    } else {
        let mut progress = Progress::new(program, span);
        simulation.run(&mut Both(&mut results, &mut progress), until)
    };
    let finished = finish(&mut results, &mut simulation, &values, started.elapsed().as_secs_f64());
    outcome?;
    finished?;
    if matches.get_flag("test") { check_expectations(program, &simulation) } else { Ok(()) }
}
