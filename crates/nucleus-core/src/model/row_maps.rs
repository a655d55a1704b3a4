//! What the rows of a cloth get of a sweep's strength, laid out like the rows themselves.

use std::ops::Range;

use crate::constraints::hinge::HingeRow;
use crate::constraints::row_map::{ShareGroup, ShareRow};
use crate::constraints::stretch::LinkRow;
use crate::integrate::aerodynamics::AirFactors;
use crate::math::Real;
use crate::model::vertex_maps::{VertexMaps, mean, mean_share};

use super::rows::{Blocks, Row, RowList};

/// Shares of the lists of a cloth; empty where every row gets all.
#[derive(Debug, Clone)]
pub struct Shares<R> {
    /// Of links, longer and shorter than at rest.
    pub stretch: RowList<ShareGroup<R>>,
    /// Of hinges of four points.
    pub bend: RowList<ShareGroup<R>>,
    /// Of hinges of six points.
    pub fold: RowList<ShareGroup<R>>,
    /// Factors on the damping along links; both sides are the same.
    pub damp: RowList<ShareGroup<R>>,
}

impl<R> Default for Shares<R> {
    fn default() -> Self {
        let none = RowList::default;
        Self { stretch: none(), bend: none(), fold: none(), damp: none() }
    }
}

impl<R> Shares<R> {
    /// How many rows have one.
    pub fn len(&self) -> usize {
        [&self.stretch, &self.bend, &self.fold, &self.damp].iter().map(|list| list.len()).sum()
    }
}

/// The factors of a cloth, and which of the user's points is at a place of the columns.
pub struct Factors<'a> {
    /// By the user's points.
    pub factors: &'a VertexMaps,
    /// The user's point at a place.
    pub point: &'a dyn Fn(u32) -> usize,
}

impl Factors<'_> {
    /// Shares of links.
    pub fn of_links<R: Real>(&self, rows: &[LinkRow<R>], blocks: &Blocks) -> RowList<ShareGroup<R>> {
        let [above, below] = [&self.factors.stretch, &self.factors.compression];
        if above.is_empty() && below.is_empty() {
            return RowList::default();
        }
        let share =
            |row: &LinkRow<R>| ShareRow::new(row.ends, [above, below].map(|c| self.share(c, row.ends)));
        RowList::new(&rows.iter().map(share).collect::<Vec<_>>(), blocks)
    }

    /// Factors on the damping along links.
    pub fn of_damping<R: Real>(&self, rows: &[LinkRow<R>], blocks: &Blocks) -> RowList<ShareGroup<R>> {
        let damp = &self.factors.damp;
        if damp.is_empty() {
            return RowList::default();
        }
        let factor = |row: &LinkRow<R>| mean(damp, row.ends.map(|end| (self.point)(end)).into_iter());
        let row = |row: &LinkRow<R>| ShareRow::new(row.ends, [factor(row); 2]);
        RowList::new(&rows.iter().map(row).collect::<Vec<_>>(), blocks)
    }

    /// Shares of hinges.
    pub fn of_hinges<R: Real, const N: usize>(
        &self,
        rows: &[HingeRow<R, N>],
        blocks: &Blocks,
    ) -> RowList<ShareGroup<R>> {
        let bend = &self.factors.bend;
        if bend.is_empty() {
            return RowList::default();
        }
        let row = |row: &HingeRow<R, N>| {
            let points: [u32; N] = std::array::from_fn(|k| row.point(k));
            ShareRow::new(points, [self.share(bend, points); 2])
        };
        RowList::new(&rows.iter().map(row).collect::<Vec<_>>(), blocks)
    }

    /// Factors on the air at each place. What is heavier is less moved by it.
    pub fn of_air(&self, places: Range<u32>) -> Vec<AirFactors> {
        let VertexMaps { mass, drag, tangential_drag, lift, .. } = self.factors;
        if [mass, drag, tangential_drag, lift].iter().all(|column| column.is_empty()) {
            return Vec::new();
        }
        let at = |column: &[f64], point: usize| column.get(point).copied().unwrap_or(1.0);
        let factors = |point: usize| AirFactors {
            drag: at(drag, point) / at(mass, point),
            tangential_drag: at(tangential_drag, point),
            lift: at(lift, point) / at(mass, point),
        };
        places.map(|place| factors((self.point)(place))).collect()
    }

    fn share<const N: usize>(&self, column: &[f64], places: [u32; N]) -> f64 {
        mean_share(column, places.map(|place| (self.point)(place)).into_iter())
    }
}
