//! Broad phase among cloths: finds the pairs of elements that can touch while every point keeps its motion bound
//! over the candidate interval. Where points violate their bounds, only the pairs of their elements are searched
//! again.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::bvh::Aabb;
use crate::contact::cloth::contact_list::Replaced;
use crate::contact::cloth::contacts::{ClothContacts, GROUPS_PER_TASK, SearchBuffers, TASKS_AT_A_TIME};
use crate::contact::cloth::found_contacts::FoundContacts;
use crate::contact::cloth::intersections::find_intersections;
use crate::contact::cloth::motion_bounds::{BoundPredictor, MarkViolations, Trajectory};
use crate::contact::cloth::near_pairs::ClothPair;
use crate::contact::cloth::search::{ClothSearch, RefreshKind, SearchInput};
use crate::contact::system::{ContactPass, ContactSystem};
use crate::input::frame::FrameInput;
use crate::math::kernel;
use crate::math::{Real, scale, sub};
use crate::model::{ClothModel, Model};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::{StepInterval, TimeInterval};
use crate::state::State;

/// Length of a candidate interval in seconds, and its smallest length in time steps. Longer intervals find more
/// contacts, shorter ones are searched more often: a drape takes a seventh longer with twice the length, at 24
/// and at 96 evaluations.
const CANDIDATE_INTERVAL: f64 = 0.01;
const MIN_INTERVAL_STEPS: f64 = 4.0;
/// Radius of a motion bound, in thicknesses and in edge lengths: the larger counts.
const BOUND_RADIUS: [f64; 2] = [0.4, 0.08];
/// Smallest radius of a motion bound, in metres.
const MIN_BOUND_RADIUS: f64 = 1e-6;

/// Ensures that the contact cache includes all that can touch in this step. Does nothing while every point
/// keeps its motion bound.
pub fn update_cloth_candidates<R: Real>(pass: &mut ContactPass<'_, R>) {
    let ContactPass { model: Model { cloths, .. }, frame, span: now, state, pool, contact, counters, .. } =
        pass;
    let ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, pair_filter, .. } =
        &mut **contact
    else {
        return;
    };
    let is_within = cloth_contacts.interval.lasts_until(now.to);
    let refresh = if is_within { RefreshKind::Incremental } else { RefreshKind::Full };
    let previous_start = cloth_contacts.interval.start;
    if refresh.is_incremental() {
        if !find_violations(cloths, state, cloth_contacts, *now, pool) {
            return;
        }
    } else {
        let least = (now.to - now.from) * MIN_INTERVAL_STEPS;
        // The nearest whole number of intervals of equal length in a frame.
        let length = least.max(1.0 / (frame.duration / CANDIDATE_INTERVAL).round().max(1.0));
        let end = (now.from + length).min(1.0);
        cloth_contacts.interval = TimeInterval { start: now.from, end: end.max(now.to) };
        renew_intersecting(cloths, cloth_contacts);
    }
    predict_trajectories(cloths, state, cloth_contacts, frame, *now, previous_start, refresh, pool);
    let interval_share = cloth_contacts.interval.share_of(now.from);
    let displacement = [&state.start[..], &state.displacement[..]];
    let intersecting = find_candidates(
        cloth_contacts,
        SearchInput {
            cloths,
            anchors: &state.anchor,
            displacement,
            interval_share,
            strength: &material_maps.strength,
            filter: pair_filter,
        },
        refresh,
        pool,
    );
    *counters.pairs_unresolved.get_mut() += intersecting;
    *counters.candidate_pairs.get_mut() += cloth_contacts.cache.len();
    *counters.broad_phases.get_mut() += 1;
}

/// Has all bounds renewed of cloths that intersect, or whose intersections are not all known: which contacts are disabled
/// changes with the contours.
fn renew_intersecting<R: Real>(cloths: &[ClothModel<R>], cloth_contacts: &mut ClothContacts<R>) {
    let ClothContacts { untangling, bounds_violated, .. } = cloth_contacts;
    let due = (0..cloths.len()).filter(|&cloth| untangling.is_search_due[cloth]);
    for cloth in due.chain(untangling.cloth_pairs().iter().flatten().map(|&cloth| cloth as usize)) {
        let points = cloths[cloth].points();
        bounds_violated[points.start as usize..points.end as usize].fill(true);
    }
}

