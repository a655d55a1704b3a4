//! The cache as others use it: recorded, damaged, refused, and played back.

mod damage;
mod falling;
mod full_disk;
mod refusals;
mod round_trip;
