//! What an attribute can hold, and how a scene may write it.

use super::value::{Choice, Value};

/// The type of an attribute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// `true` or `false`.
    Bool,
    /// A whole number.
    Int,
    /// A number.
    Float,
    /// Three numbers; each also has a name of its own: the short names of x, y and z.
    Vector([&'static str; 3]),
    /// One of some words: Maya's index and Maya's name of each.
    Choice(&'static [(i32, &'static str)]),
    /// Text.
    Text,
    /// A list of whole numbers.
    Ints,
    /// A list of numbers.
    Floats,
    /// A list of vectors.
    Vectors,
    /// A list of `(position, value)`, both numbers.
    Ramp,
    /// Parts of objects.
    Components,
    /// The name of another node, which becomes a connection.
    Node,
    /// Several attributes of the same node set in one go, by their names.
    Together(&'static [&'static str]),
    /// Something that is only ever connected, never set.
    Plug,
}

impl Kind {
    /// What a scene has to write, for messages and lists: `a number`, `true or false` ...
    pub fn expects(self) -> &'static str {
        match self {
            Self::Bool => "true or false",
            Self::Int => "a whole number",
            Self::Float => "a number",
            Self::Vector(_) => "three numbers",
            Self::Choice(_) => "one of its words",
            Self::Text => "text in quotes",
            Self::Ints => "a list of whole numbers",
            Self::Floats => "a list of numbers",
            Self::Vectors => "a list of vectors",
            Self::Ramp => "a list of (position, value)",
            Self::Components => "a list of components",
            Self::Node => "the name of a node in quotes",
            Self::Together(_) => "one number for each part",
            Self::Plug => "a connection",
        }
    }

    /// Whether such an attribute could be keyed at all.
    pub fn can_be_keyed(self) -> bool {
        matches!(self, Self::Bool | Self::Int | Self::Float | Self::Vector(_) | Self::Choice(_))
    }

    /// Whether a value is of this kind.
    pub fn admits(self, value: &Value) -> bool {
        match (self, value) {
            (Self::Choice(words), Value::Choice(Choice(index))) => words.iter().any(|(i, _)| i == index),
            (Self::Bool, Value::Bool(_))
            | (Self::Int, Value::Int(_))
            | (Self::Float, Value::Float(_))
            | (Self::Vector(_), Value::Vector(_))
            | (Self::Text, Value::Text(_))
            | (Self::Ints, Value::Ints(_))
            | (Self::Floats, Value::Floats(_))
            | (Self::Vectors, Value::Vectors(_))
            | (Self::Ramp, Value::Ramp(_))
            | (Self::Components, Value::Components(_)) => true,
            _ => false,
        }
    }
}
