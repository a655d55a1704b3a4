//! `nucleus play`: a run in the browser.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::Result;
use clap::Args;

use super::run::Run;
use crate::outcome::Outcome;
use crate::{cache_file, output};

/// Plays a cache in the browser, until Ctrl-C. A scene is run first.
#[derive(Debug, Args)]
pub struct Play {
    /// The cache (.mcap) or the scene (.ron).
    file: PathBuf,
    /// Another cache (.mcap) to compare it with.
    #[arg(long, value_name = "CACHE")]
    with: Option<PathBuf>,
    /// The port to serve on; any free one if it is 0.
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Only print the address.
    #[arg(long)]
    no_open: bool,
    /// Replace the cache of a scene that was run before.
    #[arg(long)]
    force: bool,
}

impl Play {
    /// Serves until the process is ended.
    pub fn run(self) -> Result<Outcome> {
        let cache = match cache_file::is_cache(&self.file) {
            true => self.file,
            false => {
                let run = Run::of(self.file, self.force);
                let cache = run.out()?;
                match run.run()? {
                    ended @ (Outcome::InvalidInput | Outcome::Interrupted) => return Ok(ended),
                    // What went wrong is best seen.
                    Outcome::Fine | Outcome::Trouble => cache,
                }
            }
        };
        // A file that cannot be shown is better refused here than by the page.
        drop(cache_file::open_and_warn(&cache)?);
        let player = match &self.with {
            None => nucleus_view::serve(&cache, self.port)?,
            Some(other) => {
                drop(cache_file::open_and_warn(other)?);
                nucleus_view::serve_both(&cache, other, self.port)?
            }
        };
        output::tell(&format!("playing `{}` at {} (Ctrl-C ends it)\n", cache.display(), player.url()));
        if !self.no_open {
            open_browser(&player.url());
        }
        player.wait();
        Ok(Outcome::Fine)
    }
}

/// Shows an address in the browser, if there is one; if not, the address has been printed.
fn open_browser(url: &str) {
    let opener = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let quiet = Command::new(opener)
        .arg(url)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    drop(quiet);
}
