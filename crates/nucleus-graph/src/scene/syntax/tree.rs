//! Values with their places, and syntax errors.

use std::ops::Range;

/// A value and its place in the text.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Its place: byte offsets into the text, name and brackets included.
    pub span: Range<usize>,
}

/// A value in one of RON's forms.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A finite number; integers beyond 2⁵³ are rounded.
    Number(f64),
    /// Text in double quotes, its escapes already replaced.
    Text(String),
    /// `true` or `false`.
    Bool(bool),
    /// `[a, b]`
    List(Vec<Node>),
    /// `{key: value}`, in the order of the text. Equal keys are kept.
    Map(Vec<(Node, Node)>),
    /// `Name(field: 1)` or `(field: 1)`, in the order of the text. Equal fields are kept.
    /// `Name()` and `()` are records without fields.
    Record {
        /// The word before the bracket.
        name: Option<Word>,
        /// Fields and their values.
        fields: Vec<(Word, Node)>,
    },
    /// `Name(1, 2)` or `(1, 2)`, with at least one item.
    Tuple {
        /// The word before the bracket.
        name: Option<Word>,
        /// The items.
        items: Vec<Node>,
    },
    /// A bare word: `noPenetration`.
    Word(String),
}

/// A name and its place in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Word {
    /// The name.
    pub text: String,
    /// Its place: byte offsets into the text.
    pub span: Range<usize>,
}

impl Value {
    /// The form of the value, for messages: `a number`, `a list` ...
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Text(_) => "text",
            Self::Bool(_) => "true or false",
            Self::List(_) => "a list",
            Self::Map(_) => "a map",
            Self::Record { .. } => "a record",
            Self::Tuple { .. } => "a tuple",
            Self::Word(_) => "a word",
        }
    }
}

/// A syntax error with its place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct SyntaxError {
    /// The mistake: lower case, no full stop.
    pub message: String,
    /// The place: byte offsets into the text. Empty where a character is missing.
    pub span: Range<usize>,
    /// How to fix it.
    pub help: Option<String>,
}

impl SyntaxError {
    /// An error at a place.
    pub(super) fn new(message: impl Into<String>, span: Range<usize>) -> Self {
        Self { message: message.into(), span, help: None }
    }

    /// The same error with a line of help.
    pub(super) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }
}
