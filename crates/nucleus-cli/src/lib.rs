//! The `nucleus` command as a library, so that the Python package has it too. No crate below it prints or exits.
//!
//! | You want to know…                                        | Read                     |
//! |----------------------------------------------------------|--------------------------|
//! | what a subcommand does                                   | `commands/`              |
//! | what an option's value means                             | `options.rs`             |
//! | what the exit code means, and how signals are handled    | `process.rs`             |
//! | how a run advances, frame by frame                       | `run_loop.rs`            |
//! | what its cache states about it                           | `recording.rs`           |
//! | how runs of a plan are executed                          | `runs/`                  |
//! | how a run is resumed                                     | `resumed_run.rs`         |
//! | what a run reports at its end                            | `summary.rs`             |
//! | when that report is a failure or a warning               | `warnings.rs`            |
//! | how a scene or a cache is opened, and refused            | `files.rs`               |
//! | where results are stored between commands                | `quality.rs`             |

#![forbid(unsafe_code)]

mod budget_hints;
mod commands;
mod diagnostics;
mod figures;
mod files;
mod initial_state;
mod object_names;
mod options;
mod output;
mod process;
mod progress;
mod quality;
mod recording;
mod resumed_run;
mod run_loop;
mod run_statistics;
mod runs;
mod summary;
mod warnings;

use std::ffi::OsString;

use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser};
use nucleus_core::StepReport;
use nucleus_graph::memory::Memory;

use commands::Command;
use output::say;
use process::Outcome;
pub use process::set_command;

/// Nucleus: simulates cloth and colliders without Maya.
#[derive(Debug, Parser)]
#[command(name = "nucleus", version = VERSION, after_help = process::EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Memory limit: a scene whose estimate is larger is refused. `8G`; default: three quarters of the machine's memory.
    #[arg(long, global = true, value_name = "SIZE", value_parser = options::memory_size)]
    memory: Option<Memory>,
    /// Print errors, warnings and results only: no progress, and no report of a success.
    #[arg(long, short, global = true)]
    quiet: bool,
    /// When to colour messages. `auto` colours on a terminal unless `NO_COLOR` is set.
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    color: ColorChoice,
}

/// The version, with the commit and its date where the source was a checkout.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), env!("NUCLEUS_COMMIT"));

/// Runs the command with the arguments of a process, the program's name first, and returns its exit code.
///
/// It prints, listens for signals, and ends the process where arguments are wrong: once per process.
pub fn run(arguments: Vec<OsString>) -> u8 {
    process::report_file_size_limit_as_error();
    let arguments = options::with_present_names(arguments);
    let Arguments { command, memory, quiet, color } = parse(&arguments);
    output::set_style(quiet, color);
    memory.into_iter().for_each(files::set_memory_limit);
    match command.run() {
        Ok(outcome) => with_report_error(outcome).exit_code(),
        // The reader has closed the pipe: `nucleus info x.mcap | head -3`.
        Err(error) if output::is_broken_pipe(&error) => Outcome::Success.exit_code(),
        Err(error) if output::is_print_error(&error) => {
            say!("error: {}", error_text(&error));
            Outcome::Problem.exit_code()
        }
        Err(error) => {
            say!("error: {}", error_text(&error));
            if is_full_disk(&error) { Outcome::Problem.exit_code() } else { process::COULD_NOT_START }
        }
    }
}

/// An error with its causes. A cause that the text before it states already is left out.
fn error_text(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |text, cause| match text.contains(&cause) {
        true if !cause.is_empty() => text,
        _ if text.is_empty() => cause,
        _ => format!("{text}: {cause}"),
    })
}

/// Whether a file could not be written because there is no more room for it. The command had started by then.
fn is_full_disk(error: &anyhow::Error) -> bool {
    use std::io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    let io = error.chain().filter_map(|cause| cause.downcast_ref::<std::io::Error>());
    io.into_iter().any(|error| matches!(error.kind(), StorageFull | QuotaExceeded | FileTooLarge))
}

/// Parses the arguments; ends the process with a message if they are wrong or ask for help, in the wanted colours.
fn parse(arguments: &[OsString]) -> Arguments {
    let command = command().color(options::color(arguments));
    let parsed =
        command.try_get_matches_from(arguments).and_then(|found| Arguments::from_arg_matches(&found));
    parsed.unwrap_or_else(|error| error.exit())
}

/// The command with all its subcommands and options.
fn command() -> clap::Command {
    Arguments::command()
}

/// The figures of a frame, as `nucleus run --json` prints them.
pub fn frame_figures(frame: i32, report: &StepReport) -> serde_json::Value {
    serde_json::json!(run_statistics::FrameStatistics::new(frame, report))
}

/// The outcome of a command. A success becomes a problem if its report could not be printed.
fn with_report_error(outcome: Outcome) -> Outcome {
    let Some(error) = output::report_error() else { return outcome };
    say!("warning: standard output cannot be written to, the report is incomplete: {error}");
    if outcome == Outcome::Success { Outcome::Problem } else { outcome }
}
