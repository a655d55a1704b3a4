//! Axis-aligned boxes, and a bounding volume hierarchy over them. Boxes hold coordinates exactly, without rounding.

use nalgebra::Vector3;

/// Axis-aligned box from `min` to `max`, both included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    pub min: [f64; 3],
    pub max: [f64; 3],
}

impl Aabb {
    pub const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    /// The box of some points. A coordinate that is not finite makes the box infinite, so that no candidate is missed.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Vector3<f64>>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| bounds.with(point))
    }

    fn with(mut self, point: &Vector3<f64>) -> Self {
        for axis in 0..3 {
            let x = point[axis];
            if x.is_finite() {
                self.min[axis] = self.min[axis].min(x);
                self.max[axis] = self.max[axis].max(x);
            } else {
                (self.min[axis], self.max[axis]) = (f64::NEG_INFINITY, f64::INFINITY);
            }
        }
        self
    }

    /// Enlarged by a distance along every axis, rounded to nearest.
    pub fn inflated(mut self, by: f64) -> Self {
        self.min.iter_mut().for_each(|min| *min -= by);
        self.max.iter_mut().for_each(|max| *max += by);
        self
    }

    /// The box of both.
    pub fn union(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            self.min[axis] = self.min[axis].min(other.min[axis]);
            self.max[axis] = self.max[axis].max(other.max[axis]);
        }
        self
    }

    /// Whether two closed boxes overlap.
    pub fn overlaps(&self, other: &Self) -> bool {
        let along = |axis: usize| (self.min[axis] <= other.max[axis]) & (other.min[axis] <= self.max[axis]);
        // Bitwise `&` avoids branches that are hard to predict.
        along(0) & along(1) & along(2)
    }

    /// Twice the centre along an axis; zero for an infinite box.
    pub fn centre(&self, axis: usize) -> f64 {
        let sum = self.min[axis] + self.max[axis];
        if sum.is_finite() { sum } else { 0.0 }
    }
}

/// Boxes in a leaf.
const LEAF: usize = 4;

/// Binary tree of boxes, split at the median along the axis of widest spread.
#[derive(Default)]
pub struct Bvh {
    /// Depth first: the first child of a node follows it.
    nodes: Vec<Node>,
    items: Vec<u32>,
}

struct Node {
    bounds: Aabb,
    /// Range of the items below.
    items: [u32; 2],
    /// Index of the second child; 0 in a leaf.
    second: u32,
}

impl Bvh {
    /// Builds the tree over `items`, whose boxes are in `boxes`.
    pub fn new(items: Vec<u32>, boxes: &[Aabb]) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(items.len()), items };
        if !tree.items.is_empty() {
            tree.grow(0, tree.items.len(), boxes);
        }
        tree
    }

    fn grow(&mut self, from: usize, to: usize, boxes: &[Aabb]) {
        let items = &mut self.items[from..to];
        let of = |item: &u32| &boxes[*item as usize];
        let bounds = items.iter().fold(Aabb::EMPTY, |all, item| all.union(of(item)));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, items: [from as u32, to as u32], second: 0 });
        if items.len() <= LEAF {
            return;
        }
        let axis = widest(items.iter().map(of));
        let half = items.len() / 2;
        items.select_nth_unstable_by(half, |a, b| of(a).centre(axis).total_cmp(&of(b).centre(axis)));
        self.grow(from, from + half, boxes);
        self.nodes[node].second = self.nodes.len() as u32;
        self.grow(from + half, to, boxes);
    }

    /// Updates the boxes of the same items; the topology stays.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        // Children follow their parents.
        for index in (0..self.nodes.len()).rev() {
            let Node { items, second, .. } = self.nodes[index];
            self.nodes[index].bounds = if second > 0 {
                self.nodes[index + 1].bounds.union(&self.nodes[second as usize].bounds)
            } else {
                let [from, to] = items.map(|item| item as usize);
                let of = |item: &u32| &boxes[*item as usize];
                self.items[from..to].iter().fold(Aabb::EMPTY, |all, item| all.union(of(item)))
            };
        }
    }

    /// The leaves; neighbours in the list are near each other.
    pub fn leaves(&self) -> Vec<u32> {
        (0..).zip(&self.nodes).filter(|(_, node)| node.second == 0).map(|(index, _)| index).collect()
    }

    /// Calls `visit` for every item of a leaf and every item of another tree whose boxes overlap; `boxes` belong to
    /// this tree.
    pub fn query_leaf(
        &self,
        boxes: &[Aabb],
        leaf: u32,
        (other, others): (&Self, &[Aabb]),
        stack: &mut Vec<u32>,
        visit: impl FnMut(u32, u32),
    ) {
        self.leaf_and(0, boxes, leaf, (other, others), stack, visit);
    }

    /// As [`query_leaf`](Self::query_leaf) within one tree: with the items of the same leaf and of later leaves.
    /// Over all leaves, every pair is visited once.
    pub fn query_self(
        &self,
        boxes: &[Aabb],
        leaf: u32,
        stack: &mut Vec<u32>,
        mut visit: impl FnMut(u32, u32),
    ) {
        let [from, to] = self.nodes[leaf as usize].items.map(|item| item as usize);
        for (k, &one) in (from..to).zip(&self.items[from..to]) {
            let meets = |other: &&u32| boxes[one as usize].overlaps(&boxes[**other as usize]);
            self.items[k + 1..to].iter().filter(meets).for_each(|&other| visit(one, other));
        }
        self.leaf_and(leaf + 1, boxes, leaf, (self, boxes), stack, visit);
    }

    fn leaf_and(
        &self,
        first: u32,
        boxes: &[Aabb],
        leaf: u32,
        (other, others): (&Self, &[Aabb]),
        stack: &mut Vec<u32>,
        mut visit: impl FnMut(u32, u32),
    ) {
        let Node { bounds, items, .. } = &self.nodes[leaf as usize];
        let own = &self.items[items[0] as usize..items[1] as usize];
        other.query_from(first, bounds, others, stack, |found| {
            for &item in own {
                if boxes[item as usize].overlaps(&others[found as usize]) {
                    visit(item, found);
                }
            }
        });
    }

    /// Calls `visit` for every item whose box overlaps `bounds`.
    pub fn query(&self, bounds: &Aabb, boxes: &[Aabb], stack: &mut Vec<u32>, visit: impl FnMut(u32)) {
        self.query_from(0, bounds, boxes, stack, visit);
    }

    /// As [`query`](Self::query), for leaves from node `first` on.
    fn query_from(
        &self,
        first: u32,
        bounds: &Aabb,
        boxes: &[Aabb],
        stack: &mut Vec<u32>,
        mut visit: impl FnMut(u32),
    ) {
        stack.clear();
        stack.extend(self.nodes.first().map(|_| 0));
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !node.bounds.overlaps(bounds) {
                continue;
            }
            if node.second > 0 {
                stack.push(node.second);
                // All nodes below the first child precede the second child.
                stack.extend(Some(index + 1).filter(|_| node.second > first));
                continue;
            }
            if index < first {
                continue;
            }
            let [from, to] = node.items.map(|item| item as usize);
            for &item in &self.items[from..to] {
                if boxes[item as usize].overlaps(bounds) {
                    visit(item);
                }
            }
        }
    }
}

