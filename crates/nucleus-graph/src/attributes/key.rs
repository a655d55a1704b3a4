//! Typed keys: a row with the Rust type of its values, and the functions that define rows.

use std::borrow::Cow;
use std::marker::PhantomData;

use super::kind::{Data, Kind};
use super::row::{Attribute, Effect, Range};
use super::value::{Choice, ColorPoint, Component, RampPoint, Value};

/// A row whose values are read as `T`.
#[derive(Debug)]
pub struct Key<T> {
    /// The row.
    pub row: Attribute,
    read_as: PhantomData<fn() -> T>,
}

/// A Rust type that attribute values can be read as.
pub trait FromValue: Sized {
    /// The value as this type; `None` if it is of another kind.
    fn from_value(value: &Value) -> Option<Self>;
}

/// The type of attributes without a value: connections and node names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plugged {}

macro_rules! read_as {
    ($($type:ty: $variant:ident),+ $(,)?) => {
        $(impl FromValue for $type {
            fn from_value(value: &Value) -> Option<Self> {
                if let Value::$variant(value) = value { Some(value.clone().into()) } else { None }
            }
        })+
    };
}

read_as! {
    bool: Bool, i64: Int, f64: Float, [f64; 3]: Vector, Choice: Choice, String: Text, Vec<String>: Texts, Vec<u32>: Ints,
    Vec<f64>: Floats, Vec<[f64; 3]>: Vectors, Cow<'static, [RampPoint]>: Ramp,
    Cow<'static, [ColorPoint]>: ColorRamp, Vec<Component>: Components,
}

/// `true` or `false`.
pub(super) const fn toggle(name: &'static str, short: &'static str, default: bool) -> Key<bool> {
    Key::new(name, short, Kind::Bool, Some(Value::Bool(default)))
}

/// A whole number.
pub(super) const fn int(name: &'static str, short: &'static str, default: i64) -> Key<i64> {
    Key::new(name, short, Kind::Int, Some(Value::Int(default)))
}

/// A number.
pub(super) const fn float(name: &'static str, short: &'static str, default: f64) -> Key<f64> {
    Key::new(name, short, Kind::Float, Some(Value::Float(default)))
}

/// A number or a texture.
pub(super) const fn texture(name: &'static str, short: &'static str, default: f64) -> Key<f64> {
    Key::new(name, short, Kind::Texture, Some(Value::Float(default))).fixed()
}

/// A vector, with a short name per component.
pub(super) const fn vector(
    name: &'static str,
    short: &'static str,
    default: [f64; 3],
    parts: [&'static str; 3],
) -> Key<[f64; 3]> {
    Key::new(name, short, Kind::Vector(parts), Some(Value::Vector(default)))
}

/// An enum: Maya's index and name of each value.
pub(super) const fn choice(
    name: &'static str,
    short: &'static str,
    default: i32,
    words: &'static [(i32, &'static str)],
) -> Key<Choice> {
    Key::new(name, short, Kind::Choice(words), Some(Value::Choice(Choice(default))))
}

/// Text, empty by default.
pub(super) const fn text(name: &'static str, short: &'static str) -> Key<String> {
    Key::new(name, short, Kind::Text, Some(Value::Text(String::new()))).fixed()
}

/// Text or a list of texts, empty by default.
pub(super) const fn texts(name: &'static str, short: &'static str) -> Key<Vec<String>> {
    Key::new(name, short, Kind::Texts, Some(Value::Texts(Vec::new()))).fixed()
}

/// Whole numbers, one per element.
pub(super) const fn ints(name: &'static str, short: &'static str) -> Key<Vec<u32>> {
    Key::new(name, short, Kind::Ints, Some(Value::Ints(Vec::new()))).fixed()
}

/// Numbers, one per point.
pub(super) const fn floats(name: &'static str, short: &'static str) -> Key<Vec<f64>> {
    Key::new(name, short, Kind::Floats, Some(Value::Floats(Vec::new()))).fixed()
}

/// Vectors, one per point.
pub(super) const fn vectors(name: &'static str, short: &'static str) -> Key<Vec<[f64; 3]>> {
    Key::new(name, short, Kind::Vectors, Some(Value::Vectors(Vec::new()))).fixed()
}

