//! The bounding tree of an object: boxes over its elements through space and time.
//!
//! Built once, by halving the triangles across their longest side, four to a leaf; a moving collider is only
//! refitted. Nodes stand in heap order: the children of node k are 2k + 1 and 2k + 2.

use nalgebra::Vector3;

use super::aabb::Aabb;
use crate::bytes::checkpoint_struct;
use crate::model::by_halves;

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

checkpoint_struct!([] Tree { columns: [triangles], values: [], parts: [], rebuilt: [nodes, leaves] });

impl Tree {
    /// A tree over triangles with these centres. The boxes are empty until [`Tree::refit`].
    pub fn new(centres: &[Vector3<f64>]) -> Self {
        let triangles = by_halves(centres, LEAF);
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
