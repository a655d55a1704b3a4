//! Broad phase of cloth and colliders: predicts motion bounds, searches contacts, and checks that all points keep
//! their bounds.
//!
//! The motion bound of a point is a box that contains its displacement over a window of a few time steps
//! (`window_bounds`), or over the whole candidate interval (`interval_bounds`). The contacts found for a bound
//! are complete as long as the point stays inside it. Bounds are relative to a frame that moves with the fastest
//! collider: in that frame, cloth that the collider carries is at rest and keeps tight bounds.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::Vector3;

use crate::contact::collider::frame_start::{find_approaching_colliders, near_colliders};
use crate::contact::collider::motion_bounds::{
    MAX_TRAVEL, MotionBounds, box_contains, box_growth, box_within, predict_box, travel_row,
};
use crate::contact::collider::query::ColliderQuery;
use crate::contact::material::MIN_THICKNESS;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::contact::time_step::ColliderStepArgs;
use crate::math::{Real, dot};
use crate::model::Model;
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{StepInterval, TimeInterval};

/// Margin of a motion bound in thicknesses: for the window, and for the candidate interval.
const WINDOW_MARGIN: f64 = 0.05;
const INTERVAL_MARGIN: f64 = 0.5;
/// Time steps in an active window.
const WINDOW_STEPS: f64 = 8.0;

/// Ensures that the active contacts of a cloth include all that can touch in this step. Does nothing while
/// every point keeps its bound.
pub fn update_collider_candidates<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize) {
    let step = pass.span.times();
    if pass.contact.active_windows[cloth].lasts_until(step.end) && !has_violations(pass, cloth) {
        return;
    }
    let window = loop {
        if !pass.contact.candidate_intervals[cloth].lasts_until(step.end) {
            begin_candidate_interval(pass, cloth);
        }
        let end = pass.contact.candidate_intervals[cloth].end.min(interval_end(pass, cloth));
        let rest = TimeInterval { end, ..step };
        let window = TimeInterval { end: end.min(step.start + step.length() * WINDOW_STEPS), ..step };
        let has_new_bounds = predict_bounds(pass, cloth, window, rest);
        if find_approaching_colliders(pass.model, pass.state, pass.contact, cloth, window) {
            continue;
        }
        if has_new_bounds {
            find_candidates(pass, cloth);
        }
        break window;
    };
    pass.contact.active_windows[cloth] = window;
    let of_cloth = pass.contact.lists_of(cloth);
    let ContactPass {
        pool,
        model: Model { cloths, .. },
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
    } = pass;
    let bounds = MotionBounds { boxes: window_bounds, first: 0, frame_travel: frame_travel[cloth] };
    for list in &mut collider_contacts[of_cloth] {
        if let Some(material) = &collider_materials[[cloth, list.collider]] {
            let is_at_rest = !collider_states[list.collider].moves && frame_travel[cloth] == [R::ZERO; 3];
            let growth = is_at_rest.then_some(&bound_growth[..]);
            list.activate(&bounds, window, material, growth, &cloths[cloth].blocks, pool);
        }
    }
}

/// Starts a candidate interval. Around a moving collider it ends after a few edge lengths of motion; around
/// colliders at rest contacts stay valid for as long as their points keep their bounds.
fn begin_candidate_interval<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize) {
    if near_colliders(pass.contact, cloth).any(|collider| pass.contact.collider_states[collider].moves) {
        pass.contact.candidate_intervals[cloth] =
            TimeInterval { start: pass.span.from, end: interval_end(pass, cloth) };
        pass.contact.frame_travel[cloth] = moving_frame(pass.contact, cloth).map(R::from_f64);
        let points = pass.model.cloths[cloth].points();
        pass.contact.bounds_violated[points.start as usize..points.end as usize].fill(true);
    } else {
        pass.contact.candidate_intervals[cloth] = TimeInterval { start: 0.0, end: 1.0 };
        pass.contact.frame_travel[cloth] = [R::ZERO; 3];
    }
}

/// The mean motion in a frame of the fastest collider near a cloth, in metres: the moving frame of its bounds.
fn moving_frame<R: Real>(contact: &ContactSystem<R>, cloth: usize) -> [f64; 3] {
    let fastest = near_colliders(contact, cloth)
        .map(|collider| contact.collider_states[collider].mean_travel)
        .reduce(|most, travel| if travel.norm_squared() > most.norm_squared() { travel } else { most });
    fastest.unwrap_or_default().into()
}

/// End of the candidate interval: the end of the substep, or the time at which something has moved
/// [`MAX_TRAVEL`] edge lengths. Boxes over longer motion would overlap too much.
fn interval_end<R: Real>(pass: &ContactPass<'_, R>, cloth: usize) -> f64 {
    let StepInterval { from, to, end_of_substep } = pass.span;
    let model = &pass.model.cloths[cloth];
    let points = match model.edge_length > 0.0 {
        true => model.points(),
        false => 0..0, // one step at any speed
    };
    let rows = &pass.state.velocity[points.start as usize..points.end as usize];
    let least = pass.pool.least(rows.len(), |at| -dot(rows[at].xyz(), rows[at].xyz()).to_f64());
    let max_speed = (-least).max(0.0).sqrt() * pass.frame.duration;
    let near =
        near_colliders(pass.contact, cloth).map(|collider| pass.contact.collider_states[collider].max_travel);
    let farthest = near.fold(max_speed, f64::max);
    let length = to - from;
    let steps = (MAX_TRAVEL * model.edge_length / (farthest * length)).floor().max(1.0);
    // Rounds to the end of the substep.
    let end = from + steps * length;
    if end >= end_of_substep - length / 2.0 { end_of_substep } else { end }
}

