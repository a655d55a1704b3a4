//! Fallbacks for free points whose contacts with colliders have no certificate.
//!
//! A point without faces that touches no other cloth depends on nothing but its own contacts, so the fallbacks of the
//! safeguard are applied to it alone: among a million particles a few fail in a frame, and the others neither move nor are
//! tested again.

use std::sync::atomic::Ordering;

use crate::contact::collider::broad_phase::update_collider_candidates;
use crate::contact::collider::contact::{Certificate, Outcome};
use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::collider::lists::for_contacts_of;
use crate::contact::collider::motion_bounds::{box_contains, travel_row};
use crate::contact::collider::sweep::resolve_point;
use crate::contact::fallbacks::{Fallback, attempts_for_free_points};
use crate::contact::ground::pass::push_by_ground;
use crate::contact::system::ContactPass;
use crate::math::Real;
use crate::parallel::disjoint::DisjointSlice;

/// Applies the fallbacks to the cloths that are marked as having contacts without certificate, where they are free points by
/// themselves. Unmarks those that have none left.
pub fn apply_fallbacks_to_free_points<R: Real>(pass: &mut ContactPass<'_, R>) {
    for cloth in 0..pass.model.cloths.len() {
        let is_marked = pass.contact.has_unproven[1][cloth].load(Ordering::Relaxed);
        if is_marked && is_independent(pass, cloth) && apply_fallbacks(pass, cloth) {
            pass.contact.has_unproven[1][cloth].store(false, Ordering::Relaxed);
        }
    }
}

/// Whether the points of a cloth depend on nothing but colliders.
fn is_independent<R: Real>(pass: &ContactPass<'_, R>, cloth: usize) -> bool {
    pass.model.cloths[cloth].boundary.triangles.is_empty()
        && !pass.contact.cloth_contacts.as_ref().is_some_and(|contacts| contacts.touches(cloth))
}

/// Applies the fallbacks to the points of a cloth. Returns whether every contact has a certificate.
fn apply_fallbacks<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize) -> bool {
    let mut points = Vec::new();
    let of_cloth = pass.contact.lists_of(cloth);
    pass.contact.collider_contacts[of_cloth].iter_mut().for_each(|list| points.append(&mut list.unproven));
    for attempt in attempts_for_free_points() {
        points.sort_unstable();
        points.dedup();
        if points.is_empty() {
            break;
        }
        match attempt.fallback {
            Fallback::Push => push(pass, cloth, &points, attempt.thickness_scale),
            Fallback::Truncate | Fallback::Freeze => revert(pass, cloth, &points),
        }
        points = unproven(pass, cloth, &points);
    }
    for_contacts_of(pass, cloth, |list, _, pool, _| list.copy_planes(pool));
    points.is_empty()
}

/// One sweep over the contacts of some points, with a factor on every thickness.
fn push<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize, points: &[u32], thickness_scale: f64) {
    push_by_ground(pass, cloth, points, thickness_scale);
    update_candidates_of(pass, cloth, points);
    for_contacts_of(pass, cloth, |list, step, _, counters| {
        let step = step.with_thickness_scale(thickness_scale);
        for_contacts_of_points(list, points, |list, own| {
            resolve_point(DisjointSlice::new(&mut list.point_face), own, &step, counters);
        });
    });
}

/// Moves some points with the surfaces of their contacts without certificate.
fn revert<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize, points: &[u32]) {
    for_contacts_of(pass, cloth, |list, step, _, counters| {
        for_contacts_of_points(list, points, |list, own| {
            for &at in own {
                let contact = &mut list.point_face[at as usize];
                if contact.certify(&step) == Certificate::Unproven {
                    contact.move_with_surface(&step);
                    Outcome::Reverted.count(counters);
                }
            }
        });
    });
}

/// Ensures that the active contacts of some points include all that can touch.
fn update_candidates_of<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize, points: &[u32]) {
    let frame_motion = travel_row(pass.contact.frame_travel[cloth], pass.span.to);
    let keeps_bound = |&point: &u32| {
        let displacement = pass.state.displacement[point as usize];
        box_contains(&pass.contact.window_bounds[point as usize], displacement, frame_motion)
    };
    if !points.iter().all(keeps_bound) {
        update_collider_candidates(pass, cloth);
    }
}

/// Those of some points that have a contact without certificate.
fn unproven<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize, points: &[u32]) -> Vec<u32> {
    update_candidates_of(pass, cloth, points);
    let mut left = Vec::new();
    for_contacts_of(pass, cloth, |list, step, _, _| {
        for_contacts_of_points(list, points, |list, own| {
            for &at in own {
                let contact = &mut list.point_face[at as usize];
                if contact.certify(&step) == Certificate::Unproven {
                    left.push(contact.points[0]);
                }
            }
        });
    });
    left
}

/// Calls `work` with the active contacts of each of some points, which ascend.
fn for_contacts_of_points<R: Real>(
    list: &mut ColliderContacts<R>,
    points: &[u32],
    mut work: impl FnMut(&mut ColliderContacts<R>, &[u32]),
) {
    let active = std::mem::take(&mut list.active.points.indices);
    for &point in points {
        let first = active.partition_point(|&at| list.point_face[at as usize].points[0] < point);
        let own = active[first..].iter().take_while(|&&at| list.point_face[at as usize].points[0] == point);
        let count = own.count();
        work(list, &active[first..first + count]);
    }
    list.active.points.indices = active;
}
