//! A file as statements: lines, with those joined that end in a backslash.

use std::io::{self, BufRead};

/// Reads one statement at a time into the same memory.
pub(super) struct Lines<R> {
    input: R,
    statement: Vec<u8>,
    read: u64,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(input: R) -> Self {
        Self { input, statement: Vec::new(), read: 0 }
    }

    /// The next statement without its line end, and the number of its first line, counted from 1.
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
            // A path at the end of a comment may well end in a backslash.
            if !self.statement.ends_with(b"\\") || self.statement.starts_with(b"#") {
                return Ok(Some((first, &self.statement)));
            }
            self.statement.pop();
            self.statement.push(b' ');
        }
    }
}
