//! Axis-aligned boxes, alone and by four.

use nalgebra::Vector3;

use crate::bytes::encode_struct;
use crate::math::{Lanes as _, Real};

/// An axis-aligned box in metres, relative to some origin. In single precision, rounded outwards; the fourth
/// number is always nought, so that a box is two aligned loads.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(16))]
pub struct Aabb {
    low: [f32; 4],
    high: [f32; 4],
}

impl Aabb {
    /// The box that holds nothing and meets nothing.
    pub const EMPTY: Self = Self {
        low: [f32::INFINITY, f32::INFINITY, f32::INFINITY, 0.0],
        high: [f32::NEG_INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY, 0.0],
    };

    /// A box by its corners, rounded outwards.
    pub fn new(low: Vector3<f64>, high: Vector3<f64>) -> Self {
        let down = |x: f64| (x - x.abs() * 1e-7) as f32;
        let up = |x: f64| (x + x.abs() * 1e-7) as f32;
        Self {
            low: [down(low.x), down(low.y), down(low.z), 0.0],
            high: [up(high.x), up(high.y), up(high.z), 0.0],
        }
    }

    /// The smallest box round some points, rounded outwards.
    pub fn of(points: impl Iterator<Item = Vector3<f64>>) -> Self {
        points.map(|point| Self::new(point, point)).fold(Self::EMPTY, Self::union)
    }

    /// The box round a ball.
    #[inline(always)]
    pub fn ball(centre: [f32; 3], radius: f32) -> Self {
        let [x, y, z] = centre;
        let low = [x - radius, y - radius, z - radius, 0.0];
        Self { low, high: [x + radius, y + radius, z + radius, 0.0] }
    }

    /// The smallest box round two.
    #[inline(always)]
    pub fn union(self, other: Self) -> Self {
        let low =
            std::array::from_fn(|k| if other.low[k] < self.low[k] { other.low[k] } else { self.low[k] });
        let high =
            std::array::from_fn(|k| if other.high[k] > self.high[k] { other.high[k] } else { self.high[k] });
        Self { low, high }
    }

    /// The box with `margin` added on every side.
    #[inline(always)]
    pub fn inflate(self, margin: f32) -> Self {
        let margin = [margin, margin, margin, 0.0];
        Self {
            low: std::array::from_fn(|k| self.low[k] - margin[k]),
            high: std::array::from_fn(|k| self.high[k] + margin[k]),
        }
    }

    /// Whether something that moves from one box to another, each of its points along a straight line, may
    /// meet something else that does. Boxes that are apart on one side all the time cannot.
    #[inline(always)]
    pub fn may_meet(ours: &[Self; 2], theirs: &[Self; 2]) -> bool {
        // All four numbers, though the last says nothing: four are compared at once.
        let mut apart = [false; 4];
        for (k, apart) in apart.iter_mut().enumerate() {
            let above = (ours[0].low[k] > theirs[0].high[k]) & (ours[1].low[k] > theirs[1].high[k]);
            let below = (ours[0].high[k] < theirs[0].low[k]) & (ours[1].high[k] < theirs[1].low[k]);
            *apart = above | below;
        }
        apart == [false; 4]
    }

    /// Whether two boxes have a point in common.
    #[inline(always)]
    pub fn meets(&self, other: &Self) -> bool {
        let mut overlaps = [false; 4];
        for (k, overlaps) in overlaps.iter_mut().enumerate() {
            *overlaps = (self.low[k] <= other.high[k]) & (other.low[k] <= self.high[k]);
        }
        overlaps == [true; 4]
    }
}

encode_struct!([] Aabb { low: [f32; 4], high: [f32; 4] });

/// A box at the start and at the end of a straight way.
pub type SweptBox = [Aabb; 2];

type Lanes = <f32 as Real>::Lanes;

/// Four boxes on their ways, side by side: one is tested against all of them at once.
#[derive(Debug, Clone, Copy)]
pub struct Four {
    /// Corners by end and axis.
    low: [[[f32; 4]; 3]; 2],
    high: [[[f32; 4]; 3]; 2],
}

impl Four {
    /// Four boxes.
    #[inline(always)]
    pub fn of([a, b, c, d]: &[SweptBox; 4]) -> Self {
        let axes = |a: [f32; 4], b: [f32; 4], c: [f32; 4], d: [f32; 4]| {
            let [x, y, z, _] = Lanes::transpose([a, b, c, d].map(Lanes::from_array));
            [x.to_array(), y.to_array(), z.to_array()]
        };
        Self {
            low: [0, 1].map(|end| axes(a[end].low, b[end].low, c[end].low, d[end].low)),
            high: [0, 1].map(|end| axes(a[end].high, b[end].high, c[end].high, d[end].high)),
        }
    }

    /// Which of the four something may meet that moves from one box to another, as [`Aabb::may_meet`] says; a bit for
    /// each.
    #[inline(always)]
    pub fn met_by(&self, ours: &SweptBox) -> u32 {
        let mut gap = Lanes::splat(f32::NEG_INFINITY);
        for axis in 0..3 {
            let [low, high] = [ours.map(|one| one.low[axis]), ours.map(|one| one.high[axis])];
            let above = |end: usize| Lanes::splat(low[end]) - Lanes::from_array(self.high[end][axis]);
            let below = |end: usize| Lanes::from_array(self.low[end][axis]) - Lanes::splat(high[end]);
            gap = gap.most(above(0).least(above(1))).most(below(0).least(below(1)));
        }
        !gap.above_zero() & 0b1111
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ways() -> impl Strategy<Value = SweptBox> {
        let corner = || proptest::array::uniform3(-2.0..2.0f64).prop_map(Vector3::from);
        let one = (corner(), corner()).prop_map(|(a, b)| Aabb::new(a.inf(&b), a.sup(&b)));
        proptest::array::uniform2(one)
    }

    proptest! {
        #[test]
        fn four_at_once_are_met_as_each_alone(ours in ways(), theirs in proptest::array::uniform4(ways())) {
            let alone = (0..).zip(&theirs).map(|(lane, boxes)| u32::from(Aabb::may_meet(&ours, boxes)) << lane);
            prop_assert_eq!(Four::of(&theirs).met_by(&ours), alone.sum::<u32>());
        }
    }
}
