//! Broad phase of cloth and colliders: predicts motion bounds, searches contacts, and checks that all points keep
//! their bounds.
//!
//! The motion bound of a point is a box that contains its displacement over a window of a few time steps
//! (`window_bounds`), or over the whole candidate interval (`interval_bounds`). The contacts found for a bound
//! are complete as long as the point stays inside it. Bounds are relative to a frame that moves with the fastest
//! collider: in that frame, cloth that the collider carries is at rest and keeps tight bounds.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::Vector3;

use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::collider::pass::ColliderStepArgs;
use crate::contact::collider::query::ColliderQuery;
use crate::contact::material::{ContactMaterial, MIN_THICKNESS};
use crate::contact::time_step::ContactCounters;
use crate::input::frame::FrameInput;
use crate::math::{Real, Row4, add, dot, scale, sub};
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Model, Solver};

/// Margin of a motion bound in thicknesses: for the window, and for the candidate interval.
const WINDOW_MARGIN: f64 = 0.05;
const INTERVAL_MARGIN: f64 = 0.5;
/// Distance that anything may move in a candidate interval, in edge lengths.
const MAX_TRAVEL: f64 = 2.0;
/// Time steps in an active window.
const WINDOW_STEPS: f64 = 8.0;

impl<R: Real> Solver<R> {
    /// Ensures that the active contacts of a cloth include all that can touch in this step. Does nothing while
    /// every point keeps its bound.
    pub(crate) fn update_collider_candidates(
        &mut self,
        frame: &FrameInput,
        cloth: usize,
        schedule: &Schedule<R>,
        times: StepInterval,
        counters: &mut ContactCounters,
    ) {
        let step = [times.from, times.to];
        if step[1] <= self.contact.active_windows[cloth][1] + 1e-9 && !self.has_violations(cloth, step[1]) {
            return;
        }
        let window = loop {
            if step[1] > self.contact.candidate_intervals[cloth][1] + 1e-9 {
                self.begin_candidate_interval(frame, cloth, times);
            }
            let rest = [
                step[0],
                self.contact.candidate_intervals[cloth][1].min(self.interval_end(frame, cloth, times)),
            ];
            let window = [step[0], rest[1].min(step[0] + (step[1] - step[0]) * WINDOW_STEPS)];
            let has_new_bounds = self.predict_bounds(frame, cloth, schedule, step, [window, rest]);
            if self.find_approaching_colliders(cloth, window) {
                continue;
            }
            if has_new_bounds {
                self.find_candidates(cloth, schedule, step[0], counters);
            }
            break window;
        };
        self.contact.active_windows[cloth] = window;
        let Self {
            pool,
            model: Model { cloths, colliders, .. },
            contact:
                ContactSystem {
                    collider_contacts,
                    window_bounds,
                    bound_growth,
                    frame_travel,
                    collider_states,
                    collider_materials,
                    ..
                },
            ..
        } = self;
        let bounds = MotionBounds { boxes: window_bounds, frame_travel: frame_travel[cloth] };
        for list in collider_contacts.iter_mut().filter(|list| list.cloth == cloth) {
            if let Some(material) = &collider_materials[cloth * colliders.len() + list.collider] {
                let is_at_rest = !collider_states[list.collider].moves && frame_travel[cloth] == [R::ZERO; 3];
                let growth = is_at_rest.then_some(&bound_growth[..]);
                list.activate(&bounds, window, material, growth, &cloths[cloth].blocks, pool);
            }
        }
    }

    /// Starts a candidate interval. Around a moving collider it ends after a few edge lengths of motion; around
    /// colliders at rest contacts stay valid for as long as their points keep their bounds.
    fn begin_candidate_interval(&mut self, frame: &FrameInput, cloth: usize, times: StepInterval) {
        if self.near_colliders(cloth).any(|collider| self.contact.collider_states[collider].moves) {
            self.contact.candidate_intervals[cloth] = [times.from, self.interval_end(frame, cloth, times)];
            self.contact.frame_travel[cloth] = self.moving_frame(cloth).map(R::from_f64);
            let points = self.model.cloths[cloth].points();
            self.contact.bounds_violated[points.start as usize..points.end as usize].fill(true);
        } else {
            self.contact.candidate_intervals[cloth] = [0.0, 1.0];
            self.contact.frame_travel[cloth] = [R::ZERO; 3];
        }
    }

