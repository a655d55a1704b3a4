//! The text of a file that a scene consists of, within a limit on memory.

use std::io::Read;
use std::path::Path;

use crate::files;
use crate::memory::{Budget, Memory};

/// The text of a scene file.
///
/// # Errors
/// When it is not a regular file, cannot be read, is larger than `memory`, or is not UTF-8.
pub fn read_text(path: &Path, memory: Memory) -> Result<String, TextError> {
    let path_of = || path.display().to_string();
    let unreadable = |cause| TextError::Unreadable { path: path_of(), cause };
    let (mut file, bytes) = files::open(path).map_err(unreadable)?;
    let refused = |refused| TextError::TooLarge { path: path_of(), why: format!("{refused}") };
    Budget::new(memory).check(bytes).map_err(refused)?;
    let mut all = Vec::new();
    file.read_to_end(&mut all).map_err(unreadable)?;
    let not_text = |at| TextError::NotText { path: path_of(), at };
    String::from_utf8(all).map_err(|error| not_text(error.utf8_error().valid_up_to()))
}

/// Reasons why the text of a scene file cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TextError {
    /// The file cannot be read.
    #[error("cannot read `{path}`: {cause}")]
    Unreadable {
        /// The file.
        path: String,
        /// The error of the system.
        cause: std::io::Error,
    },
    /// The file is larger than the memory limit.
    #[error("`{path}` takes {why}")]
    TooLarge {
        /// The file.
        path: String,
        /// The size and the limit.
        why: String,
    },
    /// The file is not UTF-8.
    #[error("`{path}` is not text: scenes are UTF-8")]
    NotText {
        /// The file.
        path: String,
        /// The number of valid bytes before the first invalid one.
        at: usize,
    },
}
