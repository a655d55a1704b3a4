//! Push-out: moves points of other objects that are near a surface to the side that it specifies.
//!
//! It uses present positions only, for scenes that start with one object inside another. Points that it moves pass
//! through surfaces; contact starts again from the new positions (Maya's `pushOut` and `pushOutRadius`).
//!
//! It is no motion: links that it stretches would throw the points that it has moved. Those that it has moved by more than the
//! thickness have at the end of the substep the velocity that they had at its start, but none into the surface.

use nalgebra::Vector3;

use crate::contact::placed_surface::{Nearest, PlacedSurface};
use crate::contact::system::ContactSystem;
use crate::input::frame::{FrameInput, PushOut};
use crate::math::{Real, Row4, dot, min, scale, sub};
use crate::model::{ClothModel, Model};
use crate::schedule::TimeInterval;
use crate::state::State;

type Point = Vector3<f64>;

/// A surface that pushes out, at its present position.
struct PushOutSurface {
    /// Its triangles face the side that points are pushed to.
    surface: PlacedSurface,
    /// Its own thickness in metres.
    thickness: f64,
    /// Share of the correction in each substep.
    share: f64,
    radius: f64,
    /// Whether each cloth collides with it.
    collides: Vec<bool>,
}

/// Pushes points out of all surfaces that do so, at the start of a substep, at time `time` as a share of the
/// frame.
pub fn push_out<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    contact: &mut ContactSystem<R>,
    frame: &FrameInput,
    time: f64,
) {
    for at in (0..model.colliders.len()).filter(|&at| frame.colliders[at].push_out.is_on()) {
        let collider = &contact.collider_states[at];
        let faces = model.colliders[at].boundary.triangles.iter();
        let triangles = faces.map(|face| face.map(|point| collider.point(point, time))).collect();
        let theirs = &frame.colliders[at];
        let collides = (0..model.cloths.len())
            .map(|cloth| contact.collider_materials_of(cloth).get(at).is_some_and(Option::is_some));
        let collides = collides.collect();
        let surface = PushOutSurface::new(triangles, theirs.push_out, theirs.thickness, collides);
        (0..model.cloths.len())
            .for_each(|cloth| push_out_of(&model.cloths[cloth], state, contact, &surface, frame, cloth));
    }
    for at in (0..model.cloths.len()).filter(|&at| frame.cloths[at].push_out.is_on()) {
        let place = |row: u32| Point::from(state.position(row));
        let triangles = model.cloths[at].boundary.triangles.iter().map(|face| face.map(place)).collect();
        let own = &frame.cloths[at];
        let materials =
            contact.cloth_contacts.as_ref().map_or(&[][..], |contacts| contacts.materials.row(at));
        let with = |cloth: usize| materials.get(cloth).is_some_and(Option::is_some);
        let collides = (0..model.cloths.len()).map(with).collect();
        let surface = PushOutSurface::new(triangles, own.push_out, own.thickness, collides);
        let others = (0..model.cloths.len()).filter(|&cloth| cloth != at);
        others.for_each(|cloth| push_out_of(&model.cloths[cloth], state, contact, &surface, frame, cloth));
    }
}

/// Moves the free points of a cloth, and invalidates their motion bounds.
fn push_out_of<R: Real>(
    model: &ClothModel<R>,
    state: &mut State<R>,
    contact: &mut ContactSystem<R>,
    surface: &PushOutSurface,
    frame: &FrameInput,
    cloth: usize,
) {
    let thickness = surface.thickness + frame.cloths[cloth].thickness;
    let mut is_moved = false;
    for row in model.points() {
        let mut moved = state.displacement[row as usize];
        let correction =
            surface.correction(Point::from(state.position(row)), thickness, surface.collides[cloth]);
        let Some((correction, normal)) = correction.filter(|_| moved.0[3] > R::ZERO) else { continue };
        (0..3).for_each(|axis| moved.0[axis] += R::from_f64(correction[axis]));
        state.displacement[row as usize] = moved;
        is_moved = true;
        contact.invalidate_bounds(row as usize);
        if correction.norm() <= thickness {
            continue; // no more than contact moves it
        }
        let (normal, velocity) = (normal.map(R::from_f64), state.velocity[row as usize].xyz());
        let inward = min(dot(velocity, normal), R::ZERO);
        state.pushed_out.push((row, sub(velocity, scale(normal, inward))));
    }
    if is_moved {
        contact.active_windows[cloth] = TimeInterval::EXPIRED;
        if let Some(cloth_contacts) = &mut contact.cloth_contacts {
            cloth_contacts.untangling.is_search_due[cloth] = true;
        }
    }
}

impl PushOutSurface {
    fn new(mut triangles: Vec<[Point; 3]>, push_out: PushOut, thickness: f64, collides: Vec<bool>) -> Self {
        if push_out.share < 0.0 {
            triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        let share = push_out.share.abs().min(1.0);
        let corners: Vec<Point> = triangles.iter().flatten().copied().collect();
        let faces = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let surface = PlacedSurface::new(faces, |corner| corners[corner as usize]);
        Self { surface, thickness, share, radius: push_out.radius, collides }
    }

    /// The correction of a point in this substep, if it is within the radius and closer to the surface than
    /// `thickness`, or behind it; and the normal there. `collides` says whether contact keeps points at that distance too.
    fn correction(&self, place: Point, thickness: f64, collides: bool) -> Option<(Point, [f64; 3])> {
        let Nearest { distance, point, normal, .. } = self.surface.nearest(place, self.radius)?;
        let height = normal.dot(&(place - point));
        let is_clear = height >= 0.0 && distance >= thickness;
        let reached = height + (thickness - height) * self.share;
        // Within the thickness contact would hold it on the far side.
        let share = if collides && reached > -thickness { 1.0 } else { self.share };
        (!is_clear).then(|| ((point + normal * thickness - place) * share, normal.into()))
    }
}

/// Gives the points that were moved in a substep their velocities back.
pub fn end_push_out<R: Real>(state: &mut State<R>) {
    for (row, [x, y, z]) in state.pushed_out.drain(..) {
        let velocity = &mut state.velocity[row as usize];
        *velocity = Row4([x, y, z, velocity.0[3]]);
    }
}
