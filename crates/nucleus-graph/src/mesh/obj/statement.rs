//! Statements of an OBJ file (lines, continued after a backslash at their end) and their words.

use std::io::{self, BufRead};
use std::path::Path;

use super::error::{ObjError, ObjFault};
use crate::files::LineSpan;

/// Reads one statement at a time into a reused buffer.
pub(super) struct Statements<R> {
    input: R,
    statement: Vec<u8>,
    read: u64,
}

impl<R: BufRead> Statements<R> {
    pub(super) fn new(input: R) -> Self {
        Self { input, statement: Vec::new(), read: 0 }
    }

    /// The next statement without its line end, and the number of its first line, from 1.
    pub(super) fn next(&mut self) -> io::Result<Option<(u64, &[u8])>> {
        self.statement.clear();
        let first = self.read + 1;
        loop {
            let start = self.statement.len();
            if self.input.read_until(b'\n', &mut self.statement)? == 0 {
                return Ok(if start > 0 { Some((first, &self.statement)) } else { None });
            }
            self.read += 1;
            if first == 1 && self.statement.starts_with(b"\xef\xbb\xbf") {
                self.statement.drain(..3); // byte order mark
            }
            if self.statement.ends_with(b"\n") {
                self.statement.pop();
            }
            if self.statement.ends_with(b"\r") {
                self.statement.pop();
            }
            // A path at the end of a comment can end in a backslash.
            if !self.statement.ends_with(b"\\") || self.statement.starts_with(b"#") {
                return Ok(Some((first, &self.statement)));
            }
            self.statement.pop();
            self.statement.push(b' ');
        }
    }
}

/// A word of a statement.
#[derive(Clone, Copy)]
pub(super) struct Word<'a> {
    pub(super) bytes: &'a [u8],
    statement: &'a [u8],
}

impl Word<'_> {
    pub(super) fn span(self) -> LineSpan {
        LineSpan::of(self.bytes, self.statement)
    }
}

/// The words of a statement, up to a comment.
pub(super) fn words(statement: &[u8]) -> impl Iterator<Item = Word<'_>> {
    let code = statement.split(|&byte| byte == b'#').next().unwrap_or_default();
    let words = code.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    words.map(move |bytes| Word { bytes, statement })
}

pub(super) fn number(word: Word<'_>) -> Result<f64, ObjFault> {
    let number = std::str::from_utf8(word.bytes).ok().and_then(|text| text.parse::<f64>().ok());
    match number {
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(ObjFault::NotFinite { span: word.span() }),
        None => Err(ObjFault::NotANumber { span: word.span() }),
    }
}

/// An error that does not yet name its file.
#[derive(Debug)]
pub(super) enum Fault {
    Io(io::Error),
    Line(u64, ObjFault),
    NoVertices,
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl Fault {
    pub(super) fn in_file(self, path: &Path) -> ObjError {
        let path = path.to_owned();
        match self {
            Self::Io(source) => ObjError::Unreadable { path, source },
            Self::Line(line, fault) => ObjError::Malformed { path, line, fault },
            Self::NoVertices => ObjError::NoVertices { path },
        }
    }
}
