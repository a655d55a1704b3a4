//! Force fields around the points of objects (Maya's `pointForceField`), and the attraction of an object's points among
//! themselves (`selfAttract`).
//!
//! Once per substep, from the positions at its start. A source accelerates a point at a distance d from its surface by
//! the magnitude times the falloff at d over the reach; several sources add up. Between the points of one object the
//! same law is a force, equal and opposite, so the object as a whole is not accelerated.

use nalgebra::Vector3;

use crate::contact::bvh::{Aabb, Bvh};
use crate::contact::collider::ColliderState;
use crate::input::frame::FrameInput;
use crate::input::object_fields::PointField;
use crate::input::samples::sample_at;
use crate::math::Real;
use crate::model::{ClothModel, Model};
use crate::particles::population::Population;
use crate::schedule::PassTime;
use crate::state::State;

type Point = Vector3<f64>;

/// The points of an object that are sources of a field.
struct Sources {
    field: PointField,
    points: Vec<Point>,
    /// Factors by source; empty where they are 1.
    factors: Vec<f32>,
    bvh: Bvh,
    origin: Point,
}

impl Sources {
    fn new(field: PointField, points: Vec<Point>, factors: &[f32]) -> Self {
        let origin = points.first().copied().unwrap_or_default();
        let mut bvh = Bvh::new(&points);
        bvh.refit(|at| Aabb::of(std::iter::once(points[at] - origin)));
        Self { field, points, factors: factors.to_vec(), bvh, origin }
    }

    /// The sum over all sources but `own` of the falloff along the direction away from each.
    fn push(&self, place: Point, own: Option<usize>) -> Point {
        let reach = self.field.radius + self.field.distance;
        let (away, half) = (place - self.origin, Point::repeat(reach));
        let mut sum = Point::zeros();
        self.bvh.query(&Aabb::new(away - half, away + half), |at| {
            let from = place - self.points[at as usize];
            let distance = from.norm();
            if Some(at as usize) != own && distance > 0.0 && distance < reach {
                let share = (distance - self.field.radius) / self.field.distance;
                let factor = self.factors.get(at as usize).map_or(1.0, |&factor| f64::from(factor));
                sum += from * (factor * sample_at(&self.field.falloff, share) / distance);
            }
        });
        sum
    }
}

/// Accelerates points in the fields of points for a substep that begins at a time.
pub fn apply_point_fields<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    colliders: &[ColliderState],
    frame: &FrameInput,
    PassTime { at: time, length }: PassTime,
) {
    for (placed, settings) in colliders.iter().zip(&frame.colliders) {
        let Some(field) = settings.point_field.filter(PointField::is_on) else { continue };
        let points = (0..placed.start.len() as u32).map(|point| placed.point(point, time)).collect();
        let sources = Sources::new(field, points, &[]);
        model.cloths.iter().for_each(|cloth| accelerate(cloth, state, &sources, length));
    }
    for at in 0..model.cloths.len() {
        let Some(field) = frame.cloths[at].point_field.filter(PointField::is_on) else { continue };
        let rows = model.cloths[at].points();
        let factors = state.population_of(at).map_or(&[][..], Population::field_factors);
        let sources = Sources::new(field, rows.map(|row| state.position(row).into()).collect(), factors);
        if field.self_attract != 0.0 {
            attract(&model.cloths[at], state, &sources, length);
        }
        let others = (0..model.cloths.len()).filter(|&cloth| cloth != at);
        others.for_each(|cloth| accelerate(&model.cloths[cloth], state, &sources, length));
    }
}

fn accelerate<R: Real>(cloth: &ClothModel<R>, state: &mut State<R>, sources: &Sources, length: f64) {
    if sources.field.magnitude == 0.0 {
        return;
    }
    for row in cloth.points() {
        let push = sources.push(state.position(row).into(), None);
        kick(state, row, push * (sources.field.magnitude * length));
    }
}

/// Pulls the points of one object together. The force between two is the acceleration times the harmonic mean of the
/// object's masses.
fn attract<R: Real>(cloth: &ClothModel<R>, state: &mut State<R>, sources: &Sources, length: f64) {
    let rows = cloth.points();
    let count = rows.len().max(1) as f64;
    let mean = rows.clone().map(|row| state.inverse_mass[row as usize].to_f64()).sum::<f64>() / count;
    for (own, row) in rows.enumerate() {
        // The product of both factors is the same for both sides.
        let factor = sources.factors.get(own).map_or(1.0, |&factor| f64::from(factor));
        let push = sources.push(sources.points[own], Some(own)) * factor;
        let share = state.inverse_mass[row as usize].to_f64() / mean;
        kick(state, row, push * (-sources.field.self_attract * length * share));
    }
}

/// Changes the velocity of a point that is not pinned.
fn kick<R: Real>(state: &mut State<R>, row: u32, change: Point) {
    if state.displacement[row as usize].0[3] > R::ZERO {
        let velocity = &mut state.velocity[row as usize];
        (0..3).for_each(|axis| velocity.0[axis] += R::from_f64(change[axis]));
    }
}
