//! `nucleus play`: serves the player and a cache to the browser.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Result, ensure};
use clap::Args;
use nucleus_cache::shell_word;
use nucleus_view::LiveRun;

use super::run::Run;
use super::watch;
use crate::process::Outcome;
use crate::{files, output};

/// Plays a cache in the browser until Ctrl-C. Given a scene, runs it first.
#[derive(Debug, Args)]
pub struct Play {
    /// The cache (.mcap) or the scene (.ron).
    file: PathBuf,
    /// A second cache (.mcap) to compare with.
    #[arg(long, value_name = "CACHE")]
    compare: Option<PathBuf>,
    /// The port of the server; 0: any free port.
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Print the address without opening the browser.
    #[arg(long)]
    no_open: bool,
    /// Replace the existing cache of a scene.
    #[arg(long)]
    force: bool,
    /// Run the scene again whenever its file changes, and show frames as they are solved.
    #[arg(long, conflicts_with = "compare")]
    watch: bool,
}

impl Play {
    /// Serves until the process ends.
    pub fn run(self) -> Result<Outcome> {
        if self.watch {
            return self.watch();
        }
        let cache = match files::is_cache(&self.file) {
            true => self.file,
            false => {
                let run = Run::of(self.file, self.force);
                let cache = run.out()?;
                ensure!(
                    self.force || !cache.exists(),
                    "`{}` exists: `nucleus play {}` plays it, `--force` runs the scene again",
                    cache.display(),
                    shell_word(&cache)
                );
                match run.run()? {
                    ended @ (Outcome::InvalidInput | Outcome::Interrupted | Outcome::Busy) => {
                        return Ok(ended);
                    }
                    // A problem is easiest to diagnose in the player.
                    Outcome::Success | Outcome::Problem => cache,
                }
            }
        };
        // Refuses an unreadable file here, before the page does.
        drop(files::open_cache_and_warn(&cache)?);
        let player = match &self.compare {
            None => nucleus_view::serve(&cache, self.port)?,
            Some(other) => {
                drop(files::open_cache_and_warn(other)?);
                nucleus_view::serve_both(&cache, other, self.port)?
            }
        };
        output::print(&format!("playing `{}` at {} (end with Ctrl-C)\n", cache.display(), player.url()))?;
        if !self.no_open {
            open_browser(&player.url());
        }
        player.wait();
        Ok(Outcome::Success)
    }

    /// Solves the scene again and again, until the process ends.
    fn watch(&self) -> Result<Outcome> {
        let scene = &self.file;
        ensure!(!files::is_cache(scene), "`--watch` takes a scene, and `{}` is a cache", scene.display());
        let cache = Run::of(scene.clone(), true).out()?;
        ensure!(self.force || !cache.exists(), "`{}` exists; `--force` replaces it", cache.display());
        let run = LiveRun::new(&cache);
        let player = nucleus_view::serve_live(&run, self.port)?;
        output::print(&format!("watching `{}` at {} (end with Ctrl-C)\n", scene.display(), player.url()))?;
        if !self.no_open {
            open_browser(&player.url());
        }
        loop {
            watch::solve_until_changed(scene, &cache, &run)?;
        }
    }
}

/// Opens an address in the browser. Failure is ignored, because the address has been printed.
fn open_browser(url: &str) {
    let opener = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let child = Command::new(opener)
        .arg(url)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    drop(child);
}
