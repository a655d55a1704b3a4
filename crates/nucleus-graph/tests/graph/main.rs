//! Properties of all graphs and scenes.

mod animation;
mod constraints;
mod contact;
mod effects;
mod emission;
mod filled_particles;
mod hostile;
mod independence;
mod liquids;
mod maps;
mod materials;
mod mesh_files;
mod mirrored;
mod mutations;
mod particles;
mod pulling;
mod scenes;
mod soft_bodies;
mod welds;
mod wiring;
