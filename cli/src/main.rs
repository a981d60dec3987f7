//! The `ansatz` command: checks, shows, runs and builds models.

mod commands;
mod files;
mod project;

use clap::{CommandFactory, Parser, Subcommand};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What `ansatz run --help` says of the arguments of a simulator, which has them and its parameters in its own `--help`.
const OPTIONS_OF_A_RUN: &str = "Arguments of the simulator:
  --set NAME=VALUE  Sets a parameter, such as --set r=\"1.2 um\"
  --out DIR         Folder for the results; results/MODEL if not given
  --until TIME      Ends the run at this time, such as \"50 s\"
  --threads N       Computes on this many threads
  --no-frames       Writes tables only, no field frames and pictures
  --quiet           Shows no progress
  --test            Checks the model's expectations after the run

`ansatz run MODEL --help` compiles the model and lists its parameters as well.";

/// Turns a multiphysics model into a native simulator.
#[derive(Parser)]
#[command(name = "ansatz", version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Checks a model: every error at once, with its line
    Check {
        /// A model file, or a folder with a `model.ansatz`
        model: PathBuf,
    },
    /// Shows what the compiler makes of a model; the generated Rust unless --stage says otherwise
    Expand {
        /// A model file, or a folder with a `model.ansatz`
        model: PathBuf,
        /// Compiler stage to show
        #[arg(long, default_value = "rust")]
        stage: String,
        /// Shows flops and bytes of each kernel instead
        #[arg(long)]
        cost: bool,
    },
    /// Compiles a model and runs it; what follows the model goes to the simulator (--set, --out, --until, --help)
    #[command(disable_help_flag = true, after_help = OPTIONS_OF_A_RUN)]
    Run {
        /// A model file, or a folder with a `model.ansatz`
        #[arg(allow_hyphen_values = true)]
        model: PathBuf,
        /// Arguments of the simulator
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Compiles a model into one executable that needs neither Rust nor the model file
    Build {
        /// A model file, or a folder with a `model.ansatz`
        model: PathBuf,
        /// The executable
        #[arg(short, long)]
        output: PathBuf,
    },
    /// Runs the tests that a model states
    Test {
        /// A model file, or a folder with a `model.ansatz`
        model: PathBuf,
        /// Arguments of the simulator for the tests that read a run
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
}

/// Whether what stands in place of a model is an option.
fn is_option(model: &Path) -> bool {
    model.as_os_str().as_encoded_bytes().starts_with(b"-")
}

/// The help of `ansatz run`, which was asked for, or is needed where an option stands before the model.
fn help_of_run(option: &Path) -> Result<ExitCode, String> {
    let mut cli = Cli::command();
    cli.build();
    let help = cli.find_subcommand_mut("run").map_or_else(String::new, |run| run.render_help().to_string());
    if [Path::new("--help"), Path::new("-h")].contains(&option) {
        commands::say(help.trim_end());
        return Ok(ExitCode::SUCCESS);
    }
    let option = option.display();
    Err(format!("error: the model stands before `{option}`\n\n{}", help.trim_end()))
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Check { model } => commands::check(&model),
        Command::Expand { model, stage, cost } => {
            commands::expand(&model, if cost { "cost" } else { &stage })
        }
        Command::Run { model, .. } if is_option(&model) => help_of_run(&model),
        Command::Run { model, arguments } => commands::run(&model, &arguments),
        Command::Build { model, output } => commands::build(&model, &output),
        Command::Test { model, arguments } => commands::test(&model, &arguments),
    };
    outcome.unwrap_or_else(|message| {
        commands::complain(&format!("{message}\n"));
        ExitCode::FAILURE
    })
}
