//! The process: exit codes and signals.
//!
//! The first Ctrl-C asks a run to close its cache and end. The second ends the process at once.

use std::ffi::OsString;
use std::io;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};

/// Shown at the end of `nucleus --help`.
pub const EXIT_CODES: &str = "\
Exit codes: 0 success; 1 the command ran and found a problem (a check failed, contact left pairs unresolved, a disk was \
full, a cache has lost frames); 2 the command could not start; 130 the command was interrupted (Ctrl-C) and has closed its \
cache.";

/// The exit code of a command that could not start.
pub const COULD_NOT_START: u8 = 2;

/// The exit code of an interrupted command: 128 + SIGINT, as shells report it.
const INTERRUPTED: u8 = 130;

/// How a command that started has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    Success,
    /// The command ran and found a problem.
    Problem,
    /// The scene has errors, which have been reported.
    InvalidInput,
    /// The command was interrupted and has closed its files.
    Interrupted,
    /// Another process does what the command was asked to do.
    Busy,
}

impl Outcome {
    /// The exit code of a command that ends so.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Success => 0,
            Self::Problem => 1,
            Self::InvalidInput => COULD_NOT_START,
            Self::Interrupted => INTERRUPTED,
            Self::Busy => nucleus_wedge::BUSY as u8,
        }
    }
}

/// The words that start this command in another process.
static COMMAND: OnceLock<Vec<OsString>> = OnceLock::new();

/// Sets the words that start this command in another process, where they are not the path of this program: the runs of a
/// wedge are started so. The first call counts.
pub fn set_command(command: Vec<OsString>) {
    let _ = COMMAND.set(command);
}

/// The words that start this command in another process.
pub fn command() -> Result<Vec<OsString>> {
    match COMMAND.get() {
        Some(command) => Ok(command.clone()),
        None => {
            let program = std::env::current_exe().context("the path of this program is unknown")?;
            Ok(vec![program.into_os_string()])
        }
    }
}

static IS_INTERRUPTED: AtomicBool = AtomicBool::new(false);
static IS_LISTENING: AtomicBool = AtomicBool::new(false);
static HAS_OPEN_FILES: AtomicBool = AtomicBool::new(false);
/// More files are written after those that [`files_are_closed`] tells of.
static HAS_MORE_FILES: AtomicBool = AtomicBool::new(false);

/// Starts to listen for signals. SIGTERM, SIGHUP and SIGQUIT count as Ctrl-C, so that a render farm can end a run cleanly.
pub fn listen_for_signals() -> Result<()> {
    HAS_OPEN_FILES.store(true, Ordering::SeqCst);
    if IS_LISTENING.swap(true, Ordering::SeqCst) {
        return Ok(());
    }
    on_signal(|| {
        if IS_INTERRUPTED.swap(true, Ordering::SeqCst) || !HAS_OPEN_FILES.load(Ordering::SeqCst) {
            std::process::exit(INTERRUPTED.into());
        }
    })
    .context("cannot listen for Ctrl-C")
}

/// Asks the command to end, as a first Ctrl-C does.
pub fn interrupt() {
    IS_INTERRUPTED.store(true, Ordering::SeqCst);
    if !HAS_OPEN_FILES.load(Ordering::SeqCst) {
        std::process::exit(INTERRUPTED.into());
    }
}

/// All files are closed: from now on a single Ctrl-C ends the process, unless more files are to be written.
pub fn files_are_closed() {
    HAS_OPEN_FILES.store(HAS_MORE_FILES.load(Ordering::SeqCst), Ordering::SeqCst);
}

/// A run has a result to write after its cache is closed. A signal in between must not lose it.
pub fn more_files_follow() {
    HAS_MORE_FILES.store(true, Ordering::SeqCst);
}

/// The command has no files that it must close: it ends at once when it is asked to, or has been already.
pub fn end_at_once_when_asked() {
    HAS_OPEN_FILES.store(false, Ordering::SeqCst);
    if is_interrupted() {
        std::process::exit(INTERRUPTED.into());
    }
}

/// Whether a signal has asked the command to end.
pub fn is_interrupted() -> bool {
    IS_INTERRUPTED.load(Ordering::SeqCst)
}

#[cfg(unix)]
fn on_signal(handle: impl Fn() + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    use signal_hook::iterator::Signals;

    // `nohup` starts a command with SIGHUP ignored, and it must stay so.
    let hangup = (!is_ignored(SIGHUP)).then_some(SIGHUP);
    let mut signals = Signals::new([SIGINT, SIGTERM, SIGQUIT].into_iter().chain(hangup))?;
    let listener = std::thread::Builder::new().name("signals".to_owned());
    listener.spawn(move || signals.forever().for_each(|_| handle())).map(drop)
}

/// Whether the process was started with a signal ignored; unknown, and taken as no, where there is no `/proc`.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}

#[cfg(not(unix))]
fn on_signal(handle: impl Fn() + Send + 'static) -> io::Result<()> {
    ctrlc::set_handler(handle).map_err(io::Error::other)
}

/// Turns a write past the file size limit (`ulimit -f`) into an error. By default SIGXFSZ would kill the process.
pub fn report_file_size_limit_as_error() {
    #[cfg(unix)]
    {
        use std::sync::Arc;
        // An installed handler is enough: the write then fails with EFBIG.
        let handled = Arc::new(AtomicBool::new(false));
        drop(signal_hook::flag::register(signal_hook::consts::SIGXFSZ, handled));
    }
}
