//! Maya ASCII as text: statements, their arguments and the values of `setAttr`. Nothing is executed.
//!
//! | You want to know...                               | Read             |
//! |---------------------------------------------------|------------------|
//! | how bytes become text, whatever their codeset     | [`SourceText`]   |
//! | where a statement ends                            | [`Statements`]   |
//! | words, quoted strings, comments                   | [`Tokens`]       |
//! | flags of a command, short and long                | [`Arguments`]    |
//! | numbers, switches and strings of a value          | [`Values`]       |
//!
//! **Invariant:** the text of a file is kept once, and everything else refers to places in it. A value is parsed when
//! it is asked for, so a mesh that the simulation does not need costs only its statement.

mod arguments;
mod statements;
mod text;
mod values;

pub use arguments::{Arguments, Flag, PlugPath, Segment};
pub use statements::{Statement, Statements, Token, Tokens, unescaped};
pub use text::{ImportError, SourceText, Span};
pub use values::Values;
