//! Panics of foreign readers as errors: a damaged file must not end the program.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

use super::error::Fault;

thread_local! {
    /// Whether this thread runs a foreign reader, whose panics are not printed.
    static IS_READING: Cell<bool> = const { Cell::new(false) };
}

static QUIET: Once = Once::new();

/// Calls a foreign reader.
///
/// # Errors
/// Those of the reader; if it panics, that the file is malformed. What it has half read must not be used then.
pub(super) fn guarded<T>(read: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    QUIET.call_once(|| {
        let print = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_READING.get() {
                print(panic);
            }
        }));
    });
    let before = IS_READING.replace(true);
    let result = catch_unwind(AssertUnwindSafe(read));
    IS_READING.set(before);
    result.unwrap_or_else(|_| {
        Err("it is damaged, or of a kind that the reader of its format cannot handle".into())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_of_a_reader_is_an_error_and_its_result_is_passed_on() {
        assert_eq!(guarded(|| Ok(3)).ok(), Some(3));
        assert!(guarded(|| -> Result<(), Fault> { panic!("index out of range") }).is_err());
        assert!(!IS_READING.get());
    }
}
