//! Standard output and standard error, which may be closed or full at any time.
//!
//! A command whose result is a text [`print()`]s it, and ends where that fails. A command whose result is a file
//! [`tell`]s of it: it goes on to its end whether anybody reads that or not, and [`lost`] says so then.

use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::sync::OnceLock;

use anyhow::Result;

/// What the system said when a text was not written for the first time.
static LOST: OnceLock<io::Error> = OnceLock::new();

/// Prints a text.
///
/// # Errors
/// When nobody takes it; see [`is_lost`].
pub fn print(text: &str) -> Result<()> {
    write(text).map_err(|error| NotPrinted(error).into())
}

/// Prints one JSON value on a line of its own.
///
/// # Errors
/// As [`print()`].
pub fn print_json(value: &serde_json::Value) -> Result<()> {
    print(&format!("{value}\n"))
}

/// Prints a text, if anybody takes it. After the first that nobody took no other is tried.
pub fn tell(text: &str) {
    if LOST.get().is_none() {
        told(write(text));
    }
}

/// Keeps in mind whether something was told.
fn told(written: io::Result<()>) {
    if let Err(error) = written {
        LOST.get_or_init(|| error);
    }
}

/// What has come of a text that was [`print()`]ed, if it is the result of the command, or else told.
///
/// # Errors
/// As [`print()`].
pub fn put(written: io::Result<()>, is_result: bool) -> Result<()> {
    match is_result {
        true => written.map_err(|error| NotPrinted(error).into()),
        false => {
            told(written);
            Ok(())
        }
    }
}

/// The same for one JSON value on a line of its own.
pub fn tell_json(value: &serde_json::Value) {
    tell(&format!("{value}\n"));
}

/// Why something that was told got lost, if so.
pub fn lost() -> Option<&'static io::Error> {
    LOST.get()
}

/// Writes to standard error, if that can be written to: `eprintln!` would end the command if not.
pub fn write_error(text: fmt::Arguments) {
    // There is nowhere left to say that this failed.
    let _ = writeln!(io::stderr(), "{text}");
}

/// As `eprintln!`, but a closed or full standard error ends nothing.
macro_rules! say {
    ($($text:tt)*) => { $crate::output::write_error(format_args!($($text)*)) };
}
pub(crate) use say;

/// Writes a text to standard output.
pub fn write(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// A text could not be printed.
#[derive(Debug)]
struct NotPrinted(io::Error);

impl fmt::Display for NotPrinted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("standard output cannot be written to")
    }
}

impl std::error::Error for NotPrinted {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.0)
    }
}

/// Whether an error only says that a text could not be printed.
pub fn is_lost(error: &anyhow::Error) -> bool {
    error.is::<NotPrinted>()
}

/// Whether it only says that nobody reads our output any more.
pub fn reader_has_gone(error: &anyhow::Error) -> bool {
    error.downcast_ref::<NotPrinted>().is_some_and(|NotPrinted(error)| error.kind() == ErrorKind::BrokenPipe)
}