/// The axis along which centres spread most.
fn widest<'a>(boxes: impl Iterator<Item = &'a Aabb>) -> usize {
    let mut spread = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for bounds in boxes {
        for (axis, [min, max]) in spread.iter_mut().enumerate() {
            let middle = bounds.centre(axis);
            (*min, *max) = (min.min(middle), max.max(middle));
        }
    }
    let width = |axis: &usize| spread[*axis][1] - spread[*axis][0];
    (0..3).max_by(|a, b| width(a).total_cmp(&width(b))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::*;

    fn some_box() -> impl Strategy<Value = Aabb> {
        // A coarse grid, so that boxes often touch.
        prop::array::uniform6(-8_i8..8).prop_map(|[a, b, c, d, e, f]| {
            let corner = |x, y, z| Vector3::new(f64::from(x), f64::from(y), f64::from(z));
            Aabb::of([&corner(a, b, c), &corner(d, e, f)])
        })
    }

    proptest! {
        #[test]
        fn a_bvh_query_finds_exactly_the_overlapping_boxes(boxes in prop::collection::vec(some_box(), 0..60), one in some_box()) {
            let tree = Bvh::new((0..boxes.len() as u32).collect(), &boxes);
            let mut found = Vec::new();
            tree.query(&one, &boxes, &mut Vec::new(), |item| found.push(item));
            found.sort_unstable();
            let all: Vec<u32> = (0..boxes.len() as u32).filter(|&item| boxes[item as usize].overlaps(&one)).collect();
            prop_assert_eq!(found, all);
        }

        #[test]
        fn a_bvh_finds_every_overlapping_pair_once(boxes in prop::collection::vec(some_box(), 0..60)) {
            let tree = Bvh::new((0..boxes.len() as u32).collect(), &boxes);
            let mut found = Vec::new();
            for leaf in tree.leaves() {
                tree.query_self(&boxes, leaf, &mut Vec::new(), |a, b| found.push([a.min(b), a.max(b)]));
            }
            found.sort_unstable();
            let pairs = (0..boxes.len() as u32).flat_map(|a| (a + 1..boxes.len() as u32).map(move |b| [a, b]));
            let all: Vec<_> = pairs.filter(|&[a, b]| boxes[a as usize].overlaps(&boxes[b as usize])).collect();
            prop_assert_eq!(found, all);
        }

        #[test]
        fn a_refitted_bvh_finds_exactly_the_overlapping_boxes(
            pairs in prop::collection::vec((some_box(), some_box()), 0..60), one in some_box(),
        ) {
            let (before, boxes): (Vec<Aabb>, Vec<Aabb>) = pairs.into_iter().unzip();
            let mut tree = Bvh::new((0..boxes.len() as u32).collect(), &before);
            tree.refit(&boxes);
            let mut found = Vec::new();
            tree.query(&one, &boxes, &mut Vec::new(), |item| found.push(item));
            found.sort_unstable();
            let all: Vec<u32> = (0..boxes.len() as u32).filter(|&item| boxes[item as usize].overlaps(&one)).collect();
            prop_assert_eq!(found, all);
        }
    }
}
