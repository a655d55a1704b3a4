//! Pictures of a cache: stills, animations, and a player in the browser.
//!
//! | You want to know…                               | Read                                      |
//! |-------------------------------------------------|-------------------------------------------|
//! | how objects become a picture                    | [`draw()`]                                |
//! | what an automatic camera frames                 | [`Bounds::to_frame`], [`Camera::framing`] |
//! | how a cache becomes pictures                    | [`Film`]                                  |
//! | how frames become an animated PNG or a GIF      | [`AnimationWriter`], [`GifWriter`]        |
//! | how strain becomes a colour                     | [`Colouring::Strain`]                     |
//! | how the page and the cache reach the browser    | [`serve()`]                               |
//! | how a run is shown while it is solved           | [`LiveRun`], [`serve_live`]               |
//! | how the player reads a cache                    | `assets/player/cache.js`                  |
//!
//! **Invariant:** this crate does not depend on how a run was solved. It draws any numbers, and the same numbers give the
//! same bytes on any machine.

#![forbid(unsafe_code)]

mod error;
mod picture;
mod player;

pub use error::ViewError;
pub use picture::{
    AnimationWriter, Background, Bounds, Camera, Colouring, Film, GifWriter, Ground, Image, Kind, Object,
    Style, draw,
};
pub use player::{LiveRun, Player, serve, serve_both, serve_live};