/// A ramp.
pub(super) const fn ramp(
    name: &'static str,
    short: &'static str,
    default: &'static [RampPoint],
) -> Key<Cow<'static, [RampPoint]>> {
    Key::new(name, short, Kind::Ramp, Some(Value::Ramp(Cow::Borrowed(default)))).fixed()
}

/// A ramp of colours, empty by default.
pub(super) const fn color_ramp(name: &'static str, short: &'static str) -> Key<Cow<'static, [ColorPoint]>> {
    Key::new(name, short, Kind::ColorRamp, Some(Value::ColorRamp(Cow::Borrowed(&[])))).fixed()
}

/// Components of objects.
pub(super) const fn components(name: &'static str, short: &'static str) -> Key<Vec<Component>> {
    Key::new(name, short, Kind::Components, Some(Value::Components(Vec::new()))).fixed()
}

/// The name of another node, and the data of the connection from it.
pub(super) const fn node(name: &'static str, short: &'static str, data: Option<Data>) -> Key<Plugged> {
    Key::new(name, short, Kind::Node(data), None).fixed()
}

/// A connection without a value.
pub(super) const fn plug(name: &'static str, short: &'static str, data: Data) -> Key<Plugged> {
    Key::new(name, short, Kind::Plug(data), None).fixed().hidden()
}

/// Sets several attributes at once.
pub(super) const fn together(name: &'static str, parts: &'static [&'static str]) -> Key<Plugged> {
    Key::new(name, name, Kind::Together(parts), None).fixed()
}

/// Further properties of a row.
impl<T> Key<T> {
    const fn new(name: &'static str, short: &'static str, kind: Kind, default: Option<Value>) -> Self {
        let range = Range { min: None, max: None, soft: None };
        let row = Attribute {
            name,
            short,
            kind,
            default,
            range,
            unit: "",
            group: "",
            hidden: false,
            extension: false,
            keyable: true,
            multi: false,
            readable: true,
            writable: true,
            effect: Effect::NotYet,
            doc: "",
        };
        Self { row, read_as: PhantomData }
    }

    /// Hard minimum: smaller values are errors.
    pub(super) const fn min(mut self, min: f64) -> Self {
        self.row.range.min = Some(min);
        self
    }

    /// Hard maximum: larger values are errors.
    pub(super) const fn max(mut self, max: f64) -> Self {
        self.row.range.max = Some(max);
        self
    }

    /// Range of Maya's slider.
    pub(super) const fn soft(mut self, from: f64, to: f64) -> Self {
        self.row.range.soft = Some((from, to));
        self
    }

    /// Unit of the values.
    pub(super) const fn unit(mut self, unit: &'static str) -> Self {
        self.row.unit = unit;
        self
    }

    /// The path of the module that implements it, starting with its crate.
    pub(super) const fn solved(mut self, module: &'static str) -> Self {
        self.row.effect = Effect::Solved(module);
        self
    }

    /// Not listed for users.
    pub(super) const fn hidden(mut self) -> Self {
        self.row.hidden = true;
        self
    }

    /// An array of plugs.
    pub(super) const fn multi(mut self) -> Self {
        self.row.multi = true;
        self
    }

    /// An output: it cannot be the destination of a connection.
    pub(super) const fn output(mut self) -> Self {
        self.row.writable = false;
        self
    }

    /// An input only: it cannot be the source of a connection.
    pub(super) const fn sink(mut self) -> Self {
        self.row.readable = false;
        self
    }

    /// Without effect in Maya.
    pub(super) const fn unused(mut self) -> Self {
        self.row.effect = Effect::Never;
        self
    }

    /// Without effect here; `reason` is a clause that says why.
    pub(super) const fn elsewhere(mut self, reason: &'static str) -> Self {
        self.row.effect = Effect::Elsewhere(reason);
        self
    }

    /// Without effect here, as a part of Maya's wiring; `reason` is a clause that says why.
    pub(super) const fn wiring(mut self, reason: &'static str) -> Self {
        self.row.effect = Effect::Wiring(reason);
        self
    }

    /// Not an attribute of Maya.
    pub(super) const fn extension(mut self) -> Self {
        self.row.extension = true;
        self
    }

    /// Read once, at the start frame.
    pub(super) const fn fixed(mut self) -> Self {
        self.row.keyable = false;
        self
    }

    /// Section and description, from the table.
    pub(super) const fn described(mut self, group: &'static str, doc: &'static str) -> Self {
        self.row.group = group;
        self.row.doc = doc;
        self
    }
}
