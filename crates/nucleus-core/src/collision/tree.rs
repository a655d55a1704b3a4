//! The bounding tree of a collider: boxes over its triangles through space and time.
//!
//! Built once, by sorting the triangles along a Morton curve, four to a leaf; a moving collider is only
//! refitted. Nodes stand in heap order: the children of node k are 2k + 1 and 2k + 2.

use nalgebra::Vector3;

use crate::model::Order;

/// An axis-aligned box in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub low: Vector3<f64>,
    /// The corner with the largest coordinates.
    pub high: Vector3<f64>,
}

impl Aabb {
    /// The box that holds nothing and meets nothing.
    pub const EMPTY: Self = Self {
        low: Vector3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        high: Vector3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The smallest box round some points.
    pub fn of(points: impl IntoIterator<Item = Vector3<f64>>) -> Self {
        points.into_iter().fold(Self::EMPTY, |all, p| Self { low: all.low.inf(&p), high: all.high.sup(&p) })
    }

    /// The smallest box round two.
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// The box with `margin` added on every side.
    pub fn inflate(self, margin: f64) -> Self {
        Self { low: self.low.add_scalar(-margin), high: self.high.add_scalar(margin) }
    }

    /// Whether two boxes have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
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

impl Tree {
    /// A tree over triangles with these centres. The boxes are empty until [`Tree::refit`].
    pub fn new(centres: &[Vector3<f64>]) -> Self {
        let order = Order::morton(centres);
        let triangles: Vec<u32> = (0..order.len()).map(|place| order.user(place) as u32).collect();
        let leaves = triangles.len().div_ceil(LEAF).next_power_of_two();
        Self { triangles, nodes: vec![Aabb::EMPTY; 2 * leaves - 1], leaves }
    }

    /// Sets every box from the boxes of the triangles.
    pub fn refit(&mut self, triangle_box: impl Fn(u32) -> Aabb) {
        for (leaf, triangles) in self.triangles.chunks(LEAF).enumerate() {
            let all = triangles.iter().fold(Aabb::EMPTY, |all, &triangle| all.union(triangle_box(triangle)));
            self.nodes[self.leaves - 1 + leaf] = all;
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

    fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
        let corner = || proptest::array::uniform3(-5.0..5.0f64).prop_map(Vector3::from);
        proptest::collection::vec(
            (corner(), corner()).prop_map(|(a, b)| Aabb::of([a, a + (b - a) * 0.1])),
            1..100,
        )
    }

    proptest! {
        // EVIDENCE: N2.4-1  the tree finds what trying every pair finds
        #[test]
        fn the_tree_finds_every_box_that_meets(boxes in boxes(), sought in 0usize..100) {
            let mut tree = Tree::new(&boxes.iter().map(|b| (b.low + b.high) / 2.0).collect::<Vec<_>>());
            tree.refit(|triangle| boxes[triangle as usize]);
            let sought = boxes[sought % boxes.len()].inflate(0.5);
            let mut found = Vec::new();
            tree.query(&sought, |triangle| found.push(triangle));
            let all = (0..boxes.len() as u32).filter(|&k| boxes[k as usize].meets(&sought));
            prop_assert!(all.into_iter().all(|k| found.contains(&k)));
        }
    }
}
