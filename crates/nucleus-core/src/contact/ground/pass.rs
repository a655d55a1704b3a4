//! The passes of a time step over contacts with the ground plane.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::contact::ground::GroundContact;
use crate::contact::material::ContactMaterial;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::contact::time_step::{ContactCounters, PositionWriter};
use crate::math::Real;
use crate::parallel::thread_pool::ThreadPool;

/// Pushes the points of all cloths above the ground plane. `thickness_scale` is a factor on every thickness.
pub fn resolve_ground_contacts<R: Real>(pass: &mut ContactPass<'_, R>, thickness_scale: f64) {
    let model = pass.model;
    for_ground_contacts(pass, thickness_scale, |cloth, ground, pool, counters| {
        let blocks = &model.cloths[cloth].blocks;
        pool.parallel_for(blocks.len(), |block| push(ground, blocks.range(block), counters));
    });
}

/// Pushes some points of one cloth above the ground plane.
pub fn push_by_ground<R: Real>(
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

/// Applies adhesion to the ground.
pub fn apply_ground_adhesion<R: Real>(pass: &mut ContactPass<'_, R>) {
    if pass.frame.plane.is_none()
        || !pass.contact.ground_materials.iter().flatten().any(ContactMaterial::has_adhesion)
    {
        return;
    }
    let model = pass.model;
    for_ground_contacts(pass, 1.0, |cloth, ground, pool, _| {
        let blocks = &model.cloths[cloth].blocks;
        pool.parallel_for(blocks.len(), |block| ground.adhere(blocks.range(block)));
    });
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

/// Returns the points that went through the ground plane to their height at the start of the time step. Calls `freeze` with
/// each.
pub fn revert_ground_contacts<R: Real>(pass: &mut ContactPass<'_, R>, freeze: &mut impl FnMut(u32)) {
    let model = pass.model;
    for_ground_contacts(pass, 1.0, |cloth, ground, _, counters| {
        for point in model.cloths[cloth].points().filter(|&point| ground.has_passed(point)) {
            ground.revert(point);
            freeze(point);
            counters.pairs_reverted.fetch_add(1, Ordering::Relaxed);
        }
    });
}

/// Calls `work` with each cloth that collides with the ground.
pub fn for_ground_contacts<R: Real>(
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
