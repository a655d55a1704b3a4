//! A scene that is solved again whenever it changes: which run is shown, and whether it is still being solved.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use nucleus_cache::part_path;

/// The state of a run that is watched. Clones share it: the solving side changes it, the server sends it.
#[derive(Debug, Clone)]
pub struct LiveRun(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    /// The cache, under its final name.
    cache: PathBuf,
    /// Counts the runs.
    run: u32,
    solving: bool,
    /// Errors of the scene or the run; empty if there are none.
    message: String,
}

impl LiveRun {
    /// No run yet. `cache` is the file that each run writes.
    pub fn new(cache: impl Into<PathBuf>) -> Self {
        let state = State { cache: cache.into(), run: 0, solving: false, message: String::new() };
        Self(Arc::new(Mutex::new(state)))
    }

    /// A run begins. Until it ends its growing file is shown.
    pub fn begin(&self) {
        let mut state = self.state();
        state.run += 1;
        state.solving = true;
        state.message.clear();
    }

    /// The run has ended, with this message if it failed.
    pub fn end(&self, message: impl Into<String>) {
        let mut state = self.state();
        state.solving = false;
        state.message = message.into();
    }

    /// The file to show: the growing one while there is one. `None` if another run is meant, whose file is replaced.
    pub(super) fn path(&self, run: Option<u32>) -> Option<PathBuf> {
        let state = self.state();
        if run.is_some_and(|run| run != state.run) {
            return None;
        }
        let part = part_path(&state.cache);
        Some(if state.solving && is_file(&part) { part } else { state.cache.clone() })
    }

    pub(super) fn to_json(&self) -> String {
        let State { run, solving, ref message, .. } = *self.state();
        format!("{{\"run\":{run},\"solving\":{solving},\"message\":\"{}\"}}", escaped(message))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn is_file(path: &Path) -> bool {
    path.metadata().is_ok_and(|found| found.is_file())
}

/// A text inside a string of JSON.
fn escaped(text: &str) -> String {
    text.chars().fold(String::new(), |mut out, c| {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\u{:04x}", u32::from(c));
            }
            c => out.push(c),
        }
        out
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_growing_file_is_shown_while_a_run_is_solved() {
        let folder = tempfile::tempdir().unwrap();
        let cache = folder.path().join("a.mcap");
        let run = LiveRun::new(&cache);
        run.begin();
        assert_eq!(run.path(None).as_ref(), Some(&cache), "it has no file yet");
        std::fs::write(part_path(&cache), "").unwrap();
        assert_eq!(run.path(None), Some(part_path(&cache)));
        run.end("a \"bad\"\nscene");
        assert_eq!(run.path(Some(1)), Some(cache));
        assert_eq!(run.path(Some(2)), None);
        assert_eq!(run.to_json(), r#"{"run":1,"solving":false,"message":"a \"bad\"\u000ascene"}"#);
    }
}
