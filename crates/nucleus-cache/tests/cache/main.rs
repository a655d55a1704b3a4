//! The public interface of the cache: record, damage, refuse, play back.

mod checkpoints;
mod compared;
mod damage;
mod falling;
mod flipped;
mod full_disk;
mod meshes;
mod recovered;
mod refusals;
mod round_trip;
mod torn;
