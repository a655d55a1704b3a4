//! The passes of a time step over contacts with colliders, and over the ground plane before them.

use std::sync::atomic::Ordering;

use crate::contact::cloth::frozen::Frozen;
use crate::contact::collider::broad_phase::update_collider_candidates;
use crate::contact::collider::contacts::{ColliderContacts, certify, for_unproven_points, revert_to_start};
use crate::contact::collider::lists::for_contacts_of;
use crate::contact::collider::pinched::push_points_outward;
use crate::contact::collider::start_gaps::release_cleared_points;
use crate::contact::collider::sweep::{adhere, resolve};
use crate::contact::ground::pass::{apply_ground_adhesion, resolve_ground_contacts, revert_ground_contacts};
use crate::contact::material::ContactMaterial;
use crate::contact::system::ContactPass;
use crate::contact::time_step::{ColliderStep, ContactCounters};
use crate::math::Real;
use crate::output::{Stage, StepObserver};
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::TimeInterval;

/// One sweep over all contacts with the ground plane, then with colliders. `thickness_scale` is a factor on
/// every thickness.
pub fn resolve_collider_contacts<R: Real>(
    pass: &mut ContactPass<'_, R>,
    thickness_scale: f64,
    watch: &mut dyn StepObserver,
) {
    watch.enter(Stage::BroadPhase);
    resolve_ground_contacts(pass, thickness_scale);
    let model = pass.model;
    for cloth in 0..model.cloths.len() {
        if !pass.contact.has_collider_material(cloth) || !pass.contact.is_listed(cloth) {
            continue;
        }
        update_collider_candidates(pass, cloth);
        release_cleared_points(pass, cloth);
        watch.enter(Stage::Contact);
        let before = *pass.counters.contacts.get_mut();
        for_contacts_of(pass, cloth, |list, step, pool, counters| {
            let step = step.with_thickness_scale(thickness_scale);
            resolve(list, &step, pool, counters);
        });
        push_points_outward(pass, cloth, thickness_scale);
        *pass.contact.has_touched[cloth].get_mut() |= *pass.counters.contacts.get_mut() > before;
    }
}

/// Applies adhesion to the ground and to colliders.
pub fn apply_collider_adhesion<R: Real>(pass: &mut ContactPass<'_, R>) {
    apply_ground_adhesion(pass);
    for cloth in 0..pass.model.cloths.len() {
        let has_adhesion = ContactMaterial::has_adhesion;
        let materials = pass.contact.collider_materials_of(cloth);
        if !pass.contact.is_free[cloth] && materials.iter().flatten().any(has_adhesion) {
            update_collider_candidates(pass, cloth);
            for_contacts_of(pass, cloth, |list, step, pool, _| {
                if step.material.has_adhesion() {
                    adhere(list, &step, pool);
                }
            });
        }
    }
}

/// The number of contacts with colliders without certificate, and of inseparable ones, at the end of a time
/// step.
pub fn certify_collider_contacts<R: Real>(pass: &mut ContactPass<'_, R>) -> [u64; 2] {
    let marks = std::mem::take(&mut pass.contact.has_unproven[1]);
    let mut counts = [0; 2];
    for_all_contacts(pass, |list, step, pool, _| {
        let [unproven, inseparable] = certify(list, step, pool);
        if unproven > 0 {
            marks[list.cloth].store(true, Ordering::Relaxed);
        }
        counts = [counts[0] + unproven, counts[1] + inseparable];
    });
    pass.contact.has_unproven[1] = marks;
    counts
}

/// Reverts contacts without certificate, with the ground and with colliders, to the start of the time step, and freezes
/// their points: those of a collider with an affine motion, if it is known, move by it, and others with a face.
pub fn revert_collider_contacts<R: Real>(pass: &mut ContactPass<'_, R>) {
    let cloth_contacts = pass.contact.cloth_contacts.as_mut();
    let mut frozen = cloth_contacts.map(|contacts| std::mem::take(&mut contacts.frozen)).unwrap_or_default();
    let mut freeze = |point: u32, held: Frozen| {
        frozen.get_mut(point as usize).into_iter().for_each(|frozen| *frozen = held);
    };
    revert_ground_contacts(pass, &mut |point| freeze(point, Frozen::Carried));
    let carriers = std::mem::take(&mut pass.contact.carriers);
    for_all_contacts(pass, |list, step, pool, counters| {
        let carrier = carriers.get(list.collider).and_then(Option::as_ref);
        let held = carrier.map_or(Frozen::Carried, |_| Frozen::With(list.collider as u32));
        revert_to_start(list, step, pool, counters, &mut |point| {
            if let Some(carrier) = carrier {
                step.move_from_start(point, carrier.at(step.start_position(point)));
            }
            freeze(point, held);
        });
    });
    pass.contact.carriers = carriers;
    if let Some(cloth_contacts) = &mut pass.contact.cloth_contacts {
        cloth_contacts.frozen = frozen;
    }
}

/// Accepts contacts without certificate: invalidates the bounds of their points, so that they are searched
/// anew.
pub fn accept_unresolved_collider_contacts<R: Real>(pass: &mut ContactPass<'_, R>) {
    let mut released = Vec::new();
    let mut mark = |point: u32| released.push(point);
    for_all_contacts(pass, |list, step, pool, _| for_unproven_points(list, step, pool, &mut mark));
    for point in released {
        pass.contact.bounds_violated[point as usize] = true;
        let cloth = pass.model.cloths.partition_point(|cloth| cloth.points().end <= point);
        pass.contact.active_windows[cloth] = TimeInterval::EXPIRED;
    }
}

/// Calls `work` with the contacts of each cloth and each collider.
fn for_all_contacts<R: Real>(
    pass: &mut ContactPass<'_, R>,
    mut work: impl FnMut(&mut ColliderContacts<R>, &ColliderStep<'_, R>, &ThreadPool, &ContactCounters),
) {
    for cloth in 0..pass.model.cloths.len() {
        if pass.contact.has_collider_material(cloth) && !pass.contact.is_free[cloth] {
            update_collider_candidates(pass, cloth);
            for_contacts_of(pass, cloth, |list, step, pool, counters| work(list, &step, pool, counters));
        }
    }
}
