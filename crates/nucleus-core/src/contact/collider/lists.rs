//! The lists of contacts of a cloth with each collider, in a time step.

use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::contact::time_step::{ColliderStep, ColliderStepArgs, ContactCounters};
use crate::math::Real;
use crate::parallel::thread_pool::ThreadPool;

/// Calls `work` with the contacts of a cloth and each collider that it collides with.
pub fn for_contacts_of<R: Real>(
    pass: &mut ContactPass<'_, R>,
    cloth: usize,
    mut work: impl FnMut(&mut ColliderContacts<R>, ColliderStep<'_, R>, &ThreadPool, &ContactCounters),
) {
    let ContactPass { state, pool, contact, counters, .. } = pass;
    let of_cloth = contact.lists_of(cloth);
    let ContactSystem { collider_states, collider_contacts, collider_materials, material_maps, .. } = contact;
    for list in &mut collider_contacts[of_cloth] {
        let Some(material) = collider_materials[[cloth, list.collider]] else { continue };
        let view = ColliderStepArgs {
            material,
            material_maps,
            at: list.collider,
            h: pass.schedule.h,
            time: pass.span.times(),
            interval: list.interval,
        };
        let collider = list.collider;
        work(list, view.of(state, &collider_states[collider]), pool, counters);
    }
}
