//! The elements of all cloths, in groups of neighbours, under one tree.

use nalgebra::Vector3;

use super::lists::Lists;
use super::seen::Seen;
use crate::bytes::checkpoint_struct;
use crate::contact::aabb::{Aabb, SweptBox};
use crate::contact::skin::Group;
use crate::contact::tree::Tree;
use crate::math::Real;
use crate::model::ClothModel;

/// Triangles to a group.
const GROUP: usize = 8;

/// A group of elements and the cloth it belongs to.
#[derive(Debug, Clone)]
pub struct Body {
    /// The cloth, by its index.
    pub cloth: u32,
    /// Its elements, in the cloth's skin.
    pub group: Group,
}

/// All groups.
#[derive(Debug, Clone, Default)]
pub struct Bodies {
    /// The groups, cloth by cloth.
    pub groups: Vec<Body>,
    /// Boxes over groups.
    pub tree: Option<Tree>,
    /// Boxes round each group at the start and at the end of what is foreseen.
    pub around: Vec<SweptBox>,
    /// The groups that have an element of each point; none for rows that are no point.
    pub of_point: Lists,
    /// Whether each point is of no face.
    pub is_free: Vec<bool>,
    /// The points of each group's elements, and where they end in that column.
    pub points: Vec<u32>,
    ends: Vec<u32>,
    /// The block that each point is in, counted over all cloths.
    pub block: Vec<u32>,
    /// The cloth that each point is of.
    pub cloth: Vec<u32>,
    /// Mean length of the cloths' edges at rest in metres; of the smallest such.
    pub edge_length: f64,
    /// How many blocks there are.
    pub blocks: u32,
    /// Where each point is at rest, in metres from the first of its cloth.
    pub rest: Vec<[f32; 3]>,
}

checkpoint_struct!([] Bodies {
    columns: [rest],
    values: [],
    parts: [tree],
    rebuilt: [groups, around, points, ends, block, cloth, edge_length, blocks, of_point, is_free],
});

impl Bodies {
    /// The elements of these cloths in their shape at rest, which `anchors` have.
    pub fn new<R: Real>(cloths: &[ClothModel<R>], anchors: &[[f64; 3]]) -> Self {
        let rows = anchors.len();
        let mut all = Self {
            block: vec![0; rows],
            cloth: vec![0; rows],
            rest: vec![[0.0; 3]; rows],
            is_free: vec![true; rows],
            ..Self::default()
        };
        for (cloth, model) in (0..).zip(cloths) {
            all.groups.extend(model.skin.groups(GROUP).map(|group| Body { cloth, group }));
            let corners = model.skin.triangles.iter().flatten();
            corners.for_each(|&corner| all.is_free[corner as usize] = false);
            let points = model.points();
            all.cloth[points.start as usize..points.end as usize].fill(cloth);
            for block in 0..model.blocks.len() {
                let range = model.blocks.range(block);
                all.block[range.start as usize..range.end as usize].fill(all.blocks);
                all.blocks += 1;
            }
        }
        let lengths = cloths.iter().map(|cloth| cloth.edge_length).filter(|&length| length > 0.0);
        all.edge_length = lengths.fold(f64::INFINITY, f64::min);
        all.take_shape(cloths, anchors);
        all
    }

    /// All points that the elements of a group have.
    pub fn points_of(&self, group: usize) -> &[u32] {
        let from = group.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.points[from as usize..self.ends[group] as usize]
    }

    /// Writes the groups that have an element of some points, in their order.
    pub fn groups_of(&self, points: impl Iterator<Item = u32>, groups: &mut Vec<u32>) {
        groups.clear();
        points.for_each(|point| groups.extend(self.of_point.of(point)));
        groups.sort_unstable();
        groups.dedup();
    }

    /// Sets what is round a group.
    pub fn look(&mut self, group: u32, seen: &Seen, margin: f32) {
        self.around[group as usize] = seen.bound(self.points_of(group as usize), margin);
    }

    /// Fits the tree to what is round the groups.
    pub fn refit(&mut self) {
        let Self { tree, around, .. } = self;
        if let Some(tree) = tree {
            tree.refit(|group| around[group][0].union(around[group][1]));
        }
    }

    /// The box round all that is foreseen for a group.
    pub fn swept(&self, group: u32) -> Aabb {
        let [start, end] = self.around[group as usize];
        start.union(end)
    }

    /// Takes the shape at rest, and builds the tree over it.
    fn take_shape<R: Real>(&mut self, cloths: &[ClothModel<R>], anchors: &[[f64; 3]]) {
        for model in cloths {
            let points = model.points();
            let first = Vector3::from(anchors[points.start as usize]);
            for row in points.map(|row| row as usize) {
                let away = Vector3::from(anchors[row]) - first;
                self.rest[row] = [away.x as f32, away.y as f32, away.z as f32];
            }
        }
        for body in &self.groups {
            let skin = &cloths[body.cloth as usize].skin;
            let corners = skin.triangles[body.group.triangles.clone()].iter().flatten();
            let from = self.points.len();
            self.points.extend(corners.chain(&skin.points[body.group.points.clone()]));
            self.points[from..].sort_unstable();
            let mut kept = from;
            for at in from..self.points.len() {
                if at == from || self.points[at] != self.points[kept - 1] {
                    self.points[kept] = self.points[at];
                    kept += 1;
                }
            }
            self.points.truncate(kept);
            self.ends.push(kept as u32);
        }
        let groups = 0..self.groups.len();
        let pairs =
            groups.flat_map(|group| self.points_of(group).iter().map(move |&point| (point, group as u32)));
        self.of_point = Lists::new(anchors.len(), pairs);
        let centre = |group: usize| {
            let points = self.points_of(group);
            let sum: Vector3<f64> = points.iter().map(|&point| Vector3::from(anchors[point as usize])).sum();
            sum / f64::max(points.len() as f64, 1.0)
        };
        let centres: Vec<_> = (0..self.groups.len()).map(centre).collect();
        self.tree = (!centres.is_empty()).then(|| Tree::new(&centres));
        self.around = vec![[Aabb::EMPTY; 2]; self.groups.len()];
    }
}
