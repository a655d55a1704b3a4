//! Particles that are born and die, and time steps of free points.
//!
//! An object of particles has capacity for a fixed number of them. Living particles are the first rows of the object, in the
//! order of their birth, and only these rows are swept, so a row without a particle costs nothing. Particles that are near
//! in time of birth are near in space, so neighbouring rows stay near each other, which contact relies on: this is why the
//! rows of dead particles are closed up in order, and not filled from the end or kept in a free list.
//!
//! Births and deaths happen at the end of each substep. A particle is born at its own time within the substep and flies
//! freely to the end of it, so that a fast emitter leaves an even trail.
//!
//! | You want to know… | Read |
//! |---|---|
//! | ages, lifespans and numbers | [`population`] |
//! | births and deaths in the solver's columns | [`lifecycle`] |
//! | new particles that a surface would be in the way of | [`birth_path`] |
//! | time steps of particles that depend on nothing but colliders | [`free`], [`free_pass`], then [`free_run`] |
//! | attributes that differ by particle | [`ramps`] |
//! | what an observer draws of them | [`looks`] |
//! | what happens at collisions | [`events`] |
//! | `computeRotation` | [`rotation`] |
//! | `conserve` and `damp` | [`slowing`] |
//! | new particles that would overlap others | [`occupancy`] |

pub mod birth_path;
pub mod events;
pub mod free;
pub mod free_pass;
pub mod free_run;
pub mod lifecycle;
pub mod looks;
pub mod occupancy;
pub mod population;
pub mod ramps;
pub mod rotation;
pub mod slowing;