    /// The colliders that a cloth can touch in this frame.
    fn near_colliders(&self, cloth: usize) -> impl Iterator<Item = usize> + '_ {
        let lists =
            self.contact.collider_contacts.iter().filter(move |list| list.cloth == cloth && list.is_near);
        lists.map(|list| list.collider).filter(move |&at| self.collider_materials_of(cloth)[at].is_some())
    }

    /// The mean motion in a frame of the fastest collider near a cloth, in metres: the moving frame of its bounds.
    fn moving_frame(&self, cloth: usize) -> [f64; 3] {
        let fastest = self
            .near_colliders(cloth)
            .map(|collider| self.contact.collider_states[collider].mean_travel)
            .reduce(|most, travel| if travel.norm_squared() > most.norm_squared() { travel } else { most });
        fastest.unwrap_or_default().into()
    }

    /// End of the candidate interval: the end of the substep, or the time at which something has moved
    /// [`MAX_TRAVEL`] edge lengths. Boxes over longer motion would overlap too much.
    fn interval_end(&self, frame: &FrameInput, cloth: usize, times: StepInterval) -> f64 {
        let (step, end_of_substep) = ([times.from, times.to], times.end_of_substep);
        let model = &self.model.cloths[cloth];
        let points = model.points();
        let rows = &self.state.velocity[points.start as usize..points.end as usize];
        let squares = rows.iter().map(|row| dot(row.xyz(), row.xyz()).to_f64());
        let max_speed = squares.fold(0.0, f64::max).sqrt() * frame.duration;
        let near =
            self.near_colliders(cloth).map(|collider| self.contact.collider_states[collider].max_travel);
        let farthest = near.fold(max_speed, f64::max);
        let length = step[1] - step[0];
        let steps = (MAX_TRAVEL * model.edge_length / (farthest * length)).floor().max(1.0);
        // Rounds to the end of the substep.
        if step[0] + steps * length >= end_of_substep - length / 2.0 {
            end_of_substep
        } else {
            step[0] + steps * length
        }
    }

    /// Searches contacts of a cloth with every collider, for all points with a new bound.
    fn find_candidates(
        &mut self,
        cloth: usize,
        schedule: &Schedule<R>,
        now: f64,
        counters: &mut ContactCounters,
    ) {
        let Self {
            state,
            pool,
            model: Model { cloths, colliders, .. },
            contact:
                ContactSystem {
                    collider_states,
                    collider_contacts,
                    interval_bounds,
                    candidate_intervals,
                    frame_travel,
                    bounds_violated,
                    collider_materials,
                    material_maps,
                    ..
                },
            ..
        } = self;
        let interval = candidate_intervals[cloth];
        let bounds = MotionBounds { boxes: interval_bounds, frame_travel: frame_travel[cloth] };
        let mut freed = Vec::new();
        for list in collider_contacts.iter_mut().filter(|list| list.cloth == cloth) {
            let collider = list.collider;
            list.interval = interval;
            let material = collider_materials[cloth * colliders.len() + collider];
            let Some(material) = material.filter(|_| list.is_near) else {
                list.clear();
                continue;
            };
            collider_states[collider].fit_boxes(&colliders[collider], interval);
            let state_of = &collider_states[collider];
            let view = ColliderStepArgs { material, material_maps, h: schedule.h, time: [now; 2], interval };
            let step = &view.of(state, state_of);
            let (cloth, collider) = (&cloths[cloth], &colliders[collider]);
            let frame_shifts = interval
                .map(|time| Vector3::from(bounds.travel_at(time).map(R::to_f64)) - state_of.origin(time));
            ColliderQuery {
                cloth,
                collider,
                state: state_of,
                motion_bounds: bounds,
                bounds_violated,
                step,
                frame_shifts,
            }
            .run(list, pool);
            if material.depenetrates {
                list.depenetration.suspect_start(cloth.points(), collider, state_of, step);
                list.depenetration.update(collider, state_of, step, |point| freed.push(point));
            } else {
                list.depenetration.clear();
            }
            *counters.candidate_pairs.get_mut() += list.len() as u64;
        }
        *counters.broad_phases.get_mut() += 1;
        let points = cloths[cloth].points();
        bounds_violated[points.start as usize..points.end as usize].fill(false);
        // Their contacts were found while they were inside.
        freed.into_iter().for_each(|point| bounds_violated[point as usize] = true);
    }

    /// Predicts the window bounds of a cloth's points, and interval bounds where they are violated or do not
    /// contain the window bound. Returns whether there were any.
    fn predict_bounds(
        &mut self,
        frame: &FrameInput,
        cloth: usize,
        schedule: &Schedule<R>,
        step: [f64; 2],
        [window, rest]: [[f64; 2]; 2],
    ) -> bool {
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact:
                ContactSystem {
                    window_bounds, bound_growth, interval_bounds, frame_travel, bounds_violated, ..
                },
            ..
        } = self;
        let [frame_at_start, frame_now] = step.map(|time| travel_at(frame_travel[cloth], time));
        let thickness = frame.cloths[cloth].thickness.max(MIN_THICKNESS);
        let most = R::from_f64(cloths[cloth].edge_length);
        let horizon = |time: [f64; 2], margin_share: f64| {
            let left = (time[1] - time[0]) * frame.duration;
            let margin = frame.gravity.norm() * left * left / 2.0 + margin_share * thickness;
            (R::from_f64(left / schedule.h - 1.0), [R::from_f64(margin), most])
        };
        let (window_bound, interval_bound) = (horizon(window, WINDOW_MARGIN), horizon(rest, INTERVAL_MARGIN));
        let (window_bounds, bound_growth, interval_bounds, bounds_violated) = (
            DisjointSlice::new(window_bounds),
            DisjointSlice::new(bound_growth),
            DisjointSlice::new(interval_bounds),
            DisjointSlice::new(bounds_violated),
        );
        let any = AtomicBool::new(false);
        let blocks = &cloths[cloth].blocks;
        pool.parallel_for(blocks.len(), |block| {
            for row in blocks.range(block) {
                let start = sub(state.start[row as usize].xyz(), frame_at_start);
                let now = sub(state.displacement[row as usize].xyz(), frame_now);
                let bound = predict_box(start, now, window_bound.0, window_bound.1);
                // SAFETY: blocks do not overlap.
                #[allow(unsafe_code)]
                unsafe {
                    let growth = box_growth(&window_bounds.get(row), &bound);
                    bound_growth.set(row, bound_growth.get(row) + growth);
                    window_bounds.set(row, bound);
                    if bounds_violated.get(row) || !box_within(&bound, &interval_bounds.get(row)) {
                        interval_bounds.set(row, predict_box(start, now, interval_bound.0, interval_bound.1));
                        bounds_violated.set(row, true);
                        any.store(true, Ordering::Relaxed);
                    }
                }
            }
        });
        any.into_inner()
    }

    /// Whether a point of the cloth violates its window bound at a time of the frame.
    fn has_violations(&self, cloth: usize, now: f64) -> bool {
        let frame_motion = travel_at(self.contact.frame_travel[cloth], now);
        let keeps_bound = |row: u32| {
            box_contains(
                &self.contact.window_bounds[row as usize],
                self.state.displacement[row as usize].xyz(),
                frame_motion,
            )
        };
        let any = AtomicBool::new(false);
        let blocks = &self.model.cloths[cloth].blocks;
        self.pool.parallel_for(blocks.len(), |block| {
            if !blocks.range(block).all(keeps_bound) {
                any.store(true, Ordering::Relaxed);
            }
        });
        any.into_inner()
    }

    /// Takes contacts over into a new frame, before anchors move. Those of a cloth are searched anew if a collider near
    /// it has moved, or if its materials change the candidates.
    pub(crate) fn begin_collider_contact(&mut self, frame: &FrameInput) {
        self.contact.active_windows.fill([0.0, 0.0]);
        self.contact.candidate_intervals.fill([0.0, 0.0]);
        self.contact.bound_growth.fill(R::ZERO);
        let is_same = self.update_materials(frame);
        for (cloth, is_same) in is_same.into_iter().enumerate() {
            if !self.has_collider_material(cloth) {
                let lists = self.contact.collider_contacts.iter_mut().filter(|list| list.cloth == cloth);
                lists.for_each(ColliderContacts::clear);
            }
            let moved =
                self.near_colliders(cloth).any(|collider| self.contact.collider_states[collider].moves);
            if is_same && !moved {
                self.rebase_contacts(cloth);
            } else {
                self.invalidate_cloth(cloth);
            }
        }
    }

    /// Rebases the contacts and interval bounds of a cloth on anchors that move to the points' positions.
    fn rebase_contacts(&mut self, cloth: usize) {
        let Self {
            state,
            model: Model { cloths, .. },
            contact: ContactSystem { collider_contacts, interval_bounds, bounds_violated, .. },
            ..
        } = self;
        for list in collider_contacts.iter_mut().filter(|list| list.cloth == cloth) {
            // Points inside a collider are tested in every frame.
            list.depenetration.points.iter().for_each(|&(point, _)| bounds_violated[point as usize] = true);
            list.shift_anchors(&state.displacement);
        }
        let rows = cloths[cloth].points().start as usize..cloths[cloth].points().end as usize;
        let bounds = interval_bounds.get_mut(rows.clone()).unwrap_or_default();
        for ([low, high], moved) in bounds.iter_mut().zip(&state.displacement[rows]) {
            for axis in 0..3 {
                low.0[axis] -= moved.0[axis];
                high.0[axis] -= moved.0[axis];
            }
        }
    }

    /// Invalidates all interval bounds of a cloth.
    fn invalidate_cloth(&mut self, cloth: usize) {
        let rows =
            self.model.cloths[cloth].points().start as usize..self.model.cloths[cloth].points().end as usize;
        self.contact.bounds_violated.get_mut(rows).unwrap_or_default().fill(true);
    }

    /// Finds the colliders that each cloth can touch in this frame, once they have taken up their motion. A moving
    /// collider whose bounding box stays away from the cloth is far, and has no influence on it. Should the cloth approach
    /// it within the frame, [`find_approaching_colliders`](Self::find_approaching_colliders) makes it near.
    pub(crate) fn find_near_colliders(&mut self, frame: &FrameInput) {
        for index in 0..self.contact.collider_contacts.len() {
            let ColliderContacts { cloth, collider, is_near: was_near, .. } =
                self.contact.collider_contacts[index];
            let motion = &frame.colliders[collider];
            let is_renewed = !motion.start.is_empty() || !motion.end.is_empty();
            let is_near =
                !is_renewed || self.can_touch_in_frame(cloth, collider, frame.duration, frame.gravity.norm());
            self.contact.collider_contacts[index].is_near = is_near;
            if is_near && (is_renewed || !was_near) {
                self.invalidate_cloth(cloth);
            }
            if !is_near {
                self.contact.collider_contacts[index].clear();
            }
        }
    }

    /// Whether the bounding box of a cloth, inflated by its interaction range and by free flight for a frame, overlaps the
    /// box that a collider sweeps in the frame.
    fn can_touch_in_frame(&self, cloth: usize, collider: usize, duration: f64, gravity: f64) -> bool {
        let Some(material) = &self.collider_materials_of(cloth)[collider] else { return false };
        let model = &self.model.cloths[cloth];
        let squares = model.points().map(|row| self.state.velocity[row as usize].xyz());
        let speed = squares.map(|v| dot(v, v).to_f64()).fold(0.0, f64::max).sqrt();
        let flight = (speed + gravity * duration) * duration;
        let room = material.thickness * material.adhesion_range + flight + MAX_TRAVEL * model.edge_length;
        let cloth_box = bounding_box(model.points().map(|row| self.state.position(row)));
        overlaps(cloth_box, room, self.contact.collider_states[collider].swept_bounds())
    }

    /// Makes colliders near whose swept box overlaps the window bounds of a cloth. Returns whether there were any: all
    /// bounds must then be predicted anew.
    fn find_approaching_colliders(&mut self, cloth: usize, window: [f64; 2]) -> bool {
        if self.contact.collider_contacts.iter().all(|list| list.cloth != cloth || list.is_near) {
            return false;
        }
        let frame_motion =
            window.map(|time| travel_at(self.contact.frame_travel[cloth], time).map(R::to_f64));
        let corners = self.model.cloths[cloth].points().flat_map(|row| {
            let anchor = self.state.anchor[row as usize];
            let bound = self.contact.window_bounds[row as usize].map(|corner| corner.xyz().map(R::to_f64));
            bound.into_iter().flat_map(move |corner| frame_motion.map(|by| add(add(anchor, corner), by)))
        });
        let cloth_box = bounding_box(corners);
        let mut any = false;
        for index in 0..self.contact.collider_contacts.len() {
            let ColliderContacts { cloth: of, collider, is_near, .. } = self.contact.collider_contacts[index];
            let material = self.collider_materials_of(cloth)[collider].filter(|_| of == cloth && !is_near);
            let Some(material) = material else { continue };
            let room = material.thickness * material.adhesion_range;
            if overlaps(cloth_box, room, self.contact.collider_states[collider].swept_bounds()) {
                self.contact.collider_contacts[index].is_near = true;
                any = true;
            }
        }
        if any {
            self.invalidate_cloth(cloth);
            self.contact.candidate_intervals[cloth] = [0.0; 2];
        }
        any
    }

    /// Sets the contact materials of every cloth with colliders and the ground. Returns for each cloth whether its
    /// candidates stay the same.
    fn update_materials(&mut self, frame: &FrameInput) -> Vec<bool> {
        let settings = || frame.cloths.iter().zip(&self.contact.material_maps.max_thickness_factor);
        let for_ground = |(cloth, &max_thickness_factor)| {
            frame
                .plane
                .as_ref()
                .and_then(|ground| ContactMaterial::for_ground(cloth, ground, max_thickness_factor))
        };
        let materials: Vec<_> = settings()
            .flat_map(|(cloth, &max_thickness_factor)| {
                frame
                    .colliders
                    .iter()
                    .map(move |collider| ContactMaterial::for_collider(cloth, collider, max_thickness_factor))
            })
            .collect();
        self.contact.ground_materials = settings().map(for_ground).collect();
        let before = std::mem::replace(&mut self.contact.collider_materials, materials);
        let colliders = self.model.colliders.len();
        let is_same = |cloth: usize| {
            let of_cloth = cloth * colliders..(cloth + 1) * colliders;
            let before = before.get(of_cloth.clone()).unwrap_or_default();
            ContactMaterial::same_candidates(&self.contact.collider_materials[of_cloth], before)
        };
        (0..self.model.cloths.len()).map(is_same).collect()
    }
}

