//! Values of attributes.

use std::borrow::Cow;
use std::fmt;

/// A value of any kind.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A number.
    Float(f64),
    /// Three numbers.
    Vector([f64; 3]),
    /// A value of an enum.
    Choice(Choice),
    /// Text, such as the path of a file.
    Text(String),
    /// Whole numbers, one per element.
    Ints(Vec<u32>),
    /// Numbers, one per point.
    Floats(Vec<f64>),
    /// Vectors, one per point.
    Vectors(Vec<[f64; 3]>),
    /// A function on 0 to 1.
    Ramp(Cow<'static, [RampPoint]>),
    /// A function of colours on 0 to 1.
    ColorRamp(Cow<'static, [ColorPoint]>),
    /// Components of objects.
    Components(Vec<Component>),
    /// Values per point from a file, an expression or a texture.
    Painting(Painting),
}

/// The source of values per point that are not a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Painting {
    /// A file of numbers: `file("weights.txt")`.
    File(String),
    /// An expression, evaluated at each point: `expression("x > 0 ? 2 : 1")`.
    Expression(String),
    /// An image: `texture("weights.png")`.
    Texture(String),
}

impl Painting {
    /// The name of the source in a scene, and its argument.
    pub fn parts(&self) -> (&'static str, &str) {
        match self {
            Self::File(file) => ("file", file),
            Self::Expression(text) => ("expression", text),
            Self::Texture(file) => ("texture", file),
        }
    }
}

/// A value of an enum attribute, by Maya's index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Choice(pub i32);

/// One point of a ramp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RampPoint {
    /// Position on the ramp, 0 to 1.
    pub position: f64,
    /// Value at that position.
    pub value: f64,
    /// Interpolation to the next point.
    pub interpolation: Choice,
}

impl RampPoint {
    /// The scene's names of Maya's interpolations after a point, by Maya's number.
    pub const INTERPOLATIONS: [&str; 4] = ["none", "linear", "smooth", "spline"];
}

/// One point of a ramp of colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorPoint {
    /// Position on the ramp, 0 to 1.
    pub position: f64,
    /// Red, green and blue at that position.
    pub color: [f64; 3],
    /// Interpolation to the next point.
    pub interpolation: Choice,
}

/// A component of an object: `cloth1.vtx[0:64]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Name of the object's node.
    pub object: String,
    /// Its elements.
    pub selection: Selection,
}

/// Elements of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selection {
    /// The whole object: `cloth1`.
    Object,
    /// All points: `cloth1.vtx[*]`.
    AllPoints,
    /// A range of points, including both ends: `cloth1.vtx[3]`, `cloth1.vtx[0:64]`.
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
