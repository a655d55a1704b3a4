//! Types of attributes, and the data that flows through connections.

use super::value::{Choice, Painting, Value};

/// The data of a plug. Only plugs of the same data can be connected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Data {
    /// Numbers, booleans, enums and times. The destination converts the value to its own kind.
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
    /// State of an object: initial, current or solved.
    State,
    /// A constraint.
    Constraint,
    /// A component of an object.
    Component,
    /// The id of an object in its nucleus.
    ObjectId,
    /// Emitted particles.
    NewParticles,
    /// Particles as the input of a field.
    FieldData,
    /// Settings of a field per particle.
    FieldSettings,
    /// A transformation matrix.
    Matrix,
    /// No value: two nodes belong together.
    Message,
    /// Compound data that only Maya's nodes exchange.
    Bundle,
}

impl Data {
    /// A noun for messages: `a mesh`, `a number`.
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
    /// A number or a texture.
    Texture,
    /// Three numbers, with the short names of x, y and z.
    Vector([&'static str; 3]),
    /// An enum: Maya's index and name of each value.
    Choice(&'static [(i32, &'static str)]),
    /// Text.
    Text,
    /// Text, or a list of texts.
    Texts,
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
    /// Components of objects.
    Components,
    /// The name of another node; with data, it becomes a connection.
    Node(Option<Data>),
    /// Sets several attributes of the same node at once; their names.
    Together(&'static [&'static str]),
    /// A connection without a value.
    Plug(Data),
}

impl Kind {
    /// The syntax in a scene, for messages and lists: `a number`, `true or false`.
    pub fn expects(self) -> &'static str {
        match self {
            Self::Bool => "true or false",
            Self::Int => "a whole number",
            Self::Float => "a number",
            Self::Texture => "texture(\"...\") or a number",
            Self::Vector(_) => "three numbers",
            Self::Choice(_) => "one of its words",
            Self::Text => "text in quotes",
            Self::Texts => "text in quotes or a list of texts",
            Self::Ints => "a list of whole numbers",
            Self::Floats => "a list of numbers, file(\"...\") or expression(\"...\")",
            Self::Vectors => "a vector, a list of vectors or file(\"...\")",
            Self::Ramp => "a list of (position, value)",
            Self::ColorRamp => "a list of (position, (red, green, blue))",
            Self::Components => "a list of components",
            Self::Node(_) => "the name of a node in quotes",
            Self::Together(_) => "one number for each part",
            Self::Plug(_) => "a connection",
        }
    }

    /// Whether keys can animate attributes of this kind.
    pub fn can_be_keyed(self) -> bool {
        matches!(self, Self::Bool | Self::Int | Self::Float | Self::Vector(_) | Self::Choice(_))
    }

    /// The data of a plug of this kind; `None` if it cannot be connected.
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
            Self::Texts | Self::Components | Self::Together(_) => None,
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
            | (
                Self::Floats,
                Value::Painting(Painting::File(_) | Painting::Expression(_) | Painting::Selection(_)),
            )
            | (Self::Vectors, Value::Painting(Painting::File(_)))
            | (Self::Vector(_), Value::Vector(_))
            | (Self::Text, Value::Text(_))
            | (Self::Texts, Value::Texts(_))
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
