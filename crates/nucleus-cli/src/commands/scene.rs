//! `nucleus check`, `fmt` and `graph`: scene files, without a simulation.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::{Args, ValueEnum};
use nucleus_cache::atomic_file;
use nucleus_graph::scene::{Scene, format_scene, read_scene_text};

use crate::process::Outcome;
use crate::{budget_hints, diagnostics, files, output};

/// Reads and compiles a scene and prints all its errors and warnings, and hints at cloth whose budget is too small.
#[derive(Debug, Args)]
pub struct Check {
    /// The scene (.ron).
    scene: PathBuf,
}

impl Check {
    /// Prints errors and warnings. Warnings alone are a success.
    pub fn run(self) -> Result<Outcome> {
        let file = files::open_scene(&self.scene, None)?.with_first_frame();
        let count = diagnostics::count(&file.diagnostics);
        match file.report()? {
            None => Ok(Outcome::InvalidInput),
            Some((_, program, _)) => {
                output::report(&format!("`{}` can run: {count}\n", self.scene.display()));
                budget_hints::budgets(&program).iter().for_each(|line| output::report(&format!("{line}\n")));
                budget_hints::hints(&program).iter().for_each(|hint| output::report(&format!("{hint}\n")));
                budget_hints::local_forces(&program)
                    .iter()
                    .for_each(|hint| output::report(&format!("{hint}\n")));
                budget_hints::liquid_steps(&program)
                    .iter()
                    .for_each(|hint| output::report(&format!("{hint}\n")));
                Ok(Outcome::Success)
            }
        }
    }
}

/// Reads a scene without its files. Returns its text with it, or `None` if there are errors, which are printed.
fn read(path: &Path) -> Result<Option<(Scene, String)>> {
    let text = files::scene_text(path)?;
    match read_scene_text(&text, path) {
        Ok((scene, _)) => Ok(Some((scene, text))),
        Err(errors) => {
            diagnostics::print(&errors, &text)?;
            Ok(None)
        }
    }
}

/// Writes scenes in canonical form: nodes by name, attributes in the order of their tables, comments kept.
#[derive(Debug, Args)]
pub struct Fmt {
    /// The scenes (.ron).
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Change nothing; exit with 1 if a scene is not in canonical form.
    #[arg(long)]
    check: bool,
    /// Print instead of writing to the file.
    #[arg(long, conflicts_with = "check")]
    stdout: bool,
}

impl Fmt {
    /// Formats all scenes. A scene with errors is left unchanged.
    pub fn run(self) -> Result<Outcome> {
        let mut worst = Outcome::Success;
        for path in &self.scenes {
            let outcome = self.format(path)?;
            if matches!((worst, outcome), (_, Outcome::InvalidInput) | (Outcome::Success, _)) {
                worst = outcome;
            }
        }
        Ok(worst)
    }

    fn format(&self, path: &Path) -> Result<Outcome> {
        let Some((scene, text)) = read(path)? else { return Ok(Outcome::InvalidInput) };
        let formatted = format_scene(&scene, &text);
        // Reading the formatted text back must give an equal scene.
        let again = read_scene_text(&formatted, path).map(|(scene, _)| scene);
        ensure!(
            again.is_ok_and(|again| again == scene),
            "formatting `{}` would change its meaning; it is left unchanged",
            path.display()
        );
        if self.stdout {
            output::print(&formatted)?;
        } else if formatted == text {
            return Ok(Outcome::Success);
        } else if self.check {
            output::print(&format!("`{}` is not in canonical form\n", path.display()))?;
            return Ok(Outcome::Problem);
        } else {
            // A link stays a link: the file that it leads to is replaced.
            let file = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
            atomic_file::write(&file, formatted.as_bytes())
                .with_context(|| format!("cannot write `{}`", path.display()))?;
        }
        Ok(Outcome::Success)
    }
}

/// Prints the nodes of a scene and all their connections as a diagram, including those that the short form implies.
#[derive(Debug, Args)]
pub struct Graph {
    /// The scene (.ron).
    scene: PathBuf,
    /// The language of the diagram.
    #[arg(long, value_enum, default_value_t)]
    format: DiagramFormat,
}

/// Languages of diagrams.
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
enum DiagramFormat {
    /// For Graphviz: `nucleus graph scene.ron | dot -Tsvg > scene.svg`.
    #[default]
    Dot,
    /// For Markdown pages.
    Mermaid,
}

impl Graph {
    /// Prints the diagram.
    pub fn run(self) -> Result<Outcome> {
        let Some((scene, _)) = read(&self.scene)? else { return Ok(Outcome::InvalidInput) };
        output::print(&match self.format {
            DiagramFormat::Dot => scene.graph.dot(),
            DiagramFormat::Mermaid => scene.graph.mermaid(),
        })?;
        Ok(Outcome::Success)
    }
}
