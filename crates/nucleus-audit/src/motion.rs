//! A linear motion between two states, and the collision tests of its pairs.

use nalgebra::Vector3;

use crate::bvh::Aabb;
use crate::ccd::ccd;
use crate::collision_filter::CollisionFilter;
use crate::collision_mesh::CollisionMesh;
use crate::pair::{CcdResult, Collision, Pair, PairKind};

/// Linear motion of all points from one state to the next.
pub struct Motion<'a> {
    pub mesh: &'a CollisionMesh,
    pub filter: &'a CollisionFilter,
    pub before: &'a [Vector3<f64>],
    pub after: &'a [Vector3<f64>],
}

impl<'a> Motion<'a> {
    pub fn new(
        mesh: &'a CollisionMesh,
        filter: &'a CollisionFilter,
        [before, after]: [&'a [Vector3<f64>]; 2],
    ) -> Self {
        let count = mesh.points();
        assert!(before.len() == count && after.len() == count, "a position for every point");
        Self { mesh, filter, before, after }
    }

    /// The box that an element sweeps.
    pub fn swept<const N: usize>(&self, points: &[u32; N]) -> Aabb {
        let ends = |&point: &u32| [&self.before[point as usize], &self.after[point as usize]];
        Aabb::of(points.iter().flat_map(ends))
    }

    /// Kind and points of a pair, in the order of [`PairKind`]; `None` when the filter excludes it.
    pub fn elements(&self, pair: Pair) -> Option<(PairKind, [u32; 4])> {
        match pair {
            Pair::PointFace(point, face) => {
                let corners @ [a, b, c] = self.mesh.triangles()[face.0 as usize];
                let apply = self.filter.apply(self.mesh, &[point], &corners);
                apply.then_some((PairKind::PointFace, [point, a, b, c]))
            }
            Pair::EdgeEdge(one, other) => {
                let [ends @ [a, b], others @ [c, d]] =
                    [one, other].map(|edge| self.mesh.edges()[edge.0 as usize]);
                let apply = self.filter.apply(self.mesh, &ends, &others);
                apply.then_some((PairKind::EdgeEdge, [a, b, c, d]))
            }
        }
    }

    /// Tests candidates; returns those that collide.
    pub fn collisions(&self, candidates: impl Iterator<Item = Pair>) -> Vec<Collision> {
        candidates.filter_map(|pair| self.collision(pair)).collect()
    }

    fn collision(&self, pair: Pair) -> Option<Collision> {
        let (kind, points) = self.elements(pair)?;
        let [a, b, c, d] = points;
        let meet = match kind {
            PairKind::PointFace => self.swept(&[a]).overlaps(&self.swept(&[b, c, d])),
            PairKind::EdgeEdge => self.swept(&[a, b]).overlaps(&self.swept(&[c, d])),
        };
        let [before, after] =
            [self.before, self.after].map(|state| points.map(|point| state[point as usize]));
        let result = if meet { ccd(kind, &before, &after) } else { CcdResult::Separated };
        (result != CcdResult::Separated).then_some(Collision { pair, result })
    }
}