/// Marks the points that violate their bounds at the end of the step; those marked since the last search stay so. Returns
/// whether there are any.
fn find_violations<R: Real>(
    cloths: &[ClothModel<R>],
    state: &State<R>,
    cloth_contacts: &mut ClothContacts<R>,
    now: StepInterval,
    pool: &ThreadPool,
) -> bool {
    let ClothContacts { interval, bounds_violated, trajectories, .. } = cloth_contacts;
    let share = R::from_f64(interval.share_of(now.to));
    let any = AtomicBool::new(false);
    let bounds_violated = DisjointSlice::new(bounds_violated);
    for cloth in cloths {
        pool.parallel_for(cloth.blocks.len(), |block| {
            let points = cloth.blocks.range(block);
            let rows = points.start as usize..points.end as usize;
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            unsafe {
                let is_violated = bounds_violated.run(points);
                kernel::run(MarkViolations {
                    displacement: &state.displacement[rows.clone()],
                    origin: &trajectories.origin[rows.clone()],
                    travel: &trajectories.travel[rows],
                    is_violated: &mut *is_violated,
                    share,
                });
                any.fetch_or(is_violated.contains(&true), Ordering::Relaxed);
            }
        });
    }
    any.into_inner()
}

/// Predicts trajectories for the points that violate theirs. In a full refresh, points that stay near the end
/// of their last trajectory get a trajectory at rest there, without a search. `previous_start` is the start
/// of the last interval.
#[allow(clippy::too_many_arguments)] // what it reads and writes, by name
fn predict_trajectories<R: Real>(
    cloths: &[ClothModel<R>],
    state: &State<R>,
    cloth_contacts: &mut ClothContacts<R>,
    frame: &FrameInput,
    now: StepInterval,
    previous_start: f64,
    refresh: RefreshKind,
    pool: &ThreadPool,
) {
    let ClothContacts { trajectories, interval_start, interval, bounds_violated, cache, .. } = cloth_contacts;
    let of_last = R::from_f64((now.to - now.from) / (now.from - previous_start).max(now.to - now.from));
    let (trajectories, bounds_violated) = (trajectories.shared(), DisjointSlice::new(bounds_violated));
    let predictor = BoundPredictor::new(now, *interval);
    for (cloth, settings) in cloths.iter().zip(&frame.cloths) {
        let thickness = settings.thickness.max(settings.self_collision.thickness);
        let [of_thickness, of_edge] = BOUND_RADIUS;
        let radius = (of_thickness * thickness).max(of_edge * cloth.edge_length).max(MIN_BOUND_RADIUS);
        let radius = R::from_f64(radius);
        pool.parallel_for(cloth.blocks.len(), |block| {
            for row in cloth.blocks.range(block) {
                let before = state.start[row as usize].xyz();
                let motion = sub(state.displacement[row as usize].xyz(), before);
                // The motion of a trembling point over one step does not extrapolate; its motion over the
                // last interval does.
                let last_motion = (!refresh.is_incremental() && now.from > previous_start)
                    .then(|| sub(before, interval_start[row as usize].xyz()));
                let rate = last_motion.map_or(motion, |last_motion| scale(last_motion, of_last));
                // SAFETY: blocks do not overlap.
                #[allow(unsafe_code)]
                unsafe {
                    if !bounds_violated.get(row) {
                        if refresh.is_incremental() {
                            continue;
                        }
                        let last = trajectories.of(row);
                        let rest =
                            Trajectory { origin: last.at(R::ONE), travel: [R::ZERO; 3], radius: last.radius };
                        if predictor.stays_within(&rest, before, motion)
                            || predictor.stays_within(&rest, before, rate)
                        {
                            trajectories.set(row, rest);
                            continue;
                        }
                        bounds_violated.set(row, true);
                    }
                    trajectories.set(row, predictor.extrapolate(before, [motion, rate], radius));
                }
            }
        });
    }
    if !refresh.is_incremental() {
        cache.carry_anchors(&state.anchor, &state.start, interval_start, pool);
        interval_start.clone_from(&state.start);
    }
}

