//! A bounding volume hierarchy (BVH) of elements: the nearest to a place, and those within a distance of one.

use nalgebra::Vector3;

type Point = Vector3<f64>;

/// The most elements of a leaf.
const LEAF: usize = 4;
/// Share of a distance, and of the largest coordinate, that rounding may take from it.
const ROUNDING: f64 = 1e-12;

/// An axis-aligned bounding box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: Point,
    high: Point,
}

impl Bounds {
    /// The box of some points; it contains nothing without any.
    pub(super) fn of(points: &[Point]) -> Self {
        let empty = Self { low: Point::repeat(f64::INFINITY), high: Point::repeat(f64::NEG_INFINITY) };
        points.iter().fold(empty, |all, point| Self { low: all.low.inf(point), high: all.high.sup(point) })
    }

    fn with(&self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// The distance to another box; 0 where they overlap.
    fn distance(&self, other: &Self) -> f64 {
        let gap = (self.low - other.high).sup(&(other.low - self.high));
        gap.sup(&Point::zeros()).norm()
    }
}

/// A node of the tree.
struct Node {
    bounds: Bounds,
    /// Its elements in `order`.
    first: usize,
    end: usize,
    /// The second child; the first follows its parent. 0 in a leaf.
    right: usize,
}

/// Elements with their boxes, to find those near a place.
pub(super) struct Bvh {
    boxes: Vec<Bounds>,
    order: Vec<u32>,
    nodes: Vec<Node>,
    /// A distance that rounding may hide.
    slack: f64,
}

impl Bvh {
    /// The tree of elements, each given by its corners.
    pub(super) fn new<'a>(elements: impl Iterator<Item = &'a [Point]>) -> Self {
        let boxes: Vec<Bounds> = elements.map(Bounds::of).collect();
        let order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut tree = Self { boxes, order, nodes: Vec::new(), slack: 0.0 };
        if !tree.boxes.is_empty() {
            tree.build(0, tree.order.len());
            let Bounds { low, high } = tree.nodes[0].bounds;
            tree.slack = ROUNDING * low.amax().max(high.amax());
        }
        tree
    }

    /// Adds the node of a range of `order`, with all nodes below it; returns its index.
    fn build(&mut self, first: usize, end: usize) -> usize {
        let Self { boxes, order, nodes, .. } = self;
        let own = order[first..end].iter().map(|at| boxes[*at as usize]);
        let bounds = own.reduce(|all, one| all.with(&one)).unwrap_or(Bounds::of(&[]));
        let at = nodes.len();
        nodes.push(Node { bounds, first, end, right: 0 });
        if end - first > LEAF {
            let axis = (bounds.high - bounds.low).imax();
            let center = |at: &u32| boxes[*at as usize].low[axis] + boxes[*at as usize].high[axis];
            let middle = first.midpoint(end);
            let half = middle - first;
            order[first..end].select_nth_unstable_by(half, |a, b| center(a).total_cmp(&center(b)));
            self.build(first, middle);
            let right = self.build(middle, end);
            self.nodes[at].right = right;
        }
        at
    }

    /// A lower bound of the distance of elements in a node from those in a box, despite rounding.
    fn bound(&self, bounds: &Bounds, to: &Bounds) -> f64 {
        bounds.distance(to) * (1.0 - ROUNDING) - self.slack
    }

    /// The elements whose boxes are within a distance of a box, in no particular order.
    pub(super) fn within(&self, to: &Bounds, reach: f64) -> Vec<u32> {
        let mut found = Vec::new();
        let mut open: Vec<usize> = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(at) = open.pop() {
            let node = &self.nodes[at];
            if self.bound(&node.bounds, to) > reach {
                continue;
            }
            if node.right > 0 {
                open.extend([at + 1, node.right]);
                continue;
            }
            let own = self.order[node.first..node.end].iter().copied();
            found.extend(own.filter(|at| self.bound(&self.boxes[*at as usize], to) <= reach));
        }
        found
    }