/// The bounding box of some positions, in metres.
fn bounding_box(positions: impl Iterator<Item = [f64; 3]>) -> [Vector3<f64>; 2] {
    let empty = [Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)];
    positions
        .map(Vector3::from)
        .fold(empty, |[low, high], position| [low.inf(&position), high.sup(&position)])
}

/// Whether a box, inflated by `room`, overlaps another.
fn overlaps(ours: [Vector3<f64>; 2], room: f64, theirs: [Vector3<f64>; 2]) -> bool {
    (0..3).all(|k| ours[0][k] - room <= theirs[1][k] && theirs[0][k] <= ours[1][k] + room)
}

/// Motion bound: low and high corner of a point's displacement in metres, relative to the moving frame.
pub type MotionBox<R> = [Row4<R>; 2];

/// The motion bounds of a cloth's points.
#[derive(Debug, Clone, Copy)]
pub struct MotionBounds<'a, R> {
    /// One for each row.
    pub boxes: &'a [MotionBox<R>],
    /// Motion of the moving frame in a frame, in metres.
    pub frame_travel: [R; 3],
}

impl<R: Real> MotionBounds<'_, R> {
    /// The bound of one point.
    #[inline(always)]
    pub fn of(&self, point: u32) -> MotionBox<R> {
        self.boxes[point as usize]
    }

    /// Motion of the moving frame up to a time, given as a share of the frame.
    #[inline(always)]
    pub fn travel_at(&self, time: f64) -> [R; 3] {
        travel_at(self.frame_travel, time)
    }
}

