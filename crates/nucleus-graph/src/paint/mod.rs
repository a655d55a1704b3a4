//! Values that differ from point to point, and the ways to give them.
//!
//! | You want to know...                                  | Read                   |
//! |------------------------------------------------------|------------------------|
//! | what an expression can say                           | [`Expression`]         |
//! | how a file of numbers is read                        | `numbers.rs`           |
//! | how a texture is read and sampled                    | `texture.rs`           |
//!
//! **Invariant:** what is wrong is told with its place: the character of an expression, the line of a file.

mod expression;
mod numbers;
mod texture;

pub use expression::{Expression, ExpressionError, Point, Variable};
pub use numbers::{NumbersError, read_numbers, read_vectors};
pub use texture::{Texture, TextureError};
