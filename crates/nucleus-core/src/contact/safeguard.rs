//! Penetration safeguard: certifies at the end of a time step that no pair passed through each other, else
//! applies fallbacks in a fixed order.
//!
//! 1. Contacts push again, four times. Where surfaces that face each other leave too little clearance, each point keeps the share
//!    of its thickness that fits.
//! 2. Contacts push with a smaller and smaller share of their thickness: two bodies may leave too little clearance for
//!    all of it.
//! 3. Motion is truncated at a division plane between the two elements, or, at a collider or the ground, reverted to the start
//!    of the step in its moving frame (planar divide and truncate).
//! 4. The points of the pair freeze: they keep the positions of the start of the step, or move with a collider, a pin or a
//!    point that these carry.
//! 5. The pair is accepted as unresolved, and counted.
//!
//! Cloth that only cloth can touch is truncated and frozen relative to the mean motion of its island.
//!
//! Only islands of cloths with a failed certificate push again; of free points that touch no cloth, only those that failed.
//!
//! The positions at the start of the step are certified, so a pair that does not move is certified too. Only
//! between colliders that close on cloth, and between pins that cross, does the fourth fallback fail.

use std::sync::atomic::Ordering;

use crate::contact::cloth::broad_phase::update_cloth_candidates;
use crate::contact::cloth::contacts::ClothContacts;
use crate::contact::cloth::frozen::Frozen;
use crate::contact::cloth::islands::{find_drift, grow_to_islands, keep_momentum};
use crate::contact::cloth::pass::resolve_cloth_contacts;
use crate::contact::collider::affine_motion::AffineMotion;
use crate::contact::collider::facing::find_clearance;
use crate::contact::collider::free_points::apply_fallbacks_to_free_points;
use crate::contact::collider::pass::{
    accept_unresolved_collider_contacts, certify_collider_contacts, resolve_collider_contacts,
    revert_collider_contacts,
};
use crate::contact::fallbacks::{Attempt, Fallback, attempts_for_cloth};
use crate::contact::ground::pass::certify_ground_contacts;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::math::{Real, Row4};
use crate::output::{Stage, StepObserver};

/// Certifies all pairs at the end of a time step, and applies the fallbacks.
pub fn safeguard<R: Real>(pass: &mut ContactPass<'_, R>, watch: &mut dyn StepObserver) {
    certify_or_fall_back(pass, watch);
    pass.contact.material_maps.clearance.clear();
    if !pass.contact.drift.is_empty() {
        keep_momentum(pass);
        pass.contact.drift.clear();
    }
}

fn certify_or_fall_back<R: Real>(pass: &mut ContactPass<'_, R>, watch: &mut dyn StepObserver) {
    for attempt in attempts_for_cloth() {
        let unproven = certify(pass, watch);
        if !unproven.any() {
            *pass.counters.pairs_unresolved.get_mut() += unproven.inseparable;
            return;
        }
        fall_back(pass, attempt, &unproven, watch);
    }
    let unproven = certify(pass, watch);
    let Unproven { among_cloths, with_obstacles, inseparable } = unproven;
    *pass.counters.pairs_unresolved.get_mut() += among_cloths + with_obstacles + inseparable;
    if unproven.any() {
        accept_unresolved(pass);
    }
}

/// The numbers of contacts without certificate.
struct Unproven {
    among_cloths: u64,
    /// With colliders and the ground.
    with_obstacles: u64,
    /// Those of elements that no fallback separates.
    inseparable: u64,
}

impl Unproven {
    /// Whether a fallback may still certify any.
    fn any(&self) -> bool {
        self.among_cloths > 0 || self.with_obstacles > 0
    }
}

/// Counts the contacts without certificate, after the fallbacks for free points, and marks their cloths.
fn certify<R: Real>(pass: &mut ContactPass<'_, R>, watch: &mut dyn StepObserver) -> Unproven {
    watch.enter(Stage::BroadPhase);
    if pass.contact.cloth_contacts.as_ref().is_some_and(ClothContacts::is_enabled) {
        update_cloth_candidates(pass);
    }
    watch.enter(Stage::Contact);
    pass.contact.has_unproven.iter_mut().flatten().for_each(|mark| *mark.get_mut() = false);
    let among_cloths = certify_cloth_contacts(pass);
    let [mut with_obstacles, inseparable] = certify_collider_contacts(pass);
    if with_obstacles > 0 {
        apply_fallbacks_to_free_points(pass);
        let is_left = pass.contact.has_unproven[1].iter_mut().any(|mark| *mark.get_mut());
        with_obstacles = if is_left { with_obstacles } else { 0 };
    }
    with_obstacles += certify_ground_contacts(pass);
    Unproven { among_cloths, with_obstacles, inseparable }
}

