//! Depenetration: points inside a closed collider.
//!
//! Points that the scene puts into a collider, or that another collider presses into it, move out to the nearest
//! face, slowly and without velocity. Until then no other contact with that collider acts on them (Maya's
//! `trappedCheck`).

use std::ops::Range;

use nalgebra::Vector3;

use crate::bytes::encode_struct;
use crate::contact::boundary::unit_normal;
use crate::contact::bvh::Aabb;
use crate::contact::collider::ColliderState;
use crate::contact::material::ContactMaterial;
use crate::contact::narrow_phase::closest_on_triangle;
use crate::contact::response::DEPENETRATION_SPEED;
use crate::contact::time_step::ColliderStep;
use crate::input::validation::MAX_COORDINATE;
use crate::math::Real;
use crate::model::ColliderModel;

type Point = Vector3<f64>;

/// The points of one cloth inside one collider.
#[derive(Debug, Clone, Default)]
pub struct Depenetration {
    /// Each with its exit face.
    pub points: Vec<(u32, u32)>,
    /// Points found behind a face since the last inside test.
    pub suspects: Vec<u32>,
    /// Whether the positions have been tested at which contact with full strength began, where a point may be far from any
    /// face.
    has_begun: bool,
}

/// What is in the way of a point that leaves a collider.
#[derive(Debug, Clone, Copy)]
pub struct Obstacle {
    /// The point.
    pub point: u32,
    /// The other collider by its index; `None` for the ground.
    pub collider: Option<usize>,
    /// Its unit normal at the point.
    pub normal: Point,
    /// How far the point may go against the normal, in metres.
    pub clearance: f64,
}

encode_struct!([] Depenetration { points: Vec<(u32, u32)>, suspects: Vec<u32>, has_begun: bool });

impl Depenetration {
    /// Whether a point is inside.
    pub fn contains(&self, point: u32) -> bool {
        self.exit_of(point).is_some()
    }

    /// The exit face of a point, if it is inside.
    pub fn exit_of(&self, point: u32) -> Option<u32> {
        self.points.binary_search_by_key(&point, |&(point, _)| point).ok().map(|at| self.points[at].1)
    }

    /// Forgets all points: they stay where they are until contact begins again.
    pub fn clear(&mut self) {
        self.points.clear();
        self.suspects.clear();
        self.has_begun = false;
    }

    /// Tests all points again, as where contact begins.
    pub fn begin_again(&mut self) {
        self.has_begun = false;
    }

    /// Renumbers points; forgets those without a number. Numbers keep their order.
    pub fn renumber(&mut self, number: impl Fn(u32) -> Option<u32>) {
        let points = std::mem::take(&mut self.points).into_iter();
        self.points = points.filter_map(|(point, face)| Some((number(point)?, face))).collect();
        self.suspects = std::mem::take(&mut self.suspects).into_iter().filter_map(number).collect();
    }

    /// Whether the positions have been tested at which contact began.
    pub fn has_begun(&self) -> bool {
        self.has_begun
    }

    /// Forgets all points once a time step has found those that are still inside, which follow. `material` is that of
    /// the two, if they collide.
    pub fn begin_points<R: Real>(&mut self, material: Option<&ContactMaterial<R>>) {
        self.points.clear();
        self.has_begun |=
            material.is_some_and(|material| material.depenetrates && material.has_full_strength());
    }

    /// Suspects all points that are in the bounding box of a closed collider where contact with full strength begins.
    pub fn suspect_start<R: Real>(
        &mut self,
        points: Range<u32>,
        collider: &ColliderModel,
        state: &ColliderState,
        step: &ColliderStep<'_, R>,
    ) {
        if self.has_begun || !step.material.has_full_strength() || collider.pseudonormals.is_none() {
            return;
        }
        self.has_begun = true;
        let [low, high] = state.bounds(step.time.start);
        let is_in = |place: Point| (0..3).all(|axis| low[axis] <= place[axis] && place[axis] <= high[axis]);
        self.suspects.extend(points.filter(|&point| is_in(step.start_position(point))));
    }

    /// Runs the inside test for all points that are inside or suspected, at the start of the step, but for those that are
    /// `excluded` from the face through which they would leave. Calls `freed` with each point that was inside and is outside
    /// now.
    pub fn update<R: Real>(
        &mut self,
        collider: &ColliderModel,
        state: &ColliderState,
        step: &ColliderStep<'_, R>,
        excluded: impl Fn(u32, [u32; 3]) -> bool,
        mut freed: impl FnMut(u32),
    ) {
        let before = Self { points: std::mem::take(&mut self.points), ..Self::default() };
        let Self { points, suspects, .. } = self;
        suspects.extend(before.points.iter().map(|&(point, _)| point));
        suspects.sort_unstable();
        suspects.dedup();
        for point in suspects.drain(..).filter(|&point| step.has_full_strength(point)) {
            let place = step.start_position(point);
            let last = before.exit_of(point);
            let face = exit_face(place, last, collider, state, step.time.start)
                .filter(|&face| !excluded(point, collider.boundary.triangles[face as usize]));
            points.extend(face.map(|face| (point, face)));
            if face.is_none() && last.is_some() {
                freed(point);
            }
        }
    }

