//! The elements of all cloths, in groups of neighbours, under a BVH for each cloth.

use std::ops::Range;

use nalgebra::Vector3;

use crate::bytes::checkpoint_struct;
use crate::contact::boundary::ElementGroup;
use crate::contact::bvh::{Aabb, Bvh, SweptBox};
use crate::contact::cloth::local_origins::LocalOrigins;
use crate::math::Real;
use crate::model::ClothModel;
use crate::parallel::thread_pool::ThreadPool;

/// Triangles in a group.
const GROUP_SIZE: usize = 8;

/// A group of elements and the cloth it belongs to.
#[derive(Debug, Clone)]
pub struct ClothGroup {
    /// The cloth, by its index.
    pub cloth: u32,
    /// Its elements, in the cloth's boundary.
    pub group: ElementGroup,
}

/// Which points of a group have new bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NewBounds {
    /// None of them.
    None,
    /// Some, but not all.
    Some,
    /// All of them.
    All,
}

/// All element groups.
#[derive(Debug, Clone, Default)]
pub struct ElementGroups {
    /// The groups, cloth by cloth.
    pub groups: Vec<ClothGroup>,
    /// A hierarchy over the groups of each cloth: one for all would make the order of contacts in a cloth depend on others.
    pub bvhs: Vec<Bvh>,
    /// The first group of each cloth.
    first_groups: Vec<u32>,
    /// The swept box of each group, relative to the origin of its cloth.
    pub swept_boxes: Vec<SweptBox>,
    /// Whether each point belongs to no face.
    pub is_free_point: Vec<bool>,
    /// The points of each group, and the end of each group's run.
    pub points: Vec<u32>,
    ends: Vec<u32>,
    /// The block of each point, counted over all cloths.
    pub block: Vec<u32>,
    /// The cloth of each point.
    pub cloth: Vec<u32>,
    /// Mean edge length of each cloth at rest, in metres; zero without edges.
    pub edge_lengths: Vec<f64>,
    /// The number of blocks.
    pub blocks: u32,
    /// Position of each point at rest, in metres relative to the first of its cloth.
    pub rest_positions: Vec<[f32; 3]>,
}

checkpoint_struct!([] ElementGroups {
    columns: [rest_positions],
    values: [],
    parts: [bvhs],
    rebuilt: [groups, first_groups, swept_boxes, points, ends, block, cloth, edge_lengths, blocks, is_free_point],
});

impl ElementGroups {
    /// The elements of these cloths, with `anchors` as their shape at rest.
    pub fn new<R: Real>(cloths: &[ClothModel<R>], anchors: &[[f64; 3]]) -> Self {
        let rows = anchors.len();
        let mut all = Self {
            block: vec![0; rows],
            cloth: vec![0; rows],
            rest_positions: vec![[0.0; 3]; rows],
            is_free_point: vec![true; rows],
            ..Self::default()
        };
        for (cloth, model) in (0..).zip(cloths) {
            all.first_groups.push(all.groups.len() as u32);
            all.groups.extend(model.boundary.groups(GROUP_SIZE).map(|group| ClothGroup { cloth, group }));
            let corners = model.boundary.triangles.iter().flatten();
            corners.for_each(|&corner| all.is_free_point[corner as usize] = false);
            let rows = model.blocks.rows();
            all.cloth[rows.start as usize..rows.end as usize].fill(cloth);
            for block in 0..model.blocks.len() {
                let range = model.blocks.range(block);
                all.block[range.start as usize..range.end as usize].fill(all.blocks);
                all.blocks += 1;
            }
        }
        all.edge_lengths = cloths.iter().map(|cloth| cloth.edge_length).collect();
        all.build(cloths, anchors);
        all
    }

    /// All points of a group.
    pub fn points_of(&self, group: usize) -> &[u32] {
        let from = group.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.points[from as usize..self.ends[group] as usize]
    }

    /// Which points of a group have new bounds.
    pub fn new_bounds_of(&self, group: usize, has_new_bound: &[bool]) -> NewBounds {
        let points = self.points_of(group);
        match points.iter().filter(|&&point| has_new_bound[point as usize]).count() {
            0 => NewBounds::None,
            all if all == points.len() => NewBounds::All,
            _ => NewBounds::Some,
        }
    }

