//! The cache as others use it: recorded, damaged, refused, and played back.

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
