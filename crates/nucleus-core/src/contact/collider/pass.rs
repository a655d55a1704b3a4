//! The passes of a time step over contacts with colliders and the ground plane.

use std::sync::atomic::Ordering;

use crate::contact::collider::ColliderState;
use crate::contact::collider::contacts::{
    ColliderContacts, adhere, certify, for_unproven_points, resolve, revert_to_start,
};
use crate::contact::ground::GroundContact;
use crate::contact::material::{ContactMaterial, MaterialMaps};
use crate::contact::time_step::{ColliderStep, ContactCounters, PositionWriter};
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::output::{Stage, StepObserver};
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Model, Solver};
use crate::state::State;

impl<R: Real> Solver<R> {
    /// One sweep over all contacts with the ground plane, then with colliders. `thickness_scale` is a factor on
    /// every thickness.
    pub(crate) fn resolve_collider_contacts(
        &mut self,
        thickness_scale: f64,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &mut ContactCounters,
        watch: &mut dyn StepObserver,
    ) {
        watch.enter(Stage::BroadPhase);
        self.resolve_ground_contacts(thickness_scale, schedule, span, counters);
        for cloth in 0..self.model.cloths.len() {
            if !self.has_collider_material(cloth) || !self.is_resolved(cloth) {
                continue;
            }
            self.update_collider_candidates(frame, cloth, schedule, span, counters);
            watch.enter(Stage::Contact);
            self.for_contacts_of(cloth, schedule, span, |list, step, colliders, pool| {
                let step = step.with_thickness_scale(thickness_scale);
                resolve(list, &step, pool, counters);
                list.depenetration.push_outward(&colliders[list.collider], &step);
            });
        }
    }

    /// Applies adhesion to the ground and to colliders.
    pub(crate) fn apply_collider_adhesion(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &mut ContactCounters,
    ) {
        if frame.plane.is_some()
            && self.contact.ground_materials.iter().flatten().any(ContactMaterial::has_adhesion)
        {
            self.for_ground_contacts(1.0, schedule, span, |ground, points| ground.adhere(points));
        }
        for cloth in 0..self.model.cloths.len() {
            if self.collider_materials_of(cloth).iter().flatten().any(ContactMaterial::has_adhesion) {
                self.update_collider_candidates(frame, cloth, schedule, span, counters);
                self.for_contacts_of(cloth, schedule, span, |list, step, _, pool| {
                    if step.material.has_adhesion() {
                        adhere(list, &step, pool);
                    }
                });
            }
        }
    }

    /// The number of contacts with colliders without certificate, and of inseparable ones, at the end of a time
    /// step.
    pub(crate) fn certify_collider_contacts(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &mut ContactCounters,
    ) -> [u64; 2] {
        let marks = std::mem::take(&mut self.contact.has_unproven);
        let mut counts = [0; 2];
        self.for_all_contacts(frame, schedule, span, counters, |list, step, pool, _| {
            let [unproven, inseparable] = certify(list, step, pool);
            if unproven > 0 {
                marks[list.cloth].store(true, Ordering::Relaxed);
            }
            counts = [counts[0] + unproven, counts[1] + inseparable];
        });
        self.contact.has_unproven = marks;
        counts
    }

    /// Reverts contacts without certificate to the start of the time step, and freezes their points.
    pub(crate) fn revert_collider_contacts(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &mut ContactCounters,
    ) {
        let mut frozen = self
            .contact
            .cloth_contacts
            .as_mut()
            .map(|cloth_contacts| std::mem::take(&mut cloth_contacts.frozen))
            .unwrap_or_default();
        let mut freeze =
            |point: u32| frozen.get_mut(point as usize).into_iter().for_each(|frozen| *frozen = true);
        self.for_all_contacts(frame, schedule, span, counters, |list, step, _, counters| {
            revert_to_start(list, step, counters, &mut freeze)
        });
        if let Some(cloth_contacts) = &mut self.contact.cloth_contacts {
            cloth_contacts.frozen = frozen;
        }
    }

    /// Accepts contacts without certificate: invalidates the bounds of their points, so that they are searched
    /// anew.
    pub(crate) fn accept_unresolved_collider_contacts(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &mut ContactCounters,
    ) {
        let mut released = Vec::new();
        let mut mark = |point: u32| released.push(point);
        self.for_all_contacts(frame, schedule, span, counters, |list, step, _, _| {
            for_unproven_points(list, step, &mut mark)
        });
        for point in released {
            self.contact.bounds_violated[point as usize] = true;
            let cloth = self.model.cloths.partition_point(|cloth| cloth.points().end <= point);
            self.contact.active_windows[cloth] = [0.0, 0.0];
        }
    }

