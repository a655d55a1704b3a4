//! `nucleus check`: whether a scene can run.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use crate::outcome::Outcome;
use crate::{diagnostics, output, scene_file};

/// Reads and compiles a scene, and tells everything there is to say about it.
#[derive(Debug, Args)]
pub struct Check {
    /// The scene (.ron).
    scene: PathBuf,
}

impl Check {
    /// Prints mistakes and warnings. Warnings alone are fine.
    pub fn run(self) -> Result<Outcome> {
        let file = scene_file::open(&self.scene, None)?;
        let count = diagnostics::count(&file.diagnostics);
        match file.told()? {
            None => Ok(Outcome::InvalidInput),
            Some(_) => {
                output::print(&format!("`{}` can run: {count}\n", self.scene.display()))?;
                Ok(Outcome::Fine)
            }
        }
    }
}
