//! Ctrl-C: the first asks the run to end with the frame it is in, the second ends it at once.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};

use crate::outcome;

static ASKED: AtomicBool = AtomicBool::new(false);
static RUNNING: AtomicBool = AtomicBool::new(false);

/// Begins to listen. SIGTERM and SIGHUP count as Ctrl-C, so that a farm can end a run in order.
pub fn listen() -> Result<()> {
    RUNNING.store(true, Ordering::SeqCst);
    ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::SeqCst) || !RUNNING.load(Ordering::SeqCst) {
            std::process::exit(outcome::INTERRUPTED.into());
        }
    })
    .context("cannot listen for Ctrl-C")
}

/// From now on there is nothing to be closed in order: the next Ctrl-C ends the program.
pub fn run_is_over() {
    RUNNING.store(false, Ordering::SeqCst);
}

/// Whether the run has been asked to end.
pub fn asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}
