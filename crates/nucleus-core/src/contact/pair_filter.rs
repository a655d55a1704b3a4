//! Pair filter: elements that do not collide with each other, because a constraint says so or because they are joined.
//!
//! The broad phase asks it for every candidate. Empty columns, in scenes without such constraints, cost a length check.

use crate::bytes::checkpoint_struct;
use crate::input::links::{ExcludedSide, Exclusion, MAX_EXCLUSIONS};
use crate::math::Real;
use crate::model::{ClothModel, ColliderModel};
use crate::union_find::UnionFind;

/// The exclusions that have a point on their first and on their second side, as bits.
type Sides = [u64; 2];

/// Which elements do not collide.
#[derive(Debug, Clone, Default)]
pub struct PairFilter {
    /// By row: the lowest row that it is welded to; empty where nothing is welded.
    clusters: Vec<u32>,
    /// By row; empty without exclusions.
    cloths: Vec<Sides>,
    /// By point of each collider; empty without exclusions.
    colliders: Vec<Vec<Sides>>,
    /// The exclusions with everything on one side.
    everything: Sides,
    /// Whether welds can break: elements that coincide at rest then part.
    tears: bool,
    /// Pairs of rows that were welded, and are still nearer to each other than their contact thickness.
    released: Vec<[u32; 2]>,
    /// By row: the lowest row that it is welded to or was released from; empty where nothing was released.
    released_clusters: Vec<u32>,
}

checkpoint_struct!([] PairFilter {
    columns: [], values: [clusters, cloths, colliders, everything, tears, released, released_clusters], parts: [],
    rebuilt: [],
});

impl PairFilter {
    /// Whether it excludes nothing.
    pub fn is_empty(&self) -> bool {
        self.clusters.is_empty() && self.cloths.is_empty()
    }

    /// Whether its columns fit these numbers of rows and of points of colliders.
    pub fn is_valid(&self, rows: usize, colliders: impl ExactSizeIterator<Item = usize>) -> bool {
        let of_rows = |length: usize| length == 0 || length == rows;
        let of_colliders = self.colliders.is_empty()
            || self.colliders.len() == colliders.len()
                && self.colliders.iter().zip(colliders).all(|(points, count)| points.len() == count);
        of_rows(self.clusters.len())
            && of_rows(self.released_clusters.len())
            && self.released.iter().flatten().all(|row| (*row as usize) < rows)
            && of_rows(self.cloths.len())
            && self.colliders.is_empty() == self.cloths.is_empty()
            && of_colliders
    }

    /// Whether elements that coincide at rest may have been torn from each other.
    pub fn tears(&self) -> bool {
        self.tears
    }

    /// Whether there are points that were welded to each other, and have not been apart since.
    pub fn has_released(&self) -> bool {
        !self.released.is_empty()
    }

    /// Whether two elements have such points.
    #[inline]
    pub fn are_released(&self, ours: &[u32], theirs: &[u32]) -> bool {
        share_cluster(&self.released_clusters, ours, theirs) && !self.are_joined(ours, theirs)
    }

    /// Whether two elements of cloth do not collide.
    #[inline]
    pub fn excludes(&self, ours: &[u32], theirs: &[u32]) -> bool {
        !self.is_empty()
            && (self.are_joined(ours, theirs) || meet(self.of_cloth(ours), self.of_cloth(theirs)))
    }

    /// Whether an element of cloth and one of a collider do not collide.
    #[inline]
    pub fn excludes_collider(&self, ours: &[u32], collider: usize, theirs: &[u32]) -> bool {
        self.sides_of_all(ours.iter().copied()).exclude_collider(collider, theirs)
    }

    /// Whether a point does not collide with the ground plane.
    #[inline]
    pub fn excludes_ground(&self, point: u32) -> bool {
        self.sides_of_all([point].into_iter()).exclude_ground()
    }

