//! The state of contact among cloths.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::cloth::cache::ContactCache;
use crate::contact::cloth::element_bounds::ElementBounds;
use crate::contact::cloth::elements::{ClothGroup, ElementGroups, NewBounds};
use crate::contact::cloth::found_contacts::FoundContacts;
use crate::contact::cloth::frozen::Frozen;
use crate::contact::cloth::group_bounds::GroupBounds;
use crate::contact::cloth::local_anchors::{LocalAnchors, local_anchor};
use crate::contact::cloth::motion_bounds::Trajectories;
use crate::contact::cloth::search::{RefreshKind, SearchInput};
use crate::contact::cloth::untangling::Untangling;
use crate::contact::material::ContactMaterial;
use crate::contact::pair_table::{ContactMaterials, PairTable};
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::particles::population::close_up;
use crate::schedule::TimeInterval;
use crate::state::rows::number_after;

/// All contact among cloths; empty where a scene has none.
pub struct ClothContacts<R> {
    /// The elements of all cloths.
    pub elements: ElementGroups,
    /// Contact materials in this frame, by cloth and cloth.
    pub materials: ContactMaterials<R>,
    /// Which effects they have.
    pub effects: ContactEffects,
    /// Whether the two cloths of each material may overlap, since the scene brought them together. In other cloths, what is
    /// nearer than its thickness is pressed together, and bears loads.
    pub overlapping: PairTable<bool>,
    /// The motion bound of each point over the candidate interval.
    pub trajectories: Trajectories<R>,
    /// Anchors for fast gaps.
    pub local_anchors: LocalAnchors<R>,
    /// Displacements at the start of the candidate interval.
    pub interval_start: Vec<Row4<R>>,
    /// The candidate interval, as shares of the frame.
    pub interval: TimeInterval,
    /// Points that violate their motion bound.
    pub bounds_violated: Vec<bool>,
    /// All contacts that can touch within the candidate interval.
    pub cache: ContactCache<R>,
    /// Buffers of the search.
    pub buffers: SearchBuffers<R>,
    /// Points that the safeguard has frozen in this step.
    pub frozen: Vec<Frozen>,
    /// Intersections, and their corrections.
    pub untangling: Untangling,
}

/// Which effects contact among cloths has in a frame: found once, because a scene of a thousand cloths has a million pairs.
#[derive(Debug, Clone, Copy, Default)]
pub struct ContactEffects {
    /// Some cloths collide.
    pub contact: bool,
    /// Some stick to each other.
    pub adhesion: bool,
    /// Some bounce off each other.
    pub restitution: bool,
}

impl ContactEffects {
    /// Those of the materials of a frame.
    pub fn of<R: Real>(materials: &ContactMaterials<R>) -> Self {
        materials.present().fold(Self::default(), |found, material| Self {
            contact: true,
            adhesion: found.adhesion || material.has_adhesion(),
            restitution: found.restitution || material.has_restitution(),
        })
    }
}

impl<R: Real> ClothContacts<R> {
    /// For cloths of which some may collide with others or with themselves.
    pub fn new(cloths: &[ClothModel<R>], anchors: &[[f64; 3]]) -> Self {
        let rows = anchors.len();
        Self {
            elements: ElementGroups::new(cloths, anchors),
            materials: PairTable::EMPTY,
            effects: ContactEffects::default(),
            overlapping: PairTable::EMPTY,
            trajectories: Trajectories::new(rows),
            local_anchors: LocalAnchors::default(),
            interval_start: vec![Row4::ZERO; rows],
            interval: TimeInterval { start: 1.0, end: 0.0 }, // expired
            bounds_violated: vec![true; rows],
            cache: ContactCache::default(),
            buffers: SearchBuffers::default(),
            frozen: Vec::new(),
            untangling: Untangling::new(rows, cloths.len()),
        }
    }

    /// Follows the particles of an object whose rows are closed up; `kept` are the places of those that remain, which
    /// ascend. Their contacts keep normals and friction anchors.
    pub fn close_up(&mut self, points: Range<u32>, kept: &[u32]) {
        let Self {
            elements,
            cache,
            buffers,
            bounds_violated,
            interval_start,
            trajectories,
            local_anchors,
            // Not by row.
            materials: _,
            effects: _,
            overlapping: _,
            interval: _,
            // Written in each step before it is read.
            frozen: _,
            // Only cloth with faces intersects.
            untangling: _,
        } = self;
        let rows = points.start as usize..points.end as usize;
        buffers.bounds.close_up(rows.clone(), kept);
        buffers.group_margins.clear();
        local_anchors.clear();
        close_up(&mut interval_start[rows.clone()], kept);
        trajectories.close_up(rows.clone(), kept);
        close_up(&mut bounds_violated[rows.clone()], kept);
        let dead = rows.start + kept.len()..rows.end;
        interval_start[dead.clone()].fill(Row4::ZERO);
        bounds_violated[dead].fill(true);
        let number = |row: u32| number_after(row, &points, kept);
        cache.renumber(&number, (&elements.block, elements.blocks));
    }

