//! `nucleus attrs`: what a type of node holds.

use std::collections::HashSet;
use std::fmt::Write;

use anyhow::{Result, bail};
use clap::Args;
use nucleus_graph::attributes::{Attribute, Effect, Kind, NodeType, Range, Value, node_type, node_types};

use crate::outcome::Outcome;
use crate::{figures, output};

/// Lists the attributes of a type of node.
#[derive(Debug, Args)]
pub struct Attrs {
    /// The type of node, such as `nCloth`; all types are listed if none is given.
    node: Option<String>,
    /// Attributes too that are kept from view: what a node inherits and does not use, and inner workings.
    #[arg(long)]
    all: bool,
}

impl Attrs {
    /// Prints the table.
    pub fn run(self) -> Result<Outcome> {
        let text = match &self.node {
            None => list_types()?,
            Some(name) => match find(name) {
                Some(node_type) => table(node_type, self.all)?,
                None => bail!("there is no node type `{name}`; there are {}", names()),
            },
        };
        output::print(&text)?;
        Ok(Outcome::Fine)
    }
}

/// The type of this name, whatever the case of its letters.
fn find(name: &str) -> Option<&'static NodeType> {
    let loosely = || node_types().iter().copied().find(|known| known.name.eq_ignore_ascii_case(name));
    node_type(name).or_else(loosely)
}

fn names() -> String {
    let names: Vec<String> = node_types().iter().map(|known| format!("`{}`", known.name)).collect();
    names.join(", ")
}

fn list_types() -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for known in node_types() {
        writeln!(text, "{:<18} {}", known.name, known.doc())?;
    }
    Ok(text)
}

/// The attributes in groups, each with its default, range and unit, and what it does.
fn table(node_type: &'static NodeType, all: bool) -> Result<String, std::fmt::Error> {
    let shown = |row: &&Attribute| all || !node_type.keeps_from_view(row);
    let rows: Vec<&Attribute> = node_type.attributes().into_iter().filter(shown).collect();
    let left_out = node_type.attributes().len() - rows.len();
    let mut text = format!("{}: {}\n", node_type.name, node_type.doc());
    // A group may come both from the type itself and from one it inherits from.
    let mut seen = HashSet::new();
    let groups = rows.iter().map(|row| row.group).filter(|group| seen.insert(*group));
    for group in groups {
        writeln!(text, "\n{group}")?;
        for row in rows.iter().filter(|row| row.group == group) {
            let name = format!("{} ({})", row.name, row.short);
            let without_effect = match row.effect {
                Effect::Solved(_) => "",
                Effect::NotYet => " No effect yet.",
                Effect::Never => " No effect, in Maya neither.",
            };
            writeln!(text, "  {name:<36} {}\n      {}{without_effect}", facts(row), row.doc())?;
        }
    }
    if left_out > 0 {
        writeln!(text, "\n{left_out} more are hidden: `--all` shows them")?;
    }
    Ok(text)
}

/// Kind, default, range and unit in one line.
fn facts(row: &Attribute) -> String {
    let mut facts = vec![kind(row)];
    facts
        .extend(row.default.as_ref().and_then(|value| default(row, value)).map(|value| format!("= {value}")));
    facts.extend(range(row.range));
    facts.extend(Some(row.unit.to_owned()).filter(|unit| !unit.is_empty()));
    facts.join("  ")
}

fn kind(row: &Attribute) -> String {
    match row.kind {
        Kind::Bool => "bool".to_owned(),
        Kind::Int => "int".to_owned(),
        Kind::Float => "float".to_owned(),
        Kind::Texture => "texture".to_owned(),
        Kind::Vector(_) => "vector".to_owned(),
        Kind::Choice(_) => row.words().into_iter().map(|(_, word)| word).collect::<Vec<_>>().join(" | "),
        Kind::Text => "text".to_owned(),
        Kind::Ints => "list of int".to_owned(),
        Kind::Floats => "list of float".to_owned(),
        Kind::Vectors => "list of vector".to_owned(),
        Kind::Ramp => "ramp".to_owned(),
        Kind::ColorRamp => "ramp of colours".to_owned(),
        Kind::Components => "components".to_owned(),
        Kind::Node(_) => "node".to_owned(),
        Kind::Together(names) => names.join(", "),
        Kind::Plug(_) => "connected only".to_owned(),
    }
}

/// The default as a scene would write it; nothing for empty lists and texts.
fn default(row: &Attribute, value: &Value) -> Option<String> {
    match value {
        Value::Bool(on) => Some(on.to_string()),
        Value::Int(x) => Some(x.to_string()),
        Value::Float(x) if row.kind == Kind::Float => Some(figures::number(*x)),
        Value::Vector(v) => Some(format!("({})", v.map(figures::number).join(", "))),
        Value::Choice(choice) => {
            row.words().into_iter().find(|(index, _)| index == choice).map(|(_, word)| word)
        }
        Value::Text(text) => Some(format!("\"{text}\"")).filter(|_| !text.is_empty()),
        _ => None,
    }
}

/// The hard range, and what the slider shows of it.
fn range(Range { min, max, soft }: Range) -> Option<String> {
    let hard = match (min, max) {
        (Some(min), Some(max)) => Some(format!("{} to {}", figures::number(min), figures::number(max))),
        (Some(min), None) => Some(format!("from {}", figures::number(min))),
        (None, Some(max)) => Some(format!("up to {}", figures::number(max))),
        (None, None) => None,
    };
    let soft =
        soft.map(|(low, high)| format!("usually {} to {}", figures::number(low), figures::number(high)));
    hard.into_iter().chain(soft).reduce(|hard, soft| format!("{hard}, {soft}"))
}
