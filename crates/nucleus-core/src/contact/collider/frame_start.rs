//! Contact with colliders at the start of a frame: materials, contacts of the last frame, and the colliders that each
//! cloth can touch.

use std::ops::Range;

use nalgebra::Vector3;

use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::collider::motion_bounds::{MAX_TRAVEL, travel_at};
use crate::contact::material::ContactMaterial;
use crate::contact::pair_table::PairTable;
use crate::contact::system::ContactSystem;
use crate::input::frame::FrameInput;
use crate::math::{Real, add, dot};
use crate::model::{ClothModel, Model};
use crate::schedule::TimeInterval;
use crate::state::State;

/// Takes contacts over into a new frame, before anchors move. Those of a cloth are searched anew if a collider near
/// it has moved, or if its materials change the candidates.
pub fn begin_collider_contact<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &mut ContactSystem<R>,
    frame: &FrameInput,
) {
    contact.active_windows.fill(TimeInterval::EXPIRED);
    contact.candidate_intervals.fill(TimeInterval::EXPIRED);
    contact.bound_growth.fill(R::ZERO);
    let is_same = update_materials(contact, frame);
    forget_where_contact_is_partial(contact);
    for (cloth, is_same) in is_same.into_iter().enumerate() {
        if !contact.has_collider_material(cloth) {
            let of_cloth = contact.lists_of(cloth);
            contact.collider_contacts[of_cloth].iter_mut().for_each(ColliderContacts::clear);
        }
        let moved = near_colliders(contact, cloth).any(|collider| contact.collider_states[collider].moves);
        if is_same && !moved {
            rebase_contacts(model, state, contact, cloth);
        } else {
            invalidate_cloth(model, contact, cloth);
        }
    }
}

/// Cloth may enter a collider while they do not collide, or in part: all of its points are tested again where they collide in
/// full.
fn forget_where_contact_is_partial<R: Real>(contact: &mut ContactSystem<R>) {
    let ContactSystem { collider_contacts, collider_materials, .. } = contact;
    for list in collider_contacts {
        match &collider_materials[[list.cloth, list.collider]] {
            None => list.depenetration.clear(),
            Some(material) if !material.has_full_strength() => list.depenetration.begin_again(),
            Some(_) => {}
        }
    }
}

/// Tests all points again of cloth that collides with a collider which has moved between two frames, while neither was solved.
pub fn begin_after_jump<R: Real>(contact: &mut ContactSystem<R>, collider: usize) {
    let lists = contact.collider_contacts.iter_mut().filter(|list| list.collider == collider);
    lists.for_each(|list| list.depenetration.begin_again());
}

/// Rebases the contacts and interval bounds of a cloth on anchors that move to the points' positions.
fn rebase_contacts<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &mut ContactSystem<R>,
    cloth: usize,
) {
    let of_cloth = contact.lists_of(cloth);
    let ContactSystem { collider_contacts, interval_bounds, bounds_violated, .. } = contact;
    for list in &mut collider_contacts[of_cloth] {
        // Points inside a collider are tested in every frame.
        for &(point, _) in &list.depenetration.points {
            bounds_violated.get_mut(point as usize).into_iter().for_each(|is_violated| *is_violated = true);
        }
        list.shift_anchors(&state.displacement);
    }
    let rows = rows_of(model, cloth);
    let bounds = interval_bounds.get_mut(rows.clone()).unwrap_or_default();
    for ([low, high], moved) in bounds.iter_mut().zip(&state.displacement[rows]) {
        for axis in 0..3 {
            low.0[axis] -= moved.0[axis];
            high.0[axis] -= moved.0[axis];
        }
    }
}

/// The rows of a cloth, as indices.
fn rows_of<R: Real>(model: &Model<R>, cloth: usize) -> Range<usize> {
    let points = model.cloths[cloth].points();
    points.start as usize..points.end as usize
}

/// Invalidates all interval bounds of a cloth.
fn invalidate_cloth<R: Real>(model: &Model<R>, contact: &mut ContactSystem<R>, cloth: usize) {
    contact.bounds_violated.get_mut(rows_of(model, cloth)).unwrap_or_default().fill(true);
}

/// The colliders that a cloth can touch in this frame.
pub fn near_colliders<R: Real>(contact: &ContactSystem<R>, cloth: usize) -> impl Iterator<Item = usize> {
    let lists = contact.collider_contacts[contact.lists_of(cloth)].iter().filter(|list| list.is_near);
    lists.map(|list| list.collider).filter(move |&at| contact.collider_materials_of(cloth)[at].is_some())
}

/// Finds the colliders that each cloth can touch in this frame, once they have taken up their motion. A moving
/// collider whose bounding box stays away from the cloth is far, and has no influence on it. Should the cloth approach
/// it within the frame, [`find_approaching_colliders`] makes it near.
pub fn find_near_colliders<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &mut ContactSystem<R>,
    frame: &FrameInput,
) {
    for index in 0..contact.collider_contacts.len() {
        let ColliderContacts { cloth, collider, is_near: was_near, .. } = contact.collider_contacts[index];
        let motion = &frame.colliders[collider];
        let is_renewed = !motion.start.is_empty() || !motion.end.is_empty();
        let is_near =
            !is_renewed || can_touch_in_frame(&model.cloths[cloth], state, contact, [cloth, collider], frame);
        contact.collider_contacts[index].is_near = is_near;
        if is_near && (is_renewed || !was_near) {
            invalidate_cloth(model, contact, cloth);
        }
        if !is_near {
            contact.collider_contacts[index].clear();
        }
    }
}