/// Finds the contacts of all elements with a point that violated its bound, or of all elements in a full refresh. Returns the
/// number of pairs that intersect where a weld broke.
fn find_candidates<R: Real>(
    cloth_contacts: &mut ClothContacts<R>,
    input: SearchInput<'_, R>,
    refresh: RefreshKind,
    pool: &ThreadPool,
) -> u64 {
    cloth_contacts.update_bounds(&input, refresh, pool);
    let mut intersecting = 0;
    if !refresh.is_incremental() && cloth_contacts.untangling.may_exist() {
        let ClothContacts { elements, materials, untangling, buffers, .. } = cloth_contacts;
        let bounds = (&buffers.bounds, &buffers.group_bounds[..]);
        intersecting = find_intersections(elements, bounds, materials, &input, untangling, pool);
    }
    let ClothContacts {
        elements, materials, overlapping, bounds_violated, buffers, cache, untangling, ..
    } = cloth_contacts;
    let SearchBuffers { bounds, group_bounds, margins, groups, new_bounds, tasks, has_violations, .. } =
        buffers;
    cache.remove(&Replaced { bounds_violated, has_violations }, pool);
    let search = ClothSearch {
        elements,
        materials,
        overlapping,
        bounds,
        group_bounds,
        untangling,
        input,
        margins,
        bounds_violated,
        new_bounds,
    };
    for groups in groups.chunks(GROUPS_PER_TASK * TASKS_AT_A_TIME) {
        let chunks = groups.len().div_ceil(GROUPS_PER_TASK);
        tasks.resize_with(tasks.len().max(chunks), FoundContacts::default);
        pool.for_each_mut(&mut tasks[..chunks], |task, found| {
            found.clear();
            let groups = groups.chunks(GROUPS_PER_TASK).nth(task).unwrap_or_default();
            search.search_groups(groups, found);
            found.sort_by_task(&elements.block);
        });
        cache.add(&tasks[..chunks], pool);
    }
    cache.finish(elements.blocks);
    bounds_violated.fill(false);
    if !refresh.is_incremental() {
        cloth_contacts.find_overlapping();
    }
    intersecting
}

impl<R: Real> ClothSearch<'_, R> {
    /// Finds all contacts of the elements of some groups that have a new bound.
    fn search_groups(&self, groups: &[u32], found: &mut FoundContacts<R>) {
        let [mut own, mut shifted] = std::mem::take(&mut found.new_elements);
        let mut waiting: Option<ClothPair<'_, R>> = None;
        for &group in groups {
            let ours = self.group(group);
            own.fill(self, &ours);
            for cloth in 0..self.input.cloths.len() {
                let Some(pair) = ClothPair::new(self, [ours.first_edge.0, cloth]) else { continue };
                let swept_box = pair.in_their_space(&own.swept_box);
                let target = swept_box[0].union(swept_box[1]);
                if !self.elements.bounds(cloth).overlaps(&target) {
                    continue;
                }
                let new = pair.elements_in_their_space(&own, &mut shifted);
                // Pairs of several groups together fill the lanes of the narrow phase.
                if let Some(waiting) = &waiting
                    && (waiting.cloths != pair.cloths || found.has_many_overlaps())
                {
                    waiting.find_contacts(found);
                }
                self.elements.query_cloth(cloth, &target, |other| {
                    if Aabb::may_overlap(&swept_box, &self.elements.swept_boxes[other as usize]) {
                        pair.test_boxes((&ours, new), &self.group(other), found);
                    }
                });
                waiting = Some(pair);
            }
        }
        if let Some(waiting) = waiting {
            waiting.find_contacts(found);
        }
        found.new_elements = [own, shifted];
    }
}
