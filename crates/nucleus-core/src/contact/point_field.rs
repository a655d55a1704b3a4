//! Force fields around the points of objects (Maya's `pointForceField`), and the attraction of an object's points among
//! themselves (`selfAttract`).
//!
//! Once per substep, from the positions at its start. A source accelerates a point at a distance d from its surface by
//! the magnitude times the falloff at d over the reach; several sources add up. Between the points of one object the
//! same law is a force, equal and opposite, so the object as a whole is not accelerated.

use nalgebra::Vector3;

use crate::contact::bvh::{Aabb, Bvh};
use crate::contact::collider::ColliderState;
use crate::contact::force_field::kick_points;
use crate::input::frame::FrameInput;
use crate::input::object_fields::PointField;
use crate::input::samples::sample_at;
use crate::math::Real;
use crate::model::{ClothModel, Model};
use crate::parallel::thread_pool::ThreadPool;
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
    /// The boxes of `bvh` are those of the points.
    fn new(
        field: PointField,
        points: Vec<Point>,
        factors: Vec<f32>,
        mut bvh: Bvh,
        pool: &ThreadPool,
    ) -> Self {
        let origin = points.first().copied().unwrap_or_default();
        bvh.refit_in_tasks(|at| Aabb::of(std::iter::once(points[at] - origin)), pool);
        Self { field, points, factors, bvh, origin }
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
    (model, colliders): (&Model<R>, &[ColliderState]),
    state: &mut State<R>,
    frame: &FrameInput,
    PassTime { at: time, length }: PassTime,
    pool: &ThreadPool,
) {
    for (placed, settings) in colliders.iter().zip(&frame.colliders) {
        let Some(field) = settings.point_field.filter(PointField::is_on) else { continue };
        let points: Vec<Point> =
            (0..placed.start.len() as u32).map(|point| placed.point(point, time)).collect();
        let bvh = Bvh::new(&points);
        let sources = Sources::new(field, points, Vec::new(), bvh, pool);
        model.cloths.iter().for_each(|cloth| accelerate(cloth, state, &sources, length, pool));
    }
    for (at, cloth) in model.cloths.iter().enumerate() {
        let Some(field) = frame.cloths[at].point_field.filter(PointField::is_on) else { continue };
        let factors = state.population_of(at).map_or_else(Vec::new, |own| own.field_factors().to_vec());
        let points: Vec<Point> = cloth.points().map(|row| state.position(row).into()).collect();
        // The points of a mesh are in the order of a curve through it, and stay neighbours; particles mix.
        let bvh = if cloth.has_faces { Bvh::in_order(points.len()) } else { Bvh::new(&points) };
        let sources = Sources::new(field, points, factors, bvh, pool);
        if field.self_attract != 0.0 {
            attract(cloth, state, &sources, length, pool);
        }
        let others = (0..model.cloths.len()).filter(|&other| other != at);
        others.for_each(|other| accelerate(&model.cloths[other], state, &sources, length, pool));
    }
}

fn accelerate<R: Real>(
    cloth: &ClothModel<R>,
    state: &mut State<R>,
    sources: &Sources,
    length: f64,
    pool: &ThreadPool,
) {
    if sources.field.magnitude != 0.0 {
        kick_points(cloth, state, pool, |_, place| {
            Some(sources.push(place, None) * (sources.field.magnitude * length))
        });
    }
}

/// Pulls the points of one object together. The force between two is the acceleration times the harmonic mean of the
/// object's masses.
fn attract<R: Real>(
    cloth: &ClothModel<R>,
    state: &mut State<R>,
    sources: &Sources,
    length: f64,
    pool: &ThreadPool,
) {
    let rows = cloth.points();
    let count = rows.len().max(1) as f64;
    let inverse_mass = std::mem::take(&mut state.inverse_mass);
    let mean = rows.clone().map(|row| inverse_mass[row as usize].to_f64()).sum::<f64>() / count;
    kick_points(cloth, state, pool, |row, place| {
        let own = (row - rows.start) as usize;
        // The product of both factors is the same for both sides.
        let factor = sources.factors.get(own).map_or(1.0, |&factor| f64::from(factor));
        let push = sources.push(place, Some(own)) * factor;
        let share = inverse_mass[row as usize].to_f64() / mean;
        Some(push * (-sources.field.self_attract * length * share))
    });
    state.inverse_mass = inverse_mass;
}
