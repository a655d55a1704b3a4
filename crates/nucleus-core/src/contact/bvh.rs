//! Axis-aligned boxes, and a bounding volume hierarchy over them.
//!
//! The hierarchy is built once, by splitting the elements at the median along their longest side, four to a leaf.
//! A moving object only refits it. Nodes stand in heap order: the children of node k are 2k + 1 and 2k + 2.

use std::cell::Cell;

use nalgebra::Vector3;

use crate::bytes::{checkpoint_struct, encode_struct};
use crate::model::order::by_halves;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// An axis-aligned box in metres, relative to an origin of the caller. In single precision, rounded outwards. The
/// fourth number is always zero, so that a box is two aligned loads.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(16))]
pub struct Aabb {
    low: [f32; 4],
    high: [f32; 4],
}

impl Aabb {
    /// The empty box, which overlaps nothing.
    pub const EMPTY: Self = Self {
        low: [f32::INFINITY, f32::INFINITY, f32::INFINITY, 0.0],
        high: [f32::NEG_INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY, 0.0],
    };

    /// The box between two corners, rounded outwards.
    pub fn new(low: Vector3<f64>, high: Vector3<f64>) -> Self {
        let down = |x: f64| (x - x.abs() * 1e-7) as f32;
        let up = |x: f64| (x + x.abs() * 1e-7) as f32;
        Self {
            low: [down(low.x), down(low.y), down(low.z), 0.0],
            high: [up(high.x), up(high.y), up(high.z), 0.0],
        }
    }

    /// The smallest box around some points, rounded outwards.
    pub fn of(points: impl Iterator<Item = Vector3<f64>>) -> Self {
        points.map(|point| Self::new(point, point)).fold(Self::EMPTY, Self::union)
    }

    /// The box around a ball.
    #[inline(always)]
    pub fn ball(centre: [f32; 3], radius: f32) -> Self {
        let [x, y, z] = centre;
        let low = [x - radius, y - radius, z - radius, 0.0];
        Self { low, high: [x + radius, y + radius, z + radius, 0.0] }
    }

    /// The smallest box around two.
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

    /// The box moved by a vector in metres, without care for rounding.
    #[inline(always)]
    pub fn translate(self, [x, y, z]: [f32; 3]) -> Self {
        let by = [x, y, z, 0.0];
        Self {
            low: std::array::from_fn(|k| self.low[k] + by[k]),
            high: std::array::from_fn(|k| self.high[k] + by[k]),
        }
    }

    /// Whether two moving elements may overlap, each given by its boxes at the start and at the end of linear
    /// motion. Boxes that are separated along one axis at both ends are separated throughout.
    #[inline(always)]
    pub fn may_overlap(ours: &[Self; 2], theirs: &[Self; 2]) -> bool {
        // Compares all four numbers, so that the comparison vectorises; the last is always equal.
        let mut apart = [false; 4];
        for (k, apart) in apart.iter_mut().enumerate() {
            let above = (ours[0].low[k] > theirs[0].high[k]) & (ours[1].low[k] > theirs[1].high[k]);
            let below = (ours[0].high[k] < theirs[0].low[k]) & (ours[1].high[k] < theirs[1].low[k]);
            *apart = above | below;
        }
        apart == [false; 4]
    }

    /// The low and the high corner; the fourth number is zero.
    #[inline(always)]
    pub fn corners(&self) -> [[f32; 4]; 2] {
        [self.low, self.high]
    }

    /// The squared distance of a place from the box in m²; infinite for the empty box.
    pub fn squared_distance(&self, place: Vector3<f64>) -> f64 {
        let outside = |k: usize| {
            let (below, above) = (f64::from(self.low[k]) - place[k], place[k] - f64::from(self.high[k]));
            below.max(above).max(0.0)
        };
        let [x, y, z] = [outside(0), outside(1), outside(2)];
        x * x + y * y + z * z
    }

    /// Whether two boxes have a point in common.
    #[inline(always)]
    pub fn overlaps(&self, other: &Self) -> bool {
        let mut overlaps = [false; 4];
        for (k, overlaps) in overlaps.iter_mut().enumerate() {
            *overlaps = (self.low[k] <= other.high[k]) & (other.low[k] <= self.high[k]);
        }
        overlaps == [true; 4]
    }
}

