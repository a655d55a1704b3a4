//! What a run looks like: still pictures, animated pictures, and a player in the browser.
//!
//! | You want to know…                            | Read                     |
//! |----------------------------------------------|--------------------------|
//! | how meshes become a picture                  | [`draw()`]               |
//! | where the camera stands when none is given   | [`Camera::framing`]      |
//! | how frames become an animated PNG            | [`AnimationWriter`]      |
//! | how strain becomes a colour                  | [`Colouring::Strain`]    |
//!
//! **Invariant:** this crate knows no solver; it draws what it is given, whatever the numbers are,
//! and the same numbers give the same bytes on any machine.

mod error;
mod picture;

pub use error::ViewError;
pub use picture::{AnimationWriter, Bounds, Camera, Colouring, Image, Kind, Object, Style, draw};
