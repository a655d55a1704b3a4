//! Anchors in the solver's scalar, relative to a common origin: a contact's gap from them is computed in lanes, and is
//! exact within a tolerance. Nearly all contacts that a sweep visits exceed their thickness by more.

use crate::math::{Lanes, Real, Row4};
use crate::parallel::disjoint::DisjointSlice;

/// The anchor of each point in this frame.
#[derive(Debug, Default)]
pub struct LocalAnchors<R> {
    /// In metres from the origin; empty until the first search of a frame.
    rows: Vec<Row4<R>>,
    /// Error of a gap, in metres.
    tolerance: R,
}

/// The tolerance in rounding errors of the extent: 48 for the gap that a certificate needs, about 20 for that computed
/// here, and a margin.
const ROUNDINGS: f64 = 96.0;

/// An anchor relative to the origin, the anchor of the first point.
pub fn local_anchor<R: Real>(anchor: [f64; 3], origin: [f64; 3]) -> Row4<R> {
    Row4::new(std::array::from_fn(|axis| anchor[axis] - origin[axis]), R::ZERO)
}

impl<R: Real> LocalAnchors<R> {
    /// Makes all gaps unknown, before anchors move.
    pub fn clear(&mut self) {
        self.rows.clear();
    }

    /// Takes up the anchors of all points where they are unknown. Returns a view through which tasks set points of their own
    /// to [`local_anchor`].
    pub fn shared(&mut self, anchors: &[[f64; 3]]) -> DisjointSlice<'_, Row4<R>> {
        if self.rows.len() != anchors.len() {
            self.rows.clear();
            self.rows.extend(anchors.iter().map(|&anchor| local_anchor(anchor, anchors[0])));
        }
        DisjointSlice::new(&mut self.rows)
    }

    /// Sets the tolerance: no position is farther than `extent` metres from the origin on any axis.
    pub fn set_extent(&mut self, extent: f64) {
        self.tolerance = R::EPSILON * R::from_f64(ROUNDINGS * extent);
    }

    /// A lower bound on the gap of two elements along a direction, and on how far it exceeds rounding error, in metres. `row`
    /// gives the displacement of a point; `points` are `N` of one element and `M` of the other. `None` where anchors are
    /// unknown.
    #[inline(always)]
    pub fn min_gap<const N: usize, const M: usize>(
        &self,
        normal: [R; 3],
        points: [u32; 4],
        row: impl Fn(u32) -> Row4<R>,
    ) -> Option<R> {
        if self.rows.is_empty() {
            return None;
        }
        let mut lanes = [R::Lanes::splat(R::ZERO); 4];
        for k in 0..N + M {
            lanes[k] = self.rows[points[k] as usize].lanes() + row(points[k]).lanes();
        }
        let [x, y, z, _] = R::Lanes::transpose(lanes);
        let [nx, ny, nz] = normal.map(R::Lanes::splat);
        let heights = (x * nx + y * ny + z * nz).to_array();
        let (mut low, mut high) = (heights[0], heights[N]);
        for &height in &heights[1..N] {
            low = if height < low { height } else { low };
        }
        for &height in &heights[N + 1..N + M] {
            high = if height > high { height } else { high };
        }
        Some(low - high - self.tolerance)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn places() -> impl Strategy<Value = [[f64; 3]; 5]> {
        proptest::array::uniform5(proptest::array::uniform3(-1.0..1.0f64))
    }

    proptest! {
        #[test]
        fn a_fast_gap_is_below_the_exact_one_by_twice_the_tolerance_at_most(
            anchors in places(), moved in places(), normal in proptest::array::uniform3(-0.5..0.5f32),
        ) {
            let moved = moved.map(|place| Row4::<f32>::new(place, 1.0));
            let mut local = LocalAnchors::<f32>::default();
            prop_assert_eq!(local.min_gap::<1, 3>(normal, [0, 1, 2, 3], |point| moved[point as usize]), None);
            local.shared(&anchors);
            local.set_extent(3.0);
            let gap = local.min_gap::<1, 3>(normal, [1, 2, 3, 4], |point| moved[point as usize]).expect("anchors are known");
            let height = |point: usize| {
                (0..3).map(|axis| f64::from(normal[axis]) * (anchors[point][axis] + f64::from(moved[point].0[axis]))).sum::<f64>()
            };
            let exact = height(1) - height(2).max(height(3)).max(height(4));
            prop_assert!(f64::from(gap) < exact && f64::from(gap) > exact - 2.0 * f64::from(local.tolerance));
        }
    }
}
