//! Broad phase among cloths: finds the pairs of elements that can touch while every point keeps its motion bound
//! over the candidate interval. Where points violate their bounds, only the pairs of their elements are searched
//! again.

use std::sync::RwLock;

use crate::contact::boundary::{BoundaryElements, ElementGroup};
use crate::contact::bvh::{Aabb, SweptBox};
use crate::contact::cloth::ClothContacts;
use crate::contact::cloth::cache::FoundContacts;
use crate::contact::cloth::element_bounds::{ElementBounds, GroupBoundsCache};
use crate::contact::cloth::elements::ElementGroups;
use crate::contact::cloth::intersections::find_intersections;
use crate::contact::cloth::query::QueryGroup;
use crate::contact::cloth::untangling::Untangling;
use crate::contact::material::ContactMaterial;
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::parallel::thread_pool::ThreadPool;

/// Which contacts a search replaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RefreshKind {
    /// All of them: a candidate interval begins.
    Full,
    /// Those of points that violated their motion bounds.
    Incremental,
}

impl RefreshKind {
    /// Whether contacts of points that keep their bounds stay.
    pub fn is_incremental(self) -> bool {
        self == Self::Incremental
    }
}

/// Buffers of a search, kept between searches.
#[derive(Debug)]
pub struct SearchBuffers<R> {
    bounds: ElementBounds,
    /// The groups with a new bound.
    groups: Vec<u32>,
    tasks: Vec<RwLock<SearchTask<R>>>,
}

/// The contacts that a task finds, and its buffers.
#[derive(Debug)]
pub(super) struct SearchTask<R> {
    pub(super) found: FoundContacts<R>,
    query: QueryGroup,
    group_bounds: GroupBoundsCache,
}

impl<R> Default for SearchTask<R> {
    fn default() -> Self {
        Self {
            found: FoundContacts::default(),
            query: QueryGroup::default(),
            group_bounds: GroupBoundsCache::default(),
        }
    }
}

impl<R> Default for SearchBuffers<R> {
    fn default() -> Self {
        Self { bounds: ElementBounds::default(), groups: Vec::new(), tasks: Vec::new() }
    }
}

/// The input of a search.
#[derive(Clone, Copy)]
pub struct SearchInput<'a, R> {
    /// The cloths.
    pub cloths: &'a [ClothModel<R>],
    /// Anchors in metres.
    pub anchors: &'a [[f64; 3]],
    /// Displacements at the start and at the end of the time step.
    pub displacement: [&'a [Row4<R>]; 2],
    /// The start of the time step, as a share of the candidate interval.
    pub interval_share: f64,
    /// A factor on the collide strength of each point; empty without a map.
    pub strength: &'a [R],
}

/// Groups in a task.
const GROUPS_PER_TASK: usize = 64;

/// A search, shared by its tasks.
pub(super) struct ClothSearch<'a, R> {
    pub(super) elements: &'a ElementGroups,
    pub(super) materials: &'a [Option<ContactMaterial<R>>],
    pub(super) bounds: &'a ElementBounds,
    pub(super) untangling: &'a Untangling,
    pub(super) input: SearchInput<'a, R>,
    bounds_violated: &'a [bool],
    /// Half of the largest interaction range, in metres.
    margin: f32,
}

/// Finds the contacts of all elements with a point that violated its bound, or of all elements in a full refresh.
pub fn find_candidates<R: Real>(
    cloth_contacts: &mut ClothContacts<R>,
    input: SearchInput<'_, R>,
    refresh: RefreshKind,
    pool: &ThreadPool,
) {
    let widest = cloth_contacts
        .materials
        .iter()
        .flatten()
        .map(|material| material.thickness * material.adhesion_range)
        .fold(0.0, f64::max);
    let margin = widest as f32 * 0.5 * (1.0 + 1e-5);
    cloth_contacts.update_bounds(input.anchors, margin, refresh);
    if !refresh.is_incremental() && cloth_contacts.untangling.may_exist() {
        find_intersections(cloth_contacts, &input);
    }
    let ClothContacts { elements, materials, bounds_violated, buffers, cache, untangling, .. } =
        cloth_contacts;
    let SearchBuffers { bounds, groups, tasks } = buffers;
    let chunks = groups.len().div_ceil(GROUPS_PER_TASK);
    tasks.resize_with(tasks.len().max(chunks), RwLock::default);
    let search = ClothSearch { elements, materials, bounds, untangling, input, bounds_violated, margin };
    pool.parallel_for(chunks, |task| {
        // Uncontended: a task runs once.
        let Ok(mut own) = tasks[task].write() else { return };
        own.found.clear();
        own.group_bounds.clear();
        let end = ((task + 1) * GROUPS_PER_TASK).min(groups.len());
        groups[task * GROUPS_PER_TASK..end].iter().for_each(|&group| search.search_group(group, &mut own));
    });
    cache.update(&tasks[..chunks], bounds_violated, refresh, (&elements.block, elements.blocks), pool);
    bounds_violated.fill(false);
}

impl<R: Real> ClothContacts<R> {
    /// Updates the bounds of points and of the groups that contain them: of those that violated theirs, or of
    /// all.
    fn update_bounds(&mut self, anchors: &[[f64; 3]], margin: f32, refresh: RefreshKind) {
        let Self { elements, bounds_violated, buffers, trajectories, .. } = self;
        let SearchBuffers { bounds, groups, .. } = buffers;
        let violated =
            (0..).zip(&*bounds_violated).filter(|(_, is_violated)| **is_violated).map(|(point, _)| point);
        elements.groups_of(violated.clone(), groups);
        if refresh.is_incremental() {
            bounds.update(anchors, trajectories, violated);
            groups.iter().for_each(|&group| elements.set_bound(group, bounds, margin));
        } else {
            bounds.update(anchors, trajectories, 0..anchors.len() as u32);
            (0..elements.groups.len() as u32).for_each(|group| elements.set_bound(group, bounds, margin));
        }
        elements.refit();
    }
}

impl<R: Real> ClothSearch<'_, R> {
    /// Finds all contacts of the elements of a group that have a new bound.
    fn search_group(&self, group: u32, task: &mut SearchTask<R>) {
        let SearchTask { found, query, group_bounds } = task;
        let all = query.fill(self, group);
        self.elements.query(&all[0].union(all[1]), |other| {
            if Aabb::may_overlap(&all, &self.elements.swept_boxes[other as usize]) {
                query.find_contacts(self, other, group_bounds.of(self, other), found);
            }
        });
    }

    /// A group's elements, and the boundary that contains them.
    pub(super) fn elements(&self, group: u32) -> (&BoundaryElements, &ElementGroup) {
        let target = &self.elements.groups[group as usize];
        (&self.input.cloths[target.cloth as usize].boundary, &target.group)
    }

    /// The swept box of some points, inflated by half of the largest interaction range.
    #[inline(always)]
    pub(super) fn bound(&self, points: &[u32]) -> SweptBox {
        self.bounds.bound(points, self.margin)
    }

    /// Whether any of these points has a new bound.
    #[inline(always)]
    pub(super) fn has_new_bound(&self, points: &[u32]) -> bool {
        points.iter().any(|&point| self.bounds_violated[point as usize])
    }
}
