//! Chores of the repository: `cargo xtask ci`, `evidence`, `tidy`, `meshes`, `bench`, `interop` and `book`.
//!
//! | You want to know...                                   | Read            |
//! |-------------------------------------------------------|-----------------|
//! | what must hold before a change goes in, in order      | [`ci`]          |
//! | which claim of the paper is shown by which test       | [`evidence`]    |
//! | what else is checked: the map, sizes, paths           | [`tidy`]        |
//! | how fast and how exact the solver is, beside others   | [`mod@bench`]   |
//! | which meshes the gallery has of its own                | [`meshes`]      |
//! | whether other tools read what is exported             | [`mod@interop`] |
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
mod interop;
mod map;
mod meshes;
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
    /// Writes the meshes of the gallery that no primitive gives.
    Meshes,
    /// Times the solver and measures its error, beside the figures of other solvers.
    Bench(bench::Options),
    /// Exports caches in every format and has other tools read them; installs those first.
    Interop(interop::Options),
    /// Makes anew the pages of docs/ whose figures are measured; takes an hour or more.
    Book(book::Options),
}

fn main() -> ExitCode {
    let root = root();
    let result = match Chore::parse() {
        Chore::Ci => ci::run(&root),
        Chore::Evidence => evidence::print(&root),
        Chore::Tidy => tidy::run(&root),
        Chore::Meshes => meshes::run(&root),
        Chore::Bench(options) => bench::run(&options),
        Chore::Interop(options) => interop::run(&root, &options),
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

/// Where cargo puts what it builds.
fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from)
}
