//! `nucleus completions` and `man`: files for the shell and for `man`, made from the definitions of the commands.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use clap_complete::Shell;

use crate::output;
use crate::process::Outcome;

/// Prints completions for a shell.
///
/// bash: `nucleus completions bash > ~/.local/share/bash-completion/completions/nucleus`
/// zsh: `nucleus completions zsh > ~/.zfunc/_nucleus`, with `~/.zfunc` in `fpath`
/// fish: `nucleus completions fish > ~/.config/fish/completions/nucleus.fish`
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct Completions {
    /// The shell.
    shell: Shell,
}

impl Completions {
    /// Prints the script.
    pub fn run(self) -> Result<Outcome> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut crate::command(), "nucleus", &mut script);
        output::print(&String::from_utf8(script)?)?;
        Ok(Outcome::Success)
    }
}

/// Writes the manual pages `nucleus.1`, `nucleus-run.1` and so on into a folder.
#[derive(Debug, Args)]
pub struct Man {
    /// The folder; `~/.local/share/man/man1` is where `man` looks.
    folder: PathBuf,
}

impl Man {
    /// Writes the pages. Existing ones are replaced.
    pub fn run(self) -> Result<Outcome> {
        let folder = &self.folder;
        fs::create_dir_all(folder).with_context(|| format!("cannot make `{}`", folder.display()))?;
        clap_mangen::generate_to(crate::command(), folder)
            .with_context(|| format!("cannot write into `{}`", folder.display()))?;
        output::report(&format!("wrote the manual pages into `{}`\n", folder.display()));
        Ok(Outcome::Success)
    }
}
