//! Signals: the first Ctrl-C asks the run to end where it is, the second ends the program at once; a limit on the size of
//! files is an error like a full disk.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};

use crate::outcome;

static ASKED: AtomicBool = AtomicBool::new(false);
static RUNNING: AtomicBool = AtomicBool::new(false);

/// Begins to listen. SIGTERM, SIGHUP and SIGQUIT count as Ctrl-C, so that a farm can end a run in order.
pub fn listen() -> Result<()> {
    RUNNING.store(true, Ordering::SeqCst);
    on_signal(|| {
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

#[cfg(unix)]
fn on_signal(handle: impl Fn() + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    use signal_hook::iterator::Signals;

    let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP, SIGQUIT])?;
    let listener = std::thread::Builder::new().name("signals".to_owned());
    listener.spawn(move || signals.forever().for_each(|_| handle())).map(drop)
}

#[cfg(not(unix))]
fn on_signal(handle: impl Fn() + Send + 'static) -> io::Result<()> {
    ctrlc::set_handler(handle).map_err(io::Error::other)
}

/// Has a write past the limit on the size of files (`ulimit -f`) fail, instead of killing the program by SIGXFSZ.
pub fn heed_file_size_limit() {
    #[cfg(unix)]
    {
        use std::sync::Arc;
        // The handler only has to be there: the write then fails with EFBIG.
        let handled = Arc::new(AtomicBool::new(false));
        drop(signal_hook::flag::register(signal_hook::consts::SIGXFSZ, handled));
    }
}
