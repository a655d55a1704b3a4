//! Errors of a wedge.

use std::io;
use std::path::{Path, PathBuf};

use nucleus_cache::shell_word;

/// Reasons why a wedge cannot be planned, run or collected.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WedgeError {
    /// A file cannot be read or written.
    #[error("cannot read or write `{}`", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The plan cannot be read.
    #[error("`{}` is not a plan of runs: {message}", path.display())]
    NotAPlan {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// There is no plan.
    #[error("`{}` holds no plan; `nucleus wedge SCENE --vary node.attribute=... --out {}` makes one", path.display(), shell_word(path))]
    NoPlan {
        /// The folder.
        path: PathBuf,
    },
    /// There is a plan already.
    #[error("`{}` holds a plan already: finish it with `nucleus wedge --continue --out {}`, or name another folder", path.display(), shell_word(path))]
    PlanExists {
        /// The folder.
        path: PathBuf,
    },
    /// The plan has no such run.
    #[error("there is no run {run}; the plan has {count} runs, from 0 on")]
    NoRun {
        /// The number.
        run: u32,
        /// Runs of the plan.
        count: usize,
    },
    /// A program of the scheduler cannot be started, or has failed.
    #[error("{0}")]
    Scheduler(String),
    /// A picture cannot be drawn.
    #[error("cannot draw `{}`: {message}", path.display())]
    Picture {
        /// The cache.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

/// An error at a path.
pub(crate) fn at(path: &Path, source: io::Error) -> WedgeError {
    WedgeError::Io { path: path.to_owned(), source }
}
