//! What each command does.

use crate::files::{compile_file, model_file};
use crate::project::{self, Machine};
use ansatz_dsl::compile::{Compilation, Output};
use ansatz_dsl::diagnostic::{Style, render_with};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

type Outcome = Result<ExitCode, String>;

/// `ansatz check`: diagnostics, or a line that says what the model has.
pub fn check(model: &Path) -> Outcome {
    let compilation = compile_file(model)?;
    let output = output(&compilation)?;
    say(&format!("{}: no errors", output.name));
    Ok(ExitCode::SUCCESS)
}

/// `ansatz expand`: the text of one stage.
pub fn expand(model: &Path, stage: &str) -> Outcome {
    let compilation = compile_file(model)?;
    let output = output(&compilation)?;
    match output.stage(stage) {
        Some(text) => say(text),
        None => {
            return Err(format!(
                "error: there is no stage `{stage}`; the stages are {}",
                output.stage_names().join(", ")
            ));
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// `ansatz run`: builds the simulator and runs it.
pub fn run(model: &Path, arguments: &[String]) -> Outcome {
    let program = build_simulator(model, Machine::This)?;
    let status = Command::new(&program).args(arguments).status();
    let status = status.map_err(|e| format!("error: cannot start `{}`: {e}", program.display()))?;
    Ok(ExitCode::from(u8::try_from(status.code().unwrap_or(1)).unwrap_or(1)))
}

/// `ansatz build`: builds the simulator and copies it.
pub fn build(model: &Path, to: &Path) -> Outcome {
    let program = build_simulator(model, Machine::Any)?;
    std::fs::copy(&program, to).map_err(|e| format!("error: cannot write `{}`: {e}", to.display()))?;
    say(&format!(
        "{}: a simulator that needs neither Rust nor the model; try `{} --help`",
        to.display(),
        to.display()
    ));
    Ok(ExitCode::SUCCESS)
}

/// `ansatz test`: laws at compile time, then a run if a test needs one.
pub fn test(model: &Path, arguments: &[String]) -> Outcome {
    let compilation = compile_file(model)?;
    let output = output(&compilation)?;
    if output.law_tests.text.is_empty() && !output.has_run_tests {
        say(&format!("no tests in {}", output.name));
    } else {
        say(&output.law_tests.text);
    }
    if output.law_tests.failed > 0 {
        return Ok(ExitCode::FAILURE);
    }
    let mut all = vec![String::from("--test")];
    all.extend_from_slice(arguments);
    if output.has_run_tests { run(model, &all) } else { Ok(ExitCode::SUCCESS) }
}

fn build_simulator(model: &Path, machine: Machine) -> Result<PathBuf, String> {
    let compilation = compile_file(model)?;
    let output = output(&compilation)?;
    let file = model_file(model);
    let place = file.canonicalize().unwrap_or(file).display().to_string();
    project::build(&output.name, &fingerprint(&place), &output.rust, machine)
}

/// Prints the diagnostics; the output, or an error if there are any errors.
fn output(compilation: &Compilation) -> Result<&Output, String> {
    let style = if std::io::stderr().is_terminal() { Style::Coloured } else { Style::Plain };
    let report = render_with(&compilation.diagnostics, &compilation.sources, style);
    match &compilation.output {
        Some(output) => {
            complain(&report);
            Ok(output)
        }
        None => Err(report),
    }
}

/// Eight hexadecimal digits of a text (FNV-1a).
fn fingerprint(text: &str) -> String {
    let hash = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    format!("{:08x}", hash >> 32)
}

/// Writes to standard error, as it is; where nobody reads that, nothing is lost.
pub fn complain(text: &str) {
    let _ = write!(std::io::stderr(), "{text}");
}

/// Writes a line to standard output.
pub fn say(text: &str) {
    // A reader that went away, as in `ansatz expand | head`, is no error.
    let _ = writeln!(std::io::stdout(), "{text}");
}
