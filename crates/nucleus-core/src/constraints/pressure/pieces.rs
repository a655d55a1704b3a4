//! The pieces of a mesh that tears: pressure pushes a piece as far as it is closed.
//!
//! The area vectors of a closed surface add up to zero, those of a flat piece to its whole area. A sphere from which a cap is
//! cut is closed by 1 - |Σ a| / Σ |a|: one less the share of the solid angle that the hole has. In relation to that of the mesh
//! at the start, a piece gets all of the pressure while it is closed, and none from half a sphere on: a scrap in open air has
//! the same pressure on both sides.

use std::collections::BTreeMap;

use crate::math::{Real, Row4};
use crate::state::inflation::AreaSums;
use crate::union_find::UnionFind;

/// The chamber of a point of no face.
pub(super) const NO_CHAMBER: u32 = u32::MAX;

/// Which piece each point of a cloth is in; empty where the mesh cannot tear.
#[derive(Debug, Clone, Default)]
pub(super) struct Pieces {
    /// By point, from the first row of the cloth on.
    of_point: Vec<u32>,
    /// The chamber of each piece, from the first of the cloth on.
    chamber: Vec<u32>,
    /// By chamber: how closed it is at the start.
    closed: Vec<f64>,
    /// By chamber: the number of its pieces.
    counts: Vec<u32>,
}

/// A mesh that is less closed than this at the start is a sheet, and every piece of it gets all of the pressure.
const SHEET: f64 = 1e-3;

impl Pieces {
    pub(super) fn is_empty(&self) -> bool {
        self.of_point.is_empty()
    }

    /// Whether a chamber is in one piece.
    pub(super) fn is_one(&self, chamber: usize) -> bool {
        self.counts.get(chamber).is_none_or(|&count| count == 1)
    }

    /// Measures how closed each chamber is; `chamber` and `area` are by point.
    pub(super) fn start<R: Real>(&mut self, chamber: &[u32], area: &[Row4<R>], chambers: usize) {
        let mut sums = vec![AreaSums::default(); chambers];
        for (own, area) in chamber.iter().zip(area) {
            sums.get_mut(*own as usize).into_iter().for_each(|sums| sums.add(area));
        }
        self.closed = sums.iter().map(AreaSums::closed).collect();
    }

    /// Finds the pieces: the faces that share a point, or points of one of the `clusters` of welded rows (empty where nothing
    /// is welded). `first` is the first row of the cloth.
    pub(super) fn find<'a>(
        &mut self,
        first: u32,
        chamber: &[u32],
        triangles: impl Iterator<Item = &'a [u32; 3]>,
        clusters: &[u32],
    ) {
        let mut sets = UnionFind::new(chamber.len());
        let at = |row: u32| row - first;
        for [a, b, c] in triangles.map(|triangle| triangle.map(at)) {
            sets.union(a, b);
            sets.union(a, c);
        }
        // The lowest row of a cluster may be of another cloth.
        let mut lowest = BTreeMap::new();
        for (point, &cluster) in (0..chamber.len() as u32).zip(clusters.iter().skip(first as usize)) {
            sets.union(*lowest.entry(cluster).or_insert(point), point);
        }
        let mut numbers = vec![u32::MAX; chamber.len()];
        self.chamber.clear();
        self.of_point.clear();
        self.counts.clear();
        self.counts.resize(
            chamber.iter().filter(|own| **own != NO_CHAMBER).max().map_or(0, |last| *last as usize + 1),
            0,
        );
        for (point, &own) in (0..).zip(chamber) {
            let number = &mut numbers[sets.find(point) as usize];
            if *number == u32::MAX {
                *number = self.chamber.len() as u32;
                self.chamber.push(own);
                self.counts.get_mut(own as usize).into_iter().for_each(|count| *count += 1);
            }
            self.of_point.push(*number);
        }
    }

    /// The share of the pressure of each piece, from its `sums`, which are set.
    pub(super) fn shares<R: Real>(
        &self,
        area: &[Row4<R>],
        sums: &mut Vec<AreaSums>,
    ) -> impl Iterator<Item = f64> {
        sums.clear();
        sums.resize(self.chamber.len(), AreaSums::default());
        for (&piece, area) in self.of_point.iter().zip(area) {
            sums[piece as usize].add(area);
        }
        let share = |(sums, &chamber): (&AreaSums, &u32)| match self.closed.get(chamber as usize) {
            Some(&closed) if closed > SHEET => (2.0 * sums.closed() / closed - 1.0).clamp(0.0, 1.0),
            _ => 1.0,
        };
        sums.iter().zip(&self.chamber).map(share)
    }

    /// The piece of a point.
    pub(super) fn of(&self, point: usize) -> Option<usize> {
        self.of_point.get(point).map(|&piece| piece as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn areas(vectors: &[[f64; 3]]) -> Vec<Row4<f64>> {
        vectors.iter().map(|&[x, y, z]| Row4([x, y, z, 0.0])).collect()
    }

    #[test]
    fn a_closed_piece_gets_all_of_the_pressure_an_open_one_a_share_and_a_scrap_none() {
        // Six points with the area vectors of an octahedron's corners, joined by triangles.
        let all = areas(&[
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ]);
        let shares = |triangles: &[[u32; 3]], clusters: &[u32]| {
            let mut pieces = Pieces::default();
            pieces.start(&[0; 6], &all, 1);
            pieces.find(10, &[0; 6], triangles.iter(), clusters);
            let shares: Vec<f64> = pieces.shares(&all, &mut Vec::new()).collect();
            (
                (0..6).map(|point| shares[pieces.of(point).expect("a piece")]).collect::<Vec<_>>(),
                pieces.is_one(0),
            )
        };
        assert_eq!(shares(&[[10, 11, 12], [13, 14, 15], [12, 13, 14]], &[]), (vec![1.0; 6], true));
        let (loose, is_one) = shares(&[[10, 11, 12], [13, 14, 15]], &[]);
        assert!(!is_one && loose.iter().all(|share| (share - 1.0 / 3.0).abs() < 1e-12), "{loose:?}");
        let (scraps, _) = shares(&[], &[]);
        assert_eq!(scraps, [0.0; 6]);
        // A weld joins the two halves again.
        let mut welds: Vec<u32> = (0..16).collect();
        welds[13] = 12;
        assert_eq!(shares(&[[10, 11, 12], [13, 14, 15]], &welds), (vec![1.0; 6], true));
        // So do two welds to one point of another cloth.
        (welds[12], welds[13]) = (4, 4);
        assert_eq!(shares(&[[10, 11, 12], [13, 14, 15]], &welds), (vec![1.0; 6], true));
    }
}
