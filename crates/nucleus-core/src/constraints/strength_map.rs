//! Vertex maps of stiffness, row by row: cloth that is not equally stiff everywhere.
//!
//! A map has a factor of 0 to 1 on the resistance of each row. A sweep without compliance (Classic) removes a share of
//! the error, and the factor scales that share. A sweep with compliance (Physical) stands for a stiffness, and the
//! factor divides the compliance: half the stiffness is twice the compliance. A row with the factor 0 is skipped.

use crate::math::{Lanes, Real};
use crate::model::rows::Row;

/// A value for rows longer (`above`) and one for rows shorter (`below`) than at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sides<T> {
    /// Longer than at rest.
    pub above: T,
    /// Shorter than at rest.
    pub below: T,
}

/// Scales the strength of a sweep for rows side by side.
pub trait StrengthMap<R: Real>: Copy {
    /// Share and compliance of the rows of the groups from `at` on, from those of the sweep; the sign of `c` says on which
    /// side of rest each row is.
    fn scale<L: Lanes<R>>(self, at: usize, c: L, share: L, compliance: L) -> (L, L);
}

/// No map: every row has the factor 1.
#[derive(Debug, Clone, Copy)]
pub struct Uniform;

impl<R: Real> StrengthMap<R> for Uniform {
    #[inline(always)]
    fn scale<L: Lanes<R>>(self, _at: usize, _c: L, share: L, compliance: L) -> (L, L) {
        (share, compliance)
    }
}

/// The factors of four rows side by side, 0 to 1.
#[derive(Debug, Clone, Copy)]
pub struct StrengthGroup<R> {
    /// For rows longer than at rest.
    pub above: [R; 4],
    /// For rows shorter than at rest.
    pub below: [R; 4],
}

/// One entry per group.
impl<R: Real> StrengthMap<R> for &[StrengthGroup<R>] {
    #[inline(always)]
    fn scale<L: Lanes<R>>(self, at: usize, c: L, share: L, compliance: L) -> (L, L) {
        let (zero, one, tiny) = (L::splat(R::ZERO), L::splat(R::ONE), L::splat(R::MIN_DENOMINATOR));
        let above = L::of_groups(|k| self[at + k].above);
        let own = c.choose_by_sign(above, L::of_groups(|k| self[at + k].below));
        let some = own - tiny;
        let is_soft = compliance - tiny;
        let taken = is_soft.choose_by_sign(some.choose_by_sign(one, zero), own);
        (share * taken, compliance / some.choose_by_sign(own, one))
    }
}

/// The factors of a row, before they are laid out like the row itself.
#[derive(Debug, Clone, Copy)]
pub struct StrengthRow<R, const N: usize> {
    points: [u32; N],
    factor: Sides<R>,
}

impl<R: Real, const N: usize> StrengthRow<R, N> {
    /// The factors of a row that joins these points, above and below its rest length.
    pub fn new(points: [u32; N], [above, below]: [f64; 2]) -> Self {
        Self { points, factor: Sides { above: R::from_f64(above), below: R::from_f64(below) } }
    }
}

impl<R: Real, const N: usize> Row for StrengthRow<R, N> {
    type Group = StrengthGroup<R>;
    const POINTS: usize = N;
    const GROUPS: usize = 2;

    fn point(&self, k: usize) -> u32 {
        self.points[k]
    }

    fn idle(padding_point: u32) -> Self {
        Self { points: [padding_point; N], factor: Sides { above: R::ONE, below: R::ONE } }
    }

    fn group(rows: [Self; 4]) -> StrengthGroup<R> {
        StrengthGroup { above: rows.map(|row| row.factor.above), below: rows.map(|row| row.factor.below) }
    }
}
