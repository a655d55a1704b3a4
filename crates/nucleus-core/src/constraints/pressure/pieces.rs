//! The pieces of a mesh that tears: pressure pushes a piece as far as it is closed.
//!
//! The area vectors of a closed surface add up to zero, those of a flat piece to its whole area. What is left of
//! 1 - |Σ a| / Σ |a|, in relation to that of the mesh at the start, is the share of the pressure that a piece gets: a scrap in
//! open air has the same pressure on both sides.

use nalgebra::Vector3;

use crate::math::{Real, Row4};
use crate::union_find::UnionFind;

/// Which piece each point of a cloth is in; empty where the mesh cannot tear.
#[derive(Debug, Clone, Default)]
pub(super) struct Pieces {
    /// By point, from the first row of the cloth on.
    of_point: Vec<u32>,
    /// The chamber of each piece, from the first of the cloth on.
    chamber: Vec<u32>,
    /// By chamber: how closed it is at the start.
    closed: Vec<f64>,
}

/// Sums of the area vectors, and of their lengths.
#[derive(Clone, Copy, Default)]
struct AreaSums {
    vectors: Vector3<f64>,
    lengths: f64,
}

impl AreaSums {
    fn add<R: Real>(&mut self, area: &Row4<R>) {
        let area = Vector3::from(area.xyz().map(R::to_f64));
        self.vectors += area;
        self.lengths += area.norm();
    }

    /// 1 for a closed surface, 0 for a flat one.
    fn closed(&self) -> f64 {
        if self.lengths > 0.0 { (1.0 - self.vectors.norm() / self.lengths).max(0.0) } else { 0.0 }
    }
}

/// A mesh that is less closed than this at the start is a sheet, and every piece of it gets all of the pressure.
const SHEET: f64 = 1e-3;

impl Pieces {
    pub(super) fn is_empty(&self) -> bool {
        self.of_point.is_empty()
    }

    /// Whether a chamber is in one piece.
    pub(super) fn is_one(&self, chamber: usize) -> bool {
        self.is_empty() || self.chamber.iter().filter(|&&own| own as usize == chamber).count() == 1
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
        for (row, &welded) in clusters.iter().enumerate().skip(first as usize).take(chamber.len()) {
            // A weld to another cloth joins no pieces of this one.
            if welded >= first && ((welded - first) as usize) < chamber.len() {
                sets.union(at(row as u32), at(welded));
            }
        }
        let mut numbers = vec![u32::MAX; chamber.len()];
        self.chamber.clear();
        self.of_point.clear();
        for (point, &own) in (0..).zip(chamber) {
            let number = &mut numbers[sets.find(point) as usize];
            if *number == u32::MAX {
                *number = self.chamber.len() as u32;
                self.chamber.push(own);
            }
            self.of_point.push(*number);
        }
    }

    /// The share of the pressure of each piece.
    pub(super) fn shares<R: Real>(&self, area: &[Row4<R>]) -> Vec<f64> {
        let mut sums = vec![AreaSums::default(); self.chamber.len()];
        for (&piece, area) in self.of_point.iter().zip(area) {
            sums[piece as usize].add(area);
        }
        let share = |(sums, &chamber): (&AreaSums, &u32)| match self.closed.get(chamber as usize) {
            Some(&closed) if closed > SHEET => (sums.closed() / closed).min(1.0),
            _ => 1.0,
        };
        sums.iter().zip(&self.chamber).map(share).collect()
    }

    /// The piece of a point.
    pub(super) fn of(&self, point: usize) -> Option<usize> {
        self.of_point.get(point).map(|&piece| piece as usize)
    }
}
