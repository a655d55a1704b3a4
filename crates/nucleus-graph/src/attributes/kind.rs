//! What an attribute can hold, and how a scene may write it.

use super::value::{Choice, Painting, Value};

/// What flows through a plug; only plugs of the same data can be connected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Data {
    /// Numbers of all kinds, switches, words and times: each is read as what the input holds.
    Number,
    /// Three numbers.
    Vector,
    /// A number per element.
    Numbers,
    /// A vector per element.
    Vectors,
    /// Text.
    Text,
    /// A ramp.
    Ramp,
    /// A ramp of colours.
    ColorRamp,
    /// A surface.
    Mesh,
    /// State of an object: initial, current, or solved.
    State,
    /// A constraint.
    Constraint,
    /// A part of an object.
    Component,
    /// Which object of its nucleus something is.
    ObjectId,
    /// Particles that are emitted.
    NewParticles,
    /// Particles as fields see them.
    FieldData,
    /// Settings of fields that differ by particle.
    FieldSettings,
    /// A placement.
    Matrix,
    /// Nothing but that two nodes belong together.
    Message,
    /// Several things that only Maya's own nodes exchange.
    Bundle,
}

impl Data {
    /// For messages: `a mesh`, `numbers` ...
    pub fn noun(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Vector => "a vector",
            Self::Numbers => "a list of numbers",
            Self::Vectors => "a list of vectors",
            Self::Text => "text",
            Self::Ramp => "a ramp",
            Self::ColorRamp => "a ramp of colours",
            Self::Mesh => "a mesh",
            Self::State => "the state of an object",
            Self::Constraint => "a constraint",
            Self::Component => "a component",
            Self::ObjectId => "the id of an object",
            Self::NewParticles => "new particles",
            Self::FieldData => "particles for a field",
            Self::FieldSettings => "settings for a field",
            Self::Matrix => "a matrix",
            Self::Message => "a message",
            Self::Bundle => "a bundle of Maya's own",
        }
    }
}

/// The type of an attribute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// `true` or `false`.
    Bool,
    /// A whole number.
    Int,
    /// A number.
    Float,
    /// A number, or a texture to take it from.
    Texture,
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
    /// A list of `(position, (red, green, blue))`.
    ColorRamp,
    /// Parts of objects.
    Components,
    /// The name of another node; it becomes a connection if this is what flows through it.
    Node(Option<Data>),
    /// Several attributes of the same node set in one go, by their names.
    Together(&'static [&'static str]),
    /// Something that is only ever connected, never set.
    Plug(Data),
}

impl Kind {
    /// What a scene has to write, for messages and lists: `a number`, `true or false` ...
    pub fn expects(self) -> &'static str {
        match self {
            Self::Bool => "true or false",
            Self::Int => "a whole number",
            Self::Float => "a number",
            Self::Texture => "texture(\"...\") or a number",
            Self::Vector(_) => "three numbers",
            Self::Choice(_) => "one of its words",
            Self::Text => "text in quotes",
            Self::Ints => "a list of whole numbers",
            Self::Floats => "a list of numbers, file(\"...\") or expression(\"...\")",
            Self::Vectors => "a list of vectors or file(\"...\")",
            Self::Ramp => "a list of (position, value)",
            Self::ColorRamp => "a list of (position, (red, green, blue))",
            Self::Components => "a list of components",
            Self::Node(_) => "the name of a node in quotes",
            Self::Together(_) => "one number for each part",
            Self::Plug(_) => "a connection",
        }
    }

    /// Whether such an attribute could be keyed at all.
    pub fn can_be_keyed(self) -> bool {
        matches!(self, Self::Bool | Self::Int | Self::Float | Self::Vector(_) | Self::Choice(_))
    }

    /// What flows through a plug of this kind; nothing if it cannot be connected.
    pub fn carries(self) -> Option<Data> {
        match self {
            Self::Bool | Self::Int | Self::Float | Self::Texture | Self::Choice(_) => Some(Data::Number),
            Self::Vector(_) => Some(Data::Vector),
            Self::Ints | Self::Floats => Some(Data::Numbers),
            Self::Vectors => Some(Data::Vectors),
            Self::Text => Some(Data::Text),
            Self::Ramp => Some(Data::Ramp),
            Self::ColorRamp => Some(Data::ColorRamp),
            Self::Node(data) => data,
            Self::Plug(data) => Some(data),
            Self::Components | Self::Together(_) => None,
        }
    }

    /// Whether a value is of this kind.
    pub fn admits(self, value: &Value) -> bool {
        match (self, value) {
            (Self::Choice(words), Value::Choice(Choice(index))) => words.iter().any(|(i, _)| i == index),
            (Self::Bool, Value::Bool(_))
            | (Self::Int, Value::Int(_))
            | (Self::Float | Self::Texture, Value::Float(_))
            | (Self::Texture, Value::Painting(Painting::Texture(_)))
            | (Self::Floats, Value::Painting(Painting::File(_) | Painting::Expression(_)))
            | (Self::Vectors, Value::Painting(Painting::File(_)))
            | (Self::Vector(_), Value::Vector(_))
            | (Self::Text, Value::Text(_))
            | (Self::Ints, Value::Ints(_))
            | (Self::Floats, Value::Floats(_))
            | (Self::Vectors, Value::Vectors(_))
            | (Self::Ramp, Value::Ramp(_))
            | (Self::ColorRamp, Value::ColorRamp(_))
            | (Self::Components, Value::Components(_)) => true,
            _ => false,
        }
    }
}
