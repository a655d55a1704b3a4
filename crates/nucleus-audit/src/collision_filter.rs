//! The filter of pairs: which elements of which bodies are tested with each other.

use crate::collision_mesh::CollisionMesh;

/// Which pairs of elements are tested. The default tests all.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CollisionFilter {
    ignored: BodyPairs,
    kinematic: Vec<bool>,
    permeable: Vec<bool>,
    /// By point: the point that stands for all that are welded together; empty without welds.
    clusters: Vec<u32>,
    /// By point: the exclusions that have it on their first and on their second side, as bits; empty without exclusions.
    sides: Vec<[u64; 2]>,
    /// The exclusions with everything, and the ground plane, on a side.
    everything: [u64; 2],
}

impl CollisionFilter {
    /// Excludes pairs between two bodies, or within one.
    pub fn ignore(&mut self, a: usize, b: usize) {
        self.ignored.insert(a, b);
    }

    /// Whether pairs between two bodies, or within one, are tested.
    pub fn is_tested(&self, a: usize, b: usize) -> bool {
        !self.ignored.contains(a, b)
    }

    /// Marks a point as kinematic: its motion is prescribed. Pairs of elements with kinematic points only are excluded,
    /// since no solver can separate them.
    pub fn set_kinematic(&mut self, point: usize) {
        if self.kinematic.len() <= point {
            self.kinematic.resize(point + 1, false);
        }
        self.kinematic[point] = true;
    }

    /// Marks a point as permeable: elements that have it may pass through others, and are not tested.
    pub fn set_permeable(&mut self, point: usize) {
        if self.permeable.len() <= point {
            self.permeable.resize(point + 1, false);
        }
        self.permeable[point] = true;
    }

    /// Joins two points: elements that have one each are neighbours, as if they shared a point.
    pub fn weld(&mut self, points: usize, a: usize, b: usize) {
        if self.clusters.len() < points {
            self.clusters.extend(self.clusters.len() as u32..points as u32);
        }
        let [a, b] = [self.clusters[a], self.clusters[b]];
        let (kept, lost) = (a.min(b), a.max(b));
        if kept != lost {
            self.clusters.iter_mut().filter(|cluster| **cluster == lost).for_each(|cluster| *cluster = kept);
        }
    }

    /// Puts points on a side (0 or 1) of an exclusion, by its number below 64: elements with all points on one side are not
    /// tested with those on the other.
    pub fn exclude(&mut self, points: usize, of_side: impl Iterator<Item = usize>, number: u32, side: usize) {
        self.sides.resize(self.sides.len().max(points), self.everything);
        of_side.for_each(|point| self.sides[point][side] |= 1 << number);
    }

    /// Puts all points and the ground planes on a side of an exclusion.
    pub fn exclude_everything(&mut self, points: usize, number: u32, side: usize) {
        self.sides.resize(self.sides.len().max(points), self.everything);
        self.everything[side] |= 1 << number;
        self.sides.iter_mut().for_each(|sides| sides[side] |= 1 << number);
    }

    /// Whether a point is not tested with the ground plane.
    pub(crate) fn is_free_of_ground(&self, point: usize) -> bool {
        self.is_kinematic(point)
            || self.is_permeable(point)
            || self.sides.get(point).is_some_and(|sides| meet(*sides, self.everything))
    }

    /// The exclusions that have all of these points on a side.
    fn sides_of(&self, points: &[u32]) -> [u64; 2] {
        let both = |all: [u64; 2], own: [u64; 2]| [all[0] & own[0], all[1] & own[1]];
        points.iter().fold([u64::MAX; 2], |all, &point| both(all, self.sides[point as usize]))
    }

    /// Whether elements with these points are not tested because a weld or an exclusion says so.
    pub fn excludes(&self, a: &[u32], b: &[u32]) -> bool {
        let cluster = |point: &u32| self.clusters[*point as usize];
        let are_joined = || a.iter().any(|p| b.iter().any(|q| cluster(p) == cluster(q)));
        !self.clusters.is_empty() && are_joined()
            || !self.sides.is_empty() && meet(self.sides_of(a), self.sides_of(b))
    }

    /// Whether a point is kinematic.
    pub(crate) fn is_kinematic(&self, point: usize) -> bool {
        self.kinematic.get(point).copied().unwrap_or(false)
    }

