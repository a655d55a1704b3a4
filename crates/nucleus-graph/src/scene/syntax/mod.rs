//! RON text as a tree that knows where everything stands, and knows no node and no attribute.
//!
//! | You want to know...                    | Read          |
//! |----------------------------------------|---------------|
//! | what a text can say                    | [`Value`]     |
//! | how it is read, and where it stops     | `reader.rs`   |
//! | how brackets and commas are held apart | `brackets.rs` |
//! | what counts as a number                | `number.rs`   |
//! | what may stand between quotes          | `text.rs`     |
//! | what is skipped                        | `cursor.rs`   |
//!
//! The `ron` crate stops at the first error and gives values no place, so a scene is read here.
//! `ron` stays the authority on what RON is.
//!
//! **Invariant:** a text that is read here is one that `ron` reads too, to the same numbers. Left out on
//! purpose: numbers that are not finite, `Some` and `None`, single characters, byte strings, ranges, type
//! suffixes, raw and non-ASCII identifiers, extensions, and plain text that runs over the end of a line.

mod cursor;
mod number;
mod reader;
#[cfg(test)]
mod tests;
mod text;
mod tree;

pub use reader::parse;
pub use tree::{Node, SyntaxError, Value, Word};
