//! RON text as a tree of values with their places. This module knows no node and no attribute.
//!
//! | You want to know...                    | Read          |
//! |----------------------------------------|---------------|
//! | which forms of values there are        | [`Value`]     |
//! | how they are parsed, and where parsing stops | `reader.rs` |
//! | how numbers are written                | `number.rs`   |
//! | how text in quotes is written          | `text.rs`     |
//! | which characters are skipped           | `cursor.rs`   |
//!
//! The `ron` crate stops at the first error and gives values no place, so scenes have their own parser. `ron` stays
//! the reference: tests compare both.
//!
//! **Invariant:** a text that is accepted here is accepted by `ron`, with the same values. Left out on purpose:
//! numbers that are not finite, `Some` and `None`, single characters, byte strings, ranges, type suffixes, raw and
//! non-ASCII identifiers, extensions, and text in quotes over several lines.

mod cursor;
mod number;
mod reader;
#[cfg(test)]
mod tests;
mod text;
mod tree;

pub use reader::parse;
pub use tree::{Node, SyntaxError, Value, Word};