/// Whether the bounding box of a cloth, inflated by its interaction range and by free flight for a frame, overlaps the
/// box that a collider sweeps in the frame.
fn can_touch_in_frame<R: Real>(
    model: &ClothModel<R>,
    state: &State<R>,
    contact: &ContactSystem<R>,
    [cloth, collider]: [usize; 2],
    frame: &FrameInput,
) -> bool {
    let Some(material) = &contact.collider_materials_of(cloth)[collider] else { return false };
    let squares = model.points().map(|row| state.velocity[row as usize].xyz());
    let speed = squares.map(|v| dot(v, v).to_f64()).fold(0.0, f64::max).sqrt();
    let flight = (speed + frame.gravity.norm() * frame.duration) * frame.duration;
    let margin = material.thickness * material.adhesion_range + flight + MAX_TRAVEL * model.edge_length;
    let cloth_box = bounding_box(model.points().map(|row| state.position(row)));
    overlaps(cloth_box, margin, contact.collider_states[collider].swept_bounds())
}

/// Makes colliders near whose swept box overlaps the window bounds of a cloth. Returns whether there were any: all
/// bounds must then be predicted anew.
pub fn find_approaching_colliders<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &mut ContactSystem<R>,
    cloth: usize,
    window: TimeInterval,
) -> bool {
    if contact.collider_contacts[contact.lists_of(cloth)].iter().all(|list| list.is_near) {
        return false;
    }
    let frame_motion = window.ends().map(|time| travel_at(contact.frame_travel[cloth], time).map(R::to_f64));
    let corners = model.cloths[cloth].points().flat_map(|row| {
        let anchor = state.anchor[row as usize];
        let bound = contact.window_bounds[row as usize].map(|corner| corner.xyz().map(R::to_f64));
        bound.map(|corner| add(anchor, corner))
    });
    let in_moving_frame = bounding_box(corners);
    let cloth_box = bounding_box(
        in_moving_frame.into_iter().flat_map(|corner| frame_motion.map(|by| add(corner.into(), by))),
    );
    let mut any = false;
    for index in contact.lists_of(cloth) {
        let ColliderContacts { collider, is_near, .. } = contact.collider_contacts[index];
        let material = contact.collider_materials_of(cloth)[collider].filter(|_| !is_near);
        let Some(material) = material else { continue };
        let margin = material.thickness * material.adhesion_range;
        if overlaps(cloth_box, margin, contact.collider_states[collider].swept_bounds()) {
            contact.collider_contacts[index].is_near = true;
            any = true;
        }
    }
    if any {
        invalidate_cloth(model, contact, cloth);
        contact.candidate_intervals[cloth] = TimeInterval::EXPIRED;
    }
    any
}

/// Sets the contact materials of every cloth with colliders and the ground. Returns for each cloth whether its
/// candidates stay the same.
fn update_materials<R: Real>(contact: &mut ContactSystem<R>, frame: &FrameInput) -> Vec<bool> {
    let settings = || frame.cloths.iter().zip(&contact.material_maps.max_thickness_factor);
    let for_ground = |(cloth, &max_thickness_factor)| {
        frame
            .plane
            .as_ref()
            .and_then(|ground| ContactMaterial::for_ground(cloth, ground, max_thickness_factor))
            .map(|material| material.for_resistance(frame.resistance))
    };
    let maps = &contact.material_maps;
    let with = |[cloth, collider]: [usize; 2]| {
        let (own, theirs) = (&frame.cloths[cloth], &frame.colliders[collider]);
        let factors = maps.max_thickness_factors(cloth, collider);
        ContactMaterial::for_collider(own, theirs, factors, frame.layer_range)
            .map(|material| material.for_resistance(frame.resistance))
    };
    let materials = PairTable::of([frame.cloths.len(), frame.colliders.len()], with);
    contact.ground_materials = settings().map(for_ground).collect();
    let before = std::mem::replace(&mut contact.collider_materials, materials);
    let is_same = |cloth: usize| {
        let (now, before) = (contact.collider_materials_of(cloth), before.row(cloth));
        let mut pairs = now.iter().zip(before);
        now.len() == before.len() && pairs.all(|(now, before)| ContactMaterial::same_candidates(now, before))
    };
    (0..frame.cloths.len()).map(is_same).collect()
}

/// The bounding box of some positions, in metres.
fn bounding_box(positions: impl Iterator<Item = [f64; 3]>) -> [Vector3<f64>; 2] {
    let empty = [Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)];
    positions
        .map(Vector3::from)
        .fold(empty, |[low, high], position| [low.inf(&position), high.sup(&position)])
}

/// Whether a box, inflated by `margin`, overlaps another.
fn overlaps(ours: [Vector3<f64>; 2], margin: f64, theirs: [Vector3<f64>; 2]) -> bool {
    (0..3).all(|k| ours[0][k] - margin <= theirs[1][k] && theirs[0][k] <= ours[1][k] + margin)
}
