//! Has anything passed through anything? An answer that shares nothing with the solver.
//!
//! ```text
//! before, after ─▶ motion bounds ─tree─▶ pairs of elements ─certify─▶ few ─exact─▶ Event
//! after         ─▶ boxes         ─tree─▶ edges and faces   ─exact──────────────▶ Overlap
//! ```
//!
//! | You want to know...                                      | Read                   |
//! |----------------------------------------------------------|------------------------|
//! | how a run is watched, and what is said of it             | [`Auditor`]            |
//! | what there is to meet: bodies and their elements         | [`Body`], [`World`]    |
//! | which pairs pass through each other during a motion      | [`crossings`]          |
//! | which vertices pass through the ground plane             | [`Plane`]              |
//! | which edges are inside which faces in a state            | [`intersections`]      |
//! | what is certified apart for several steps at once        | `window`               |
//! | whether one pair does                                    | [`passage()`]          |
//! | how that is decided where rounding could deceive         | `exact`                |
//!
//! A motion is linear: every point goes straight from one state to the next. Then two elements can only change
//! sides at a moment when their four points lie in one plane, which is the root of a cubic.
//!
//! **Invariant:** nothing is missed. Whatever floating point cannot prove is decided in integers; the input's
//! bits are taken as they are. What is left, degenerate pairs, is named as undecided.
//!
//! **Invariant:** this crate does not know the solver.

#![forbid(unsafe_code)]

mod auditor;
mod bounds;
mod coplanarity;
mod crossings;
mod estimate;
mod event;
mod exact;
mod ground;
mod intersections;
mod overlap;
mod passage;
mod sturm;
mod tangle;
mod threads;
mod tree;
mod window;
mod world;

pub use auditor::{Account, Auditor, Finding, Moment, What};
pub use crossings::crossings;
pub use event::{Event, Overlapping, Pair};
pub use ground::Plane;
pub use intersections::intersections;
pub use overlap::{Overlap, overlap};
pub use passage::{Kind, Passage, passage};
pub use world::{Body, EdgeId, FaceId, Rules, World};