    fn is_permeable(&self, point: usize) -> bool {
        self.permeable.get(point).copied().unwrap_or(false)
    }

    /// Whether a pair of elements with these points is tested. Elements that share a point always touch there; their
    /// other neighbours show any further collision.
    pub(crate) fn apply<const A: usize, const B: usize>(
        &self,
        mesh: &CollisionMesh,
        a: &[u32; A],
        b: &[u32; B],
    ) -> bool {
        // Most candidates are neighbours in a mesh.
        if a.iter().any(|point| b.contains(point)) {
            return false;
        }
        let bodies = [mesh.body_of(a[0]), mesh.body_of(b[0])];
        let is_kinematic = |point: &u32| self.is_kinematic(*point as usize);
        let are_permeable = a.iter().chain(b).any(|point| self.is_permeable(*point as usize));
        let are_kinematic = a.iter().all(is_kinematic) && b.iter().all(is_kinematic);
        !(are_kinematic
            || are_permeable
            || self.ignored.contains(bodies[0], bodies[1])
            || self.excludes(a, b))
    }

    /// The elements of bodies with at least one tested pair.
    pub(crate) fn active_elements<const N: usize>(
        &self,
        mesh: &CollisionMesh,
        elements: &[[u32; N]],
    ) -> Vec<u32> {
        let bodies = mesh.bodies().len();
        let is_active: Vec<bool> = (0..bodies).map(|body| self.ignored.partners(body) < bodies).collect();
        let is_concerned = |(_, points): &(u32, &[u32; N])| is_active[mesh.body_of(points[0])];
        (0..).zip(elements).filter(is_concerned).map(|(index, _)| index).collect()
    }
}

/// Whether one is on the first side of an exclusion and the other on its second.
fn meet(a: [u64; 2], b: [u64; 2]) -> bool {
    (a[0] & b[1]) | (a[1] & b[0]) != 0
}

/// A set of pairs of bodies, as a symmetric matrix of bits: a scene of a thousand objects that do not collide has half a
/// million.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct BodyPairs {
    rows: Vec<Vec<u64>>,
}

impl BodyPairs {
    fn insert(&mut self, a: usize, b: usize) {
        for [row, column] in [[a, b], [b, a]] {
            if self.rows.len() <= row {
                self.rows.resize(row + 1, Vec::new());
            }
            let words = &mut self.rows[row];
            if words.len() <= column / 64 {
                words.resize(column / 64 + 1, 0);
            }
            words[column / 64] |= 1 << (column % 64);
        }
    }

    fn contains(&self, a: usize, b: usize) -> bool {
        self.rows.get(a).and_then(|words| words.get(b / 64)).is_some_and(|word| word >> (b % 64) & 1 == 1)
    }

    /// The number of bodies that form a pair with this one, itself included.
    fn partners(&self, body: usize) -> usize {
        let words = self.rows.get(body).map(Vec::as_slice).unwrap_or_default();
        words.iter().map(|word| word.count_ones() as usize).sum()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::collision_mesh::Body;

    proptest! {
        #[test]
        fn a_body_is_left_out_where_it_is_tested_with_none(
            ignored in proptest::collection::btree_set(proptest::array::uniform2(0..70usize), 0..200),
            alone in 0..70usize,
        ) {
            let bodies = (0..70).map(|_| Body::mesh("", 3, [&[0u32, 1, 2][..]])).collect();
            let mesh = CollisionMesh::new(bodies);
            let mut pairs: BTreeSet<[usize; 2]> = ignored.into_iter().map(|[a, b]| [a.min(b), a.max(b)]).collect();
            pairs.extend((0..70).map(|other| [alone.min(other), alone.max(other)]));
            let mut filter = CollisionFilter::default();
            pairs.iter().for_each(|&[a, b]| filter.ignore(b, a));
            for a in 0..70 {
                for b in 0..70 {
                    prop_assert_eq!(filter.is_tested(a, b), !pairs.contains(&[a.min(b), a.max(b)]));
                }
            }
            let active: Vec<u32> = (0..70).filter(|&a| (0..70).any(|b| filter.is_tested(a, b))).map(|a| a as u32).collect();
            prop_assert!(!active.contains(&(alone as u32)));
            prop_assert_eq!(filter.active_elements(&mesh, mesh.triangles()), active);
        }
    }
}
