//! Maintenance commands: `cargo xtask ci`, `evidence`, `tidy`, `meshes`, `bench`, `interop`, `fuzz`, `python` and `book`.
//!
//! | Question                                              | Module          |
//! |-------------------------------------------------------|-----------------|
//! | all checks before a merge, in order                   | [`ci`]          |
//! | tests that cover each claim of the paper              | [`evidence`]    |
//! | code map, file sizes, paths of one machine            | [`tidy`]        |
//! | cost and error, compared with other solvers           | [`mod@bench`]   |
//! | generated meshes of the gallery                       | [`meshes`]      |
//! | exports read by other tools                           | [`mod@interop`] |
//! | mutated Maya scenes                                   | [`fuzz`]        |
//! | pages with measured figures                           | [`book`]        |
//! | the Python package and its tests                      | [`python`]      |
//! | parser of `ARCHITECTURE.md`                           | [`map`]         |
//! | files of the repository                               | [`files`]       |

#![forbid(unsafe_code)]

use std::process::ExitCode;

use clap::Parser;

mod bench;
mod book;
mod ci;
mod cookbook;
mod evidence;
mod files;
mod fuzz;
mod interop;
mod map;
mod meshes;
mod python;
mod readme;
mod tidy;

/// Maintenance commands of the repository.
#[derive(Parser)]
#[command(bin_name = "cargo xtask")]
enum Task {
    /// Runs all checks before a merge; stops at the first failure.
    Ci,
    /// Lists the claims of the paper with the tests and scenes that cover them, and the claims without any.
    Evidence,
    /// Compares ARCHITECTURE.md with the tree; finds files that are too long and paths of one machine.
    Tidy,
    /// Writes the generated meshes of the gallery.
    Meshes,
    /// Measures time and error of the solver, compared with other solvers.
    Bench(bench::Options),
    /// Exports caches in every format and reads them with other tools, which it installs first.
    Interop(interop::Options),
    /// Mutates Maya scenes and imports them; keeps the scenes that break the import.
    Fuzz(fuzz::Options),
    /// Builds the wheel of the Python package and runs its tests, where `python3` exists
    Python,
    /// Regenerates the pages of docs/ with measured figures; takes an hour or more.
    Book(book::Options),
}

fn main() -> ExitCode {
    let root = files::root();
    let result = match Task::parse() {
        Task::Ci => ci::run(&root),
        Task::Evidence => evidence::print(&root),
        Task::Tidy => tidy::run(&root),
        Task::Meshes => meshes::run(&root),
        Task::Bench(options) => bench::run(&options),
        Task::Interop(options) => interop::run(&root, &options),
        Task::Fuzz(options) => fuzz::run(&root, &options),
        Task::Python => python::run(&root),
        Task::Book(options) => book::run(&root, &options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
