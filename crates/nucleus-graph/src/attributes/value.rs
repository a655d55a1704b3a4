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
    /// Texts, such as the names of nodes.
    Texts(Vec<String>),
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
    /// Selected points, and values for them and for the others: `selection("border ? 5 : 1")`.
    Selection(String),
}

impl Painting {
    /// The name of the source in a scene, and its argument.
    pub fn parts(&self) -> (&'static str, &str) {
        match self {
            Self::File(file) => ("file", file),
            Self::Expression(text) => ("expression", text),
            Self::Texture(file) => ("texture", file),
            Self::Selection(text) => ("selection", text),
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

/// A component of an object: `cloth1.vtx[0:64]`, `cloth1.e[border]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Name of the object's node.
    pub object: String,
    /// Its elements.
    pub selection: Selection,
}

/// Elements of an object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Selection {
    /// The whole object: `cloth1`.
    Object,
    /// Elements of one kind: `cloth1.vtx[3]`.
    Elements(ElementKind, Which),
}

/// A kind of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ElementKind {
    /// Points: `vtx`.
    Point,
    /// Edges: `e`, in the order in which the faces first name them.
    Edge,
    /// Faces: `f`.
    Face,
}

/// Which elements of a kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Which {
    /// All of them: `*`.
    All,
    /// From one to another, both included: `3`, `0:64`. The first is not after the last.
    Range(u32, u32),
    /// Those on borders: edges of one face, and their points.
    Border,
    /// Points of a border with one face only. Of edges and faces: those with such a point.
    Corners,
    /// Those whose points all satisfy an expression in start positions: `where(y > 1.49)`.
    Where(String),
    /// Those of a group of an OBJ file: `group(collar)`.
    Group(String),
    /// Those whose points all lie on an image where it is brighter than one half: `mask(tear.png)`.
    Mask(String),
}

impl ElementKind {
    /// Each with its name in components.
    pub const WORDS: [(&'static str, Self); 3] = [("vtx", Self::Point), ("e", Self::Edge), ("f", Self::Face)];

    /// Its name in components.
    pub fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(_, kind)| *kind == self).map_or("", |(word, _)| word)
    }

    /// Its name in messages.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Edge => "edge",
            Self::Face => "face",
        }
    }
}

impl Selection {
    /// Points from one to another, both included.
    pub fn points(first: u32, last: u32) -> Self {
        Self::Elements(ElementKind::Point, Which::Range(first, last))
    }
}

impl fmt::Display for Which {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => write!(f, "*"),
            Self::Range(first, last) if first == last => write!(f, "{first}"),
            Self::Range(first, last) => write!(f, "{first}:{last}"),
            Self::Border => write!(f, "border"),
            Self::Corners => write!(f, "corners"),
            Self::Where(text) => write!(f, "where({text})"),
            Self::Group(name) => write!(f, "group({name})"),
            Self::Mask(file) => write!(f, "mask({file})"),
        }
    }
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let object = &self.object;
        match &self.selection {
            Selection::Object => write!(f, "{object}"),
            Selection::Elements(kind, which) => write!(f, "{object}.{}[{which}]", kind.word()),
        }
    }
}
