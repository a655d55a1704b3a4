//! `nucleus fmt`: scenes in their canonical form.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::Args;
use nucleus_graph::scene::{format_scene, read_scene_text};

use crate::outcome::Outcome;
use crate::{diagnostics, output, scene_file};

/// Writes scenes in canonical form: nodes by name, attributes in the order of their tables, comments kept.
#[derive(Debug, Args)]
pub struct Fmt {
    /// The scenes (.ron).
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Changes nothing; exits with 1 if a scene is not in canonical form.
    #[arg(long)]
    check: bool,
    /// Prints instead of writing to the file.
    #[arg(long, conflicts_with = "check")]
    stdout: bool,
}

impl Fmt {
    /// Formats all scenes; one that has mistakes is left as it is.
    pub fn run(self) -> Result<Outcome> {
        let mut worst = Outcome::Fine;
        for path in &self.scenes {
            let outcome = self.format(path)?;
            if matches!((worst, outcome), (_, Outcome::InvalidInput) | (Outcome::Fine, _)) {
                worst = outcome;
            }
        }
        Ok(worst)
    }

    fn format(&self, path: &Path) -> Result<Outcome> {
        let text = scene_file::text(path)?;
        let scene = match read_scene_text(&text, path) {
            Ok((scene, _)) => scene,
            Err(mistakes) => {
                diagnostics::print(&mistakes, &text)?;
                return Ok(Outcome::InvalidInput);
            }
        };
        let formatted = format_scene(&scene, &text);
        // What is written has to say the same, whatever the writer thinks.
        let again = read_scene_text(&formatted, path).map(|(scene, _)| scene);
        ensure!(
            again.is_ok_and(|again| again == scene),
            "`{}` would change its meaning; it is left as it is",
            path.display()
        );
        if self.stdout {
            output::print(&formatted)?;
        } else if formatted == text {
            return Ok(Outcome::Fine);
        } else if self.check {
            output::print(&format!("`{}` is not in canonical form\n", path.display()))?;
            return Ok(Outcome::Trouble);
        } else {
            fs::write(path, formatted).with_context(|| format!("cannot write `{}`", path.display()))?;
        }
        Ok(Outcome::Fine)
    }
}
