//! Standard output and standard error, which may be closed or full at any time.
//!
//! A command whose result is text [`print()`]s it and ends if that fails. A command whose result is a file
//! [`report`]s: it runs to its end even if nobody reads the report, and [`report_error`] returns the failure.

use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::sync::OnceLock;

use anyhow::Result;
use clap::ColorChoice;

/// Whether `--quiet` was given, and the value of `--color`.
static STYLE: OnceLock<(bool, ColorChoice)> = OnceLock::new();

/// Sets how much is printed, and when in colour. Called before anything is printed.
pub fn set_style(quiet: bool, color: ColorChoice) {
    // There is one command per process, so the first value is the only one.
    let _ = STYLE.set((quiet, color));
}

/// Whether only errors, warnings and results are printed.
pub fn is_quiet() -> bool {
    STYLE.get().is_some_and(|(quiet, _)| *quiet)
}

/// When messages are coloured.
pub fn color() -> ColorChoice {
    STYLE.get().map_or(ColorChoice::Auto, |(_, color)| *color)
}

/// The first error of a [`report`].
static REPORT_ERROR: OnceLock<io::Error> = OnceLock::new();

/// Prints a text that is the result of the command.
///
/// # Errors
/// If standard output cannot be written; see [`is_print_error`].
pub fn print(text: &str) -> Result<()> {
    write(text).map_err(|error| PrintError(error).into())
}

/// Prints one JSON value on one line.
///
/// # Errors
/// As [`print()`].
pub fn print_json(value: &serde_json::Value) -> Result<()> {
    print(&format!("{value}\n"))
}

/// Prints a text that accompanies the result, unless [`is_quiet`]. After the first failure nothing more is printed.
pub fn report(text: &str) {
    if !is_quiet() {
        report_always(text);
    }
}

/// As [`report`], also with `--quiet`: for problems.
pub fn report_always(text: &str) {
    if REPORT_ERROR.get().is_none() {
        keep_error(write(text));
    }
}

/// As [`report`], for one JSON value on one line.
pub fn report_json(value: &serde_json::Value) {
    report_always(&format!("{value}\n"));
}

fn keep_error(written: io::Result<()>) {
    if let Err(error) = written {
        REPORT_ERROR.get_or_init(|| error);
    }
}

/// The first error of a [`report`], if there is one.
pub fn report_error() -> Option<&'static io::Error> {
    REPORT_ERROR.get()
}

/// Handles the outcome of a [`write()`]: as [`print()`] if the text is the result of the command, else as [`report`].
///
/// # Errors
/// As [`print()`].
pub fn check(written: io::Result<()>, is_result: bool) -> Result<()> {
    match is_result {
        true => written.map_err(|error| PrintError(error).into()),
        false => {
            keep_error(written);
            Ok(())
        }
    }
}

/// Writes a text to standard output.
pub fn write(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Writes a line to standard error if that is possible.
pub fn write_error(text: fmt::Arguments) {
    // There is no other stream on which to report this failure.
    let _ = writeln!(io::stderr(), "{text}");
}

/// As `eprintln!`, but without a panic where standard error is closed or full.
macro_rules! say {
    ($($text:tt)*) => { $crate::output::write_error(format_args!($($text)*)) };
}
pub(crate) use say;

/// The result of a command could not be printed.
#[derive(Debug)]
struct PrintError(io::Error);

impl fmt::Display for PrintError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("standard output cannot be written to")
    }
}

impl std::error::Error for PrintError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.0)
    }
}

/// Whether an error is that of [`print()`].
pub fn is_print_error(error: &anyhow::Error) -> bool {
    error.is::<PrintError>()
}

/// Whether the reader has closed the pipe.
pub fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.downcast_ref::<PrintError>().is_some_and(|PrintError(error)| error.kind() == ErrorKind::BrokenPipe)
}
