//! Continuous collision audit of a run: does anything pass through anything? Independent of the solver.
//!
//! ```text
//! before, after ─▶ motion bounds ─BVH─▶ candidates     ─separating plane─▶ few ─filter, exact─▶ Collision
//! after         ─▶ boxes         ─BVH─▶ edges and faces ─exact predicates────────────────────▶ Intersection
//! ```
//!
//! | You want to know…                                        | Read                        |
//! |----------------------------------------------------------|-----------------------------|
//! | how a run is audited, and what is reported               | [`Auditor`], [`Finding`]    |
//! | the audited bodies and their elements                    | [`Body`], [`CollisionMesh`] |
//! | which pairs pass through each other in a motion          | [`collisions`]              |
//! | which vertices pass through the ground plane             | [`Plane`]                   |
//! | which edges intersect which faces in a state             | [`intersections`]           |
//! | how pairs are certified for several steps at once        | `candidate_interval`        |
//! | the continuous collision test of one pair                | [`ccd()`]                   |
//! | how it is decided where rounding could be wrong          | `exact`                     |
//!
//! A motion is linear: every point moves straight from one state to the next. Two elements can then change sides only
//! at a time when their four points are coplanar, which is a root of a cubic.
//!
//! **Invariant:** no collision is missed. Where floating point cannot certify a sign, integers decide it from the bits
//! of the input. Degenerate pairs are reported as undecided.
//!
//! **Invariant:** this crate does not depend on the solver.

#![forbid(unsafe_code)]

mod auditor;
mod bvh;
mod candidate_interval;
mod ccd;
mod collision_filter;
mod collision_mesh;
mod coplanarity;
mod exact;
mod finding;
mod float_filter;
mod ground;
mod initial_intersections;
mod intersections;
mod motion;
mod pair;
mod parallel;
mod sturm;

pub use auditor::{AuditCounts, Auditor};
pub use candidate_interval::collisions;
pub use ccd::ccd;
pub use collision_filter::CollisionFilter;
pub use collision_mesh::{Body, CollisionMesh, EdgeId, FaceId};
pub use finding::{Finding, FindingKind, StateIndex};
pub use ground::Plane;
pub use intersections::{Intersection, IntersectionKind, intersect_edge_face, intersections};
pub use pair::{CcdResult, Collision, Pair, PairKind};
