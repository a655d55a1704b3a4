//! The bounding tree of a collider: boxes over its triangles through space and time.
//!
//! Built once, by sorting the triangles along a Morton curve, four to a leaf; a moving collider is only
//! refitted. Nodes stand in heap order: the children of node k are 2k + 1 and 2k + 2.

use nalgebra::Vector3;

use crate::checkpoint::{item, kept};
use crate::model::Order;

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

/// Triangles to a leaf.
const LEAF: usize = 4;

/// Boxes over triangles.
#[derive(Debug, Clone)]
pub struct Tree {
    /// Triangles in the order of the leaves.
    triangles: Vec<u32>,
    /// Boxes in heap order; leaves last.
    nodes: Vec<Aabb>,
    leaves: usize,
}

item!([] Aabb { low: [f32; 4], high: [f32; 4] });

kept!([] Tree { columns: [triangles], values: [], parts: [], anew: [nodes, leaves] });

impl Tree {
    /// A tree over triangles with these centres. The boxes are empty until [`Tree::refit`].
    pub fn new(centres: &[Vector3<f64>]) -> Self {
        let order = Order::morton(centres);
        let triangles: Vec<u32> = (0..order.len()).map(|place| order.user(place) as u32).collect();
        let leaves = triangles.len().div_ceil(LEAF).next_power_of_two();
        Self { triangles, nodes: vec![Aabb::EMPTY; 2 * leaves - 1], leaves }
    }

    /// Whether each of so many triangles is in it once.
    pub fn is_over(&self, triangles: usize) -> bool {
        let mut seen = vec![false; triangles];
        let is_new = |triangle: &u32| {
            seen.get_mut(*triangle as usize).is_some_and(|seen| !std::mem::replace(seen, true))
        };
        self.triangles.len() == triangles && self.triangles.iter().all(is_new)
    }

    /// Sets every box from the boxes of the triangles.
    pub fn refit(&mut self, of: impl Fn(usize) -> Aabb) {
        for (leaf, triangles) in self.triangles.chunks(LEAF).enumerate() {
            let all = triangles.iter().map(|&triangle| of(triangle as usize));
            self.nodes[self.leaves - 1 + leaf] = all.fold(Aabb::EMPTY, Aabb::union);
        }
        for node in (0..self.leaves - 1).rev() {
            self.nodes[node] = self.nodes[2 * node + 1].union(self.nodes[2 * node + 2]);
        }
    }

    /// Calls `found` with each triangle whose leaf meets the box, in an order that depends on the tree alone.
    pub fn query(&self, sought: &Aabb, mut found: impl FnMut(u32)) {
        // Deeper than any tree can be: a level per bit of the number of leaves.
        let mut stack = [0usize; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let node = stack[depth];
            if !self.nodes[node].meets(sought) {
                continue;
            }
            if node >= self.leaves - 1 {
                let leaf = node - (self.leaves - 1);
                let end = ((leaf + 1) * LEAF).min(self.triangles.len());
                self.triangles[leaf * LEAF..end].iter().for_each(|&triangle| found(triangle));
            } else {
                stack[depth] = 2 * node + 2;
                stack[depth + 1] = 2 * node + 1;
                depth += 2;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<[Vector3<f64>; 2]>> {
        let corner = || proptest::array::uniform3(-5.0..5.0f64).prop_map(Vector3::from);
        let size = || proptest::array::uniform3(0.0..0.5f64).prop_map(Vector3::from);
        proptest::collection::vec((corner(), size()).prop_map(|(low, size)| [low, low + size]), 1..100)
    }

    proptest! {
        // EVIDENCE: N2.4-1  the tree finds what trying every pair finds
        #[test]
        fn the_tree_finds_every_box_that_meets(corners in boxes(), sought in 0usize..100) {
            let boxes: Vec<Aabb> = corners.iter().map(|&[low, high]| Aabb::new(low, high)).collect();
            let mut tree = Tree::new(&corners.iter().map(|[low, high]| (low + high) / 2.0).collect::<Vec<_>>());
            tree.refit(|triangle| boxes[triangle]);
            let [low, high] = corners[sought % corners.len()];
            let mut found = Vec::new();
            tree.query(&Aabb::new(low, high).inflate(0.5), |triangle| found.push(triangle));
            let meets = |[l, h]: &[Vector3<f64>; 2]| (0..3).all(|k| l[k] <= high[k] + 0.5 && low[k] - 0.5 <= h[k]);
            let all = (0..corners.len()).filter(|&k| meets(&corners[k]));
            prop_assert!(all.into_iter().all(|k| found.contains(&(k as u32))));
        }
    }
}
