//! Pairs of elements, and the result of their continuous collision test.

use nalgebra::Vector3;

use crate::collision_mesh::{EdgeId, FaceId};

/// Two elements that can pass through each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Pair {
    /// A point and a face.
    PointFace(u32, FaceId),
    /// Two edges.
    EdgeEdge(EdgeId, EdgeId),
}

/// The two kinds of pair by which surfaces pass through each other (N2.3-3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PairKind {
    /// A point and a face: `[p, a, b, c]`.
    PointFace,
    /// Two edges: `[a, b, c, d]`.
    EdgeEdge,
}

/// Result of a continuous collision test. Times are fractions of the motion, for display only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CcdResult {
    /// They do not meet.
    Separated,
    /// They pass through each other.
    Crossing {
        /// The first such time.
        at: f64,
    },
    /// They touch without passing through each other, at an end of the motion, or while sliding in one plane.
    Touching {
        /// The time.
        at: f64,
    },
    /// They meet where the face has no area or the edges are parallel, or a coordinate is not finite.
    Undecided,
}

/// Four points at one time.
pub type Corners = [Vector3<f64>; 4];

/// A pair that collides in a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// The pair.
    pub pair: Pair,
    /// Its result; never [`CcdResult::Separated`].
    pub result: CcdResult,
}
