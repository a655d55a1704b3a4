//! One row of a table: everything there is to say about one attribute.

use std::fmt;

use super::kind::Kind;
use super::value::{Choice, Value};

/// An attribute of a node type.
pub struct Attribute {
    /// Maya's long name, which scenes use.
    pub name: &'static str,
    /// Maya's short name, which scenes may use too.
    pub short: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// What it holds when nobody sets it; `None` for what can only be connected or is worked out.
    pub default: Option<Value>,
    /// The numbers it takes.
    pub range: Range,
    /// Unit of its numbers; empty when they have none.
    pub unit: &'static str,
    /// The section it stands in, as in Maya's attribute editor.
    pub group: &'static str,
    /// Not shown to users, but it can be read and written.
    pub hidden: bool,
    /// Ours, unknown to Maya.
    pub extension: bool,
    /// Whether it may change from frame to frame.
    pub keyable: bool,
    /// It holds many: each element is a plug of its own, `inputActive[2]`.
    pub multi: bool,
    /// A connection can begin here.
    pub readable: bool,
    /// A connection can end here.
    pub writable: bool,
    /// Where it takes effect.
    pub effect: Effect,
    pub(super) doc: &'static str,
}

/// The numbers an attribute takes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Range {
    /// Below this a scene is refused.
    pub min: Option<f64>,
    /// Above this a scene is refused.
    pub max: Option<f64>,
    /// Where Maya's slider begins and ends; scenes may go beyond.
    pub soft: Option<(f64, f64)>,
}

/// Where an attribute takes effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// In the module of this path, from its crate on: `nucleus_core::constraints::bend`. `cargo xtask tidy` looks for its
    /// file.
    Solved(&'static str),
    /// Nowhere yet: it can be set, and whoever sets it is told.
    NotYet,
    /// Nowhere, and in Maya neither: it can be set, and whoever sets it is told.
    Never,
}

/// Its name is enough to tell it by.
impl fmt::Debug for Attribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Rows are compared by identity: there is one static per row.
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
    /// What it does, in one line.
    pub fn doc(&self) -> &'static str {
        self.doc.trim_start()
    }

    /// Whether it may be keyed.
    pub fn can_be_keyed(&self) -> bool {
        self.keyable && self.kind.can_be_keyed()
    }

    /// Names of the three parts of a vector, long and short: `translateX` and `tx` ...
    pub fn parts(&self) -> Option<[(String, &'static str); 3]> {
        let Kind::Vector(shorts) = self.kind else { return None };
        Some(shorts.map(|short| {
            let letter = short.chars().next_back().map(|c| c.to_ascii_uppercase());
            (format!("{}{}", self.name, letter.unwrap_or_default()), short)
        }))
    }

    /// The words of an enum as a scene writes them, with their index; empty for all other kinds.
    pub fn words(&self) -> Vec<(Choice, String)> {
        let Kind::Choice(words) = self.kind else { return Vec::new() };
        words.iter().map(|&(index, name)| (Choice(index), camel_case(name))).collect()
    }
}

/// Maya's name of an enum field as one word: `Object Space` becomes `objectSpace`.
fn camel_case(name: &str) -> String {
    let mut word = String::new();
    for part in name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|part| !part.is_empty()) {
        let (first, rest) = part.split_at(1);
        let first = if word.is_empty() { first.to_ascii_lowercase() } else { first.to_ascii_uppercase() };
        word = word + &first + rest;
    }
    word
}