/// Motion of a moving frame up to a time, given as a share of the frame.
#[inline(always)]
pub fn travel_at<R: Real>(drift: [R; 3], time: f64) -> [R; 3] {
    scale(drift, R::from_f64(time))
}

/// Margin of a bound on all sides, as a share of the point's predicted motion.
const TRAVEL_MARGIN: f64 = 0.25;

/// Predicts a bound: it contains the start and the end of this step, and the extrapolation of this motion over
/// `steps_left` steps, with a margin. The motion contributes at most `most` to the margin.
pub fn predict_box<R: Real>(
    start: [R; 3],
    now: [R; 3],
    steps_left: R,
    [margin, most]: [R; 2],
) -> MotionBox<R> {
    let mut travel = R::ZERO;
    let end: [R; 3] = std::array::from_fn(|axis| now[axis] + (now[axis] - start[axis]) * steps_left);
    for axis in 0..3 {
        let along = end[axis] - start[axis];
        travel = max(travel, max(along, -along));
    }
    let margin_share = travel * R::from_f64(TRAVEL_MARGIN);
    let margin = margin + if margin_share > most { most } else { margin_share };
    let corner = |side: R, pick: fn(R, R) -> R| {
        let at = |axis: usize| pick(pick(start[axis], now[axis]), end[axis]) + margin * side;
        Row4([at(0), at(1), at(2), R::ZERO])
    };
    [corner(-R::ONE, min), corner(R::ONE, max)]
}

