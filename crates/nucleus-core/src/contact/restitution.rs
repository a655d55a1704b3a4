//! Restitution: after a collision a point separates with part of its approach speed.
//!
//! Position corrections do not express restitution, so it is applied once the velocities of a step are known: at
//! each touching contact the normal speed becomes the coefficient times that before the collision (Müller et al.
//! 2020, "Detailed rigid body simulation with extended position based dynamics", §3.6).

use crate::contact::response::{Impact, Restitution};
use crate::contact::system::{ContactPass, ContactSystem};
use crate::contact::time_step::ColliderStepArgs;
use crate::math::{Real, Row4, add};
use crate::parallel::disjoint::DisjointSlice;
use crate::state::State;

/// Applies restitution at the end of a step: at the ground, at colliders, among cloths.
pub fn apply_restitution<R: Real>(pass: &mut ContactPass<'_, R>) {
    // Twice the speed that gravity adds in a step.
    let h = pass.schedule.h;
    let min_speed = R::from_f64(2.0 * pass.frame.gravity.norm() * h);
    let restitution = Restitution { coefficient: R::ZERO, min_speed, h: R::from_f64(h) };
    restitution_at_ground(pass, restitution);
    for cloth in 0..pass.model.cloths.len() {
        restitution_at_colliders(pass, restitution, cloth);
    }
    restitution_at_cloth(pass, restitution);
}

fn restitution_at_ground<R: Real>(pass: &mut ContactPass<'_, R>, restitution: Restitution<R>) {
    for cloth in 0..pass.model.cloths.len() {
        let Some(material) = pass.contact.ground_materials[cloth]
            .filter(|material| material.has_restitution() && !pass.contact.is_free[cloth])
        else {
            continue;
        };
        for row in pass.model.cloths[cloth].points() {
            let (point, impact) = (([row], [], &([R::ONE], [])), impact(pass.state, row as usize));
            let thickness =
                material.thickness_at(&pass.contact.material_maps, point, R::from_f64(material.thickness));
            let restitution = Restitution {
                coefficient: material.bounce_at(&pass.contact.material_maps, point),
                ..restitution
            };
            let Some(plane) = pass.contact.ground.in_step(pass.span) else { return };
            let height = plane.height_now(row, impact.displacement);
            if restitution.coefficient > R::ZERO && Restitution::touches(height, thickness) {
                let surface = plane.velocity(row, impact.displacement, restitution.h);
                let velocity = restitution.velocity_after(&impact, plane.normal(), surface);
                set_velocity(pass.state, row as usize, velocity);
            }
        }
    }
}

fn restitution_at_colliders<R: Real>(
    pass: &mut ContactPass<'_, R>,
    restitution: Restitution<R>,
    cloth: usize,
) {
    for index in pass.contact.lists_of(cloth) {
        let collider = pass.contact.collider_contacts[index].collider;
        let material =
            pass.contact.collider_materials_of(cloth)[collider].filter(|material| material.has_restitution());
        let Some(material) = material else { continue };
        for active in 0..pass.contact.collider_contacts[index].active.points.indices.len() {
            let ContactPass { state, frame, span, contact, .. } = pass;
            let ContactSystem { collider_states, collider_contacts, material_maps, .. } = &**contact;
            let contact = collider_contacts[index].point_face
                [collider_contacts[index].active.points.indices[active] as usize];
            let (h, interval) = (restitution.h.to_f64(), collider_contacts[index].interval);
            let view =
                ColliderStepArgs { material, material_maps, at: collider, h, time: [span.to; 2], interval };
            let step = view.of(state, &collider_states[collider]);
            let touch = contact.touching_surface(&step, frame.duration);
            let bounce = contact.bounce(&step);
            if let Some((normal, surface)) = touch.filter(|_| bounce > R::ZERO) {
                let row = contact.points[0] as usize;
                let restitution = Restitution { coefficient: bounce, ..restitution };
                let velocity = restitution.velocity_after(&impact(state, row), normal, surface);
                set_velocity(state, row, velocity);
            }
        }
    }
}

fn restitution_at_cloth<R: Real>(pass: &mut ContactPass<'_, R>, restitution: Restitution<R>) {
    let materials =
        pass.contact.cloth_contacts.iter().flat_map(|contacts| contacts.materials.iter().flatten());
    if !materials.into_iter().any(|material| material.has_restitution()) {
        return;
    }
    let mut velocities = std::mem::take(&mut pass.state.velocity);
    let columns = DisjointSlice::new(&mut velocities);
    pass.with_cloth_contacts(|cache, step, pool| cache.apply_restitution(step, columns, restitution, pool));
    pass.state.velocity = velocities;
}

fn impact<R: Real>(state: &State<R>, row: usize) -> Impact<R> {
    Impact {
        predicted: add(
            state.predicted[row].xyz(),
            add(state.depenetration_by_collider[row].xyz(), state.depenetration_by_cloth[row].xyz()),
        ),
        displacement: state.displacement[row].xyz(),
        velocity: state.velocity[row].xyz(),
    }
}

/// Sets the velocity of a point that is not pinned.
fn set_velocity<R: Real>(state: &mut State<R>, row: usize, [x, y, z]: [R; 3]) {
    if state.displacement[row].0[3] > R::ZERO {
        state.velocity[row] = Row4([x, y, z, R::ZERO]);
    }
}
