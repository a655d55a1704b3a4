//! What a text says, and where each part of it stands.

use std::ops::Range;

/// A value and its place in the text.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// What is written.
    pub value: Value,
    /// Where: byte offsets into the text, name and brackets included.
    pub span: Range<usize>,
}

/// Anything that can stand where a value is expected.
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
    /// `{key: value}`, in the order of the text. Equal keys are all kept.
    Map(Vec<(Node, Node)>),
    /// `Name(field: 1)` or `(field: 1)`, in the order of the text. Equal fields are all kept.
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
    /// Where it stands: byte offsets into the text.
    pub span: Range<usize>,
}

impl Value {
    /// What kind of value this is, for messages: `a number`, `a list` ...
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