    /// Moves every point at least a step farther out, along its face's normal, as far as `clearance` allows, given the point and
    /// the normal, in metres. Along the face it is free.
    pub fn push_outward<R: Real>(
        &self,
        collider: &ColliderModel,
        step: &ColliderStep<'_, R>,
        clearance: impl Fn(u32, &Point) -> f64,
    ) {
        self.points.iter().for_each(|&(point, face)| {
            push_outward(point, face, collider, step, |outward| clearance(point, outward));
        });
    }
}

/// Moves a point at least a step farther out, along the normal of its exit face, as far as `clearance` allows, given the normal.
pub fn push_outward<R: Real>(
    point: u32,
    face: u32,
    collider: &ColliderModel,
    step: &ColliderStep<'_, R>,
    clearance: impl Fn(&Point) -> f64,
) {
    let [from, to] = step.collider_positions(collider.boundary.triangles[face as usize]);
    let outward = unit_normal(to);
    let before = unit_normal(from).dot(&(step.start_position(point) - from[0]));
    let now = outward.dot(&(step.end_position(point) - to[0]));
    let target = (before + DEPENETRATION_SPEED * step.h.to_f64()).min(step.thickness.to_f64());
    let push = (target - now).min(clearance(&outward));
    if push > 0.0 {
        step.push_point(point, outward * push, outward * push.min(target - before));
    }
}

/// The face through which a position inside a closed collider leaves; `None` outside. That is the nearest, of those on the
/// same side as its `last` exit face: a point that was pressed in through one side is nearer to another when it is deep, where
/// it would come out beside the collider.
pub fn exit_face(
    place: Point,
    last: Option<u32>,
    collider: &ColliderModel,
    state: &ColliderState,
    time: f64,
) -> Option<u32> {
    if !is_inside(place, collider, state, time) {
        return None;
    }
    let normal = |face: u32| {
        unit_normal(collider.boundary.triangles[face as usize].map(|point| state.point(point, time)))
    };
    let of_last = last.map(normal).filter(|normal| *normal != Point::zeros());
    let is_on_side = |face: u32| of_last.is_none_or(|last| normal(face).dot(&last) > 0.0);
    nearest_face(place, is_on_side, collider, state, time)
}

/// Inside test: whether a ray from a position leaves a closed mesh an odd number of times. A ray through an edge
/// meets one of its two faces, because each edge belongs to one side.
pub fn is_inside(place: Point, collider: &ColliderModel, state: &ColliderState, time: f64) -> bool {
    let mut crossings = 0;
    let from = place - state.origin(time);
    let ray = Aabb::new(from, from + Point::x() * (2.0 * MAX_COORDINATE));
    state.bvh.query(&ray, |face| {
        let corners =
            collider.boundary.triangles[face as usize].map(|point| state.point(point, time) - place);
        crossings += usize::from(ray_crosses(corners));
    });
    crossings % 2 == 1
}

/// Whether the ray from the origin along x crosses a triangle.
fn ray_crosses(corners: [Point; 3]) -> bool {
    let mut inside = false;
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        // One order for both faces of an edge, so that both get the same bits.
        let (a, b) = if (a.y, a.z, a.x) < (b.y, b.z, b.x) { (a, b) } else { (b, a) };
        if (a.y > 0.0) != (b.y > 0.0) {
            let z = a.z + (b.z - a.z) * (-a.y / (b.y - a.y));
            inside ^= z > 0.0;
        }
    }
    let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
    // Where the ray meets the plane; a plane parallel to the ray is never met.
    inside && normal.x != 0.0 && normal.dot(&corners[0]) / normal.x > 0.0
}

/// The face nearest to a position of those that `is_exit` accepts.
fn nearest_face(
    place: Point,
    is_exit: impl Fn(u32) -> bool,
    collider: &ColliderModel,
    state: &ColliderState,
    time: f64,
) -> Option<u32> {
    let distance = |face: u32| {
        let corners = collider.boundary.triangles[face as usize].map(|point| state.point(point, time));
        let weights = closest_on_triangle(place.into(), corners.map(Into::into));
        (0..3).map(|k| corners[k] * weights[k]).sum::<Point>() - place
    };
    let from = place - state.origin(time);
    let size = state.bounds(time)[1] - state.bounds(time)[0];
    // The box grows until it holds a face that is no farther than its radius.
    let mut radius = size.norm() / 64.0;
    loop {
        let search_box = Aabb::new(from.add_scalar(-radius), from.add_scalar(radius));
        let mut best: Option<(f64, u32)> = None;
        state.bvh.query(&search_box, |face| {
            let found = (distance(face).norm(), face);
            if best.is_none_or(|best| found < best) && is_exit(face) {
                best = Some(found);
            }
        });
        match best {
            Some((nearest, face)) if nearest <= radius => return Some(face),
            _ if radius > 4.0 * size.norm() => return best.map(|(_, face)| face),
            _ => radius *= 2.0,
        }
    }
}
