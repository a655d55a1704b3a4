//! Files that a scene names. Only regular files are read: a device may have no end, and a pipe may have no writer.
//! Messages about a file give a line and column, never its content: a scene may name any file that the user can read.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Opens a regular file. Also returns its length in bytes.
pub(crate) fn open(path: &Path) -> io::Result<(File, u64)> {
    // Opening a pipe would wait for a writer.
    let about = fs::metadata(path)?;
    if about.is_dir() {
        return Err(io::Error::new(ErrorKind::IsADirectory, "it is a folder, not a file"));
    }
    if !about.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is a device or a pipe, not a file"));
    }
    File::open(path).map(|file| (file, about.len()))
}

/// The bytes of a regular file.
pub(crate) fn read_all(path: &Path) -> io::Result<Vec<u8>> {
    let (mut file, length) = open(path)?;
    let mut bytes = Vec::with_capacity(length as usize);
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The length of a file in bytes, or 0 if it cannot be found: reading it then reports the error.
pub(crate) fn length(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |about| about.len())
}

/// A range of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LineSpan {
    /// The column of the first character, from 1.
    pub column: usize,
    /// Its length in bytes.
    pub bytes: usize,
}

impl std::fmt::Display for LineSpan {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "column {}, {} {}", self.column, self.bytes, if self.bytes == 1 { "byte" } else { "bytes" })
    }
}

impl LineSpan {
    /// The range of `part`, which is a slice of `line`.
    pub(crate) fn of(part: &[u8], line: &[u8]) -> Self {
        let before = (part.as_ptr() as usize).saturating_sub(line.as_ptr() as usize).min(line.len());
        let column = String::from_utf8_lossy(&line[..before]).chars().count() + 1;
        Self { column, bytes: part.len() }
    }
}
