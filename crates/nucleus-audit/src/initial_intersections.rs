//! Initial intersections: pairs that intersect in the start state, and the pairs that motion carries them to.
//!
//! An initial intersection moves over the meshes: an edge leaves one face and enters the next. The collisions of this
//! propagation are counted apart from those that begin a new intersection.

use std::collections::HashSet;

use crate::collision_mesh::{CollisionMesh, EdgeId, FaceId};
use crate::intersections::Intersection;
use crate::pair::{Collision, Pair};

/// Edge-face pairs that intersect since the start state; each is removed when it separates.
#[derive(Debug, Default)]
pub struct InitialIntersections {
    inside: HashSet<(EdgeId, FaceId)>,
}

impl InitialIntersections {
    /// The intersections of the start state.
    pub fn new(start: &[Intersection]) -> Self {
        Self { inside: start.iter().map(|found| (found.edge, found.face)).collect() }
    }

    /// Adds intersections that count as initial.
    pub fn add(&mut self, found: &[Intersection]) {
        self.inside.extend(found.iter().map(|found| (found.edge, found.face)));
    }

    /// Number of remaining pairs.
    pub fn len(&self) -> usize {
        self.inside.len()
    }

    /// Whether all pairs have separated.
    pub fn is_empty(&self) -> bool {
        self.inside.is_empty()
    }

    /// Removes the collisions that propagate an initial intersection from `collisions`; returns the pairs they may have
    /// reached.
    pub fn exclude(&self, mesh: &CollisionMesh, collisions: &mut Vec<Collision>) -> Propagation {
        let mut propagation = Propagation::default();
        if self.inside.is_empty() {
            return propagation;
        }
        self.inside.iter().for_each(|&(edge, face)| propagation.add(mesh, edge, face));
        // One motion may cross several elements, in another order than that of `collisions`.
        loop {
            let before = collisions.len();
            collisions.retain(|collision| {
                !propagation.has(collision.pair) || !propagation.propagate(mesh, collision.pair)
            });
            if collisions.len() == before {
                return propagation;
            }
            propagation.excluded += (before - collisions.len()) as u64;
        }
    }

    /// Keeps those intersections of the new state that the propagation reached.
    pub fn update(&mut self, propagation: &Propagation, now: &[Intersection]) {
        let pairs = now.iter().map(|found| (found.edge, found.face));
        self.inside = pairs.filter(|pair| propagation.inside.contains(pair)).collect();
    }

    /// Whether an intersection belongs to the set.
    pub fn has(&self, found: &Intersection) -> bool {
        self.inside.contains(&(found.edge, found.face))
    }
}

/// Pairs that initial intersections may reach in one motion.
#[derive(Debug, Default)]
pub struct Propagation {
    inside: HashSet<(EdgeId, FaceId)>,
    pairs: HashSet<Pair>,
    /// Collisions that propagated an intersection.
    pub excluded: u64,
}

impl Propagation {
    /// Adds a pair: an edge leaves a face over its end points or over the face's edges.
    fn add(&mut self, mesh: &CollisionMesh, edge: EdgeId, face: FaceId) {
        if !self.inside.insert((edge, face)) {
            return;
        }
        let ends = mesh.edges()[edge.0 as usize];
        self.pairs.extend(ends.map(|point| Pair::PointFace(point, face)));
        self.pairs.extend(mesh.sides(face).map(|side| Pair::EdgeEdge(edge.min(side), edge.max(side))));
    }

    fn has(&self, pair: Pair) -> bool {
        self.pairs.contains(&pair)
    }

    /// Adds the pairs that a collision leads to. Always `true`: the collision is excluded.
    fn propagate(&mut self, mesh: &CollisionMesh, pair: Pair) -> bool {
        match pair {
            Pair::PointFace(point, face) => mesh.edges_at(point).for_each(|edge| self.add(mesh, edge, face)),
            Pair::EdgeEdge(a, b) => {
                mesh.faces_at(b).for_each(|face| self.add(mesh, a, face));
                mesh.faces_at(a).for_each(|face| self.add(mesh, b, face));
            }
        }
        true
    }
}