/// Searches contacts of a cloth with every collider, for all points with a new bound.
fn find_candidates<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize) {
    let mut freed = Vec::new();
    for list in pass.contact.lists_of(cloth) {
        find_candidates_of_list(pass, (cloth, list), &mut freed);
    }
    *pass.counters.broad_phases.get_mut() += 1;
    let points = pass.model.cloths[cloth].points();
    let bounds_violated = &mut pass.contact.bounds_violated;
    bounds_violated[points.start as usize..points.end as usize].fill(false);
    // Their contacts were found while they were inside.
    freed.into_iter().for_each(|point| bounds_violated[point as usize] = true);
}

/// Searches the contacts of one list, and the points of its cloth inside its collider; collects those that are no longer
/// inside.
fn find_candidates_of_list<R: Real>(
    pass: &mut ContactPass<'_, R>,
    (cloth, list): (usize, usize),
    freed: &mut Vec<u32>,
) {
    let ContactPass { state, pool, model: Model { cloths, colliders, .. }, contact, .. } = pass;
    let ContactSystem {
        collider_states,
        collider_contacts,
        interval_bounds,
        candidate_intervals,
        frame_travel,
        bounds_violated,
        collider_materials,
        material_maps,
        pair_filter,
        ..
    } = &mut **contact;
    let list = &mut collider_contacts[list];
    let (interval, at) = (candidate_intervals[cloth], list.collider);
    list.interval = interval;
    let material = collider_materials[[cloth, at]];
    let Some(material) = material.filter(|_| list.is_near) else {
        list.clear();
        if material.is_none() {
            list.depenetration.clear();
        }
        return;
    };
    collider_states[at].fit_boxes(&colliders[at], interval, pool);
    let collider_state = &collider_states[at];
    let args = ColliderStepArgs {
        material,
        material_maps,
        at,
        h: pass.schedule.h,
        time: TimeInterval::at(pass.span.from),
        interval,
    };
    let step = &args.of(state, collider_state);
    let motion_bounds = MotionBounds { boxes: interval_bounds, first: 0, frame_travel: frame_travel[cloth] };
    let (cloth, collider) = (&cloths[cloth], &colliders[at]);
    let frame_shifts = interval.ends().map(|time| {
        Vector3::from(motion_bounds.travel_at(time).map(R::to_f64)) - collider_state.origin(time)
    });
    ColliderQuery {
        cloth,
        collider,
        state: collider_state,
        motion_bounds,
        bounds_violated,
        filter: (pair_filter, at),
        step,
        frame_shifts,
    }
    .run(list, pool);
    if material.depenetrates {
        list.depenetration.suspect_start(cloth.points(), collider, collider_state, step);
        let excluded = |point: u32, corners: [u32; 3]| pair_filter.excludes_collider(&[point], at, &corners);
        list.depenetration.update(collider, collider_state, step, excluded, |point| freed.push(point));
    } else {
        list.depenetration.clear();
    }
    *pass.counters.candidate_pairs.get_mut() += list.len() as u64;
}

/// Predicts the window bounds of a cloth's points, and interval bounds where they are violated or do not
/// contain the window bound. Returns whether there were any.
fn predict_bounds<R: Real>(
    pass: &mut ContactPass<'_, R>,
    cloth: usize,
    window: TimeInterval,
    rest: TimeInterval,
) -> bool {
    let ContactPass {
        state,
        pool,
        model: Model { cloths, .. },
        contact:
            ContactSystem { window_bounds, bound_growth, interval_bounds, frame_travel, bounds_violated, .. },
        ..
    } = pass;
    let [frame_at_start, frame_now] =
        pass.span.times().ends().map(|time| travel_row(frame_travel[cloth], time));
    let thickness = pass.frame.cloths[cloth].thickness.max(MIN_THICKNESS);
    let most = R::from_f64(cloths[cloth].edge_length);
    let horizon = |time: TimeInterval, margin_share: f64| {
        let left = time.length() * pass.frame.duration;
        let margin = pass.frame.gravity.norm() * left * left / 2.0 + margin_share * thickness;
        (R::from_f64(left / pass.schedule.h - 1.0), [R::from_f64(margin), most])
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
            let start = state.start[row as usize].lanes() - frame_at_start.lanes();
            let now = state.displacement[row as usize].lanes() - frame_now.lanes();
            let bound = predict_box::<R>(start, now, window_bound.0, window_bound.1);
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            unsafe {
                let growth = box_growth(&window_bounds.get(row), &bound);
                bound_growth.set(row, bound_growth.get(row) + growth);
                window_bounds.set(row, bound);
                if bounds_violated.get(row) || !box_within(&bound, &interval_bounds.get(row)) {
                    interval_bounds
                        .set(row, predict_box::<R>(start, now, interval_bound.0, interval_bound.1));
                    bounds_violated.set(row, true);
                    any.store(true, Ordering::Relaxed);
                }
            }
        }
    });
    any.into_inner()
}

/// Whether a point of the cloth violates its window bound at a time of the frame.
fn has_violations<R: Real>(pass: &ContactPass<'_, R>, cloth: usize) -> bool {
    let frame_motion = travel_row(pass.contact.frame_travel[cloth], pass.span.to);
    let keeps_bound = |row: u32| {
        let (bound, now) = (&pass.contact.window_bounds[row as usize], pass.state.displacement[row as usize]);
        box_contains(bound, now, frame_motion)
    };
    let any = AtomicBool::new(false);
    let blocks = &pass.model.cloths[cloth].blocks;
    pass.pool.parallel_for(blocks.len(), |block| {
        if !blocks.range(block).all(keeps_bound) {
            any.store(true, Ordering::Relaxed);
        }
    });
    any.into_inner()
}
