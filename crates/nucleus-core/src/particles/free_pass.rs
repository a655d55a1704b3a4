//! A time step of an object of free points: what is the same for all its points, and the buffers of a task.

use std::ops::Range;
use std::sync::atomic::Ordering;

use crate::contact::collider::near_collider::NearCollider;
use crate::contact::collider::near_points::NearPoints;
use crate::contact::ground::GroundStep;
use crate::contact::material::ContactMaterial;
use crate::contact::response::Restitution;
use crate::contact::system::ContactSystem;
use crate::contact::time_step::{ColliderStepArgs, PositionWriter};
use crate::integrate::predict::{MotionColumns, Prediction};
use crate::math::{Real, Row4};
use crate::model::Model;
use crate::parallel::disjoint::DisjointSlice;
use crate::particles::free_run::Run;
use crate::schedule::{Pass, TimeStep};
use crate::state::State;

/// Points of a run: their buffers fit into the nearest cache.
const RUN: usize = 128;

/// The buffers of a run of points.
struct Buffers<R> {
    start: [Row4<R>; RUN],
    predicted: [Row4<R>; RUN],
    by_collider: [Row4<R>; RUN],
    by_cloth: [Row4<R>; RUN],
    heights: [[R; RUN]; 2],
}

impl<R: Real> Buffers<R> {
    fn new() -> Self {
        let rows = [Row4::ZERO; RUN];
        let heights = [[R::ZERO; RUN]; 2];
        Self { start: rows, predicted: rows, by_collider: rows, by_cloth: rows, heights }
    }
}

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
            prediction: Prediction::new(columns, &model.cloths[cloth], now, cloth),
            anchors: &state.anchor,
            plane: contact.ground.in_step(now.span).zip(contact.ground_materials[cloth]),
            has_colliders: contact.has_collider_material(cloth),
            sweeps: now.schedule.passes.iter().filter(|pass| **pass == Pass::ColliderContact).count(),
            restitution: Restitution { coefficient: R::ZERO, min_speed, h: R::from_f64(h) },
            frame: now.frame.duration,
        }
    }

    /// All stages of the time step for the points of a task.
    pub fn advance(&self, points: Range<u32>, near: &mut NearPoints<R>) {
        let mut buffers = Buffers::new();
        near.begin();
        for first in points.clone().step_by(RUN) {
            self.advance_run(first..points.end.min(first + RUN as u32), &mut buffers, near);
        }
        if near.counters.contacts.load(Ordering::Relaxed) > 0 {
            self.contact.has_touched[self.cloth].store(true, Ordering::Relaxed);
        }
    }

    fn advance_run(&self, rows: Range<u32>, buffers: &mut Buffers<R>, near: &mut NearPoints<R>) {
        let Buffers { start, predicted, by_collider, by_cloth, heights: [at_start, at_end] } = buffers;
        let (count, displacement) = (rows.len(), self.prediction.columns.displacement);
        // SAFETY: tasks do not overlap, nor do their runs.
        #[allow(unsafe_code)]
        unsafe {
            start[..count].copy_from_slice(displacement.run(rows.clone()));
            self.prediction.move_points(rows.clone(), &mut predicted[..count]);
        }
        if self.plane.is_none() && !self.has_colliders {
            return;
        }
        by_collider[..count].fill(Row4::ZERO);
        by_cloth[..count].fill(Row4::ZERO);
        let anchors = &self.anchors[rows.start as usize..rows.end as usize];
        self.contact.ground.heights_of(anchors, [&mut at_start[..count], &mut at_end[..count]]);
        let writer =
            PositionWriter::of_run(displacement, [by_collider, by_cloth], &predicted[..count], rows.start);
        let heights = [&at_start[..count], &at_end[..count]];
        Run { pass: self, writer, rows, start: &start[..count], heights }.advance(near);
    }

    /// The colliders that the points can touch, with their places.
    pub(super) fn colliders(&self) -> impl Iterator<Item = (usize, NearCollider<'_, R>)> {
        let (contact, span) = (self.contact, self.now.span);
        let (h, time) = (self.now.schedule.h, [span.from, span.to]);
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
