//! What an attribute holds at one moment.

use std::borrow::Cow;
use std::fmt;

/// A value of any kind.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// On or off.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A number.
    Float(f64),
    /// Three numbers.
    Vector([f64; 3]),
    /// One of the words of the attribute.
    Choice(Choice),
    /// Text, such as the path of a file.
    Text(String),
    /// Whole numbers, one per element.
    Ints(Vec<u32>),
    /// Numbers, one per point.
    Floats(Vec<f64>),
    /// Vectors, one per point.
    Vectors(Vec<[f64; 3]>),
    /// A curve over 0 to 1.
    Ramp(Cow<'static, [RampPoint]>),
    /// Colours over 0 to 1.
    ColorRamp(Cow<'static, [ColorPoint]>),
    /// Parts of objects.
    Components(Vec<Component>),
    /// Something per point that is made elsewhere.
    Painting(Painting),
}

/// Where what is given per point comes from, when it is no list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Painting {
    /// A file of numbers: `file("weights.txt")`.
    File(String),
    /// An expression of each point: `expression("x > 0 ? 2 : 1")`.
    Expression(String),
    /// A picture: `texture("weights.png")`.
    Texture(String),
}

impl Painting {
    /// The word that a scene writes for it, and what stands in its brackets.
    pub fn parts(&self) -> (&'static str, &str) {
        match self {
            Self::File(file) => ("file", file),
            Self::Expression(text) => ("expression", text),
            Self::Texture(file) => ("texture", file),
        }
    }
}

/// One of the words of an enum attribute, by Maya's index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Choice(pub i32);

/// One point of a ramp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RampPoint {
    /// Where on the ramp, 0 to 1.
    pub position: f64,
    /// Its value there.
    pub value: f64,
    /// How it goes on to the next point.
    pub interpolation: Choice,
}

/// One point of a ramp of colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorPoint {
    /// Where on the ramp, 0 to 1.
    pub position: f64,
    /// Red, green and blue there.
    pub color: [f64; 3],
    /// How it goes on to the next point.
    pub interpolation: Choice,
}

/// A part of an object: `cloth1.vtx[0:64]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Name of the object's node.
    pub object: String,
    /// Which of its elements.
    pub selection: Selection,
}

/// Which elements of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selection {
    /// The whole object: `cloth1`.
    Object,
    /// All of its points: `cloth1.vtx[*]`.
    AllPoints,
    /// A run of points, both ends included: `cloth1.vtx[3]`, `cloth1.vtx[0:64]`.
    Points {
        /// The first point.
        first: u32,
        /// The last point, not before the first.
        last: u32,
    },
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let object = &self.object;
        match self.selection {
            Selection::Object => write!(f, "{object}"),
            Selection::AllPoints => write!(f, "{object}.vtx[*]"),
            Selection::Points { first, last } if first == last => write!(f, "{object}.vtx[{first}]"),
            Selection::Points { first, last } => write!(f, "{object}.vtx[{first}:{last}]"),
        }
    }
}
