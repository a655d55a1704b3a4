//! Penetration safeguard: certifies at the end of a time step that no pair passed through each other, else
//! applies fallbacks in a fixed order.
//!
//! 1. Contacts push again, four times.
//! 2. Contacts push with a smaller and smaller share of their thickness: two bodies may leave too little room for
//!    all of it.
//! 3. Motion is truncated at a division plane between the two elements, or, at a collider, reverted to the start
//!    of the step in the collider's moving frame (planar divide and truncate).
//! 4. The points of the pair freeze: they keep the positions of the start of the step, or move with a frozen
//!    neighbour or collider.
//! 5. The pair is accepted as unresolved, and counted.
//!
//! Only islands of cloths with a failed certificate push again.
//!
//! The positions at the start of the step are certified, so a pair that does not move is certified too. Only
//! between colliders that close on cloth, and between pins that cross, does the fourth fallback fail.

use std::sync::atomic::Ordering;

use crate::contact::cloth::ClothContacts;
use crate::contact::cloth::pass::cloth_step;
use crate::contact::time_step::ContactCounters;
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::output::{Stage, StepObserver};
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Solver};

/// Attempts of each fallback.
const PUSH_ATTEMPTS: usize = 4;
const SCALED_ATTEMPTS: usize = 6;
const TRUNCATE_ATTEMPTS: usize = 8;
const FREEZE_ATTEMPTS: usize = 32;

/// Attempts after which the safeguard no longer pushes.
const PUSHING_ENDS: usize = PUSH_ATTEMPTS + SCALED_ATTEMPTS;

impl<R: Real> Solver<R> {
    /// Certifies all pairs at the end of a time step, and applies the fallbacks.
    pub(crate) fn safeguard(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        now: StepInterval,
        counters: &mut ContactCounters,
        watch: &mut dyn StepObserver,
    ) {
        let has_cloth_contact = self.contact.cloth_contacts.as_ref().is_some_and(ClothContacts::is_enabled);
        for attempt in 0..=PUSHING_ENDS + TRUNCATE_ATTEMPTS + FREEZE_ATTEMPTS {
            watch.enter(Stage::BroadPhase);
            if has_cloth_contact {
                self.update_cloth_candidates(frame, now, counters);
            }
            watch.enter(Stage::Contact);
            self.contact.has_unproven.iter().for_each(|mark| mark.store(false, Ordering::Relaxed));
            let cloths = self.certify_cloth_contacts(schedule);
            let [sides, inseparable] = self.certify_collider_contacts(frame, schedule, now, counters);
            let unproven = [cloths, sides];
            let is_last = attempt == PUSHING_ENDS + TRUNCATE_ATTEMPTS + FREEZE_ATTEMPTS;
            if unproven == [0, 0] || is_last {
                *counters.pairs_unresolved.get_mut() += unproven[0] + unproven[1] + inseparable;
            }
            if unproven == [0, 0] {
                return;
            }
            if attempt < PUSHING_ENDS {
                self.mask_islands();
                let thickness_scale = 0.5f64.powi((attempt + 1).saturating_sub(PUSH_ATTEMPTS) as i32);
                if unproven[0] > 0 {
                    self.resolve_cloth_contacts(thickness_scale, frame, schedule, now, counters, watch);
                }
                self.resolve_collider_contacts(thickness_scale, frame, schedule, now, counters, watch);
                self.contact.contact_mask.clear();
            } else if attempt < PUSHING_ENDS + TRUNCATE_ATTEMPTS {
                self.truncate(schedule, counters);
                self.revert_collider_contacts(frame, schedule, now, counters);
            } else if !is_last {
                if attempt == PUSHING_ENDS + TRUNCATE_ATTEMPTS {
                    self.clear_frozen();
                }
                self.revert_collider_contacts(frame, schedule, now, counters);
                self.freeze(schedule, counters);
            } else {
                return self.accept_unresolved(frame, schedule, now, unproven[0] > 0, counters);
            }
        }
    }

    fn certify_cloth_contacts(&mut self, schedule: &Schedule<R>) -> u64 {
        let Self {
            state,
            pool,
            contact: ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, has_unproven, .. },
            ..
        } = self
        else {
            return 0;
        };
        let ClothContacts { cache, materials, .. } = cloth_contacts;
        cache.certify(&cloth_step(state, materials, material_maps, schedule.h), has_unproven, pool)
    }

    /// Masks the islands of cloths in contact with each other that have a contact without certificate: only their contacts
    /// push again, so that no cloth elsewhere is changed.
    fn mask_islands(&mut self) {
        let Self { contact: ContactSystem { cloth_contacts, contact_mask, has_unproven, .. }, .. } = self;
        contact_mask.clear();
        contact_mask.extend(has_unproven.iter().map(|mark| mark.load(Ordering::Relaxed)));
        let Some(ClothContacts { cache, materials, .. }) = cloth_contacts else { return };
        let mut has_grown = true;
        while has_grown {
            has_grown = false;
            for [a, b] in cache.cloth_pairs(materials.len()) {
                if contact_mask[a] != contact_mask[b] {
                    (contact_mask[a], contact_mask[b]) = (true, true);
                    has_grown = true;
                }
            }
        }
    }

    fn truncate(&mut self, schedule: &Schedule<R>, counters: &mut ContactCounters) {
        let Self {
            state,
            contact: ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, .. },
            ..
        } = self
        else {
            return;
        };
        let ClothContacts { cache, materials, .. } = cloth_contacts;
        *counters.pairs_reverted.get_mut() +=
            cache.truncate(&cloth_step(state, materials, material_maps, schedule.h));
    }

    /// Freezes pairs without a certificate, or moves them with a point that is frozen already.
    fn freeze(&mut self, schedule: &Schedule<R>, counters: &mut ContactCounters) {
        let Self {
            state,
            contact: ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, .. },
            ..
        } = self
        else {
            return;
        };
        let ClothContacts { cache, frozen, materials, .. } = cloth_contacts;
        *counters.pairs_reverted.get_mut() +=
            cache.freeze(&cloth_step(state, materials, material_maps, schedule.h), frozen);
    }

    /// Only pinned points start out frozen.
    fn clear_frozen(&mut self) {
        let Self { state, contact: ContactSystem { cloth_contacts: Some(cloth_contacts), .. }, .. } = self
        else {
            return;
        };
        cloth_contacts.frozen.clear();
        cloth_contacts.frozen.extend(state.displacement.iter().map(|row| row.0[3] <= R::ZERO));
    }

    /// Accepts pairs that no fallback resolves. Their contacts are searched anew.
    fn accept_unresolved(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        now: StepInterval,
        among_cloths: bool,
        counters: &mut ContactCounters,
    ) {
        self.accept_unresolved_collider_contacts(frame, schedule, now, counters);
        if let Some(cloth_contacts) = &mut self.contact.cloth_contacts {
            cloth_contacts.untangling.is_search_due |= among_cloths;
        }
    }
}
