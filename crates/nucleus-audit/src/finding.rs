//! One finding of an audit, and its text.

use std::fmt;

use crate::collision_mesh::{CollisionMesh, EdgeId, FaceId};
use crate::intersections::Intersection;
use crate::pair::{CcdResult, Collision, Pair};

/// Frame and substep of a state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct StateIndex {
    /// The frame that ends last.
    pub frame: i64,
    /// The substep of that frame, counted from 1; 0 before the first.
    pub substep: u32,
}

/// Kinds of findings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FindingKind {
    /// A pair collided in the motion to a state.
    Collision(Collision),
    /// An edge intersects a face in a state, without a collision that led to it.
    Intersection(Intersection),
    /// A vertex was above the ground plane and is below it.
    Ground(u32),
}

/// A violation of non-penetration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// The state at the end of the motion.
    pub state: StateIndex,
    /// The finding.
    pub kind: FindingKind,
}

pub struct Described<'a> {
    pub mesh: &'a CollisionMesh,
    pub finding: &'a Finding,
}

impl Described<'_> {
    fn element(&self, f: &mut fmt::Formatter<'_>, kind: &str, points: &[u32]) -> fmt::Result {
        let (body, _) = self.mesh.local(points[0]);
        let numbers: Vec<String> = points.iter().map(|&p| self.mesh.local(p).1.to_string()).collect();
        write!(f, "{kind} {}.vtx[{}]", self.mesh.bodies()[body].name, numbers.join(","))
    }

    fn edge(&self, f: &mut fmt::Formatter<'_>, edge: EdgeId) -> fmt::Result {
        self.element(f, "edge", &self.mesh.edges()[edge.0 as usize])
    }

    fn face(&self, f: &mut fmt::Formatter<'_>, face: FaceId) -> fmt::Result {
        self.element(f, "face", &self.mesh.triangles()[face.0 as usize])
    }
}

impl fmt::Display for Described<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Finding { state, kind } = self.finding;
        write!(f, "frame {}, substep {}: ", state.frame, state.substep)?;
        match *kind {
            FindingKind::Collision(Collision { pair, result }) => {
                let verb = match result {
                    CcdResult::Touching { .. } => "touched",
                    CcdResult::Undecided => "may have gone through",
                    CcdResult::Crossing { .. } | CcdResult::Separated => "went through",
                };
                match pair {
                    Pair::PointFace(point, face) => {
                        self.element(f, "point", &[point])?;
                        write!(f, " {verb} ")?;
                        self.face(f, face)
                    }
                    Pair::EdgeEdge(a, b) => {
                        self.edge(f, a)?;
                        write!(f, " {verb} ")?;
                        self.edge(f, b)
                    }
                }
            }
            FindingKind::Ground(point) => {
                self.element(f, "point", &[point])?;
                write!(f, " went through the ground plane")
            }
            FindingKind::Intersection(Intersection { edge, face, .. }) => {
                self.edge(f, edge)?;
                write!(f, " is inside ")?;
                self.face(f, face)
            }
        }
    }
}
