//! The built binary, as a shell sees it: what it prints, and the code it ends with.

mod attrs;
mod info;
mod render;
mod sample;
