//! Force fields of objects: points of others within a distance of a surface are accelerated (Maya's `forceField`).
//!
//! Once per substep, from the positions at its start: an acceleration of the magnitude times the falloff at the distance, which
//! does not depend on the mass of the points.

use nalgebra::Vector3;

use crate::contact::bvh::{Aabb, Bvh};
use crate::contact::collider::ColliderState;
use crate::contact::narrow_phase::closest_on_triangle;
use crate::input::frame::{FieldSide, ForceField, FrameInput};
use crate::math::Real;
use crate::model::{ClothModel, Model};
use crate::state::State;

type Point = Vector3<f64>;

/// A triangulated surface at its present position, for queries of its nearest point.
pub struct PlacedSurface {
    /// In metres.
    triangles: Vec<[Point; 3]>,
    bvh: Bvh,
    /// The origin of the boxes.
    origin: Point,
}

/// The nearest point of a surface.
#[derive(Debug, Clone, Copy)]
pub struct Nearest {
    /// In metres.
    pub distance: f64,
    /// The point, in metres.
    pub point: Point,
    /// Normal of its triangle, of unit length.
    pub normal: Point,
}

impl PlacedSurface {
    /// A surface of these triangles.
    pub fn new(triangles: Vec<[Point; 3]>) -> Self {
        let centres: Vec<Point> = triangles.iter().map(|[a, b, c]| (a + b + c) / 3.0).collect();
        let origin = centres.first().copied().unwrap_or_default();
        let mut bvh = Bvh::new(&centres);
        bvh.refit(|at| Aabb::of(triangles[at].into_iter().map(|corner| corner - origin)));
        Self { triangles, bvh, origin }
    }

    /// The nearest point within a radius in metres; of two as near, that of the first triangle.
    pub fn nearest(&self, place: Point, radius: f64) -> Option<Nearest> {
        let away = place - self.origin;
        let half = Point::repeat(radius);
        let mut best: Option<(f64, u32, Point)> = None;
        self.bvh.query(&Aabb::new(away - half, away + half), |at| {
            let corners = self.triangles[at as usize];
            let weights = closest_on_triangle(place.into(), corners.map(Into::into));
            let point: Point = corners.iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
            let found = ((place - point).norm(), at);
            if best.is_none_or(|(distance, other, _)| found < (distance, other)) {
                best = Some((found.0, found.1, point));
            }
        });
        let (distance, at, point) = best.filter(|&(distance, _, _)| distance <= radius)?;
        let [a, b, c] = self.triangles[at as usize];
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        Some(Nearest { distance, point, normal })
    }
}

impl ForceField {
    /// The acceleration of a point in m/s².
    fn acceleration(&self, surface: &PlacedSurface, place: Point) -> Option<Point> {
        let Nearest { distance, point, normal } = surface.nearest(place, self.distance)?;
        let side = normal.dot(&(place - point));
        let away = (place - point).try_normalize(0.0).unwrap_or(normal);
        let direction = match self.side {
            FieldSide::AlongNormal => normal,
            FieldSide::Single if side < 0.0 => return None,
            FieldSide::Single | FieldSide::Double => away,
        };
        Some(direction * (self.magnitude * self.falloff_at(distance / self.distance)))
    }

    /// The falloff at a share of the distance, between samples in straight lines.
    fn falloff_at(&self, share: f64) -> f64 {
        let last = self.falloff.len() - 1;
        let at = share.clamp(0.0, 1.0) * last as f64;
        let low = (at as usize).min(last - 1);
        let [a, b] = [self.falloff[low], self.falloff[low + 1]];
        a + (b - a) * (at - low as f64)
    }
}

/// Accelerates points in the fields of other objects for a substep of `length` seconds that begins at `time` as a share
/// of the frame.
pub fn apply_force_fields<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    colliders: &[ColliderState],
    frame: &FrameInput,
    [time, length]: [f64; 2],
) {
    for at in 0..model.colliders.len() {
        let Some(field) = frame.colliders[at].field.filter(ForceField::is_on) else { continue };
        let collider = &colliders[at];
        let faces = model.colliders[at].boundary.triangles.iter();
        let triangles = faces.map(|face| face.map(|point| collider.point(point, time))).collect();
        let surface = PlacedSurface::new(triangles);
        model.cloths.iter().for_each(|cloth| accelerate(cloth, state, &field, &surface, length));
    }
    for at in 0..model.cloths.len() {
        let Some(field) = frame.cloths[at].field.filter(ForceField::is_on) else { continue };
        let place = |row: u32| Point::from(state.position(row));
        let faces = model.cloths[at].boundary.triangles.iter();
        let surface = PlacedSurface::new(faces.map(|face| face.map(place)).collect());
        let others = (0..model.cloths.len()).filter(|&cloth| cloth != at);
        others.for_each(|cloth| accelerate(&model.cloths[cloth], state, &field, &surface, length));
    }
}

fn accelerate<R: Real>(
    cloth: &ClothModel<R>,
    state: &mut State<R>,
    field: &ForceField,
    surface: &PlacedSurface,
    length: f64,
) {
    for row in cloth.points() {
        if state.displacement[row as usize].0[3] <= R::ZERO {
            continue;
        }
        let place = Point::from(state.position(row));
        let Some(acceleration) = field.acceleration(surface, place) else { continue };
        let velocity = &mut state.velocity[row as usize];
        (0..3).for_each(|axis| velocity.0[axis] += R::from_f64(acceleration[axis] * length));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_acts_on_its_sides_and_falls_off_with_the_distance() {
        let floor = PlacedSurface::new(vec![[
            Point::new(-9.0, 0.0, 9.0),
            Point::new(9.0, 0.0, 9.0),
            Point::new(0.0, 0.0, -9.0),
        ]]);
        let falloff = std::array::from_fn(|k| 1.0 - k as f64 / (ForceField::SAMPLES - 1) as f64);
        let field = |side| ForceField { side, magnitude: 4.0, distance: 2.0, falloff };
        let at = |side, y: f64| {
            field(side)
                .acceleration(&floor, Point::new(0.1, y, 0.2))
                .map_or(0.0, |acceleration| acceleration.y)
        };
        for (side, above, below) in [
            (FieldSide::AlongNormal, 3.0, 3.0),
            (FieldSide::Single, 3.0, 0.0),
            (FieldSide::Double, 3.0, -3.0),
        ] {
            assert!((at(side, 0.5) - above).abs() < 1e-12 && (at(side, -0.5) - below).abs() < 1e-12);
        }
        assert_eq!(at(FieldSide::Double, 2.5), 0.0, "beyond its distance there is none");
    }
}