encode_struct!([] Aabb { low: [f32; 4], high: [f32; 4] });

/// Parallel rays of one length that start in a box.
#[derive(Debug, Clone, Copy)]
pub struct RayBundle {
    low: Vector3<f64>,
    high: Vector3<f64>,
    /// One over the ray; infinite along an axis that it does not move along.
    inverse: Vector3<f64>,
}

impl RayBundle {
    /// The rays from the box between two corners.
    pub fn new([low, high]: [Vector3<f64>; 2], ray: Vector3<f64>) -> Self {
        Self { low, high, inverse: ray.map(|x| 1.0 / x) }
    }

    /// A lower bound of the share of its length after which a ray of the bundle is in a box: the slab test of a single ray
    /// (Kay and Kajiya 1986) with the box enlarged by that of the origins. Infinite where all rays miss it.
    pub fn entry(&self, bounds: &Aabb) -> f64 {
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for k in 0..3 {
            let low = f64::from(bounds.low[k]) - self.high[k];
            let high = f64::from(bounds.high[k]) - self.low[k];
            if low > high {
                return f64::INFINITY; // the empty box
            }
            if self.inverse[k].is_infinite() {
                if low > 0.0 || high < 0.0 {
                    return f64::INFINITY;
                }
            } else {
                let [a, b] = [low * self.inverse[k], high * self.inverse[k]];
                (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
            }
        }
        // Both are rounded; the margin is that of a ray through the corner of a box.
        if first <= last + 1e-12 { first } else { f64::INFINITY }
    }
}

/// The boxes of an element at the start and at the end of linear motion.
pub type SweptBox = [Aabb; 2];

/// Elements to a leaf.
const LEAF_SIZE: usize = 4;

/// Leaves of a task, a power of two.
const LEAVES_PER_TASK: usize = 128;

/// A bounding volume hierarchy over triangles, or over groups of elements.
#[derive(Debug, Clone)]
pub struct Bvh {
    /// Elements in the order of the leaves.
    triangles: Vec<u32>,
    /// Boxes in heap order; leaves last.
    nodes: Vec<Aabb>,
    leaves: usize,
}

checkpoint_struct!([] Bvh { columns: [triangles], values: [], parts: [], rebuilt: [nodes, leaves] });

impl Bvh {
    /// A hierarchy over elements with these centres. The boxes are empty until [`Bvh::refit`].
    pub fn new(centres: &[Vector3<f64>]) -> Self {
        let triangles = by_halves(centres, LEAF_SIZE);
        let leaves = triangles.len().div_ceil(LEAF_SIZE).next_power_of_two();
        Self { triangles, nodes: vec![Aabb::EMPTY; 2 * leaves - 1], leaves }
    }

    /// A hierarchy over elements of which those with close indices are close in space.
    pub fn in_order(count: usize) -> Self {
        let leaves = count.div_ceil(LEAF_SIZE).next_power_of_two();
        Self { triangles: (0..count as u32).collect(), nodes: vec![Aabb::EMPTY; 2 * leaves - 1], leaves }
    }

    /// Whether it holds each of `triangles` elements exactly once.
    pub fn covers(&self, triangles: usize) -> bool {
        let mut seen = vec![false; triangles];
        let is_new = |triangle: &u32| {
            seen.get_mut(*triangle as usize).is_some_and(|seen| !std::mem::replace(seen, true))
        };
        self.triangles.len() == triangles && self.triangles.iter().all(is_new)
    }

    /// Sets every box from the boxes of the elements.
    pub fn refit(&mut self, bounds: impl Fn(usize) -> Aabb) {
        let Self { triangles, nodes, leaves } = self;
        let (inner, leaf_nodes) = nodes.split_at_mut(*leaves - 1);
        let leaf_of = |own: &[u32]| {
            own.iter().map(|&triangle| bounds(triangle as usize)).fold(Aabb::EMPTY, Aabb::union)
        };
        leaf_nodes.iter_mut().zip(triangles.chunks(LEAF_SIZE)).for_each(|(node, own)| *node = leaf_of(own));
        for node in (0..inner.len()).rev() {
            nodes[node] = nodes[2 * node + 1].union(nodes[2 * node + 2]);
        }
    }

