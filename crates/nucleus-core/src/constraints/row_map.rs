//! Rows that get only a share of what a sweep does: cloth that is not as stiff everywhere.
//!
//! A sweep without compliance (Classic) takes away a share of the error, and a row takes its share of that. A sweep
//! with compliance (Physical) stands for a stiffness, so a row of half the stiffness has twice the compliance. Both
//! are the row's share of the resistance, and a row of no share is left alone.

use crate::math::{Lanes, Real};
use crate::model::Row;

use super::stretch::Sides;

/// What a sweep's strength comes to in four rows side by side.
pub trait Portion<R: Real>: Copy {
    /// Share and compliance, from those of the sweep; `c` says on which side of rest each row is.
    fn of(self, c: R::Lanes, share: R::Lanes, compliance: R::Lanes) -> (R::Lanes, R::Lanes);
}

/// All of it.
#[derive(Debug, Clone, Copy)]
pub struct Whole;

impl<R: Real> Portion<R> for Whole {
    #[inline(always)]
    fn of(self, _c: R::Lanes, share: R::Lanes, compliance: R::Lanes) -> (R::Lanes, R::Lanes) {
        (share, compliance)
    }
}

/// The shares of four rows side by side, 0 to 1.
#[derive(Debug, Clone, Copy)]
pub struct ShareGroup<R> {
    /// Of rows that are longer than at rest.
    pub above: [R; 4],
    /// Of rows that are shorter.
    pub below: [R; 4],
}

impl<R: Real> Portion<R> for &ShareGroup<R> {
    #[inline(always)]
    fn of(self, c: R::Lanes, share: R::Lanes, compliance: R::Lanes) -> (R::Lanes, R::Lanes) {
        let splat = R::Lanes::splat;
        let (zero, one, tiny) = (splat(R::ZERO), splat(R::ONE), splat(R::MIN_DENOMINATOR));
        let own = c.choose_by_sign(R::Lanes::from_array(self.above), R::Lanes::from_array(self.below));
        let some = own - tiny;
        let is_soft = compliance - tiny;
        let taken = is_soft.choose_by_sign(some.choose_by_sign(one, zero), own);
        (share * taken, compliance / some.choose_by_sign(own, one))
    }
}

/// The shares of a row, before they are laid out like the row itself.
#[derive(Debug, Clone, Copy)]
pub struct ShareRow<R, const N: usize> {
    points: [u32; N],
    share: Sides<R>,
}

impl<R: Real, const N: usize> ShareRow<R, N> {
    /// The shares of a row that joins these points.
    pub fn new(points: [u32; N], [above, below]: [f64; 2]) -> Self {
        Self { points, share: Sides { above: R::from_f64(above), below: R::from_f64(below) } }
    }
}

impl<R: Real, const N: usize> Row for ShareRow<R, N> {
    type Group = ShareGroup<R>;
    const POINTS: usize = N;

    fn point(&self, k: usize) -> u32 {
        self.points[k]
    }

    fn idle(stand_in: u32) -> Self {
        Self { points: [stand_in; N], share: Sides { above: R::ONE, below: R::ONE } }
    }

    fn group(rows: [Self; 4]) -> ShareGroup<R> {
        ShareGroup { above: rows.map(|row| row.share.above), below: rows.map(|row| row.share.below) }
    }
}