/// Applies a fallback to the contacts without certificate.
fn fall_back<R: Real>(
    pass: &mut ContactPass<'_, R>,
    attempt: Attempt,
    unproven: &Unproven,
    watch: &mut dyn StepObserver,
) {
    match attempt.fallback {
        Fallback::Push => {
            if unproven.among_cloths > 0 {
                mask_islands(pass.contact, |[among_cloths, _]| among_cloths);
                resolve_cloth_contacts(pass, attempt.thickness_scale, watch);
            }
            mask_islands(pass.contact, |[among_cloths, with_colliders]| among_cloths || with_colliders);
            if attempt.is_first() && unproven.with_obstacles > 0 {
                find_clearance(pass);
            }
            resolve_collider_contacts(pass, attempt.thickness_scale, watch);
            pass.contact.contact_mask.clear();
        }
        Fallback::Truncate => {
            pass.contact.carriers.clear();
            if attempt.is_first() {
                find_drift(pass);
            }
            truncate(pass);
            revert_collider_contacts(pass);
        }
        Fallback::Freeze => {
            if attempt.is_first() {
                begin_freezing(pass);
            }
            revert_collider_contacts(pass);
            freeze(pass);
        }
    }
}

fn certify_cloth_contacts<R: Real>(pass: &mut ContactPass<'_, R>) -> u64 {
    let marks = std::mem::take(&mut pass.contact.has_unproven[0]);
    let count = pass.with_cloth_contacts(|cache, step, pool| cache.certify(step, &marks, pool));
    pass.contact.has_unproven[0] = marks;
    count.unwrap_or(0)
}

/// Masks the islands of cloths in contact with each other of which any `is_unproven`, given whether it has contacts without
/// certificate among cloths and with colliders: only their contacts push again, so that no cloth elsewhere is changed.
fn mask_islands<R: Real>(contact: &mut ContactSystem<R>, is_unproven: impl Fn([bool; 2]) -> bool) {
    let ContactSystem { cloth_contacts, contact_mask, has_unproven: [among_cloths, with_colliders], .. } =
        contact;
    contact_mask.clear();
    let marks = among_cloths.iter().zip(&*with_colliders);
    contact_mask
        .extend(marks.map(|marks| is_unproven([marks.0, marks.1].map(|mark| mark.load(Ordering::Relaxed)))));
    if let Some(contacts) = cloth_contacts {
        grow_to_islands(contacts, contact_mask);
    }
}

fn truncate<R: Real>(pass: &mut ContactPass<'_, R>) {
    let reverted = pass.with_cloth_contacts(|cache, step, _| cache.truncate(step));
    *pass.counters.pairs_reverted.get_mut() += reverted.unwrap_or(0);
}

/// Freezes pairs without a certificate, or moves them with a point that is frozen already.
fn freeze<R: Real>(pass: &mut ContactPass<'_, R>) {
    let cloth_contacts = pass.contact.cloth_contacts.as_mut();
    let mut frozen = cloth_contacts.map(|contacts| std::mem::take(&mut contacts.frozen)).unwrap_or_default();
    let carriers = std::mem::take(&mut pass.contact.carriers);
    let reverted = pass.with_cloth_contacts(|cache, step, _| cache.freeze(step, &mut frozen, &carriers));
    pass.contact.carriers = carriers;
    *pass.counters.pairs_reverted.get_mut() += reverted.unwrap_or(0);
    if let Some(cloth_contacts) = &mut pass.contact.cloth_contacts {
        cloth_contacts.frozen = frozen;
    }
}

/// Only pinned points start out frozen: they are carried.
fn begin_freezing<R: Real>(pass: &mut ContactPass<'_, R>) {
    let ContactSystem { carriers, collider_states, cloth_contacts, .. } = &mut *pass.contact;
    carriers.clear();
    carriers
        .extend(collider_states.iter().map(|collider| AffineMotion::of(collider.ends(), pass.span.times())));
    let Some(ClothContacts { frozen, .. }) = cloth_contacts else { return };
    frozen.clear();
    let is_pinned = |row: &Row4<R>| row.0[3] <= R::ZERO;
    let frozen_as = |row| if is_pinned(row) { Frozen::Carried } else { Frozen::Free };
    frozen.extend(pass.state.displacement.iter().map(frozen_as));
}

/// Accepts pairs that no fallback resolves. Their contacts are searched anew.
fn accept_unresolved<R: Real>(pass: &mut ContactPass<'_, R>) {
    accept_unresolved_collider_contacts(pass);
    if let Some(cloth_contacts) = &mut pass.contact.cloth_contacts {
        let marks = pass.contact.has_unproven[0].iter_mut().map(|mark| *mark.get_mut());
        cloth_contacts
            .untangling
            .is_search_due
            .iter_mut()
            .zip(marks)
            .for_each(|(is_due, mark)| *is_due |= mark);
    }
}
