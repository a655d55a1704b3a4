//! Chores of the repository: `cargo xtask ci`, `evidence`, `tidy`, `bench` and `book`.
//!
//! | You want to know...                                   | Read            |
//! |-------------------------------------------------------|-----------------|
//! | what must hold before a change goes in, in order      | [`ci`]          |
//! | which claim of the paper is shown by which test       | [`evidence`]    |
//! | what else is checked: the map, sizes, paths           | [`tidy`]        |
//! | how fast and how exact the solver is, beside others   | [`mod@bench`]   |
//! | how the pages with measured figures are made          | [`book`]        |
//! | how `ARCHITECTURE.md` is read                         | [`map`]         |
//! | which files belong to the repository                  | [`files`]       |

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;

mod bench;
mod book;
mod ci;
mod evidence;
mod files;
mod map;
mod readme;
mod tidy;

/// Chores of the repository.
#[derive(Parser)]
#[command(bin_name = "cargo xtask")]
enum Chore {
    /// Checks everything that must hold before a change goes in; stops at the first failure.
    Ci,
    /// Lists the claims of the paper with the tests and scenes that show them, and those without any.
    Evidence,
    /// Holds ARCHITECTURE.md against the tree, and looks for files too long and paths of one machine.
    Tidy,
    /// Times the solver and measures its error, beside the figures of other solvers.
    Bench(bench::Options),
    /// Makes anew the pages of docs/ whose figures are measured; takes a quarter of an hour.
    Book(book::Options),
}

fn main() -> ExitCode {
    let root = root();
    let result = match Chore::parse() {
        Chore::Ci => ci::run(&root),
        Chore::Evidence => evidence::print(&root),
        Chore::Tidy => tidy::run(&root),
        Chore::Bench(options) => bench::run(&options),
        Chore::Book(options) => book::run(&root, &options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// The repository: the folder above this crate.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask is in a folder of the repository").to_owned()
}
