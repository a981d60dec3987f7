//! Times one benchmark and prints it as a JSON line. Use a release build: `cargo run --release -p ansatz-benches -- p1 64 axi`.

use ansatz_benches::assembly::Kind;
use ansatz_benches::factorisation::factorisation;
use ansatz_benches::report;
use serde_json::Value;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: ansatz-benches p1 N ps|axi [THREADS]   assembly on N x N x 2 triangles
                      p2 N [THREADS] Cook's membrane
                      p3 dfg L [DIR] flow past a cylinder on DIR/dfg_L.msh
                      p3 cavity N    lid-driven cavity
                      p4 N           a sphere pressed into a cylinder
                      lu ns|elastic N [THREADS]   factorisation of a matrix with N unknowns
                      compile MODEL  the stages of the compiler for a shipped model, such as `wet`, or a file
                      model dry|wet N [TIME [THREADS]]   the model on about N triangles, to a time [s]
                      dry|wet TIME [COARSE]    the same with its cells so many times larger";

/// Where the peers' meshes lie, seen from the workspace.
const MESHES: &str = "../shared/peers/mesh";

/// Threads unless more are asked for.
const ONE: NonZeroUsize = NonZeroUsize::MIN;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match run(&words) {
        Ok(line) => {
            say(&line);
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(words: &[&str]) -> Result<Value, String> {
    match words {
        ["p1", n, kind] => report::assembly(number(n)?, assembly_kind(kind)?, ONE),
        ["p1", n, kind, threads] => report::assembly(number(n)?, assembly_kind(kind)?, number(threads)?),
        ["p2", n] => report::cook(number(n)?, ONE),
        ["p2", n, threads] => report::cook(number(n)?, number(threads)?),
        ["p3", "dfg", level] => report::past_cylinder(number(level)?, Path::new(MESHES)),
        ["p3", "dfg", level, folder] => report::past_cylinder(number(level)?, Path::new(folder)),
        ["p3", "cavity", n] => report::cavity(number(n)?),
        ["p4", n] => report::sphere(number(n)?),
        ["lu", kind, n] => factorisation(kind, number(n)?, 1),
        ["lu", kind, n, threads] => factorisation(kind, number(n)?, number(threads)?),
        ["compile", model] => report::compiler(model),
        ["model", name, n] => report::model(name, number(n)?, None, ONE),
        ["model", name, n, until] => report::model(name, number(n)?, Some(number(until)?), ONE),
        ["model", name, n, until, threads] => {
            report::model(name, number(n)?, Some(number(until)?), number(threads)?)
        }
        [name @ ("dry" | "wet"), until] => report::run(name, 1.0, Some(number(until)?), ONE),
        [name @ ("dry" | "wet"), until, coarse] => {
            report::run(name, number(coarse)?, Some(number(until)?), ONE)
        }
        _ => Err(USAGE.into()),
    }
}

fn assembly_kind(word: &str) -> Result<Kind, String> {
    match word {
        "ps" => Ok(Kind::PlaneStrain),
        "axi" => Ok(Kind::Axisymmetric),
        _ => Err(USAGE.into()),
    }
}

fn number<T: std::str::FromStr>(word: &str) -> Result<T, String> {
    word.parse().map_err(|_| format!("`{word}` is no number\n{USAGE}"))
}

fn say(line: &Value) {
    use std::io::Write;
    // A reader that went away is no error.
    let _ = writeln!(std::io::stdout(), "{line}");
}
