//! One file per subcommand.

mod attrs;
mod info;
mod render;

use anyhow::Result;
use clap::Subcommand;

use crate::outcome::Outcome;

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    Info(info::Info),
    Render(render::Render),
    Attrs(attrs::Attrs),
}

impl Command {
    /// Does it.
    pub fn run(self) -> Result<Outcome> {
        match self {
            Self::Info(info) => info.run(),
            Self::Render(render) => render.run(),
            Self::Attrs(attrs) => attrs.run(),
        }
    }
}