    /// The element for which `distance` is smallest, and that distance, which is finite and at most `reach`; of equals, the
    /// first. `distance` is at least that of the boxes of the element and of `to`.
    pub(super) fn nearest(
        &self,
        to: &Bounds,
        reach: f64,
        mut distance: impl FnMut(u32) -> f64,
    ) -> Option<(f64, u32)> {
        let mut best: Option<(f64, u32)> = None;
        let mut open = if self.nodes.is_empty() { Vec::new() } else { vec![(0.0, 0)] };
        while let Some((bound, at)) = open.pop() {
            if bound > best.map_or(reach, |(distance, _)| distance) {
                continue;
            }
            let node = &self.nodes[at];
            if node.right > 0 {
                let child = |at: usize| (self.bound(&self.nodes[at].bounds, to), at);
                let [a, b] = [child(at + 1), child(node.right)];
                // The nearer one is searched first.
                open.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
                continue;
            }
            for &at in &self.order[node.first..node.end] {
                let found = (distance(at), at);
                let is_near = found.0.is_finite() && found.0 <= reach;
                if is_near && best.is_none_or(|best| found.0 < best.0 || found.0 == best.0 && at < best.1) {
                    best = Some(found);
                }
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::near::{distance, foot};
    use super::*;

    /// Elements of one to four corners on a coarse lattice, so that many distances are equal. Half of the sets lie in a
    /// plane across x.
    fn elements() -> impl Strategy<Value = Vec<Vec<Point>>> {
        let corner = proptest::array::uniform3(-3..=3i32).prop_map(|p| Point::from(p.map(f64::from)));
        let all = proptest::collection::vec(proptest::collection::vec(corner, 1..5), 1..40);
        (all, any::<bool>()).prop_map(|(mut all, is_flat)| {
            all.iter_mut().flatten().filter(|_| is_flat).for_each(|corner| corner.x = 0.5);
            all
        })
    }

    proptest! {
        #[test]
        fn the_nearest_element_is_the_first_of_the_closest_ones(
            all in elements(), from in elements(), left in proptest::collection::vec(any::<bool>(), 40),
            reach in prop_oneof![Just(f64::INFINITY), 0.0..3.0f64],
        ) {
            let tree = Bvh::new(all.iter().map(Vec::as_slice));
            for element in &from {
                let of = |at: u32| match left[at as usize] {
                    true => distance(element, &all[at as usize]),
                    false => f64::INFINITY,
                };
                let brute = (0..all.len() as u32).map(|at| (of(at), at)).filter(|found| found.0.is_finite());
                let brute = brute.reduce(|a, b| if b.0 < a.0 { b } else { a });
                let found = tree.nearest(&Bounds::of(element), reach, of);
                prop_assert_eq!(found, brute.filter(|found| found.0 <= reach));
            }
        }

        #[test]
        fn every_element_within_a_distance_is_found(all in elements(), from in elements(), reach in 0..3i32) {
            let reach = f64::from(reach);
            let tree = Bvh::new(all.iter().map(Vec::as_slice));
            for element in &from {
                let is_near = |at: &u32| distance(element, &all[*at as usize]) <= reach;
                let mut found: Vec<u32> =
                    tree.within(&Bounds::of(element), reach).into_iter().filter(is_near).collect();
                found.sort_unstable();
                let brute: Vec<u32> = (0..all.len() as u32).filter(is_near).collect();
                prop_assert_eq!(found, brute);
            }
        }

        #[test]
        fn a_place_between_lattice_points_has_the_nearest_foot_that_trying_all_finds(
            all in elements(), to in proptest::array::uniform3(-4.0..4.0f64),
        ) {
            let to = Point::from(to);
            let of = |at: u32| (foot(&all[at as usize], to).place - to).norm();
            let tree = Bvh::new(all.iter().map(Vec::as_slice));
            let found = tree.nearest(&Bounds::of(&[to]), f64::INFINITY, of);
            let brute = (0..all.len() as u32).map(|at| (of(at), at));
            prop_assert_eq!(found, brute.reduce(|a, b| if b.0 < a.0 { b } else { a }));
        }
    }
}
