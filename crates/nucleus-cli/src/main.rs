//! The `nucleus` command. No other crate prints or exits.
//!
//! | You want to know…                                        | Read                     |
//! |----------------------------------------------------------|--------------------------|
//! | what a subcommand does                                   | `commands/`              |
//! | what an option's value means                             | `options.rs`             |
//! | what the exit code means, and how signals are handled    | `process.rs`             |
//! | how a run advances, frame by frame                       | `run_loop.rs`            |
//! | what its cache states about it                           | `recording.rs`           |
//! | how a run is resumed                                     | `resumed_run.rs`         |
//! | what a run reports at its end                            | `summary.rs`             |
//! | when that report is a failure or a warning               | `warnings.rs`            |
//! | how a scene or a cache is opened, and refused            | `files.rs`               |
//! | where results are stored between commands                | `quality.rs`             |

mod commands;
mod diagnostics;
mod figures;
mod files;
mod initial_state;
mod options;
mod output;
mod process;
mod progress;
mod quality;
mod recording;
mod resumed_run;
mod run_loop;
mod run_statistics;
mod summary;
mod warnings;

use std::process::ExitCode;

use clap::Parser;
use nucleus_graph::memory::Memory;

use output::say;
use process::Outcome;

/// Nucleus: simulates cloth and colliders without Maya.
#[derive(Debug, Parser)]
#[command(name = "nucleus", version, after_help = process::EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: commands::Command,
    /// Memory limit: a scene whose estimate is larger is refused. `8G`; default: three quarters of the machine's memory.
    #[arg(long, global = true, value_name = "SIZE", value_parser = options::memory_size)]
    memory: Option<Memory>,
}

fn main() -> ExitCode {
    process::report_file_size_limit_as_error();
    let arguments = options::with_present_names(std::env::args_os().collect());
    let Arguments { command, memory } = Arguments::parse_from(arguments);
    memory.into_iter().for_each(files::set_memory_limit);
    match command.run() {
        Ok(outcome) => with_report_error(outcome).into(),
        // The reader has closed the pipe: `nucleus info x.mcap | head -3`.
        Err(error) if output::is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) if output::is_print_error(&error) => {
            say!("error: {error:#}");
            Outcome::Problem.into()
        }
        Err(error) => {
            say!("error: {error:#}");
            process::COULD_NOT_START.into()
        }
    }
}

/// The outcome of a command. A success becomes a problem if its report could not be printed.
fn with_report_error(outcome: Outcome) -> Outcome {
    let Some(error) = output::report_error() else { return outcome };
    say!("warning: standard output cannot be written to, the report is incomplete: {error}");
    if outcome == Outcome::Success { Outcome::Problem } else { outcome }
}
