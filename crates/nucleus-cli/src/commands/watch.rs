//! `nucleus play --watch`: a scene that is run again when its file changes. Each run is a process of its own, so that it
//! can be ended at any time.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime};

use anyhow::{Context, Result};
use nucleus_view::LiveRun;

use crate::output::say;

/// Time between two looks at the file and the run.
const POLL: Duration = Duration::from_millis(150);

/// The version of a file: time of the last change, and length in bytes.
type Stamp = (SystemTime, u64);

/// Runs the scene into `cache`, ends the run if the file changes, and returns when it has changed.
pub fn solve_until_changed(scene: &Path, cache: &Path, run: &LiveRun) -> Result<()> {
    let seen = stamp(scene);
    // An editor that replaces the file leaves none for a moment.
    let has_changed = || stamp(scene).is_some_and(|now| Some(now) != seen);
    run.begin();
    let mut solver = Solving::start(scene, cache)?;
    let is_done = loop {
        if let Some(is_success) = solver.poll()? {
            break Some(is_success);
        }
        if has_changed() {
            break None;
        }
        thread::sleep(POLL);
    };
    let said = solver.end();
    match is_done {
        Some(true) => run.end(""),
        Some(false) => {
            say!("{said}");
            run.end(said);
        }
        None => return Ok(()),
    }
    while !has_changed() {
        thread::sleep(POLL);
    }
    Ok(())
}

fn stamp(path: &Path) -> Option<Stamp> {
    let found = fs::metadata(path).ok()?;
    Some((found.modified().ok()?, found.len()))
}

/// A run in progress, and its output so far.
struct Solving {
    process: Child,
    printed: Vec<JoinHandle<String>>,
}

impl Solving {
    fn start(scene: &Path, cache: &Path) -> Result<Self> {
        let program = std::env::current_exe().context("the program does not know its own file")?;
        let mut command = Command::new(program);
        command.arg("run").arg(scene).args(["--force", "--quiet", "--out"]).arg(cache);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut process = command.spawn().context("cannot start the run")?;
        let mut printed = Vec::new();
        printed.extend(process.stderr.take().map(collect));
        printed.extend(process.stdout.take().map(collect));
        Ok(Self { process, printed })
    }

    /// Whether the run has succeeded; `None` while it runs.
    fn poll(&mut self) -> Result<Option<bool>> {
        Ok(self.process.try_wait()?.map(|status| status.success()))
    }

    /// Ends the run, and returns its output.
    fn end(mut self) -> String {
        // A run that has ended already cannot be killed.
        let _ = self.process.kill();
        let _ = self.process.wait();
        let texts = self.printed.into_iter().map(|text| text.join().unwrap_or_default());
        texts.collect::<String>().trim().to_owned()
    }
}

fn collect(mut from: impl Read + Send + 'static) -> JoinHandle<String> {
    thread::spawn(move || {
        let mut text = Vec::new();
        // The output before an error is shown too.
        let _ = from.read_to_end(&mut text);
        String::from_utf8_lossy(&text).into_owned()
    })
}