    /// Refits the hierarchies to the swept boxes.
    pub fn refit(&mut self, pool: &ThreadPool) {
        let Self { bvhs, first_groups, swept_boxes, .. } = self;
        for (bvh, &first) in bvhs.iter_mut().zip(&*first_groups) {
            let swept_bound = |group: usize| {
                let [start, end] = swept_boxes[first as usize + group];
                start.union(end)
            };
            bvh.refit_in_tasks(swept_bound, pool);
        }
    }

    /// The box of a cloth's groups, relative to its origin.
    pub fn bounds(&self, cloth: usize) -> Aabb {
        self.bvhs[cloth].bounds()
    }

    /// The largest coordinate of any swept box in metres, relative to the origin of the first cloth.
    pub fn extent(&self, origins: &LocalOrigins) -> f64 {
        let of_cloth = |cloth: usize| {
            let away = origins.shift([cloth, 0]).metres;
            let corners = self.bounds(cloth).corners().into_iter();
            corners.flat_map(move |corner| (0..3).map(move |axis| corner[axis].abs() + away[axis].abs()))
        };
        let coordinates = (0..self.bvhs.len()).flat_map(of_cloth).map(f64::from);
        coordinates.filter(|x| x.is_finite()).fold(0.0, f64::max)
    }

    /// Calls `found` with each group of a cloth whose leaf overlaps a box, relative to its origin.
    #[inline]
    pub fn query_cloth(&self, cloth: usize, target: &Aabb, mut found: impl FnMut(u32)) {
        let first = self.first_groups[cloth];
        self.bvhs[cloth].query(target, |group| found(first + group));
    }

    /// Whether each hierarchy holds each group of its cloth exactly once.
    pub fn are_covered(&self) -> bool {
        let ends = self.first_groups.iter().skip(1).copied().chain([self.groups.len() as u32]);
        let counts = self.first_groups.iter().zip(ends).map(|(&first, end)| (end - first) as usize);
        self.bvhs.iter().zip(counts).all(|(bvh, count)| bvh.covers(count))
    }

    /// Takes up the shape at rest, and builds the hierarchy over it.
    fn build<R: Real>(&mut self, cloths: &[ClothModel<R>], anchors: &[[f64; 3]]) {
        for model in cloths {
            let rows = model.blocks.rows();
            let first = Vector3::from(anchors[rows.start as usize]);
            for row in rows.map(|row| row as usize) {
                let away = Vector3::from(anchors[row]) - first;
                self.rest_positions[row] = [away.x as f32, away.y as f32, away.z as f32];
            }
        }
        for ClothGroup { cloth, group } in &self.groups {
            let boundary = &cloths[*cloth as usize].boundary;
            let corners = boundary.triangles[group.triangles.clone()].iter().flatten();
            let from = self.points.len();
            self.points.extend(corners.chain(&boundary.points[group.points.clone()]));
            self.points[from..].sort_unstable();
            let mut end = from;
            for at in from..self.points.len() {
                if at == from || self.points[at] != self.points[end - 1] {
                    self.points[end] = self.points[at];
                    end += 1;
                }
            }
            self.points.truncate(end);
            self.ends.push(end as u32);
        }
        let centre = |group: usize| {
            let points = self.points_of(group);
            let sum: Vector3<f64> = points.iter().map(|&point| Vector3::from(anchors[point as usize])).sum();
            sum / f64::max(points.len() as f64, 1.0)
        };
        let ends = self.first_groups.iter().skip(1).copied().chain([self.groups.len() as u32]);
        let of_cloths: Vec<_> = self.first_groups.iter().zip(ends).map(|(&first, end)| first..end).collect();
        let bvh = |groups: Range<u32>| Bvh::new(&groups.map(|k| centre(k as usize)).collect::<Vec<_>>());
        self.bvhs = of_cloths.into_iter().map(bvh).collect();
        self.swept_boxes = vec![[Aabb::EMPTY; 2]; self.groups.len()];
    }
}
