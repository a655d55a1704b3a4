//! The setting of an attribute: one value for all frames, or curves.

use crate::animation::Curve;
use crate::attributes::{Attribute, Choice, Kind, Range, Value};

/// A value or curves that an attribute is set to.
#[derive(Debug, Clone, PartialEq)]
pub enum Setting {
    /// One value for all frames. Vectors are always [`Parts`](Self::Parts).
    Fixed(Value),
    /// A curve of numbers, switches or words.
    Keyed(Curve),
    /// The three components of a vector.
    Parts([Channel; 3]),
}

/// One component of a vector.
#[derive(Debug, Clone, PartialEq)]
pub enum Channel {
    /// One value for all frames.
    Fixed(f64),
    /// A curve.
    Keyed(Curve),
}

impl Setting {
    /// Whether an attribute takes it: the kind matches, values are in the hard range, and only keyable
    /// attributes have curves.
    pub fn fits(&self, attribute: &Attribute) -> bool {
        let whole = |x: f64| match attribute.kind {
            Kind::Bool => x == 0.0 || x == 1.0,
            Kind::Int => x.fract() == 0.0,
            Kind::Choice(words) => words.iter().any(|(index, _)| f64::from(*index) == x),
            _ => true,
        };
        let within = |curve: &Curve| {
            curve.keys().iter().all(|key| attribute.range.contains(key.value) && whole(key.value))
        };
        match (self, attribute.kind) {
            (Self::Fixed(Value::Float(x)), Kind::Float | Kind::Texture) => attribute.range.contains(*x),
            (Self::Fixed(Value::Int(x)), Kind::Int) => attribute.range.contains(*x as f64),
            (Self::Fixed(Value::Vector(_)), _) => false,
            (Self::Fixed(value), kind) => kind.admits(value),
            (Self::Keyed(_), Kind::Vector(_)) => false,
            (Self::Keyed(curve), _) => attribute.can_be_keyed() && within(curve),
            (Self::Parts(channels), Kind::Vector(_)) => channels.iter().all(|channel| match channel {
                Channel::Fixed(x) => attribute.range.contains(*x),
                Channel::Keyed(curve) => attribute.keyable && within(curve),
            }),
            (Self::Parts(_), _) => false,
        }
    }

    /// The value at a frame, clamped to the hard range: a curve can overshoot it between keys.
    pub fn at(&self, frame: f64, attribute: &Attribute) -> Value {
        match self {
            Self::Fixed(value) => value.clone(),
            Self::Keyed(curve) => as_kind(curve.value_at(frame), attribute),
            Self::Parts(channels) => {
                Value::Vector([0, 1, 2].map(|part| channels[part].at(frame, attribute.range)))
            }
        }
    }

    /// Whether it has a curve that is not constant.
    pub fn changes(&self) -> bool {
        let curves = match self {
            Self::Fixed(_) => return false,
            Self::Keyed(curve) => [Some(curve), None, None],
            Self::Parts(channels) => channels.each_ref().map(|channel| match channel {
                Channel::Fixed(_) => None,
                Channel::Keyed(curve) => Some(curve),
            }),
        };
        curves.into_iter().flatten().any(|curve| !curve.is_constant())
    }

    /// The largest magnitude of a number over all frames; 0 of what is not a number.
    pub fn largest(&self) -> f64 {
        match self {
            Self::Fixed(Value::Float(x)) => x.abs(),
            Self::Fixed(Value::Int(x)) => (*x as f64).abs(),
            Self::Keyed(curve) => curve.max_abs(),
            Self::Fixed(_) | Self::Parts(_) => 0.0,
        }
    }

    /// Whether a number is nonzero at any frame.
    pub fn is_ever_nonzero(&self) -> bool {
        match self {
            Self::Fixed(Value::Float(_) | Value::Int(_)) | Self::Keyed(_) => self.largest() != 0.0,
            Self::Fixed(Value::Bool(on)) => *on,
            Self::Fixed(Value::Vector(parts)) => *parts != [0.0; 3],
            Self::Fixed(_) => true,
            Self::Parts(channels) => channels.iter().any(|channel| match channel {
                Channel::Fixed(x) => *x != 0.0,
                Channel::Keyed(curve) => curve.max_abs() != 0.0,
            }),
        }
    }
}

impl Channel {
    fn at(&self, frame: f64, range: Range) -> f64 {
        match self {
            Self::Fixed(x) => *x,
            Self::Keyed(curve) => range.clamp(curve.value_at(frame)),
        }
    }
}

impl From<Value> for Setting {
    fn from(value: Value) -> Self {
        match value {
            Value::Vector(parts) => Self::Parts(parts.map(Channel::Fixed)),
            value => Self::Fixed(value),
        }
    }
}

/// Converts a number to the kind of an attribute, as Maya does: rounded, clamped, or the nearest word.
pub(super) fn as_kind(x: f64, attribute: &Attribute) -> Value {
    match attribute.kind {
        Kind::Bool => Value::Bool(x >= 0.5),
        Kind::Int => Value::Int(attribute.range.clamp(x.round()) as i64),
        Kind::Choice(words) => {
            let near = |&&(index, _): &&(i32, &str)| (f64::from(index) - x).abs();
            let nearest = words.iter().min_by(|a, b| near(a).total_cmp(&near(b)));
            Value::Choice(Choice(nearest.map_or(0, |&(index, _)| index)))
        }
        _ => Value::Float(attribute.range.clamp(x)),
    }
}
