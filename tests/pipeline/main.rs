//! Tests over the whole pipeline, from a scene file to a cache.

mod audit;
mod caches;
mod classic;
mod emission;
mod gallery;
mod nodes;
mod paper;
mod particle_scenes;
mod particles;
mod recorded;
mod resume;
mod soft_scenes;
