//! `nucleus presets`: materials to begin from.

use std::fmt::Write;

use anyhow::{Result, bail};
use clap::Args;
use nucleus_graph::scene::{Preset, presets};

use crate::outcome::Outcome;
use crate::output;

/// Lists the materials that a node can take with `preset: "silk"`, or what one of them sets.
#[derive(Debug, Args)]
pub struct Presets {
    /// One of them.
    name: Option<String>,
}

impl Presets {
    /// Prints the list.
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
                    let names: Vec<String> = all.iter().map(|preset| format!("`{}`", preset.name)).collect();
                    bail!("there is no preset `{name}`; there are {}", names.join(", "));
                };
                writeln!(text, "{}: {}", preset.name, preset.doc)?;
                for line in preset.lines() {
                    writeln!(text, "  {line}")?;
                }
            }
        }
        output::print(&text)?;
        Ok(Outcome::Fine)
    }
}
