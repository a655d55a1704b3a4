//! Broad phase of cloth and colliders: predicts motion bounds, searches contacts, and checks that all points keep
//! their bounds.
//!
//! The motion bound of a point is a box that contains its displacement over a window of a few time steps
//! (`window_bounds`), or over the whole candidate interval (`interval_bounds`). The contacts found for a bound
//! are complete as long as the point stays inside it. Bounds are relative to a frame that moves with the fastest
//! collider: in that frame, cloth that the collider carries is at rest and keeps tight bounds.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::collider::pass::ColliderStepArgs;
use crate::contact::collider::query::ColliderQuery;
use crate::contact::material::{ContactMaterial, MIN_THICKNESS};
use crate::contact::time_step::ContactCounters;
use crate::input::frame::{ColliderFrame, FrameInput};
use crate::math::{Real, Row4, dot, scale, sub};
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
        if step[1] > self.contact.candidate_intervals[cloth][1] + 1e-9 {
            self.begin_candidate_interval(frame, cloth, times);
        }
        let rest =
            [step[0], self.contact.candidate_intervals[cloth][1].min(self.interval_end(frame, cloth, times))];
        let window = [step[0], rest[1].min(step[0] + (step[1] - step[0]) * WINDOW_STEPS)];
        if self.predict_bounds(frame, cloth, schedule, step, [window, rest]) {
            self.find_candidates(cloth, schedule, step[0], counters);
        }
        self.contact.active_windows[cloth] = window;
        let Self {
            pool,
            model: Model { cloths, colliders, .. },
            contact: ContactSystem { collider_contacts, window_bounds, frame_travel, collider_materials, .. },
            ..
        } = self;
        let bounds = MotionBounds { boxes: window_bounds, frame_travel: frame_travel[cloth] };
        for list in collider_contacts.iter_mut().filter(|list| list.cloth == cloth) {
            if let Some(material) = &collider_materials[cloth * colliders.len() + list.collider] {
                let thickness = R::from_f64(material.thickness);
                list.activate(
                    &bounds,
                    window,
                    thickness,
                    material.adhesion_range,
                    &cloths[cloth].blocks,
                    pool,
                );
            }
        }
    }

    /// Starts a candidate interval. Around a moving collider it ends after a few edge lengths of motion; around
    /// colliders at rest contacts stay valid for as long as their points keep their bounds.
    fn begin_candidate_interval(&mut self, frame: &FrameInput, cloth: usize, times: StepInterval) {
        let touching = |(_, theirs): &(&ColliderState, &ColliderFrame)| theirs.collide;
        let mut colliders = self.contact.collider_states.iter().zip(&frame.colliders).filter(touching);
        if colliders.any(|(collider, _)| collider.moves) {
            self.contact.candidate_intervals[cloth] = [times.from, self.interval_end(frame, cloth, times)];
            self.contact.frame_travel[cloth] = self.moving_frame(cloth).map(R::from_f64);
            let points = self.model.cloths[cloth].points();
            self.contact.bounds_violated[points.start as usize..points.end as usize].fill(true);
        } else {
            self.contact.candidate_intervals[cloth] = [0.0, 1.0];
            self.contact.frame_travel[cloth] = [R::ZERO; 3];
        }
    }

    /// The mean motion in a frame of the fastest collider that a cloth can touch, in metres: the moving frame of
    /// its bounds.
    fn moving_frame(&self, cloth: usize) -> [f64; 3] {
        let colliding = self
            .contact
            .collider_states
            .iter()
            .zip(self.collider_materials_of(cloth))
            .filter(|(_, material)| material.is_some());
        let fastest = colliding
            .map(|(collider, _)| collider.mean_travel)
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
        let colliding =
            self.contact.collider_states.iter().zip(&frame.colliders).filter(|(_, theirs)| theirs.collide);
        let farthest = colliding.map(|(collider, _)| collider.max_travel).fold(max_speed, f64::max);
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
            let Some(material) = collider_materials[cloth * colliders.len() + collider] else {
                list.clear();
                continue;
            };
            list.interval = interval;
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
            contact: ContactSystem { window_bounds, interval_bounds, frame_travel, bounds_violated, .. },
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
        let (window_bounds, interval_bounds, bounds_violated) = (
            DisjointSlice::new(window_bounds),
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

    /// Takes contacts over into a new frame, before anchors move. They are searched anew if a collider moved or
    /// will move, or if the materials change the candidates.
    pub(crate) fn begin_collider_contact(&mut self, frame: &FrameInput) {
        self.contact.active_windows.fill([0.0, 0.0]);
        self.contact.candidate_intervals.fill([0.0, 0.0]);
        let is_same = self.update_materials(frame);
        let moves =
            frame.colliders.iter().any(|collider| !collider.start.is_empty() || !collider.end.is_empty());
        let moved = self.contact.collider_states.iter().any(|collider| collider.moves);
        if !is_same || moves || moved {
            self.contact.bounds_violated.fill(true);
            for cloth in 0..self.model.cloths.len() {
                if !self.has_collider_material(cloth) {
                    self.contact
                        .collider_contacts
                        .iter_mut()
                        .filter(|list| list.cloth == cloth)
                        .for_each(ColliderContacts::clear);
                }
            }
            return;
        }
        let Self {
            state,
            contact: ContactSystem { collider_contacts, interval_bounds, bounds_violated, .. },
            ..
        } = self;
        // Points inside a collider are tested in every frame.
        for &(point, _) in collider_contacts.iter().flat_map(|list| &list.depenetration.points) {
            bounds_violated[point as usize] = true;
        }
        for ([low, high], moved) in interval_bounds.iter_mut().zip(&state.displacement) {
            for axis in 0..3 {
                low.0[axis] -= moved.0[axis];
                high.0[axis] -= moved.0[axis];
            }
        }
        collider_contacts.iter_mut().for_each(|list| list.shift_anchors(&state.displacement));
    }

    /// Sets the contact materials of every cloth with colliders and the ground. Returns whether the candidates
    /// stay the same.
    fn update_materials(&mut self, frame: &FrameInput) -> bool {
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
        let is_same = ContactMaterial::same_candidates(&materials, &self.contact.collider_materials);
        self.contact.collider_materials = materials;
        is_same
    }
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
