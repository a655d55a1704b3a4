//! `nucleus new`: a scene to begin from.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};

use crate::outcome::Outcome;
use crate::output;

/// Writes a small scene that runs, to begin from.
#[derive(Debug, Args)]
pub struct New {
    /// The file to write (.ron); nothing that exists is replaced.
    scene: PathBuf,
    /// What it shows.
    #[arg(long, value_enum, default_value_t)]
    template: Template,
}

/// Scenes to begin from.
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
enum Template {
    /// A cloth that falls on a sphere.
    #[default]
    Drape,
    /// A curtain that hangs by its corners in a wind.
    Hang,
}

impl Template {
    fn text(self) -> &'static str {
        match self {
            Self::Drape => include_str!("new/drape.ron"),
            Self::Hang => include_str!("new/hang.ron"),
        }
    }
}

impl New {
    /// Writes the file and says how to go on.
    pub fn run(self) -> Result<Outcome> {
        let path = self.scene.display();
        let mut file = match OpenOptions::new().write(true).create_new(true).open(&self.scene) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                bail!("`{path}` is there already; give another name")
            }
            Err(error) => return Err(error).with_context(|| format!("cannot write `{path}`")),
        };
        file.write_all(self.template.text().as_bytes()).with_context(|| format!("cannot write `{path}`"))?;
        output::tell(&format!("wrote `{path}`; run it with `nucleus run {path}`\n"));
        Ok(Outcome::Fine)
    }
}
