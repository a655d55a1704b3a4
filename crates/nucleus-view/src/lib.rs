//! What a run looks like: still pictures, animated pictures, and a player in the browser.
//!
//! | You want to know…                            | Read                     |
//! |----------------------------------------------|--------------------------|
//! | how meshes become a picture                  | [`draw()`]               |
//! | where the camera stands when none is given   | [`Camera::framing`]      |
//! | how a cache becomes pictures                 | [`Film`]                 |
//! | how frames become an animated PNG            | [`AnimationWriter`]      |
//! | how frames become a GIF                      | [`GifWriter`]            |
//! | how a browser gets the player and the cache  | [`serve()`]              |
//! | how the player reads a cache                 | `assets/player/cache.js` |
//! | how strain becomes a colour                  | [`Colouring::Strain`]    |
//!
//! **Invariant:** this crate knows no solver; it draws what it is given, whatever the numbers are,
//! and the same numbers give the same bytes on any machine.

mod error;
mod picture;
mod player;

pub use error::ViewError;
pub use picture::{
    AnimationWriter, Bounds, Camera, Colouring, Film, GifWriter, Ground, Image, Kind, Object, Style, draw,
};
pub use player::{Player, serve, serve_both};
