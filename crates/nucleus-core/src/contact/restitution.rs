//! Restitution: after a collision a point separates with part of its approach speed.
//!
//! Position corrections do not express restitution, so it is applied once the velocities of a step are known: at
//! each touching contact the normal speed becomes the coefficient times that before the collision (Müller et al.
//! 2020, "Detailed rigid body simulation with extended position based dynamics", §3.6).

use crate::contact::cloth::ClothContacts;
use crate::contact::cloth::pass::cloth_step;
use crate::contact::collider::pass::ColliderStepArgs;
use crate::input::frame::FrameInput;
use crate::math::{Real, Row4, add, dot};
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Solver};

/// Gap above the thickness up to which a contact is touching, as a share of the thickness.
const TOUCHING: f64 = 1e-3;

/// Restitution at a surface in one step.
#[derive(Debug, Clone, Copy)]
pub struct Restitution<R> {
    /// Coefficient of restitution, 0 to 1.
    pub coefficient: R,
    /// Approach speed in m/s below which there is none: resting contacts would jitter on the speed that gravity
    /// adds in each step.
    pub min_speed: R,
    /// Length of the step in seconds.
    pub h: R,
}

/// The state of a point after its contacts.
#[derive(Debug, Clone, Copy)]
pub struct Impact<R> {
    /// Predicted displacement in metres.
    pub predicted: [R; 3],
    /// Displacement now, in metres.
    pub displacement: [R; 3],
    /// Velocity now, in m/s.
    pub velocity: [R; 3],
}

impl<R: Real> Restitution<R> {
    /// Whether a gap counts as touching.
    pub fn touches(gap: R, thickness: R) -> bool {
        gap <= thickness * R::from_f64(1.0 + TOUCHING)
    }

    /// The velocity after collision with a surface of this normal and velocity.
    pub fn velocity_after(&self, impact: &Impact<R>, normal: [R; 3], surface: [R; 3]) -> [R; 3] {
        let now: [R; 3] = std::array::from_fn(|axis| impact.velocity[axis] - surface[axis]);
        let pushed: [R; 3] = std::array::from_fn(|axis| impact.displacement[axis] - impact.predicted[axis]);
        let speed = dot(normal, now);
        let before = speed - dot(normal, pushed) / self.h;
        let after = -(self.coefficient * before);
        if -before <= self.min_speed || speed >= after {
            return impact.velocity;
        }
        std::array::from_fn(|axis| impact.velocity[axis] + normal[axis] * (after - speed))
    }
}

impl<R: Real> Solver<R> {
    /// Applies restitution at the end of a step: at the ground, at colliders, among cloths.
    pub(crate) fn apply_restitution(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        now: StepInterval,
    ) {
        // Twice the speed that gravity adds in a step.
        let min_speed = R::from_f64(2.0 * frame.gravity.norm() * schedule.h);
        let restitution = Restitution { coefficient: R::ZERO, min_speed, h: R::from_f64(schedule.h) };
        self.restitution_at_ground(restitution, now);
        for cloth in 0..self.model.cloths.len() {
            self.restitution_at_colliders(frame, restitution, now.to, cloth);
        }
        self.restitution_at_cloth(schedule, restitution);
    }

    fn restitution_at_ground(&mut self, restitution: Restitution<R>, now: StepInterval) {
        for cloth in 0..self.model.cloths.len() {
            let Some(material) =
                self.contact.ground_materials[cloth].filter(|material| material.has_restitution())
            else {
                continue;
            };
            for row in self.model.cloths[cloth].points() {
                let (point, impact) = (([row], [], &([R::ONE], [])), self.impact(row as usize));
                let thickness = material.thickness_at(
                    &self.contact.material_maps,
                    point,
                    R::from_f64(material.thickness),
                );
                let restitution = Restitution {
                    coefficient: material.bounce_at(&self.contact.material_maps, point),
                    ..restitution
                };
                let Some(plane) = self.contact.ground.in_step(now) else { return };
                let height = plane.height_now(row, impact.displacement);
                if restitution.coefficient > R::ZERO && Restitution::touches(height, thickness) {
                    let surface = plane.velocity(row, impact.displacement, restitution.h);
                    let velocity = restitution.velocity_after(&impact, plane.normal(), surface);
                    self.set_velocity(row as usize, velocity);
                }
            }
        }
    }

    fn restitution_at_colliders(
        &mut self,
        frame: &FrameInput,
        restitution: Restitution<R>,
        end: f64,
        cloth: usize,
    ) {
        for index in 0..self.contact.collider_contacts.len() {
            let collider = self.contact.collider_contacts[index].collider;
            if self.contact.collider_contacts[index].cloth != cloth {
                continue;
            }
            let material =
                self.collider_materials_of(cloth)[collider].filter(|material| material.has_restitution());
            let Some(material) = material else { continue };
            for active in 0..self.contact.collider_contacts[index].active.point_face.len() {
                let Self {
                    state,
                    contact: ContactSystem { collider_states, collider_contacts, material_maps, .. },
                    ..
                } = self;
                let contact = collider_contacts[index].point_face
                    [collider_contacts[index].active.point_face[active] as usize];
                let (h, interval) = (restitution.h.to_f64(), collider_contacts[index].interval);
                let view = ColliderStepArgs { material, material_maps, h, time: [end; 2], interval };
                let touch =
                    contact.touching_surface(&view.of(state, &collider_states[collider]), frame.duration);
                let bounce = material.bounce_at(material_maps, (contact.points, [], &([R::ONE], [])));
                if let Some((normal, surface)) = touch.filter(|_| bounce > R::ZERO) {
                    let row = contact.points[0] as usize;
                    let restitution = Restitution { coefficient: bounce, ..restitution };
                    self.set_velocity(row, restitution.velocity_after(&self.impact(row), normal, surface));
                }
            }
        }
    }

    fn restitution_at_cloth(&mut self, schedule: &Schedule<R>, restitution: Restitution<R>) {
        let Self {
            state,
            pool,
            contact: ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, .. },
            ..
        } = self
        else {
            return;
        };
        let ClothContacts { cache, materials, .. } = cloth_contacts;
        if !materials.iter().flatten().any(|material| material.has_restitution()) {
            return;
        }
        let mut velocities = std::mem::take(&mut state.velocity);
        cache.apply_restitution(
            &cloth_step(state, materials, material_maps, schedule.h),
            DisjointSlice::new(&mut velocities),
            restitution,
            pool,
        );
        state.velocity = velocities;
    }

    fn impact(&self, row: usize) -> Impact<R> {
        Impact {
            predicted: add(
                self.state.predicted[row].xyz(),
                add(
                    self.state.depenetration_by_collider[row].xyz(),
                    self.state.depenetration_by_cloth[row].xyz(),
                ),
            ),
            displacement: self.state.displacement[row].xyz(),
            velocity: self.state.velocity[row].xyz(),
        }
    }

    /// Sets the velocity of a point that is not pinned.
    fn set_velocity(&mut self, row: usize, [x, y, z]: [R; 3]) {
        if self.state.displacement[row].0[3] > R::ZERO {
            self.state.velocity[row] = Row4([x, y, z, R::ZERO]);
        }
    }
}
