//! A cache given on the command line.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use nucleus_cache::{OpenError, Playback};

use crate::output::say;

/// Opens a cache; the error names the file.
pub fn open(path: &Path) -> Result<Playback> {
    Playback::open(path).map_err(|error| match error {
        OpenError::Io { .. } if nucleus_cache::part_path(path).exists() => {
            let part = nucleus_cache::part_path(path);
            let part = part.display();
            anyhow!(
                "there is no `{}` yet; its run is going on or was killed: `nucleus play {part}` shows how far it \
                 came, `nucleus recover {part}` makes it whole",
                path.display()
            )
        }
        OpenError::Io { .. } | OpenError::Folder { .. } => anyhow!(error),
        other => anyhow!(other).context(format!("cannot open `{}`", path.display())),
    })
}

/// Opens a cache to look at it: what is lost is said on standard error.
pub fn open_and_warn(path: &Path) -> Result<Playback> {
    let cache = open(path)?;
    if !cache.corruption().is_intact() {
        say!("warning: `{}`: {}", path.display(), cache.corruption());
    }
    Ok(cache)
}

/// The moment that shows the end of `frame`, or the last one.
pub fn moment(cache: &Playback, frame: Option<i32>) -> Result<usize> {
    let moments = cache.time_samples();
    let (first, last) = moments.first().zip(moments.last()).context("the cache holds no frame")?;
    match frame {
        None => Ok(moments.len() - 1),
        Some(frame) => cache.end_of(frame).with_context(|| {
            format!("there is no frame {frame}; the cache has {} to {}", first.frame, last.frame)
        }),
    }
}

/// Whether the file is to be read as a cache and not as a scene: by its first bytes, or else by its name.
pub fn is_cache(path: &Path) -> bool {
    use std::io::Read;
    let mut head = [0; 5];
    // What a killed run has left has more behind its name.
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let named = [".mcap", ".mcap.part", ".mcap.resuming"].iter().any(|end| name.ends_with(end));
    // A pipe would be waited for.
    if named || !path.is_file() {
        return named;
    }
    let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && head == *b"\x89MCAP"
}
