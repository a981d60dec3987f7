//! The `ansatz` command: checks, shows, runs and builds models.

mod commands;
mod files;
mod project;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

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
    #[command(disable_help_flag = true)]
    Run {
        /// A model file, or a folder with a `model.ansatz`
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

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Check { model } => commands::check(&model),
        Command::Expand { model, stage, cost } => {
            commands::expand(&model, if cost { "cost" } else { &stage })
        }
        Command::Run { model, arguments } => commands::run(&model, &arguments),
        Command::Build { model, output } => commands::build(&model, &output),
        Command::Test { model, arguments } => commands::test(&model, &arguments),
    };
    outcome.unwrap_or_else(|message| {
        commands::complain(&format!("{message}\n"));
        ExitCode::FAILURE
    })
}
