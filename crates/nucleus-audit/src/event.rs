//! What is found in a motion and in a state.

use crate::overlap::Overlap;
use crate::passage::Passage;
use crate::world::{EdgeId, FaceId};

/// Two elements that can pass through each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Pair {
    /// A point and a face.
    PointFace(u32, FaceId),
    /// Two edges.
    EdgeEdge(EdgeId, EdgeId),
}

/// A pair that has not stayed apart in a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// The two.
    pub pair: Pair,
    /// What they do; never [`Passage::Apart`].
    pub passage: Passage,
}

/// An edge inside a face in a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Overlapping {
    /// The edge.
    pub edge: EdgeId,
    /// The face.
    pub face: FaceId,
    /// How they lie; never [`Overlap::Apart`].
    pub overlap: Overlap,
}
