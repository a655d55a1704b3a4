//! A mistake in the writing of a text, with its place.

use std::ops::Range;

/// Something that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct SyntaxError {
    /// What is wrong: lower case, no full stop.
    pub message: String,
    /// Where: byte offsets into the text. Empty where something is missing.
    pub span: Range<usize>,
    /// What can be done about it.
    pub help: Option<String>,
}

impl SyntaxError {
    /// A mistake at a place.
    pub(super) fn new(message: impl Into<String>, span: Range<usize>) -> Self {
        Self { message: message.into(), span, help: None }
    }

    /// The same with a line of help.
    pub(super) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }
}
