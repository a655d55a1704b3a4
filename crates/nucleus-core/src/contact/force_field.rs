//! Force fields of objects: points of others within a distance of a surface are accelerated (Maya's `forceField`).
//!
//! Once per substep, from the positions at its start: an acceleration of the magnitude times the falloff at the distance, which
//! does not depend on the mass of the points.

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::contact::placed_surface::{Nearest, ObjectAt, ObjectSurfaces, PlacedSurface};
use crate::input::frame::{FieldSide, ForceField, FrameInput};
use crate::input::samples::sample_at;
use crate::math::Real;
use crate::model::{ClothModel, Model};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
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
            FieldSide::AlongNormal => surface.normal_at(&nearest),
            FieldSide::Single if side < 0.0 => return None,
            FieldSide::Single | FieldSide::Double => away,
        };
        let factor = if map.is_empty() { 1.0 } else { nearest.mean(|corner| map[corner as usize]) };
        Some(direction * (self.magnitude * factor * sample_at(&self.falloff, distance / self.distance)))
    }
}

/// Accelerates points in the fields of other objects for a substep that begins at a time.
pub fn apply_force_fields<R: Real>(
    (model, colliders): (&Model<R>, &[ColliderState]),
    state: &mut State<R>,
    surfaces: &mut ObjectSurfaces,
    frame: &FrameInput,
    PassTime { at: time, length }: PassTime,
    pool: &ThreadPool,
) {
    for (index, (collider, placed)) in model.colliders.iter().zip(colliders).enumerate() {
        let Some(field) = frame.colliders[index].field.filter(ForceField::is_on) else { continue };
        let at = ObjectAt::Collider(index);
        let place = |point| placed.point(point, time);
        surfaces.place(at, || collider.boundary.triangles.clone(), place, pool);
        let Some(surface) = surface_of(surfaces, at, &field) else { continue };
        let source = Source { field, surface, map: &collider.field_map };
        model.cloths.iter().for_each(|cloth| source.accelerate(cloth, state, length, pool));
    }
    for (index, cloth) in model.cloths.iter().enumerate() {
        let Some(field) = frame.cloths[index].field.filter(ForceField::is_on) else { continue };
        let is_alone = model.cloths.len() == 1;
        if is_alone || cloth.boundary.triangles.is_empty() {
            continue;
        }
        let at = ObjectAt::Cloth(index);
        // Corners are counted from the cloth's first row, as its map is.
        let first = cloth.points().start;
        let place = |corner: u32| Point::from(state.position(first + corner));
        surfaces.place(at, || cloth.corner_triangles(), place, pool);
        let Some(surface) = surface_of(surfaces, at, &field) else { continue };
        let source = Source { field, surface, map: &cloth.field_map };
        let others = (0..model.cloths.len()).filter(|&other| other != index);
        others.for_each(|other| source.accelerate(&model.cloths[other], state, length, pool));
    }
}

/// The placed surface of an object, with the normals that its field needs: smooth, so that the field does not jump where
/// another triangle becomes the nearest.
fn surface_of<'a>(
    surfaces: &'a mut ObjectSurfaces,
    at: ObjectAt,
    field: &ForceField,
) -> Option<&'a PlacedSurface> {
    let surface = surfaces.get_mut(at)?;
    if field.side == FieldSide::AlongNormal {
        surface.set_normals();
    }
    Some(surface)
}

/// The field of one object at its present position.
struct Source<'a> {
    field: ForceField,
    surface: &'a PlacedSurface,
    /// Factors on the magnitude by corner; empty where they are 1.
    map: &'a [f64],
}

impl Source<'_> {
    /// Accelerates the free points of a cloth for a substep of `length` seconds.
    fn accelerate<R: Real>(
        &self,
        cloth: &ClothModel<R>,
        state: &mut State<R>,
        length: f64,
        pool: &ThreadPool,
    ) {
        kick_points(cloth, state, pool, |_, place| {
            Some(self.field.acceleration(self.surface, self.map, place)? * length)
        });
    }
}

/// Adds to the velocity of each free point of a cloth, in m/s, by its row and its position in metres.
pub fn kick_points<R: Real>(
    cloth: &ClothModel<R>,
    state: &mut State<R>,
    pool: &ThreadPool,
    kick: impl Fn(u32, Point) -> Option<Point> + Sync,
) {
    let State { anchor, displacement, velocity, .. } = state;
    let velocity = DisjointSlice::new(velocity);
    pool.parallel_for(cloth.blocks.len(), |block| {
        let rows = cloth.blocks.range(block);
        // SAFETY: blocks do not overlap.
        #[allow(unsafe_code)]
        let run = unsafe { velocity.run(rows.clone()) };
        for (row, velocity) in rows.zip(run) {
            let moved = displacement[row as usize].0;
            if moved[3] <= R::ZERO {
                continue;
            }
            let place = anchor[row as usize];
            let place = Point::from(std::array::from_fn(|axis| place[axis] + moved[axis].to_f64()));
            if let Some(change) = kick(row, place) {
                (0..3).for_each(|axis| velocity.0[axis] += R::from_f64(change[axis]));
            }
        }
    });
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

    #[test]
    fn a_field_along_normals_of_a_smooth_surface_is_smooth() {
        let (lines, columns) = (12u32, 16u32);
        // A band of a ball of 1 m, whose faces are flat.
        let place = |corner: u32| {
            let (line, column) = (f64::from(corner / columns), f64::from(corner % columns));
            let (height, turn) = (0.4 + line * 0.2, column * std::f64::consts::TAU / f64::from(columns));
            Point::new(height.sin() * turn.cos(), height.cos(), height.sin() * turn.sin())
        };
        let quads = (0..lines - 1).flat_map(|line| (0..columns).map(move |column| (line, column)));
        let corners = quads.flat_map(|(line, column)| {
            let next = (column + 1) % columns;
            let [a, b] = [line * columns + column, line * columns + next];
            [[a, b + columns, a + columns], [a, b, b + columns]]
        });
        let mut ball = PlacedSurface::new(corners.collect(), place);
        ball.set_normals();
        let field = ForceField {
            side: FieldSide::AlongNormal,
            magnitude: 1.0,
            distance: 1.0,
            falloff: [1.0; ForceField::SAMPLES],
        };
        for k in 0..200 {
            let turn = f64::from(k) * 0.031;
            let away = Point::new(turn.cos(), 0.0, turn.sin());
            let acceleration = field.acceleration(&ball, &[], away * 1.2).expect("it is in reach");
            assert!(
                acceleration.angle(&away).to_degrees() < 3.0,
                "{}",
                acceleration.angle(&away).to_degrees()
            );
        }
    }
}
