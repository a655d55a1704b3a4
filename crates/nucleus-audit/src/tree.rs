//! A tree of boxes: which of many meet one.

use crate::bounds::Bounds;

/// Boxes in a leaf.
const LEAF: usize = 4;

/// Boxes, halved again and again along the axis on which their middles lie farthest apart.
#[derive(Default)]
pub struct Tree {
    /// The root first; the first child of a node stands behind it.
    nodes: Vec<Node>,
    items: Vec<u32>,
}

struct Node {
    bounds: Bounds,
    /// The items below.
    items: [u32; 2],
    /// The second child; 0 in a leaf.
    second: u32,
}

impl Tree {
    /// Of `items`, each with its box.
    pub fn new(items: Vec<u32>, boxes: &[Bounds]) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(items.len()), items };
        if !tree.items.is_empty() {
            tree.grow(0, tree.items.len(), boxes);
        }
        tree
    }

    fn grow(&mut self, from: usize, to: usize, boxes: &[Bounds]) {
        let items = &mut self.items[from..to];
        let of = |item: &u32| &boxes[*item as usize];
        let bounds = items.iter().fold(Bounds::EMPTY, |all, item| all.and(of(item)));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, items: [from as u32, to as u32], second: 0 });
        if items.len() <= LEAF {
            return;
        }
        let axis = widest(items.iter().map(of));
        let half = items.len() / 2;
        items.select_nth_unstable_by(half, |a, b| of(a).middle(axis).total_cmp(&of(b).middle(axis)));
        self.grow(from, from + half, boxes);
        self.nodes[node].second = self.nodes.len() as u32;
        self.grow(from + half, to, boxes);
    }

    /// Takes up other boxes of the same items.
    pub fn refit(&mut self, boxes: &[Bounds]) {
        // Children stand behind their parents.
        for index in (0..self.nodes.len()).rev() {
            let Node { items, second, .. } = self.nodes[index];
            self.nodes[index].bounds = if second > 0 {
                self.nodes[index + 1].bounds.and(&self.nodes[second as usize].bounds)
            } else {
                let [from, to] = items.map(|item| item as usize);
                let of = |item: &u32| &boxes[*item as usize];
                self.items[from..to].iter().fold(Bounds::EMPTY, |all, item| all.and(of(item)))
            };
        }
    }

    /// The leaves, neighbours near each other.
    pub fn leaves(&self) -> Vec<u32> {
        (0..).zip(&self.nodes).filter(|(_, node)| node.second == 0).map(|(index, _)| index).collect()
    }

    /// Shows `visit` every item of a leaf with every item of another tree whose box it meets; each tree has its own boxes.
    pub fn meeting_leaf(
        &self,
        boxes: &[Bounds],
        leaf: u32,
        (other, others): (&Self, &[Bounds]),
        stack: &mut Vec<u32>,
        visit: impl FnMut(u32, u32),
    ) {
        self.leaf_and(0, boxes, leaf, (other, others), stack, visit);
    }

    /// The same within the tree: with the items of its own leaf and of those behind it, so that over all leaves every pair
    /// is shown once.
    pub fn meeting_itself(
        &self,
        boxes: &[Bounds],
        leaf: u32,
        stack: &mut Vec<u32>,
        mut visit: impl FnMut(u32, u32),
    ) {
        let [from, to] = self.nodes[leaf as usize].items.map(|item| item as usize);
        for (k, &one) in (from..to).zip(&self.items[from..to]) {
            let meets = |other: &&u32| boxes[one as usize].meets(&boxes[**other as usize]);
            self.items[k + 1..to].iter().filter(meets).for_each(|&other| visit(one, other));
        }
        self.leaf_and(leaf + 1, boxes, leaf, (self, boxes), stack, visit);
    }

    fn leaf_and(
        &self,
        first: u32,
        boxes: &[Bounds],
        leaf: u32,
        (other, others): (&Self, &[Bounds]),
        stack: &mut Vec<u32>,
        mut visit: impl FnMut(u32, u32),
    ) {
        let Node { bounds, items, .. } = &self.nodes[leaf as usize];
        let own = &self.items[items[0] as usize..items[1] as usize];
        other.meeting_from(first, bounds, others, stack, |found| {
            for &item in own {
                if boxes[item as usize].meets(&others[found as usize]) {
                    visit(item, found);
                }
            }
        });
    }

    /// Shows `visit` every item whose box meets `bounds`.
    pub fn meeting(&self, bounds: &Bounds, boxes: &[Bounds], stack: &mut Vec<u32>, visit: impl FnMut(u32)) {
        self.meeting_from(0, bounds, boxes, stack, visit);
    }

    /// The same, of the leaves from node `first` on.
    fn meeting_from(
        &self,
        first: u32,
        bounds: &Bounds,
        boxes: &[Bounds],
        stack: &mut Vec<u32>,
        mut visit: impl FnMut(u32),
    ) {
        stack.clear();
        stack.extend(self.nodes.first().map(|_| 0));
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !node.bounds.meets(bounds) {
                continue;
            }
            if node.second > 0 {
                stack.push(node.second);
                // All nodes below the first child stand before the second.
                stack.extend(Some(index + 1).filter(|_| node.second > first));
                continue;
            }
            if index < first {
                continue;
            }
            let [from, to] = node.items.map(|item| item as usize);
            for &item in &self.items[from..to] {
                if boxes[item as usize].meets(bounds) {
                    visit(item);
                }
            }
        }
    }
}

