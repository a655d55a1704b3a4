//! A time step of an object of free points: what is the same for all its points.

use crate::contact::collider::near_collider::NearCollider;
use crate::contact::ground::GroundStep;
use crate::contact::material::ContactMaterial;
use crate::contact::response::Restitution;
use crate::contact::system::ContactSystem;
use crate::contact::time_step::ColliderStepArgs;
use crate::integrate::predict::{MotionColumns, Prediction};
use crate::math::Real;
use crate::model::Model;
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{Pass, TimeStep};
use crate::state::State;

/// A time step of the points of one object.
pub struct FreePass<'a, R: Real> {
    pub(super) cloth: usize,
    model: &'a Model<R>,
    pub(super) contact: &'a ContactSystem<R>,
    pub(super) now: &'a TimeStep<'a, R>,
    pub(super) prediction: Prediction<'a, R>,
    pub(super) anchors: &'a [[f64; 3]],
    pub(super) plane: Option<(GroundStep<'a, R>, ContactMaterial<R>)>,
    pub(super) has_colliders: bool,
    /// Sweeps over the contacts.
    pub(super) sweeps: usize,
    /// Restitution without its coefficient.
    pub(super) restitution: Restitution<R>,
    /// Length of the frame in seconds.
    pub(super) frame: f64,
}

impl<'a, R: Real> FreePass<'a, R> {
    /// The time step `now` of an object, by its index.
    pub fn new(
        cloth: usize,
        (model, state, contact): (&'a Model<R>, &'a mut State<R>, &'a ContactSystem<R>),
        now: &'a TimeStep<'a, R>,
    ) -> Self {
        let h = now.schedule.h;
        let columns = MotionColumns {
            displacement: DisjointSlice::new(&mut state.displacement),
            velocity: DisjointSlice::new(&mut state.velocity),
            normal: &state.normal,
            added_wind: &state.added_wind,
            field: &state.field,
        };
        let min_speed = R::from_f64(2.0 * now.frame.gravity.norm() * h);
        Self {
            cloth,
            model,
            contact,
            now,
            prediction: Prediction::new(columns, &model.cloths[cloth], now, cloth, h),
            anchors: &state.anchor,
            plane: contact.ground.in_step(now.span).zip(contact.ground_materials[cloth]),
            has_colliders: contact.has_collider_material(cloth),
            sweeps: now.schedule.passes.iter().filter(|pass| **pass == Pass::ColliderContact).count(),
            restitution: Restitution {
                coefficient: R::ZERO,
                friction: R::ZERO,
                min_speed,
                h: R::from_f64(h),
            },
            frame: now.frame.duration,
        }
    }

    /// The colliders that the points can touch, with their places.
    pub(super) fn colliders(&self) -> impl Iterator<Item = (usize, NearCollider<'_, R>)> {
        let (contact, span) = (self.contact, self.now.span);
        let (h, time) = (self.now.schedule.h, span.times());
        let lists = &contact.collider_contacts[contact.lists_of(self.cloth)];
        let near = lists.iter().filter_map(move |list| {
            let (at, material_maps) = (list.collider, &contact.material_maps);
            let material = contact.collider_materials_of(self.cloth)[at]?;
            let args = ColliderStepArgs { material, material_maps, at, h, time, interval: time };
            let (model, state) = (&self.model.colliders[at], &contact.collider_states[at]);
            Some(NearCollider::new(args, model, state, &list.depenetration, list.is_near))
        });
        near.enumerate()
    }
}
