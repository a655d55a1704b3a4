//! The first way of a new particle, from its birth to the end of its substep: whether a collider or the ground plane stands
//! in it.
//!
//! Contact acts on a particle from the time step after its birth on. A particle that would pass a surface on its first way
//! therefore stays at its place of birth, relative to the surface, and meets it in that time step.

use std::cell::Cell;

use nalgebra::Vector3;

use crate::contact::depenetration::is_inside;
use crate::contact::material::MIN_THICKNESS;
use crate::contact::placed_surface::meets;
use crate::contact::system::ContactSystem;
use crate::math::Real;
use crate::model::ColliderModel;

type Point = Vector3<f64>;

/// Fits the boxes of all colliders that an object collides with to a time of the frame.
pub fn fit_obstacles<R: Real>(
    contact: &mut ContactSystem<R>,
    colliders: &[ColliderModel],
    cloth: usize,
    time: f64,
) {
    for (at, collider) in colliders.iter().enumerate() {
        if contact.collider_materials_of(cloth)[at].is_some() {
            contact.collider_states[at].fit_boxes(collider, [time; 2]);
        }
    }
}

/// Where a particle stays that would pass a surface between two places at two times, as shares of the frame. `point` is its
/// object and its row. Colliders are fitted to the second time.
pub fn stopped_at<R: Real>(
    contact: &ContactSystem<R>,
    colliders: &[ColliderModel],
    (cloth, row): (usize, u32),
    way: [Point; 2],
    times: [f64; 2],
) -> Option<Point> {
    let of_collider = |(at, collider): (usize, &ColliderModel)| {
        let material = contact.collider_materials_of(cloth)[at].as_ref()?;
        let state = &contact.collider_states[at];
        // Seen from a collider that is where it will be, the particle begins as far from it as it was born.
        let start = way[0] + state.mean_travel * (times[1] - times[0]);
        let ray = way[1] - start;
        let is_met = Cell::new(false);
        let from = start - state.origin(times[1]);
        state.bvh.descend(
            |bounds| !is_met.get() && bounds.meets_ray(from, ray, 1.0),
            |face| {
                let corners = collider.boundary.triangles[face as usize];
                let share = meets(start, ray, corners.map(|corner| state.point(corner, times[1])));
                // A particle that a surface emits begins on it.
                let is_ahead = share.is_some_and(|share| share * ray.norm() > MIN_THICKNESS);
                if is_ahead && !contact.pair_filter.excludes_collider(&[row], at, &corners) {
                    is_met.set(true);
                }
            },
        );
        let leaves = || {
            material.depenetrates
                && collider.pseudonormals.is_some()
                && is_inside(start, collider, state, times[1])
        };
        (is_met.get() && !leaves()).then_some(start)
    };
    let on_ground = || {
        contact.ground_materials[cloth].as_ref()?;
        let height = |place: Point, time| contact.ground.at(place.into(), time).map(|(_, height)| height);
        let was_above = height(way[0], times[0])? >= 0.0 && height(way[0], times[1])? >= 0.0;
        (was_above && height(way[1], times[1])? < 0.0).then_some(way[0])
    };
    colliders.iter().enumerate().find_map(of_collider).or_else(on_ground)
}
