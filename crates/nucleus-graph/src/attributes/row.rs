//! One row of a table: the properties of one attribute.

use std::fmt;

use super::kind::Kind;
use super::value::{Choice, Value};

/// An attribute of a node type.
pub struct Attribute {
    /// Maya's long name, which scenes use.
    pub name: &'static str,
    /// Maya's short name, which scenes may use too.
    pub short: &'static str,
    /// Type of its value.
    pub kind: Kind,
    /// Value where it is not set; `None` for connections and outputs.
    pub default: Option<Value>,
    /// Its range.
    pub range: Range,
    /// Unit of its values; empty if they have none.
    pub unit: &'static str,
    /// Its section in Maya's attribute editor.
    pub group: &'static str,
    /// Not listed for users. It can be read and written.
    pub hidden: bool,
    /// Not an attribute of Maya.
    pub extension: bool,
    /// Whether it may change from frame to frame.
    pub keyable: bool,
    /// An array of plugs: `inputActive[2]`.
    pub multi: bool,
    /// It can be the source of a connection.
    pub readable: bool,
    /// It can be the destination of a connection.
    pub writable: bool,
    /// The module that implements it, if any.
    pub effect: Effect,
    pub(super) doc: &'static str,
}

/// The range of an attribute's values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Range {
    /// Hard minimum: a smaller value is an error.
    pub min: Option<f64>,
    /// Hard maximum: a larger value is an error.
    pub max: Option<f64>,
    /// Range of Maya's slider. Values outside are valid.
    pub soft: Option<(f64, f64)>,
}

/// Whether an attribute has an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Implemented by the module of this path: `nucleus_core::constraints::bend`. `cargo xtask tidy` checks that it exists.
    Solved(&'static str),
    /// Not implemented yet: setting it is a warning.
    NotYet,
    /// Without effect in Maya: setting it is a warning.
    Never,
    /// Without effect here, for this reason; Maya uses it outside its solver, or another attribute stands for it.
    /// Setting it is a warning, and so is connecting it.
    Elsewhere(&'static str),
    /// Without effect here, for this reason: Maya's nodes hand it on, and its state is found otherwise. Setting it is a warning;
    /// a connection of it loses nothing.
    Wiring(&'static str),
}

impl Effect {
    /// That an attribute has no effect, and why, as the end of a sentence; `None` if it is solved.
    pub fn lack(self) -> Option<String> {
        match self {
            Self::Solved(_) => None,
            Self::NotYet => Some("has no effect yet".to_owned()),
            Self::Never => Some("has no effect: nothing uses it, not even in Maya".to_owned()),
            Self::Elsewhere(reason) | Self::Wiring(reason) => Some(format!("has no effect: {reason}")),
        }
    }

    /// The same for a connection to it.
    pub fn lack_of_connection(self) -> Option<String> {
        if matches!(self, Self::Wiring(_)) { None } else { self.lack() }
    }
}

/// Prints the name.
impl fmt::Debug for Attribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Compares by identity: there is one static per row.
impl PartialEq for Attribute {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Range {
    /// Whether a number lies within the hard range.
    pub fn contains(self, x: f64) -> bool {
        self.min.is_none_or(|min| x >= min) && self.max.is_none_or(|max| x <= max)
    }

    /// The nearest number within the hard range.
    pub fn clamp(self, x: f64) -> f64 {
        let x = self.min.map_or(x, |min| x.max(min));
        self.max.map_or(x, |max| x.min(max))
    }
}

impl Attribute {
    /// Description in one line.
    pub fn doc(&self) -> &'static str {
        self.doc.trim_start()
    }

    /// Whether it may be keyed.
    pub fn can_be_keyed(&self) -> bool {
        self.keyable && self.kind.can_be_keyed()
    }

    /// Long and short names of the components of a vector: `translateX` and `tx`.
    pub fn parts(&self) -> Option<[(String, &'static str); 3]> {
        let Kind::Vector(shorts) = self.kind else { return None };
        Some(shorts.map(|short| {
            let letter = short.chars().next_back().map(|c| c.to_ascii_uppercase());
            (format!("{}{}", self.name, letter.unwrap_or_default()), short)
        }))
    }

    /// The values of an enum: index, and name in a scene. Empty for all other kinds.
    pub fn words(&self) -> Vec<(Choice, String)> {
        let Kind::Choice(words) = self.kind else { return Vec::new() };
        words.iter().map(|&(index, name)| (Choice(index), camel_case(name))).collect()
    }
}

/// Maya's name of an enum value in camel case: `Object Space` becomes `objectSpace`.
fn camel_case(name: &str) -> String {
    let mut word = String::new();
    for part in name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|part| !part.is_empty()) {
        let (first, rest) = part.split_at(1);
        let first = if word.is_empty() { first.to_ascii_lowercase() } else { first.to_ascii_uppercase() };
        word = word + &first + rest;
    }
    word
}