/// The axis on which middles spread most.
fn widest<'a>(boxes: impl Iterator<Item = &'a Bounds>) -> usize {
    let mut spread = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for bounds in boxes {
        for (axis, [least, most]) in spread.iter_mut().enumerate() {
            let middle = bounds.middle(axis);
            (*least, *most) = (least.min(middle), most.max(middle));
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

    fn some_box() -> impl Strategy<Value = Bounds> {
        // On a coarse grid, so that surfaces often touch.
        prop::array::uniform6(-8_i8..8).prop_map(|[a, b, c, d, e, f]| {
            let corner = |x, y, z| Vector3::new(f64::from(x), f64::from(y), f64::from(z));
            Bounds::of([&corner(a, b, c), &corner(d, e, f)])
        })
    }

    proptest! {
        #[test]
        fn a_tree_finds_just_the_boxes_that_meet(boxes in prop::collection::vec(some_box(), 0..60), one in some_box()) {
            let tree = Tree::new((0..boxes.len() as u32).collect(), &boxes);
            let mut found = Vec::new();
            tree.meeting(&one, &boxes, &mut Vec::new(), |item| found.push(item));
            found.sort_unstable();
            let all: Vec<u32> = (0..boxes.len() as u32).filter(|&item| boxes[item as usize].meets(&one)).collect();
            prop_assert_eq!(found, all);
        }

        #[test]
        fn a_tree_finds_every_pair_of_its_boxes_that_meet_once(boxes in prop::collection::vec(some_box(), 0..60)) {
            let tree = Tree::new((0..boxes.len() as u32).collect(), &boxes);
            let mut found = Vec::new();
            for leaf in tree.leaves() {
                tree.meeting_itself(&boxes, leaf, &mut Vec::new(), |a, b| found.push([a.min(b), a.max(b)]));
            }
            found.sort_unstable();
            let pairs = (0..boxes.len() as u32).flat_map(|a| (a + 1..boxes.len() as u32).map(move |b| [a, b]));
            let all: Vec<_> = pairs.filter(|&[a, b]| boxes[a as usize].meets(&boxes[b as usize])).collect();
            prop_assert_eq!(found, all);
        }

        #[test]
        fn a_refitted_tree_finds_just_the_boxes_that_meet(
            pairs in prop::collection::vec((some_box(), some_box()), 0..60), one in some_box(),
        ) {
            let (before, boxes): (Vec<Bounds>, Vec<Bounds>) = pairs.into_iter().unzip();
            let mut tree = Tree::new((0..boxes.len() as u32).collect(), &before);
            tree.refit(&boxes);
            let mut found = Vec::new();
            tree.meeting(&one, &boxes, &mut Vec::new(), |item| found.push(item));
            found.sort_unstable();
            let all: Vec<u32> = (0..boxes.len() as u32).filter(|&item| boxes[item as usize].meets(&one)).collect();
            prop_assert_eq!(found, all);
        }
    }
}
