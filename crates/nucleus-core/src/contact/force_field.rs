//! Force fields of objects: points of others within a distance of a surface are accelerated (Maya's `forceField`).
//!
//! Once per substep, from the positions at its start: an acceleration of the magnitude times the falloff at the distance, which
//! does not depend on the mass of the points.

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::contact::placed_surface::{Nearest, PlacedSurface};
use crate::input::frame::{FieldSide, ForceField, FrameInput};
use crate::input::samples::sample_at;
use crate::math::Real;
use crate::model::{ClothModel, Model};
use crate::schedule::PassTime;
use crate::state::State;

type Point = Vector3<f64>;

impl ForceField {
    /// The acceleration of a point in m/s². `map` has a factor on the magnitude at each corner; it is 1 where empty.
    fn acceleration(&self, surface: &PlacedSurface, map: &[f64], place: Point) -> Option<Point> {
        let nearest = surface.nearest(place, self.distance)?;
        let Nearest { distance, point, normal, .. } = nearest;
        let side = normal.dot(&(place - point));
        let away = (place - point).try_normalize(0.0).unwrap_or(normal);
        let direction = match self.side {
            FieldSide::AlongNormal => normal,
            FieldSide::Single if side < 0.0 => return None,
            FieldSide::Single | FieldSide::Double => away,
        };
        let factor = if map.is_empty() { 1.0 } else { nearest.mean(|corner| map[corner as usize]) };
        Some(direction * (self.magnitude * factor * sample_at(&self.falloff, distance / self.distance)))
    }
}

/// Accelerates points in the fields of other objects for a substep that begins at a time.
pub fn apply_force_fields<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    colliders: &[ColliderState],
    frame: &FrameInput,
    PassTime { at: time, length }: PassTime,
) {
    for at in 0..model.colliders.len() {
        let Some(field) = frame.colliders[at].field.filter(ForceField::is_on) else { continue };
        let (placed, collider) = (&colliders[at], &model.colliders[at]);
        let triangles = collider.boundary.triangles.clone();
        let surface = PlacedSurface::new(triangles, |point| placed.point(point, time));
        let source = Source { field, surface, map: &collider.field_map };
        model.cloths.iter().for_each(|cloth| source.accelerate(cloth, state, length));
    }
    for at in 0..model.cloths.len() {
        let Some(field) = frame.cloths[at].field.filter(ForceField::is_on) else { continue };
        let cloth = &model.cloths[at];
        let first = cloth.points().start;
        // Corners are counted from the cloth's first row, as its map is.
        let triangles = cloth.boundary.triangles.iter().map(|face| face.map(|row| row - first)).collect();
        let surface = PlacedSurface::new(triangles, |corner| state.position(first + corner).into());
        let source = Source { field, surface, map: &cloth.field_map };
        let others = (0..model.cloths.len()).filter(|&cloth| cloth != at);
        others.for_each(|cloth| source.accelerate(&model.cloths[cloth], state, length));
    }
}

/// The field of one object at its present position.
struct Source<'a> {
    field: ForceField,
    surface: PlacedSurface,
    /// Factors on the magnitude by corner; empty where they are 1.
    map: &'a [f64],
}

impl Source<'_> {
    /// Accelerates the free points of a cloth for a substep of `length` seconds.
    fn accelerate<R: Real>(&self, cloth: &ClothModel<R>, state: &mut State<R>, length: f64) {
        for row in cloth.points() {
            if state.displacement[row as usize].0[3] <= R::ZERO {
                continue;
            }
            let place = Point::from(state.position(row));
            let Some(acceleration) = self.field.acceleration(&self.surface, self.map, place) else {
                continue;
            };
            let velocity = &mut state.velocity[row as usize];
            (0..3).for_each(|axis| velocity.0[axis] += R::from_f64(acceleration[axis] * length));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_acts_on_its_sides_and_falls_off_with_the_distance() {
        let corners = [Point::new(-9.0, 0.0, 9.0), Point::new(9.0, 0.0, 9.0), Point::new(0.0, 0.0, -9.0)];
        let floor = PlacedSurface::new(vec![[0, 1, 2]], |corner| corners[corner as usize]);
        let falloff = std::array::from_fn(|k| 1.0 - k as f64 / (ForceField::SAMPLES - 1) as f64);
        let field = |side| ForceField { side, magnitude: 4.0, distance: 2.0, falloff };
        let at = |side, y: f64| {
            field(side)
                .acceleration(&floor, &[], Point::new(0.1, y, 0.2))
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
        // At the middle of an edge a map has the mean of its ends.
        let mapped =
            field(FieldSide::Double).acceleration(&floor, &[0.2, 0.6, 9.0], Point::new(0.0, 1.0, 9.0));
        assert!((mapped.map_or(0.0, |acceleration| acceleration.y) - 2.0 * 0.4).abs() < 1e-12);
    }
}