    /// Has the pairs searched anew that other materials than `before` may find, from one side each: of cloths with other
    /// settings, and not of all that they can touch.
    pub(super) fn search_changed(&mut self, before: &ContactMaterials<R>) {
        let Self { elements, materials, overlapping, bounds_violated, .. } = self;
        let cloths = materials.columns();
        if overlapping.len() == 0 {
            *overlapping = PairTable::of([cloths; 2], |_| true);
        }
        let is_changed = |pair: [usize; 2]| {
            let same = |before| ContactMaterial::same_candidates(&materials[pair], before);
            !before.get(pair).is_some_and(same)
        };
        let mut counts = vec![0; cloths];
        let mut changed = PairTable::of([cloths; 2], is_changed);
        for pair in (0..changed.len()).map(|index| changed.pair(index)).filter(|&pair| changed[pair]) {
            overlapping[pair] = true;
            pair.into_iter().for_each(|side| counts[side] += 1);
        }
        let mut is_searched = vec![false; cloths];
        // A greedy vertex cover.
        while let Some(most) = (0..cloths).max_by_key(|&cloth| counts[cloth]).filter(|&most| counts[most] > 0)
        {
            is_searched[most] = true;
            for other in 0..cloths {
                for pair in [[most, other], [other, most]] {
                    if std::mem::take(&mut changed[pair]) {
                        [most, other].into_iter().for_each(|side| counts[side] -= 1);
                    }
                }
            }
        }
        let points = bounds_violated.iter_mut().zip(&elements.cloth);
        points.for_each(|(is_violated, &cloth)| *is_violated |= is_searched[cloth as usize]);
    }

    /// Finds which cloths still overlap: those with such a contact, and those that intersect. After a search for all contacts.
    pub(super) fn find_overlapping(&mut self) {
        let Self { materials, overlapping, cache, untangling, .. } = self;
        if overlapping.values().contains(&true) || untangling.any() {
            overlapping.values_mut().fill(false);
            let intersecting = untangling.cloth_pairs().iter().map(|pair| pair.map(|cloth| cloth as usize));
            for [a, b] in cache.overlapping_pairs(materials).chain(intersecting) {
                (overlapping[[a, b]], overlapping[[b, a]]) = (true, true);
            }
        }
    }

    /// Whether a cloth can collide with itself or with another in this frame.
    pub fn touches(&self, cloth: usize) -> bool {
        (0..self.materials.columns()).any(|other| self.touch(cloth, other))
    }

    /// Whether two cloths can collide in this frame.
    pub fn touch(&self, cloth: usize, other: usize) -> bool {
        self.materials[[cloth, other]].is_some() || self.materials[[other, cloth]].is_some()
    }

    /// Whether any two cloths can collide in this frame.
    pub fn is_enabled(&self) -> bool {
        self.effects.contact
    }

    /// Sets the margin of the boxes of each cloth: half of what its own elements reach.
    fn set_margins(&mut self) {
        let Self { materials, buffers: SearchBuffers { margins, .. }, .. } = self;
        let reach = |material: &ContactMaterial<R>| material.thickness * material.adhesion_range;
        let of_cloth = |cloth: usize| materials[[cloth; 2]].as_ref().map_or(0.0, reach);
        margins.clear();
        margins.extend((0..materials.columns()).map(|cloth| of_cloth(cloth) as f32 * 0.5 * (1.0 + 1e-5)));
    }

    /// Updates the bounds of points, and of the groups that contain a point whose bound has changed. Finds which points of
    /// each group violated theirs, and lists the groups to be searched: those that have any.
    pub(super) fn update_bounds(
        &mut self,
        input: &SearchInput<'_, R>,
        refresh: RefreshKind,
        pool: &ThreadPool,
    ) {
        self.set_margins();
        self.update_points(input, refresh, pool);
        self.update_groups(input.cloths, pool);
        let Self { elements, buffers, local_anchors, .. } = self;
        let SearchBuffers { bounds, groups, new_bounds, .. } = buffers;
        elements.refit(pool);
        local_anchors.set_extent(elements.extent(&bounds.origins));
        groups.clear();
        groups.extend((0..).zip(&*new_bounds).filter(|(_, new)| **new != NewBounds::None).map(|(at, _)| at));
    }

