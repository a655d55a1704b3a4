//! `nucleus attrs`, `presets`, `checks` and `functions`: reference of the contents of a scene.

use std::collections::HashSet;
use std::fmt::Write;

use anyhow::{Result, bail};
use clap::Args;
use nucleus_graph::attributes::{Attribute, Effect, Kind, NodeType, Range, Value, node_type, node_types};
use nucleus_graph::checks::{Form, RENAMED};
use nucleus_graph::compile::{defaults_by_type, particle_variables};
use nucleus_graph::paint;
use nucleus_graph::scene::{Preset, presets};
use nucleus_maya::maya_preset;

use crate::diagnostics::unknown;
use crate::process::Outcome;
use crate::{figures, output};

/// Lists the attributes of a node type.
#[derive(Debug, Args)]
pub struct Attrs {
    /// The node type, such as `nCloth`; default: list all types.
    node: Option<String>,
    /// Show hidden attributes too: those inherited but not used, and internal ones.
    #[arg(long)]
    all: bool,
}

impl Attrs {
    /// Prints the table of a type, or the list of types.
    pub fn run(self) -> Result<Outcome> {
        let text = match &self.node {
            None => list_types()?,
            Some(name) => match find(name) {
                Some(node_type) => table(node_type, self.all)?,
                None => bail!(unknown("node type", name, node_types().iter().map(|known| known.name))),
            },
        };
        output::print(&text)?;
        Ok(Outcome::Success)
    }
}

/// The type of this name; upper and lower case are the same.
fn find(name: &str) -> Option<&'static NodeType> {
    let loosely = || node_types().iter().copied().find(|known| known.name.eq_ignore_ascii_case(name));
    node_type(name).or_else(loosely)
}

fn list_types() -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for known in node_types() {
        writeln!(text, "{:<18} {}", known.name, known.doc())?;
    }
    Ok(text)
}

/// The attributes in groups, each with default, range, unit and documentation.
fn table(node_type: &'static NodeType, all: bool) -> Result<String, std::fmt::Error> {
    let shown = |row: &&Attribute| all || !node_type.keeps_from_view(row);
    let rows: Vec<&Attribute> = node_type.attributes().into_iter().filter(shown).collect();
    let left_out = node_type.attributes().len() - rows.len();
    let mut text = format!("{}: {}\n", node_type.name, node_type.doc());
    // The type and its parent may both contribute to a group.
    let mut seen = HashSet::new();
    let groups = rows.iter().map(|row| row.group).filter(|group| seen.insert(*group));
    for group in groups {
        writeln!(text, "\n{group}")?;
        for row in rows.iter().filter(|row| row.group == group) {
            let name = format!("{} ({})", row.name, row.short);
            let without_effect = match row.effect {
                Effect::Solved(_) => String::new(),
                _ if node_type.has_no_use_for(row) => " No effect on such a node.".to_owned(),
                Effect::NotYet => " No effect yet.".to_owned(),
                Effect::Never => " No effect, in Maya neither.".to_owned(),
                Effect::Elsewhere(reason) | Effect::Wiring(reason) => format!(" No effect: {reason}."),
            };
            let facts = facts(node_type, row);
            writeln!(text, "  {name:<36} {facts}\n      {}{without_effect}", row.doc())?;
        }
    }
    if left_out > 0 {
        writeln!(text, "\n{left_out} more are hidden: `--all` shows them")?;
    }
    Ok(text)
}

/// Kind, defaults, range and unit in one line.
fn facts(node_type: &'static NodeType, row: &Attribute) -> String {
    let mut facts = vec![kind(row)];
    // A default that depends on the scene is in the documentation.
    let constant = row.default.as_ref().filter(|_| !row.doc().contains("Default: "));
    facts.extend(constant.and_then(|value| default(row, value)).map(|value| format!("= {value}")));
    let of_type = |(word, value): &(String, Value)| Some(format!("{} for {word}", default(row, value)?));
    let by_type: Vec<String> = defaults_by_type(node_type, row).iter().filter_map(of_type).collect();
    facts.extend(Some(format!("({})", by_type.join(", "))).filter(|_| !by_type.is_empty()));
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
        Kind::Texts => "text | list of text".to_owned(),
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

/// The default in scene syntax; `None` for empty lists and texts.
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

/// The hard range, and the range of the slider.
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

/// Lists the materials for `preset: "silk"`, or the attributes that one of them sets.
#[derive(Debug, Args)]
pub struct Presets {
    /// The material; default: list all.
    name: Option<String>,
    /// Print it as a preset of Maya: `nucleus presets silk --mel > silk.mel`.
    #[arg(long, requires = "name")]
    mel: bool,
}

impl Presets {
    /// Prints the list, or one preset.
    pub fn run(self) -> Result<Outcome> {
        let all = presets();
        let mut text = String::new();
        match self.name {
            None => {
                for Preset { name, doc, node_type, .. } in &all {
                    writeln!(text, "{name:<16} {:<8} {doc}", node_type.name)?;
                }
            }
            Some(name) => {
                let Some(preset) = all.iter().find(|preset| preset.name.eq_ignore_ascii_case(&name)) else {
                    bail!(unknown("preset", &name, all.iter().map(|preset| preset.name.as_str())));
                };
                if self.mel {
                    output::print(&maya_preset(preset))?;
                    return Ok(Outcome::Success);
                }
                writeln!(text, "{}: {}", preset.name, preset.doc)?;
                for line in preset.lines() {
                    writeln!(text, "  {line}")?;
                }
            }
        }
        output::print(&text)?;
        Ok(Outcome::Success)
    }
}

/// Lists the checks that a scene may state: `checks: [noPenetration, maxStretch(0.02)]`.
#[derive(Debug, Args)]
pub struct Checks {}

impl Checks {
    /// Prints the list.
    pub fn run(self) -> Result<Outcome> {
        let mut text = String::new();
        for form in Form::all() {
            writeln!(text, "{:<36} {}", form.usage(), form.doc)?;
        }
        let renamed: Vec<String> =
            RENAMED.iter().map(|(former, present)| format!("`{former}` is now `{present}`")).collect();
        writeln!(
            text,
            "\nA run that fails a check exits with 1. Former names still read: {}.",
            renamed.join(", ")
        )?;
        output::print(&text)?;
        Ok(Outcome::Success)
    }
}

/// Lists the variables, operators and functions of expressions: `thicknessPerVertex: expression("y > 1 ? 2 : 1")`.
#[derive(Debug, Args)]
pub struct Functions {}

impl Functions {
    /// Prints the list.
    pub fn run(self) -> Result<Outcome> {
        let mut text = String::new();
        let mut section = |title: &str, rows: &mut dyn Iterator<Item = (&str, &str)>| -> std::fmt::Result {
            writeln!(text, "{title}")?;
            for (usage, doc) in rows {
                writeln!(text, "  {usage:<24} {doc}")?;
            }
            Ok(())
        };
        section("Variables of a point", &mut paint::variables())?;
        section(
            "\nVariables of a particle, in `creationExpression` and `runtimeExpression`",
            &mut particle_variables(),
        )?;
        section("\nOperators, the weakest first", &mut paint::operators())?;
        section("\nFunctions", &mut paint::functions())?;
        output::print(&text)?;
        Ok(Outcome::Success)
    }
}