    /// The same, a task for each of the lower subtrees.
    pub fn refit_in_tasks(&mut self, bounds: impl Fn(usize) -> Aabb + Sync, pool: &ThreadPool) {
        let Self { triangles, nodes, leaves } = self;
        // Both are powers of two.
        let subtrees = (*leaves / LEAVES_PER_TASK).max(1);
        let span = *leaves / subtrees;
        let shared = DisjointSlice::new(nodes);
        pool.parallel_for(subtrees, |task| {
            // SAFETY: subtrees share no node, and children are set before their parents.
            #[allow(unsafe_code)]
            let (get, set) = (
                |node: usize| unsafe { shared.get(node as u32) },
                |node: usize, bounds| unsafe {
                    shared.set(node as u32, bounds);
                },
            );
            for leaf in task * span..(task + 1) * span {
                let own = triangles.chunks(LEAF_SIZE).nth(leaf).unwrap_or_default();
                let all = own.iter().map(|&triangle| bounds(triangle as usize));
                set(*leaves - 1 + leaf, all.fold(Aabb::EMPTY, Aabb::union));
            }
            let (mut first, mut count) = (*leaves - 1 + task * span, span);
            while count > 1 {
                (first, count) = ((first - 1) / 2, count / 2);
                (first..first + count).for_each(|node| set(node, get(2 * node + 1).union(get(2 * node + 2))));
            }
        });
        for node in (0..subtrees - 1).rev() {
            nodes[node] = nodes[2 * node + 1].union(nodes[2 * node + 2]);
        }
    }

    /// The box around all elements.
    pub fn bounds(&self) -> Aabb {
        self.nodes[0]
    }

    /// Calls `found` with each element whose leaf overlaps the box, in an order that depends on the hierarchy
    /// alone.
    pub fn query(&self, target: &Aabb, found: impl FnMut(u32)) {
        self.descend(|bounds| bounds.overlaps(target), found);
    }

    /// Calls `found` with each target and each element whose leaf overlaps it. The elements of a target come in the order of
    /// [`query`](Self::query). All targets go down the hierarchy together, so that each of its boxes is read once; `lists`
    /// is scratch memory.
    pub fn query_all(&self, targets: &[Aabb], lists: &mut Vec<u32>, mut found: impl FnMut(u32, u32)) {
        lists.clear();
        lists.extend(0..targets.len() as u32);
        // A node, and the places in `lists` of the targets that overlap its parent: those of a child follow them.
        let mut stack = [(0usize, [0usize; 2]); 64];
        stack[0] = (0, [0, targets.len()]);
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (node, [first, end]) = stack[depth];
            let last = self.overlapping(node, targets, lists, [first, end]);
            if end == last {
                continue;
            }
            if node >= self.leaves - 1 {
                let own = self.leaf(node);
                lists[end..last].iter().for_each(|&target| own.iter().for_each(|&at| found(target, at)));
            } else {
                stack[depth] = (2 * node + 2, [end, last]);
                stack[depth + 1] = (2 * node + 1, [end, last]);
                depth += 2;
            }
        }
    }

    /// Lists the targets at some places of `lists` that overlap a node, from the end of these places on. Returns the end.
    fn overlapping(
        &self,
        node: usize,
        targets: &[Aabb],
        lists: &mut Vec<u32>,
        [first, end]: [usize; 2],
    ) -> usize {
        let bounds = self.nodes[node];
        lists.resize(lists.len().max(2 * end - first), 0);
        let (parents, own) = lists.split_at_mut(end);
        let mut count = 0;
        for &target in &parents[first..] {
            own[count] = target;
            count += usize::from(bounds.overlaps(&targets[target as usize]));
        }
        end + count
    }

    /// The elements of a leaf. One of padding has none; a query that is not a number meets it all the same.
    fn leaf(&self, node: usize) -> &[u32] {
        let leaf = node - (self.leaves - 1);
        let [start, end] = [leaf, leaf + 1].map(|leaf| (leaf * LEAF_SIZE).min(self.triangles.len()));
        &self.triangles[start..end]
    }

