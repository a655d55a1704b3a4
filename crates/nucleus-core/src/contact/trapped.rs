//! Points inside a closed collider: put there by the scene, or pressed in by another collider. They are led out to the
//! nearest face, slowly and without gaining speed, and until then nothing of that collider holds them (Maya's
//! `trappedCheck`).

use std::ops::Range;

use nalgebra::Vector3;

use super::aabb::Aabb;
use super::collider::ColliderState;
use super::collider_contact::Step;
use super::narrow::closest_on_triangle;
use crate::bytes::encode_struct;
use crate::math::Real;
use crate::model::ColliderModel;

type Point = Vector3<f64>;

/// The speed in m/s at which a point is led out.
const SPEED: f64 = 1.0;
/// Metres beyond which a ray meets nothing.
const FAR: f64 = 1e7;

/// The trapped points of one cloth in one collider.
#[derive(Debug, Clone, Default)]
pub struct Trapped {
    /// Each with the face that it is led to.
    pub points: Vec<(u32, u32)>,
    /// Points that have been seen behind a face.
    pub suspects: Vec<u32>,
    /// Whether the start has been looked at, where a point may be far from any face.
    has_begun: bool,
}

encode_struct!([] Trapped { points: Vec<(u32, u32)>, suspects: Vec<u32>, has_begun: bool });

impl Trapped {
    /// Whether a point is trapped.
    pub fn holds(&self, point: u32) -> bool {
        self.points.binary_search_by_key(&point, |&(point, _)| point).is_ok()
    }

    /// Leaves everything where it is.
    pub fn forget(&mut self) {
        self.points.clear();
        self.suspects.clear();
    }

    /// Suspects all points that start in the box round a closed collider.
    pub fn begin<R: Real>(
        &mut self,
        points: Range<u32>,
        collider: &ColliderModel,
        state: &ColliderState,
        step: &Step<'_, R>,
    ) {
        if std::mem::replace(&mut self.has_begun, true) || collider.outside.is_none() {
            return;
        }
        let [low, high] = state.bounds(step.time[0]);
        let is_in = |place: Point| (0..3).all(|axis| low[axis] <= place[axis] && place[axis] <= high[axis]);
        self.suspects.extend(points.filter(|&point| is_in(step.place_at_start(point))));
    }

    /// Looks at all that is trapped or suspected, where it is at the start of the step. Calls `freed` with each
    /// point that was trapped and is no more.
    pub fn look<R: Real>(
        &mut self,
        collider: &ColliderModel,
        state: &ColliderState,
        step: &Step<'_, R>,
        mut freed: impl FnMut(u32),
    ) {
        let Self { points, suspects, .. } = self;
        suspects.extend(points.iter().map(|&(point, _)| point));
        suspects.sort_unstable();
        suspects.dedup();
        let before = std::mem::take(points);
        for point in suspects.drain(..).filter(|&point| step.is_full(point)) {
            let place = step.place_at_start(point);
            if is_inside(place, collider, state, step.time[0]) {
                points.extend(nearest_face(place, collider, state, step.time[0]).map(|face| (point, face)));
            } else if before.binary_search_by_key(&point, |&(point, _)| point).is_ok() {
                freed(point);
            }
        }
    }

    /// Sees to it that every trapped point gets a step farther out, by its face's normal. Along the face it goes
    /// where the cloth takes it.
    pub fn lead_out<R: Real>(&self, collider: &ColliderModel, step: &Step<'_, R>) {
        for &(point, face) in &self.points {
            let [from, to] = step.surface(collider.skin.triangles[face as usize]);
            let normal = |corners: [Point; 3]| {
                let across = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
                across.try_normalize(0.0).unwrap_or_default()
            };
            let outward = normal(to);
            let before = normal(from).dot(&(step.place_at_start(point) - from[0]));
            let now = outward.dot(&(step.place_at_end(point) - to[0]));
            let wanted = (before + SPEED * step.h.to_f64()).min(step.thickness.to_f64());
            if now < wanted {
                step.push(point, outward * (wanted - now), outward * (wanted - now).min(wanted - before));
            }
        }
    }
}

/// Whether a place is inside a closed mesh at a time of the frame: a ray from it leaves the mesh an odd number of
/// times. A ray along an edge meets one of its two faces, by the rule that an edge belongs to one side.
fn is_inside(place: Point, collider: &ColliderModel, state: &ColliderState, time: f64) -> bool {
    let mut crossings = 0;
    let from = place - state.origin(time);
    let ray = Aabb::new(from, from + Point::x() * FAR);
    state.tree.query(&ray, |face| {
        let corners = collider.skin.triangles[face as usize].map(|point| state.point(point, time) - place);
        crossings += usize::from(crosses(corners));
    });
    crossings % 2 == 1
}

/// Whether the ray from the origin along x crosses a triangle.
fn crosses(corners: [Point; 3]) -> bool {
    let mut inside = false;
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        // In one order whichever face asks, so that both sides of an edge agree to the last bit.
        let (a, b) = if (a.y, a.z, a.x) < (b.y, b.z, b.x) { (a, b) } else { (b, a) };
        if (a.y > 0.0) != (b.y > 0.0) {
            let z = a.z + (b.z - a.z) * (-a.y / (b.y - a.y));
            inside ^= z > 0.0;
        }
    }
    let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
    // Where along the ray the plane is met; a plane along the ray is met nowhere.
    inside && normal.x != 0.0 && normal.dot(&corners[0]) / normal.x > 0.0
}

/// The face nearest to a place.
fn nearest_face(place: Point, collider: &ColliderModel, state: &ColliderState, time: f64) -> Option<u32> {
    let distance = |face: u32| {
        let corners = collider.skin.triangles[face as usize].map(|point| state.point(point, time));
        let weights = closest_on_triangle(place.into(), corners.map(Into::into));
        (0..3).map(|k| corners[k] * weights[k]).sum::<Point>() - place
    };
    let from = place - state.origin(time);
    let size = state.bounds(time)[1] - state.bounds(time)[0];
    // Boxes that grow until one meets a face that is no farther than it reaches.
    let mut reach = size.norm() / 64.0;
    loop {
        let sought = Aabb::new(from.add_scalar(-reach), from.add_scalar(reach));
        let mut best: Option<(f64, u32)> = None;
        state.tree.query(&sought, |face| {
            let found = (distance(face).norm(), face);
            if best.is_none_or(|best| found < best) {
                best = Some(found);
            }
        });
        match best {
            Some((nearest, face)) if nearest <= reach => return Some(face),
            _ if reach > 4.0 * size.norm() => return best.map(|(_, face)| face),
            _ => reach *= 2.0,
        }
    }
}
