//! The passes of a time step over contacts with colliders and the ground plane.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::contact::cloth::certify::Frozen;
use crate::contact::collider::broad_phase::update_collider_candidates;
use crate::contact::collider::contact::Outcome;
use crate::contact::collider::contacts::{ColliderContacts, certify, for_unproven_points, revert_to_start};
use crate::contact::collider::start_gaps::release_cleared_points;
use crate::contact::collider::sweep::{adhere, resolve};
use crate::contact::ground::GroundContact;
use crate::contact::material::ContactMaterial;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::contact::time_step::{ColliderStep, ColliderStepArgs, ContactCounters, PositionWriter};
use crate::math::Real;
use crate::output::{Stage, StepObserver};
use crate::parallel::thread_pool::ThreadPool;

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
            list.depenetration.push_outward(&model.colliders[list.collider], &step);
        });
        *pass.contact.has_touched[cloth].get_mut() |= *pass.counters.contacts.get_mut() > before;
    }
}

/// Applies adhesion to the ground and to colliders.
pub fn apply_collider_adhesion<R: Real>(pass: &mut ContactPass<'_, R>) {
    if pass.frame.plane.is_some()
        && pass.contact.ground_materials.iter().flatten().any(ContactMaterial::has_adhesion)
    {
        let model = pass.model;
        for_ground_contacts(pass, 1.0, |cloth, ground, pool, _| {
            let blocks = &model.cloths[cloth].blocks;
            pool.parallel_for(blocks.len(), |block| ground.adhere(blocks.range(block)));
        });
    }
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

/// The number of points that went through the ground plane in this time step. Marks their cloths.
pub fn certify_ground_contacts<R: Real>(pass: &mut ContactPass<'_, R>) -> u64 {
    let marks = std::mem::take(&mut pass.contact.has_unproven[1]);
    let (model, all) = (pass.model, AtomicU64::new(0));
    for_ground_contacts(pass, 1.0, |cloth, ground, pool, _| {
        let blocks = &model.cloths[cloth].blocks;
        pool.parallel_for(blocks.len(), |block| {
            let passed = blocks.range(block).filter(|&point| ground.has_passed(point)).count() as u64;
            if passed > 0 {
                marks[cloth].store(true, Ordering::Relaxed);
                all.fetch_add(passed, Ordering::Relaxed);
            }
        });
    });
    pass.contact.has_unproven[1] = marks;
    all.into_inner()
}

/// Reverts contacts without certificate, with the ground and with colliders, to the start of the time step, and freezes
/// their points.
pub fn revert_collider_contacts<R: Real>(pass: &mut ContactPass<'_, R>) {
    let cloth_contacts = pass.contact.cloth_contacts.as_mut();
    let mut frozen = cloth_contacts.map(|contacts| std::mem::take(&mut contacts.frozen)).unwrap_or_default();
    let mut freeze =
        |point: u32| frozen.get_mut(point as usize).into_iter().for_each(|frozen| *frozen = Frozen::Carried);
    let model = pass.model;
    for_ground_contacts(pass, 1.0, |cloth, ground, _, counters| {
        for point in model.cloths[cloth].points().filter(|&point| ground.has_passed(point)) {
            ground.revert(point);
            freeze(point);
            Outcome::Reverted.count(counters);
        }
    });
    for_all_contacts(pass, |list, step, pool, counters| {
        revert_to_start(list, step, pool, counters, &mut freeze)
    });
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
        pass.contact.active_windows[cloth] = [0.0, 0.0];
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

/// Calls `work` with the contacts of a cloth and each collider that it collides with.
pub(super) fn for_contacts_of<R: Real>(
    pass: &mut ContactPass<'_, R>,
    cloth: usize,
    mut work: impl FnMut(&mut ColliderContacts<R>, ColliderStep<'_, R>, &ThreadPool, &ContactCounters),
) {
    let ContactPass { state, pool, contact, counters, .. } = pass;
    let ContactSystem { collider_states, collider_contacts, collider_materials, material_maps, .. } = contact;
    for list in collider_contacts.iter_mut().filter(|list| list.cloth == cloth) {
        let Some(material) = collider_materials[cloth * collider_states.len() + list.collider] else {
            continue;
        };
        let view = ColliderStepArgs {
            material,
            material_maps,
            at: list.collider,
            h: pass.schedule.h,
            time: [pass.span.from, pass.span.to],
            interval: list.interval,
        };
        let collider = list.collider;
        work(list, view.of(state, &collider_states[collider]), pool, counters);
    }
}

fn resolve_ground_contacts<R: Real>(pass: &mut ContactPass<'_, R>, thickness_scale: f64) {
    let model = pass.model;
    for_ground_contacts(pass, thickness_scale, |cloth, ground, pool, counters| {
        let blocks = &model.cloths[cloth].blocks;
        pool.parallel_for(blocks.len(), |block| push(ground, blocks.range(block), counters));
    });
}

/// Pushes some points of one cloth above the ground plane.
pub(super) fn push_by_ground<R: Real>(
    pass: &mut ContactPass<'_, R>,
    of: usize,
    points: &[u32],
    thickness_scale: f64,
) {
    for_ground_contacts(pass, thickness_scale, |cloth, ground, _, counters| {
        let own = points.iter().filter(|_| cloth == of);
        own.for_each(|&point| push(ground, point..point + 1, counters));
    });
}

fn push<R: Real>(ground: &GroundContact<'_, R>, points: Range<u32>, counters: &ContactCounters) {
    let pushed = ground.resolve(points);
    if pushed > 0 {
        ground.has_touched.store(true, Ordering::Relaxed);
        counters.contacts.fetch_add(pushed, Ordering::Relaxed);
    }
}

/// Calls `work` with each cloth that collides with the ground.
fn for_ground_contacts<R: Real>(
    pass: &mut ContactPass<'_, R>,
    thickness_scale: f64,
    mut work: impl FnMut(usize, &GroundContact<'_, R>, &ThreadPool, &ContactCounters),
) {
    let ContactPass { state, pool, contact, counters, .. } = pass;
    let ContactSystem { ground, ground_materials, material_maps, has_touched, .. } = &**contact;
    let Some(plane) = ground.in_step(pass.span) else { return };
    let (writer, start, _) = PositionWriter::of(state);
    for (index, material) in ground_materials.iter().enumerate() {
        let Some(material) = material.filter(|_| contact.is_listed(index)) else { continue };
        let ground = GroundContact {
            writer,
            start,
            plane,
            thickness_scale: R::from_f64(thickness_scale),
            material,
            material_maps,
            h: R::from_f64(pass.schedule.h),
            has_touched: &has_touched[index],
        };
        work(index, &ground, pool, counters);
    }
}
