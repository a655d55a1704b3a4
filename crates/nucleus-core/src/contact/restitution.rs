//! Restitution: after a collision a point separates with part of its approach speed.
//!
//! Position corrections do not express restitution, so it is applied once the velocities of a step are known: at
//! each touching contact the normal speed becomes the coefficient times that before the collision (Müller et al.
//! 2020, "Detailed rigid body simulation with extended position based dynamics", §3.6).

use crate::contact::response::{CountedTouches, Impact, Restitution, TouchingPoint};
use crate::contact::rigid_impact::{rebound, share_of_impact};
use crate::contact::system::{ContactPass, ContactSystem};
use crate::contact::time_step::ColliderStepArgs;
use crate::math::{Real, Row4};
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::TimeInterval;
use crate::state::State;

/// Applies restitution at the end of a step: at the ground, at colliders, among cloths.
pub fn apply_restitution<R: Real>(pass: &mut ContactPass<'_, R>) {
    // Twice the speed that gravity adds in a step.
    let h = pass.schedule.h;
    let min_speed = R::from_f64(2.0 * pass.frame.gravity.norm() * h);
    let restitution = Restitution { coefficient: R::ZERO, friction: R::ZERO, min_speed, h: R::from_f64(h) };
    let mut touches = std::mem::take(&mut pass.contact.bouncing);
    for cloth in 0..pass.model.cloths.len() {
        // A rigid body that does not bounce stops as a whole too.
        let share = share_of_impact(pass.schedule, cloth);
        touches.clear();
        find_touches_of_ground(pass, cloth, share > 0.0, &mut touches);
        find_touches_of_colliders(pass, cloth, share > 0.0, &mut touches);
        if share > 0.0 {
            let shape = &pass.model.cloths[cloth].shape;
            touches.sort_by_key(|touch| (shape.shell_of(touch.row), touch.row));
            for touches in touches.chunk_by(|a, b| shape.shell_of(a.row) == shape.shell_of(b.row)) {
                let Some(shell) = shape.shell_of(touches[0].row) else { continue };
                rebound(pass.state, shape.rows_of(shell), touches, restitution, share);
            }
        } else {
            touches.iter().for_each(|touch| bounce(pass.state, touch, restitution));
        }
    }
    pass.contact.bouncing = touches;
    restitution_at_cloth(pass, restitution);
}

/// Finds the points of a cloth that touch the ground where it bounces, or also where it does not.
fn find_touches_of_ground<R: Real>(
    pass: &ContactPass<'_, R>,
    cloth: usize,
    even_without_bounce: bool,
    touches: &mut Vec<TouchingPoint<R>>,
) {
    let Some(material) = pass.contact.ground_materials[cloth].filter(|material| {
        (even_without_bounce || material.has_restitution()) && !pass.contact.is_free[cloth]
    }) else {
        return;
    };
    let Some(plane) = pass.contact.ground.in_step(pass.span) else { return };
    let h = R::from_f64(pass.schedule.h);
    for row in pass.model.cloths[cloth].points() {
        let (point, displacement) =
            (([row], [], &([R::ONE], [])), pass.state.displacement[row as usize].xyz());
        let thickness =
            material.thickness_at(&pass.contact.material_maps, point, R::from_f64(material.thickness));
        if Restitution::touches(plane.height_now(row, displacement), thickness) {
            let coefficient = material.bounce_at(&pass.contact.material_maps, point);
            let surface = plane.velocity(row, displacement, h);
            let (normal, gap, is_rim) = (plane.normal(), R::ZERO, false);
            let friction = material.impact_friction_at(&pass.contact.material_maps, point);
            touches.push(TouchingPoint { row, normal, surface, coefficient, friction, gap, is_rim });
        }
    }
}

/// Finds the points of a cloth that touch colliders where they bounce, or also where they do not.
fn find_touches_of_colliders<R: Real>(
    pass: &mut ContactPass<'_, R>,
    cloth: usize,
    even_without_bounce: bool,
    touches: &mut Vec<TouchingPoint<R>>,
) {
    let ContactPass { state, frame, span, contact, .. } = pass;
    let ContactSystem { collider_states, collider_contacts, material_maps, .. } = &**contact;
    let h = pass.schedule.h;
    for index in contact.lists_of(cloth) {
        let list = &collider_contacts[index];
        let (at, interval) = (list.collider, list.interval);
        let material = contact.collider_materials_of(cloth)[at]
            .filter(|material| even_without_bounce || material.has_restitution());
        let Some(material) = material else { continue };
        let view =
            ColliderStepArgs { material, material_maps, at, h, time: TimeInterval::at(span.to), interval };
        let step = view.of(state, &collider_states[at]);
        let first = touches.len();
        for &active in &list.active.points.indices {
            let contact = list.point_face[active as usize];
            touches.extend(contact.touch(&step, frame.duration));
        }
        drop_rims(touches, first);
    }
}

/// Drops the touches of a collider, from `first` on, that do not count.
fn drop_rims<R: Real>(touches: &mut Vec<TouchingPoint<R>>, first: usize) {
    touches[first..].sort_by_key(|touch| touch.row);
    let (mut kept, mut from) = (first, first);
    while from < touches.len() {
        let row = touches[from].row;
        let end = from + touches[from..].partition_point(|touch| touch.row == row);
        let counted = CountedTouches::of(touches[from..end].iter().copied());
        for at in from..end {
            if counted.is_some_and(|counted| counted.contain(&touches[at])) {
                touches[kept] = touches[at];
                kept += 1;
            }
        }
        from = end;
    }
    touches.truncate(kept);
}

/// Sets the velocity of a point after its collision, unless it is pinned.
fn bounce<R: Real>(state: &mut State<R>, touch: &TouchingPoint<R>, restitution: Restitution<R>) {
    let row = touch.row as usize;
    if touch.coefficient <= R::ZERO || state.displacement[row].0[3] <= R::ZERO {
        return;
    }
    let restitution = restitution.at(touch);
    let [x, y, z] = restitution.velocity_after(&Impact::of(state, row), touch.normal, touch.surface);
    state.velocity[row] = Row4([x, y, z, R::ZERO]);
}

fn restitution_at_cloth<R: Real>(pass: &mut ContactPass<'_, R>, restitution: Restitution<R>) {
    if !pass.contact.cloth_contacts.as_ref().is_some_and(|contacts| contacts.effects.restitution) {
        return;
    }
    let mut velocities = std::mem::take(&mut pass.state.velocity);
    let columns = DisjointSlice::new(&mut velocities);
    pass.with_cloth_contacts(|cache, step, pool| cache.apply_restitution(step, columns, restitution, pool));
    pass.state.velocity = velocities;
}
