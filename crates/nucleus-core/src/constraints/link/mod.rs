//! Links of dynamic constraints, between any places of cloths, colliders and the constraint's own space.
//!
//! A constraint has a list of [`Link`]s, formed by the caller. They are laid out by their number of free points, coloured
//! across all cloths, and swept as one pass of the time step ([`Pass::Links`](crate::schedule::Pass::Links)) between the
//! constraints of cloth and contact. Single points that are joined alike are rows of [`stretch`](super::stretch), other
//! single points are such rows with a factor and a load, and all other links are combinations of one to six points.
//! Joined edges may resist folding: the bending vector of a hinge is such a combination too.
//!
//! **Stability.** A time step turns the errors y of rigid links into y' = S (2y - y₀), with those of the step before, y₀,
//! and the product S of the projections of a pass. For an eigenvalue s of S its modes are the roots of λ² - 2sλ + s = 0.
//! For s in [0, 1] they are at most 1 in magnitude, but for most complex s near 1 one of them is larger: the links gain
//! energy, and more with more steps. Along chains of links, in any order of projections, the eigenvalues are real (orders
//! differ by cyclic shifts), and rings of random masses do not grow either. Where many rigid links meet at a face they do.
//! So where more than two links meet at a point, the constraint is swept in order and backward, which makes S symmetric in
//! the metric of the masses.
//!
//! | You want to know… | Read |
//! |---|---|
//! | the projection of a link | [`rows`] |
//! | which points a link has, and where prescribed sides are | [`ends`] |
//! | the state of links, and their lists | [`lists`], [`pairs`], [`combined`], [`batches`], [`sizes`] |
//! | the start of a frame, and one pass | [`pass`], planned as [`sweep`](mod@sweep) |
//! | links on surfaces, and sliding | [`surface`], [`topology`], `placed.rs`, `gradient.rs` |
//! | links that are shorter than contact allows | `contact_distance.rs` |
//! | broken links | [`glue`], [`tear`] |
//! | links of particles that die | `deaths.rs` |
//! | edges that resist folding | [`fold`] |
//! | forces, damping and drag along links | [`velocity`] |
//! | which elements do not collide because they are joined | [`Links::clusters`](lists::Links::clusters) |
//!
//! Broken links and the places of sliding links are state and part of a checkpoint; rows are rebuilt from the links.

pub mod batches;
pub mod combined;
mod contact_distance;
mod deaths;
pub mod ends;
pub mod fold;
pub mod glue;
mod gradient;
pub mod lists;
pub mod pairs;
pub mod pass;
mod placed;
pub mod rows;
pub mod sizes;
pub mod surface;
pub mod sweep;
pub mod tear;
pub mod topology;
pub mod velocity;
