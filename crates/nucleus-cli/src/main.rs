//! The `nucleus` command: the only crate that prints or exits.
//!
//! | You want to know…                          | Read                       |
//! |--------------------------------------------|----------------------------|
//! | what a subcommand does                     | `commands/`, a file each   |
//! | what the exit code means                   | `outcome.rs`               |
//! | how a run goes, frame by frame             | `simulate.rs`              |
//! | what its cache says of it                  | `recording.rs`             |
//! | how it is gone on with                     | `continued.rs`             |
//! | how a scene is opened, and refused         | `scene_file.rs`            |
//! | how a cache is opened, and refused         | `cache_file.rs`            |
//! | how numbers are written for people         | `figures.rs`               |
//! | how quality is asked for                   | `quality.rs`               |
//! | where results are kept between commands    | `cache_folder.rs`          |

mod account;
mod cache_file;
mod cache_folder;
mod commands;
mod continued;
mod diagnostics;
mod figures;
mod fingerprint;
mod frame_range;
mod initial_state;
mod interrupt;
mod outcome;
mod output;
mod progress;
mod quality;
mod record;
mod recording;
mod scene_file;
mod session;
mod simulate;
mod summary;
mod threads;
mod trouble;

use std::process::ExitCode;

use clap::Parser;
use nucleus_graph::memory::Memory;

use outcome::Outcome;
use output::say;

/// The open Nucleus: cloth and colliders, simulated without Maya.
#[derive(Debug, Parser)]
#[command(name = "nucleus", version, after_help = outcome::EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: commands::Command,
    /// The memory that a scene may take by estimate, as `8G`; three quarters of the machine's if nothing is said.
    #[arg(long, global = true, value_name = "SIZE", value_parser = scene_file::parse_memory)]
    memory: Option<Memory>,
}

fn main() -> ExitCode {
    interrupt::heed_file_size_limit();
    let Arguments { command, memory } = Arguments::parse();
    memory.into_iter().for_each(scene_file::set_memory);
    match command.run() {
        Ok(outcome) => having_told(outcome).into(),
        // Whoever reads our output has seen enough: `nucleus info x.mcap | head -3`.
        Err(error) if output::reader_has_gone(&error) => ExitCode::SUCCESS,
        Err(error) if output::is_lost(&error) => {
            say!("error: {error:#}");
            Outcome::Trouble.into()
        }
        Err(error) => {
            say!("error: {error:#}");
            outcome::COULD_NOT_START.into()
        }
    }
}

/// The outcome of a command that has done its work: if it could not tell of it, that is trouble too.
fn having_told(outcome: Outcome) -> Outcome {
    let Some(error) = output::lost() else { return outcome };
    say!("warning: standard output cannot be written to, not all was printed: {error}");
    if outcome == Outcome::Fine { Outcome::Trouble } else { outcome }
}
