//! `nucleus graph`: the nodes of a scene and their connections, to be drawn.

use std::path::PathBuf;

use anyhow::Result;
use clap::{Args, ValueEnum};
use nucleus_graph::scene::read_scene_text;

use crate::outcome::Outcome;
use crate::{diagnostics, output, scene_file};

/// Writes the nodes of a scene and all connections, those that the short form makes too, as a diagram.
#[derive(Debug, Args)]
pub struct Graph {
    /// The scene (.ron).
    scene: PathBuf,
    /// The language of the diagram.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Languages of diagrams.
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
enum Format {
    /// For Graphviz: `nucleus graph scene.ron | dot -Tsvg > scene.svg`.
    #[default]
    Dot,
    /// For Markdown pages.
    Mermaid,
}

impl Graph {
    /// Prints the diagram.
    pub fn run(self) -> Result<Outcome> {
        let text = scene_file::text(&self.scene)?;
        let scene = match read_scene_text(&text, &self.scene) {
            Ok((scene, _)) => scene,
            Err(mistakes) => {
                diagnostics::print(&mistakes, &text)?;
                return Ok(Outcome::InvalidInput);
            }
        };
        output::print(&match self.format {
            Format::Dot => scene.graph.dot(),
            Format::Mermaid => scene.graph.mermaid(),
        })?;
        Ok(Outcome::Fine)
    }
}
