//! What a command ends with.

use std::process::ExitCode;

/// Shown at the end of `nucleus --help`.
pub const EXIT_CODES: &str = "\
Exit codes: 0 all is well; 1 trouble was found (a check failed, contact left something unresolved, a disk was full, a cache \
has lost frames); 2 it could not start; 130 it was interrupted (Ctrl-C) and has closed its cache in order.";

/// The exit code of a command that could not start.
pub const COULD_NOT_START: u8 = 2;

/// The exit code of a run that was ended by Ctrl-C, as shells have it.
pub const INTERRUPTED: u8 = 130;

/// How a command that started has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All is well.
    Fine,
    /// It ran and found trouble.
    Trouble,
    /// It could not start, and has said why.
    InvalidInput,
    /// It was asked to end, and did so in order.
    Interrupted,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Fine => Self::SUCCESS,
            Outcome::Trouble => Self::from(1),
            Outcome::InvalidInput => Self::from(COULD_NOT_START),
            Outcome::Interrupted => Self::from(INTERRUPTED),
        }
    }
}
