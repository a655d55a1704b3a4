//! What holds for every graph and every scene, whatever is done to them.

mod animation;
mod independence;
mod maps;
mod materials;
mod mutations;
mod particles;
mod pulling;
mod scenes;
mod wiring;