    /// Updates the bounds of points: of those that violated theirs, or of all. Marks those whose boxes have changed, and the
    /// blocks with violations.
    fn update_points(&mut self, input: &SearchInput<'_, R>, refresh: RefreshKind, pool: &ThreadPool) {
        let SearchInput { cloths, anchors, .. } = *input;
        let Self { elements, bounds_violated, buffers, trajectories, local_anchors, .. } = self;
        let SearchBuffers { bounds, has_changed, has_violations, .. } = buffers;
        let origin = anchors.first().copied().unwrap_or_default();
        if !refresh.is_incremental() {
            bounds.origins.set(cloths, anchors);
        }
        has_changed.clear();
        has_changed.resize(anchors.len(), false);
        has_violations.clear();
        has_violations.resize_with(elements.blocks as usize, AtomicBool::default);
        let (bounds, local_anchors) = (bounds.shared(anchors.len()), local_anchors.shared(anchors));
        let has_changed = DisjointSlice::new(has_changed);
        for (index, cloth) in (0..).zip(cloths) {
            // The rows of dead particles.
            bounds_violated[cloth.points().end as usize..cloth.blocks.rows().end as usize].fill(false);
            pool.parallel_for(cloth.blocks.len(), |block| {
                for row in cloth.blocks.range(block) {
                    let (at, is_violated) = (row as usize, bounds_violated[row as usize]);
                    if !is_violated && refresh.is_incremental() {
                        continue;
                    }
                    // SAFETY: blocks do not overlap.
                    #[allow(unsafe_code)]
                    unsafe {
                        has_changed.set(row, bounds.set([index, row], &trajectories.of(row), anchors[at]));
                        if is_violated {
                            local_anchors.set(row, local_anchor(anchors[at], origin));
                        }
                    }
                    let has_violations = &has_violations[elements.block[at] as usize];
                    if is_violated && !has_violations.load(Ordering::Relaxed) {
                        has_violations.store(true, Ordering::Relaxed);
                    }
                }
            });
        }
    }

    /// Updates the boxes of groups, and which of their points have new bounds.
    fn update_groups(&mut self, cloths: &[ClothModel<R>], pool: &ThreadPool) {
        let Self { elements, bounds_violated, buffers, .. } = self;
        let SearchBuffers { bounds, group_bounds, margins, group_margins, has_changed, new_bounds, .. } =
            buffers;
        let groups = elements.groups.len();
        group_bounds.resize_with(groups, GroupBounds::default);
        new_bounds.resize(groups, NewBounds::None);
        let mut swept_boxes = std::mem::take(&mut elements.swept_boxes);
        let (boxes, group_bounds, new_bounds) = (
            DisjointSlice::new(&mut swept_boxes),
            DisjointSlice::new(group_bounds),
            DisjointSlice::new(new_bounds),
        );
        pool.parallel_for(groups.div_ceil(GROUPS_PER_UPDATE), |task| {
            for group in task * GROUPS_PER_UPDATE..groups.min((task + 1) * GROUPS_PER_UPDATE) {
                let (at, points) = (group as u32, elements.points_of(group));
                let cloth = elements.groups[group].cloth as usize;
                let has_new_margin = group_margins.get(cloth) != Some(&margins[cloth]);
                let changes = has_new_margin || points.iter().any(|&point| has_changed[point as usize]);
                // SAFETY: every group is in one task.
                #[allow(unsafe_code)]
                unsafe {
                    new_bounds.set(at, elements.new_bounds_of(group, bounds_violated));
                    if changes && let [slot] = group_bounds.run(at..at + 1) {
                        let ClothGroup { group, .. } = &elements.groups[group];
                        boxes.set(at, bounds.bound(points, margins[cloth]));
                        slot.fill(&cloths[cloth].boundary, group, bounds, margins[cloth]);
                    }
                }
            }
        });
        elements.swept_boxes = swept_boxes;
        group_margins.clone_from(margins);
    }
}

/// Buffers of a search, kept between searches.
#[derive(Debug)]
pub struct SearchBuffers<R> {
    pub(super) bounds: ElementBounds,
    pub(super) group_bounds: Vec<GroupBounds>,
    /// The margin of the boxes of each cloth in metres.
    pub(super) margins: Vec<f32>,
    /// That of its group bounds as they are; empty if they are out of date.
    group_margins: Vec<f32>,
    /// Whether the boxes of each point have changed.
    has_changed: Vec<bool>,
    /// The groups that are searched.
    pub(super) groups: Vec<u32>,
    /// Which points of each group have new bounds.
    pub(super) new_bounds: Vec<NewBounds>,
    /// Whether a point of each block violated its bound.
    pub(super) has_violations: Vec<AtomicBool>,
    /// The candidates that each task has found.
    pub(super) tasks: Vec<FoundContacts<R>>,
}

/// Groups in a task that updates their boxes.
const GROUPS_PER_UPDATE: usize = 128;
/// Groups in a search task.
pub(super) const GROUPS_PER_TASK: usize = 16;
/// Search tasks whose candidates are held at a time.
pub(super) const TASKS_AT_A_TIME: usize = 64;

impl<R> Default for SearchBuffers<R> {
    fn default() -> Self {
        Self {
            bounds: ElementBounds::default(),
            group_bounds: Vec::new(),
            margins: Vec::new(),
            group_margins: Vec::new(),
            has_changed: Vec::new(),
            groups: Vec::new(),
            new_bounds: Vec::new(),
            has_violations: Vec::new(),
            tasks: Vec::new(),
        }
    }
}