    /// Calls `work` with the contacts of each cloth and each collider.
    fn for_all_contacts(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &mut ContactCounters,
        mut work: impl FnMut(&mut ColliderContacts<R>, &ColliderStep<'_, R>, &ThreadPool, &ContactCounters),
    ) {
        for cloth in 0..self.model.cloths.len() {
            if self.has_collider_material(cloth) {
                self.update_collider_candidates(frame, cloth, schedule, span, counters);
                self.for_contacts_of(cloth, schedule, span, |list, step, _, pool| {
                    work(list, &step, pool, counters)
                });
            }
        }
    }

    /// Calls `work` with the contacts of a cloth and each collider that it collides with.
    fn for_contacts_of(
        &mut self,
        cloth: usize,
        schedule: &Schedule<R>,
        span: StepInterval,
        mut work: impl FnMut(
            &mut ColliderContacts<R>,
            ColliderStep<'_, R>,
            &[crate::model::ColliderModel],
            &ThreadPool,
        ),
    ) {
        let Self {
            state,
            pool,
            model: Model { colliders, .. },
            contact:
                ContactSystem { collider_states, collider_contacts, collider_materials, material_maps, .. },
            ..
        } = self;
        for list in collider_contacts.iter_mut().filter(|list| list.cloth == cloth) {
            let Some(material) = collider_materials[cloth * colliders.len() + list.collider] else {
                continue;
            };
            let view = ColliderStepArgs {
                material,
                material_maps,
                h: schedule.h,
                time: [span.from, span.to],
                interval: list.interval,
            };
            let collider = list.collider;
            work(list, view.of(state, &collider_states[collider]), colliders, pool);
        }
    }

    /// Whether a pass resolves the contacts of a cloth.
    fn is_resolved(&self, cloth: usize) -> bool {
        self.contact.contact_mask.get(cloth).is_none_or(|&is_resolved| is_resolved)
    }

    /// The contact materials of a cloth with each collider.
    pub(crate) fn collider_materials_of(&self, cloth: usize) -> &[Option<ContactMaterial<R>>] {
        let colliders = self.model.colliders.len();
        self.contact.collider_materials.get(cloth * colliders..(cloth + 1) * colliders).unwrap_or_default()
    }

    /// Whether a cloth collides with any collider in this frame.
    pub(crate) fn has_collider_material(&self, cloth: usize) -> bool {
        self.collider_materials_of(cloth).iter().any(Option::is_some)
    }

    fn resolve_ground_contacts(
        &mut self,
        thickness_scale: f64,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &ContactCounters,
    ) {
        self.for_ground_contacts(thickness_scale, schedule, span, |ground, points| {
            counters.contacts.fetch_add(ground.resolve(points), Ordering::Relaxed);
        });
    }

    /// Calls `work` with the points of all cloths that collide with the ground, block by block.
    fn for_ground_contacts(
        &mut self,
        thickness_scale: f64,
        schedule: &Schedule<R>,
        span: StepInterval,
        work: impl Fn(&GroundContact<'_, R>, std::ops::Range<u32>) + Sync,
    ) {
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { ground, ground_materials, material_maps, contact_mask, .. },
            ..
        } = self;
        let Some(plane) = ground.in_step(span) else { return };
        let State {
            displacement, predicted, depenetration_by_collider, depenetration_by_cloth, start, ..
        } = state;
        let writer =
            PositionWriter::new([displacement, depenetration_by_collider, depenetration_by_cloth], predicted);
        for (index, (cloth, material)) in cloths.iter().zip(ground_materials).enumerate() {
            let is_resolved = contact_mask.get(index).is_none_or(|&is_resolved| is_resolved);
            let Some(material) = material.filter(|_| is_resolved) else { continue };
            let ground = GroundContact {
                writer,
                start,
                plane,
                thickness_scale: R::from_f64(thickness_scale),
                material,
                material_maps,
                h: R::from_f64(schedule.h),
            };
            pool.parallel_for(cloth.blocks.len(), |block| work(&ground, cloth.blocks.range(block)));
        }
    }
}

/// The parameters of a [`ColliderStep`], besides the state.
pub(crate) struct ColliderStepArgs<'a, R> {
    pub(crate) material: ContactMaterial<R>,
    pub(crate) material_maps: &'a MaterialMaps<R>,
    pub(crate) h: f64,
    pub(crate) time: [f64; 2],
    pub(crate) interval: [f64; 2],
}

impl<R: Real> ColliderStepArgs<'_, R> {
    /// A time as a share of the candidate interval.
    fn share(&self, time: f64) -> R {
        let [from, to] = self.interval;
        R::from_f64(if to > from { (time - from) / (to - from) } else { 0.0 })
    }

    pub(crate) fn of<'s>(
        &'s self,
        state: &'s mut State<R>,
        collider: &'s ColliderState,
    ) -> ColliderStep<'s, R> {
        let State {
            displacement,
            predicted,
            depenetration_by_collider,
            depenetration_by_cloth,
            start,
            anchor,
            ..
        } = state;
        ColliderStep {
            writer: PositionWriter::new(
                [displacement, depenetration_by_collider, depenetration_by_cloth],
                predicted,
            ),
            start,
            anchors: anchor,
            collider: [&collider.start, &collider.end],
            time: self.time,
            interval: self.interval,
            shares: self.time.map(|time| self.share(time)),
            h: R::from_f64(self.h),
            thickness: R::from_f64(self.material.thickness),
            thickness_scale: R::ONE,
            material: self.material,
            material_maps: self.material_maps,
        }
    }
}