    /// The sides that all of these points belong to, which then do not collide as one element.
    #[inline]
    pub fn sides_of_all(&self, points: impl Iterator<Item = u32>) -> SidesOfAll<'_> {
        let sides = match self.cloths.is_empty() {
            true => [0; 2],
            false => points.fold([u64::MAX; 2], |all, point| both(all, self.cloths[point as usize])),
        };
        SidesOfAll { filter: self, sides }
    }

    /// Whether two elements have points that are welded to each other.
    #[inline]
    pub fn are_joined(&self, ours: &[u32], theirs: &[u32]) -> bool {
        share_cluster(&self.clusters, ours, theirs)
    }

    fn of_cloth(&self, points: &[u32]) -> Sides {
        self.sides_of_all(points.iter().copied()).sides
    }

    fn of_collider(&self, collider: usize, points: &[u32]) -> Sides {
        let sides = &self.colliders[collider];
        points.iter().fold([u64::MAX; 2], |all, &point| both(all, sides[point as usize]))
    }

    /// Takes up the points that are welded to others, and whether welds can break. What was welded until now is released.
    pub fn set_welds(&mut self, clusters: Vec<u32>, tears: bool) {
        let before = std::mem::replace(&mut self.clusters, clusters);
        self.tears |= tears;
        let welded = (0..).zip(before).filter(|(row, first)| row != first);
        let Self { clusters, released, .. } = self;
        let pairs = welded.filter(|(row, first)| !share_cluster(clusters, &[*row], &[*first]));
        released.extend(pairs.map(|(row, first)| [first, row]));
    }

    /// Keeps the released pairs that are near, of `rows` rows in all.
    pub fn keep_released(&mut self, rows: usize, is_near: impl Fn([u32; 2]) -> bool) {
        self.released.retain(|pair| is_near(*pair));
        self.released_clusters.clear();
        if self.released.is_empty() {
            return;
        }
        let mut sets = UnionFind::new(rows);
        let welded = (0..).zip(&self.clusters).map(|(row, first)| [*first, row]);
        welded.chain(self.released.iter().copied()).for_each(|[a, b]| sets.union(a, b));
        self.released_clusters.extend((0..rows as u32).map(|row| sets.find(row)));
    }

    /// Whether there are exclusions.
    pub fn has_exclusions(&self) -> bool {
        !self.cloths.is_empty()
    }

    /// Whether another filter treats a row otherwise.
    pub fn differs_at(&self, other: &Self, row: usize) -> bool {
        let cluster = |filter: &Self| filter.clusters.get(row).copied().unwrap_or(row as u32);
        cluster(self) != cluster(other) || self.excludes_otherwise_at(other, row)
    }

    /// Whether another filter has other exclusions of a row.
    pub fn excludes_otherwise_at(&self, other: &Self, row: usize) -> bool {
        let sides = |filter: &Self| filter.cloths.get(row).copied().unwrap_or_default();
        sides(self) != sides(other)
    }

    /// Whether another filter treats a collider otherwise.
    pub fn differs_in_colliders(&self, other: &Self) -> bool {
        self.colliders != other.colliders
    }

    /// Takes up exclusions.
    pub fn set_exclusions<R: Real>(
        &mut self,
        exclusions: &[std::sync::Arc<Exclusion>],
        cloths: &[ClothModel<R>],
        colliders: &[ColliderModel],
        rows: usize,
    ) {
        self.everything = [0; 2];
        if exclusions.is_empty() {
            self.cloths.clear();
            self.colliders.clear();
            return;
        }
        self.cloths = vec![[0; 2]; rows];
        self.colliders = colliders.iter().map(|collider| vec![[0; 2]; collider.positions.len()]).collect();
        for (bit, exclusion) in exclusions.iter().take(MAX_EXCLUSIONS).enumerate() {
            for (side, members) in exclusion.sides.iter().enumerate() {
                let mark = |sides: &mut Sides| sides[side] |= 1 << bit;
                match members {
                    ExcludedSide::Everything => {
                        self.cloths.iter_mut().for_each(mark);
                        self.colliders.iter_mut().flatten().for_each(mark);
                        mark(&mut self.everything);
                    }
                    ExcludedSide::Points(of_cloths, of_colliders) => {
                        for (cloth, point) in of_cloths {
                            let Some(model) = cloths.get(cloth.index()) else { continue };
                            // Particles that are not born yet have a row too.
                            if point.index() < model.blocks.rows().len() {
                                mark(&mut self.cloths[model.place(point.index()) as usize]);
                            }
                        }
                        for (collider, point) in of_colliders {
                            let points = self.colliders.get_mut(collider.index());
                            points
                                .and_then(|points| points.get_mut(point.index()))
                                .into_iter()
                                .for_each(mark);
                        }
                    }
                }
            }
        }
    }
}

/// What the points of an object have in common.
#[derive(Clone, Copy)]
pub struct SidesOfAll<'a> {
    filter: &'a PairFilter,
    sides: Sides,
}

impl SidesOfAll<'_> {
    /// Whether they do not collide with an element of cloth.
    pub fn exclude(&self, theirs: &[u32]) -> bool {
        meet(self.sides, self.filter.of_cloth(theirs))
    }

    /// Whether they do not collide with an element of a collider.
    #[inline]
    pub fn exclude_collider(&self, collider: usize, theirs: &[u32]) -> bool {
        !self.filter.cloths.is_empty() && meet(self.sides, self.filter.of_collider(collider, theirs))
    }

    /// Whether they do not collide with the ground plane.
    #[inline]
    pub fn exclude_ground(&self) -> bool {
        meet(self.sides, self.filter.everything)
    }
}

/// Whether one of each is in the same cluster.
#[inline]
fn share_cluster(clusters: &[u32], ours: &[u32], theirs: &[u32]) -> bool {
    let cluster = |point: &u32| clusters[*point as usize];
    !clusters.is_empty() && ours.iter().any(|p| theirs.iter().any(|q| cluster(p) == cluster(q)))
}

fn both(a: Sides, b: Sides) -> Sides {
    [a[0] & b[0], a[1] & b[1]]
}

/// Whether one is on the first side of an exclusion and the other on the second.
fn meet(a: Sides, b: Sides) -> bool {
    (a[0] & b[1]) | (a[1] & b[0]) != 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_broken_weld_are_released_until_they_have_been_apart() {
        let mut filter = PairFilter::default();
        filter.set_welds(vec![0, 0, 0, 3, 3], false);
        // Row 1 leaves its weld with 0 and 2, and 3 and 4 stay together.
        filter.set_welds(vec![0, 1, 0, 3, 3], false);
        filter.keep_released(5, |_| true);
        assert!(filter.are_released(&[1], &[0]) && filter.are_released(&[1], &[2]));
        assert!(!filter.are_released(&[0], &[2]) && !filter.are_released(&[3], &[4]), "still welded");
        assert!(!filter.are_released(&[1], &[3]), "never welded");
        assert!(!filter.tears(), "no weld of theirs can break");
        filter.keep_released(5, |_| false);
        assert!(!filter.has_released() && !filter.are_released(&[1], &[0]));
    }
}