    /// Calls `found` with each element of the leaves that `reaches` does not exclude, itself or by a box around it.
    pub fn descend(&self, reaches: impl Fn(&Aabb) -> bool, mut found: impl FnMut(u32)) {
        // Deeper than any hierarchy: one level for each bit of the number of leaves.
        let mut stack = [0usize; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let node = stack[depth];
            if !reaches(&self.nodes[node]) {
                continue;
            }
            if node >= self.leaves - 1 {
                self.leaf(node).iter().for_each(|&triangle| found(triangle));
            } else {
                stack[depth] = 2 * node + 2;
                stack[depth + 1] = 2 * node + 1;
                depth += 2;
            }
        }
    }

    /// Calls `found` with each element of the leaves that `bound` puts within `limit`, the nearer child of a node first.
    /// `found` may lower the limit. The bound of a box is at most that of any box inside.
    pub fn descend_by(&self, bound: impl Fn(&Aabb) -> f64, limit: &Cell<f64>, mut found: impl FnMut(u32)) {
        let mut stack = [(0usize, 0.0f64); 64];
        stack[0].1 = bound(&self.nodes[0]);
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (node, own) = stack[depth];
            if own > limit.get() || own.is_nan() {
                continue;
            }
            if node >= self.leaves - 1 {
                self.leaf(node).iter().for_each(|&triangle| found(triangle));
                continue;
            }
            let [left, right] = [2 * node + 1, 2 * node + 2].map(|child| (child, bound(&self.nodes[child])));
            let (nearer, farther) = if left.1 <= right.1 { (left, right) } else { (right, left) };
            (stack[depth], stack[depth + 1]) = (farther, nearer);
            depth += 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn boxes() -> impl Strategy<Value = Vec<[Vector3<f64>; 2]>> {
        let corner = || proptest::array::uniform3(-5.0..5.0f64).prop_map(Vector3::from);
        let size = || proptest::array::uniform3(0.0..0.5f64).prop_map(Vector3::from);
        proptest::collection::vec((corner(), size()).prop_map(|(low, size)| [low, low + size]), 1..100)
    }

    proptest! {
        #[test]
        fn rays_enter_a_box_no_later_than_at_one_of_its_points(corners in boxes(), target in 0usize..100, at in 0.0..1.0f64) {
            let [low, high] = corners[target % corners.len()];
            let bounds = Aabb::new(low, high);
            let (origins, through) = (corners[0], low + (high - low) * at);
            let ray = through - origins[1];
            let one = RayBundle::new([origins[1]; 2], ray);
            prop_assert!(one.entry(&Aabb::EMPTY) == f64::INFINITY);
            // The last one ends at a point of the box; all of the bundle start no farther from it than their own box reaches.
            prop_assert!(one.entry(&bounds) <= 1.0 && RayBundle::new(origins, ray).entry(&bounds) <= one.entry(&bounds));
            // A box that lies wholly behind a plane across the ray is not entered before it.
            let nearest = (0..8).map(|k| ray.dot(&(Vector3::from_fn(|axis, _| if k >> axis & 1 == 0 { low } else { high }[axis]) - origins[1])));
            let share = nearest.fold(f64::INFINITY, f64::min) / ray.norm_squared();
            if share > 0.01 {
                prop_assert!(RayBundle::new([origins[1]; 2], ray * (0.99 * share)).entry(&bounds) == f64::INFINITY);
                prop_assert!(RayBundle::new([origins[1]; 2], -ray).entry(&bounds) == f64::INFINITY);
            }
        }

        #[test]
        fn the_nearest_element_is_found_in_boxes_ordered_by_distance(corners in boxes(), place in proptest::array::uniform3(-7.0..7.0f64)) {
            let place = Vector3::from(place);
            let boxes: Vec<Aabb> = corners.iter().map(|&[low, high]| Aabb::new(low, high)).collect();
            let mut bvh = Bvh::new(&corners.iter().map(|[low, high]| (low + high) / 2.0).collect::<Vec<_>>());
            bvh.refit(|at| boxes[at]);
            let distance = |at: usize| boxes[at].squared_distance(place);
            let limit = Cell::new(f64::INFINITY);
            bvh.descend_by(|bounds| bounds.squared_distance(place), &limit, |at| limit.set(limit.get().min(distance(at as usize))));
            prop_assert_eq!(limit.get(), (0..boxes.len()).map(distance).fold(f64::INFINITY, f64::min));
        }

        #[test]
        fn the_hierarchy_finds_every_box_that_overlaps(corners in boxes(), target in 0usize..100) {
            let boxes: Vec<Aabb> = corners.iter().map(|&[low, high]| Aabb::new(low, high)).collect();
            let mut bvh = Bvh::new(&corners.iter().map(|[low, high]| (low + high) / 2.0).collect::<Vec<_>>());
            bvh.refit(|triangle| boxes[triangle]);
            let [low, high] = corners[target % corners.len()];
            let mut found = Vec::new();
            bvh.query(&Aabb::new(low, high).inflate(0.5), |triangle| found.push(triangle));
            let meets = |[l, h]: &[Vector3<f64>; 2]| (0..3).all(|k| l[k] <= high[k] + 0.5 && low[k] - 0.5 <= h[k]);
            let all = (0..corners.len()).filter(|&k| meets(&corners[k]));
            prop_assert!(all.into_iter().all(|k| found.contains(&(k as u32))));
        }

        #[test]
        fn subtrees_fitted_in_tasks_make_the_same_hierarchy(count in 1usize..3000, seed in 0u32..100) {
            let number = |at: usize, axis: u32| ((at as u32 * 3 + axis + seed).wrapping_mul(2654435761) >> 8) as f32 / 1e5;
            let places: Vec<[f32; 3]> = (0..count).map(|at| [0, 1, 2].map(|axis| number(at, axis))).collect();
            let mut bvh = Bvh::new(&places.iter().map(|place| Vector3::from(place.map(f64::from))).collect::<Vec<_>>());
            bvh.refit_in_tasks(|at| Aabb::ball(places[at], 0.1), &ThreadPool::new(2));
            for node in 0..bvh.leaves - 1 {
                prop_assert_eq!(bvh.nodes[node], bvh.nodes[2 * node + 1].union(bvh.nodes[2 * node + 2]));
            }
            for node in bvh.leaves - 1..bvh.nodes.len() {
                let own = (node - (bvh.leaves - 1)) * LEAF_SIZE;
                let own = bvh.triangles.iter().skip(own).take(LEAF_SIZE);
                let all = own.map(|&at| Aabb::ball(places[at as usize], 0.1)).fold(Aabb::EMPTY, Aabb::union);
                prop_assert_eq!(bvh.nodes[node], all);
            }
        }

        #[test]
        fn targets_together_find_what_each_finds_alone_in_the_same_order(
            corners in boxes(), seekers in boxes(),
        ) {
            let boxes: Vec<Aabb> = corners.iter().map(|&[low, high]| Aabb::new(low, high)).collect();
            let mut bvh = Bvh::new(&corners.iter().map(|[low, high]| (low + high) / 2.0).collect::<Vec<_>>());
            bvh.refit(|triangle| boxes[triangle]);
            let targets: Vec<Aabb> = seekers.iter().map(|&[low, high]| Aabb::new(low, high).inflate(0.5)).collect();
            let mut together = vec![Vec::new(); targets.len()];
            bvh.query_all(&targets, &mut Vec::new(), |target, at| together[target as usize].push(at));
            for (target, together) in targets.iter().zip(together) {
                let mut alone = Vec::new();
                bvh.query(target, |at| alone.push(at));
                prop_assert_eq!(together, alone);
            }
        }
    }

    #[test]
    fn a_query_that_meets_everything_finds_every_element_once() {
        for count in 1..40 {
            let places: Vec<Vector3<f64>> = (0..count).map(|at| Vector3::x() * f64::from(at)).collect();
            let bvh = Bvh::new(&places);
            let mut found = Vec::new();
            // As a query of coordinates that are no numbers does: it meets leaves of padding too.
            bvh.descend(|_| true, |triangle| found.push(triangle));
            found.sort_unstable();
            assert!(found.into_iter().eq(0..count as u32), "{count}");
        }
    }
}
