//! Values that differ from point to point: expressions, files of numbers, and textures.
//!
//! | You want to know...                                  | Read                   |
//! |------------------------------------------------------|------------------------|
//! | the syntax of expressions                            | [`Expression`]         |
//! | how a file of numbers is read                        | `numbers.rs`           |
//! | how a texture is read and sampled                    | `texture.rs`           |
//!
//! **Invariant:** an error names its place: the character of an expression, or the line and column of a file.

mod expression;
mod numbers;
mod texture;

pub use expression::{Expression, ExpressionError, Point, Variable, functions, operators, variables};
pub use numbers::{NumbersError, read_numbers, read_vectors};
pub use texture::{Texture, TextureError};
