//! The path of a new particle, from its birth to the end of its substep: whether a collider, cloth or the ground plane
//! stands in it.
//!
//! Contact acts on a particle from the time step after its birth on. A particle that would pass a surface on that path
//! therefore stays at its place of birth, relative to the surface, and meets it in that time step.

use std::cell::Cell;

use nalgebra::Vector3;

use crate::contact::bvh::RayBundle;
use crate::contact::depenetration::is_inside;
use crate::contact::material::MIN_THICKNESS;
use crate::contact::placed_surface::{PlacedSurface, meets};
use crate::contact::system::ContactSystem;
use crate::math::Real;
use crate::model::{ColliderModel, Model};
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::TimeInterval;
use crate::state::State;

type Point = Vector3<f64>;

/// The surfaces that the new particles of an object can meet at the end of a substep.
pub struct Obstacles {
    cloth: usize,
    /// The end of the substep, as a share of the frame. Colliders are fitted to it.
    end: f64,
    /// The faces of cloth, their rows, and their mean velocities since the start of the frame in metres per frame. Those of
    /// one time step may be many times larger where cloth trembles.
    faces: PlacedSurface,
    rows: Vec<[u32; 3]>,
    velocities: Vec<Point>,
    /// The largest of these speeds.
    max_speed: f64,
}

impl Obstacles {
    /// Those of an object near the paths of its new particles.
    pub fn new<R: Real>(
        (model, state, contact): (&Model<R>, &State<R>, &mut ContactSystem<R>),
        cloth: usize,
        paths: impl Iterator<Item = [Point; 2]>,
        end: f64,
    ) -> Self {
        fit_colliders(contact, model, cloth, end);
        let none = [Point::repeat(f64::INFINITY), Point::repeat(f64::NEG_INFINITY)];
        let bound = paths.fold(none, |[low, high], [a, b]| [low.inf(&a).inf(&b), high.sup(&a).sup(&b)]);
        let moved = |row: u32| Point::from(state.displacement[row as usize].xyz().map(R::to_f64));
        let of_face = |[a, b, c]: [u32; 3]| (moved(a) + moved(b) + moved(c)) / (3.0 * end);
        let is_near = |rows: &[u32; 3]| {
            let corners = rows.map(|row| Point::from(state.position(row)));
            overlaps(corners, bound, of_face(*rows).norm())
        };
        let rows: Vec<[u32; 3]> = touched_faces(model, contact, cloth).filter(is_near).collect();
        let velocities: Vec<Point> = rows.iter().copied().map(of_face).collect();
        let max_speed = velocities.iter().map(|velocity| velocity.norm()).fold(0.0, f64::max);
        let faces = PlacedSurface::new(rows.clone(), |row| state.position(row).into());
        Self { cloth, end, faces, rows, velocities, max_speed }
    }

    /// Where the particle of a row stays that was born at a time, as a share of the frame, and would pass a surface on its
    /// path to the end of the substep.
    pub fn stop<R: Real>(
        &self,
        (model, contact): (&Model<R>, &ContactSystem<R>),
        row: u32,
        path: [Point; 2],
        born: f64,
    ) -> Option<Point> {
        let by_cloth = || self.stop_at_cloth(contact, row, path, self.end - born);
        stopped_at(
            contact,
            &model.colliders,
            (self.cloth, row),
            path,
            TimeInterval { start: born, end: self.end },
        )
        .or_else(by_cloth)
    }

    /// The same for cloth alone; `age` is a share of the frame.
    fn stop_at_cloth<R: Real>(
        &self,
        contact: &ContactSystem<R>,
        row: u32,
        path: [Point; 2],
        age: f64,
    ) -> Option<Point> {
        let moved = Point::repeat(self.max_speed * age);
        let around = [path[0].inf(&path[1]) - moved, path[0].sup(&path[1]) + moved];
        let mut first: Option<(f64, Point)> = None;
        self.faces.for_faces(around, |face, corners| {
            // Seen from a face that is where it will be, the particle begins as far from it as it was born.
            let start = path[0] + self.velocities[face] * age;
            let Some(share) = meets(start, path[1] - start, corners) else { return };
            let is_first = first.is_none_or(|(other, _)| share < other);
            if is_first && !contact.pair_filter.excludes(&[row], &self.rows[face]) {
                first = Some((share, start));
            }
        });
        first.map(|(_, start)| start)
    }
}

/// Fits the boxes of all colliders that an object collides with to a time of the frame.
fn fit_colliders<R: Real>(contact: &mut ContactSystem<R>, model: &Model<R>, cloth: usize, time: f64) {
    for (at, collider) in model.colliders.iter().enumerate() {
        if contact.collider_materials_of(cloth)[at].is_some() {
            contact.collider_states[at].fit_boxes(collider, TimeInterval::at(time), &ThreadPool::new(1));
        }
    }
}

/// The faces of all cloth that an object can touch.
fn touched_faces<R: Real>(
    model: &Model<R>,
    contact: &ContactSystem<R>,
    cloth: usize,
) -> impl Iterator<Item = [u32; 3]> {
    let contacts = contact.cloth_contacts.as_ref();
    let is_touched = move |other: usize| contacts.is_some_and(|contacts| contacts.touch(cloth, other));
    let touched = model.cloths.iter().enumerate().filter(move |(other, _)| is_touched(*other));
    touched.flat_map(|(_, other)| other.boundary.triangles.iter().copied())
}

/// Whether the bounding box of a face overlaps a box that is inflated by a margin.
fn overlaps(corners: [Point; 3], [low, high]: [Point; 2], margin: f64) -> bool {
    (0..3).all(|axis| {
        let along = corners.map(|corner| corner[axis]);
        along.iter().any(|&x| x >= low[axis] - margin) && along.iter().any(|&x| x <= high[axis] + margin)
    })
}

/// Where a particle stays that would pass a collider or the ground between two places at two times, as shares of the frame.
/// `point` is its object and its row. Colliders are fitted to the second time.
fn stopped_at<R: Real>(
    contact: &ContactSystem<R>,
    colliders: &[ColliderModel],
    (cloth, row): (usize, u32),
    path: [Point; 2],
    times: TimeInterval,
) -> Option<Point> {
    let of_collider = |(at, collider): (usize, &ColliderModel)| {
        let material = contact.collider_materials_of(cloth)[at].as_ref()?;
        let state = &contact.collider_states[at];
        // Seen from a collider that is where it will be, the particle begins as far from it as it was born.
        let start = path[0] + state.mean_travel * times.length();
        let ray = path[1] - start;
        let is_met = Cell::new(false);
        let from = start - state.origin(times.end);
        let bundle = RayBundle::new([from; 2], ray);
        state.bvh.descend(
            |bounds| !is_met.get() && bundle.entry(bounds) <= 1.0,
            |face| {
                let corners = collider.boundary.triangles[face as usize];
                let share = meets(start, ray, corners.map(|corner| state.point(corner, times.end)));
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
                && is_inside(start, collider, state, times.end)
        };
        (is_met.get() && !leaves()).then_some(start)
    };
    let on_ground = || {
        contact.ground_materials[cloth].as_ref()?;
        let height = |place: Point, time| contact.ground.at(place.into(), time).map(|(_, height)| height);
        let was_above = height(path[0], times.start)? >= 0.0 && height(path[0], times.end)? >= 0.0;
        (was_above && height(path[1], times.end)? < 0.0).then_some(path[0])
    };
    colliders.iter().enumerate().find_map(of_collider).or_else(on_ground)
}
