//! Values that differ from point to point: expressions, files of numbers, and textures.
//!
//! | You want to know...                                  | Read                   |
//! |------------------------------------------------------|------------------------|
//! | the syntax of expressions                            | [`Expression`]         |
//! | statements over variables that a caller names        | [`Statements`]         |
//! | how a file of numbers is read                        | `numbers.rs`           |
//! | how a texture is read and sampled                    | `texture.rs`           |
//!
//! **Invariant:** an error names its place: the character of an expression, or the line and column of a file.

mod expression;
mod numbers;
mod statements;
mod texture;

pub use expression::{Expression, ExpressionError, Point, Variable, functions, operators, variables};
pub use numbers::{NumbersError, read_numbers, read_vectors};
pub use statements::Statements;
pub use texture::{Texture, TextureError};
