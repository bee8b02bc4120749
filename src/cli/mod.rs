//! The subcommands, one file each.
//!
//! Exit codes: 0, 1 when the job failed or was interrupted, 2 when the command line or the scene
//! is at fault.

mod args;
mod completions;
mod count;
mod diff;
mod export;
mod failure;
mod files;
mod inspect;
mod interrupt;
mod memory;
mod merge;
mod new;
mod path;
mod picture;
mod playground;
mod prepare;
mod progress;
mod render;
mod schema;
mod simulate;
mod stats;
mod terminal;
#[cfg(test)]
mod tests;
mod time;
mod trade;
mod verify;
mod watch;

use clap::{Parser, Subcommand};
use failure::Failure;
use qrt_machines::InstructionSet;
use std::process::ExitCode;

/// Quantum ray tracing: scenes as countable sets of paths
///
/// qrt traces the paths of a scene that a reversible quantum circuit would trace in superposition,
/// and counts them as quantum counting would.
#[derive(Debug, Parser)]
#[command(
    name = "qrt",
    version,
    arg_required_else_help = true,
    after_help = "\
Examples:
  qrt new box               write a first scene, box.yaml
  qrt playground box.yaml   change it in a browser, and see the picture change
  qrt render box.yaml       render it to box.png
  qrt render --help         all about rendering
  qrt inspect box.yaml      what its circuit costs, and where
  qrt trade box.yaml -o out what its accuracy costs, parameter by parameter
  qrt export box.yaml       its circuit as OpenQASM, box.qasm
  qrt new edge --small      a scene whose whole circuit `qrt simulate` runs as amplitudes

QRT_INSTRUCTIONS=avx512, avx2, neon or portable, in the environment, names the instructions of the
processor that are used; it changes nothing but the speed.

Exit codes: 0; 1 the job failed or was interrupted; 2 the command line or the scene is at fault."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Render(render::RenderArgs),
    Merge(merge::MergeArgs),
    Inspect(inspect::InspectArgs),
    Count(count::CountArgs),
    Verify(verify::VerifyArgs),
    Trade(trade::TradeArgs),
    Export(export::ExportArgs),
    Simulate(simulate::SimulateArgs),
    Diff(diff::DiffArgs),
    New(new::NewArgs),
    Playground(playground::PlaygroundArgs),
    Schema(schema::SchemaArgs),
    Completions(completions::CompletionsArgs),
}

pub(crate) fn main() -> ExitCode {
    interrupt::outlive_file_limits();
    let done = match Cli::try_parse() {
        Ok(Cli { command }) => InstructionSet::asked()
            .map_err(|error| Failure::Usage(error.to_string()))
            .and_then(|_| run(command)),
        Err(usage) if usage.use_stderr() => usage.exit(),
        // The user asked for help or the version, so this is no error.
        Err(help) => terminal::stream(|_| help.print()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            terminal::error(&failure);
            failure.exit_code()
        }
    }
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Render(args) => render::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Count(args) => count::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Trade(args) => trade::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Simulate(args) => simulate::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::New(args) => new::run(&args),
        Command::Playground(args) => playground::run(&args),
        Command::Schema(_) => schema::run(),
        Command::Completions(args) => completions::run(args),
    }
}