/// The diagonal of a bound, in metres.
pub fn diagonal<R: Real>([low, high]: &MotionBox<R>) -> R {
    let diagonal: [R; 3] = std::array::from_fn(|axis| high.0[axis] - low.0[axis]);
    dot(diagonal, diagonal).sqrt()
}

/// How far a bound extends beyond an older one, in metres: the sum over all axes.
fn box_growth<R: Real>(old: &MotionBox<R>, new: &MotionBox<R>) -> R {
    let of_axis = |axis: usize| {
        let beyond = max(old[0].0[axis] - new[0].0[axis], new[1].0[axis] - old[1].0[axis]);
        max(beyond, R::ZERO)
    };
    of_axis(0) + of_axis(1) + of_axis(2)
}

/// Whether one bound contains another.
pub fn box_within<R: Real>(inner: &MotionBox<R>, outer: &MotionBox<R>) -> bool {
    (0..3).all(|axis| outer[0].0[axis] <= inner[0].0[axis] && inner[1].0[axis] <= outer[1].0[axis])
}

/// Whether a bound contains a displacement; `frame_motion` is the motion of the moving frame.
pub fn box_contains<R: Real>([low, high]: &MotionBox<R>, now: [R; 3], frame_motion: [R; 3]) -> bool {
    let now = sub(now, frame_motion);
    (0..3).all(|axis| low.0[axis] <= now[axis] && now[axis] <= high.0[axis])
}

fn min<R: Real>(a: R, b: R) -> R {
    if b < a { b } else { a }
}

fn max<R: Real>(a: R, b: R) -> R {
    if b > a { b } else { a }
}
