//! What is said about a scene file: what is wrong, where, and what can be done.

use std::ops::Range;
use std::path::PathBuf;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene runs, but not all of it does what it says.
    Warning,
    /// The scene cannot run.
    Error,
}

/// Something to say about a place in a scene file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong: lower case, no full stop, names in backticks.
    pub message: String,
    /// The scene file.
    pub file: PathBuf,
    /// Where in it: byte offsets. `0..0` when it is about the file as a whole.
    pub span: Range<usize>,
    /// What can be done about it, in one line.
    pub help: Option<String>,
    /// Further places, and things worth knowing.
    pub notes: Vec<Note>,
}

/// An addition to a diagnostic.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// What is to be known.
    pub message: String,
    /// Another place in the same file that it is about.
    pub span: Option<Range<usize>>,
}
