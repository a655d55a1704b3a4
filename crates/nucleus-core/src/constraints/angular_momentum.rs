//! Angular momentum: what holds a cloth together has no torque, but sweeps over it do.
//!
//! A projection moves two points along the line between them, where they are at that moment. The velocities of the step are
//! differences to its start s, so their angular momentum is Σ m s × x / h, and a sweep changes it. Links that turn within
//! the step lose it, in proportion to the step. Links under tension, corrected one after the other, add to it, always in the
//! same sense: each correction is a lever of the next. A cushion under pressure began to spin by itself.
//!
//! After the sweeps of a time step the cloth is turned about its centre of mass, by the small angle that takes the torque
//! away. Distances within the cloth stay as they are.

use nalgebra::{Matrix3, Vector3};

use crate::input::frame::{FrameInput, Pressure};
use crate::math::Real;
use crate::model::ClothModel;
use crate::state::State;

/// Share of the moment of inertia that is added about every axis: points in one line have none about it.
const LEAST_INERTIA: f64 = 1e-9;

/// Whether the sweeps of a cloth may have to lose their torque in a frame: where it can touch nothing, or is under pressure,
/// whatever it touches. Without pressure the torque is small, and cloth that lies on the ground would creep by the rounding of
/// what takes it away.
pub fn may_keep_angular_momentum(frame: &FrameInput, cloth: usize) -> bool {
    frame.cloths[cloth].pressure != Pressure::Off || !can_touch(frame, cloth)
}

/// Whether they do: where the cloth moves freely (`is_free`), or its pressure is that of closed chambers. The gas that an open
/// chamber loses takes momentum with it.
pub fn keeps_angular_momentum<R: Real>(cloth: &ClothModel<R>, pressure: &Pressure, is_free: bool) -> bool {
    let has_links = cloth.stretch.len() > 0; // particles have none
    has_links
        && match pressure {
            Pressure::Off => is_free,
            pressure => cloth.pressure.is_closed(pressure),
        }
}

/// Whether a cloth collides with anything, near or far.
fn can_touch(frame: &FrameInput, index: usize) -> bool {
    let cloth = &frame.cloths[index];
    let has_others = frame.plane.is_some()
        || frame.cloths.len() > 1
        || frame.colliders.iter().any(|collider| collider.collide);
    cloth.self_collision.on || cloth.collide && has_others
}

/// Takes the torque of the sweeps of a time step of `h` seconds, and of the pressure before them, from a cloth that is not
/// pinned.
pub fn keep_angular_momentum<R: Real>(cloth: &ClothModel<R>, state: &mut State<R>, h: f64) {
    if cloth.parts.is_empty() {
        turn_back(cloth.points(), state, h);
    }
    cloth.parts.iter().for_each(|part| turn_back(part.iter().copied(), state, h));
}

fn turn_back<R: Real>(rows: impl Iterator<Item = u32> + Clone, state: &mut State<R>, h: f64) {
    let Some(first) = rows.clone().next() else { return };
    let origin = Vector3::from(state.anchor[first as usize]);
    let Some(moments) = Moments::of(rows.clone(), state, origin, h) else { return };
    let centre = moments.sum / moments.mass;
    let Some(angle) = moments.angle() else { return };
    for row in rows.map(|row| row as usize) {
        let moved = &mut state.displacement[row];
        let anchor = Vector3::from(state.anchor[row]) - origin;
        let from_centre = anchor + Vector3::from(moved.xyz().map(R::to_f64)) - centre;
        let back = angle.cross(&from_centre);
        for axis in 0..3 {
            let before = moved.0[axis];
            moved.0[axis] = before - R::from_f64(back[axis]);
            // What is less than the last bit of a displacement is still some of a velocity.
            let rest = back[axis] - (before.to_f64() - moved.0[axis].to_f64());
            state.velocity[row].0[axis] -= R::from_f64(rest / h);
        }
    }
}

/// Moments of a cloth, relative to an origin.
struct Moments {
    /// In kg.
    mass: f64,
    /// Σ m x and Σ m s, in kg m: now, and at the start of the time step.
    sum: Vector3<f64>,
    start_sum: Vector3<f64>,
    /// Σ m x sᵀ, in kg m².
    square: Matrix3<f64>,
    /// Σ m (x - p) and Σ m s × (x - p), with the positions p before the sweeps.
    push: Vector3<f64>,
    torque: Vector3<f64>,
}

impl Moments {
    /// Those of some rows; `None` where one is pinned, which takes any torque.
    fn of<R: Real>(
        rows: impl Iterator<Item = u32>,
        state: &State<R>,
        origin: Vector3<f64>,
        h: f64,
    ) -> Option<Self> {
        let zero = Vector3::zeros();
        let square = Matrix3::zeros();
        let mut all = Self { mass: 0.0, sum: zero, start_sum: zero, square, push: zero, torque: zero };
        for row in rows.map(|row| row as usize) {
            let moved = state.displacement[row];
            let inverse_mass = moved.0[3].to_f64();
            if inverse_mass <= 0.0 {
                return None;
            }
            let mass = 1.0 / inverse_mass;
            let anchor = Vector3::from(state.anchor[row]) - origin;
            let of = |row: [R; 3]| Vector3::from(row.map(R::to_f64));
            let (now, predicted) = (of(moved.xyz()), of(state.predicted[row].xyz()));
            let start = anchor + predicted - of(state.velocity[row].xyz()) * h;
            let (place, push) = (anchor + now, (now - predicted) * mass);
            all.mass += mass;
            all.sum += place * mass;
            all.start_sum += start * mass;
            all.square += place * start.transpose() * mass;
            all.push += push;
            all.torque += start.cross(&push);
        }
        Some(all)
    }

    /// The angle a, in radians about each axis, by which the sweeps have turned the cloth as a whole: the turn a × (x - c)
    /// about the centre c has the torque Σ m s × (a × (x - c)).
    fn angle(&self) -> Option<Vector3<f64>> {
        let centre = self.sum / self.mass;
        let square = self.square - centre * self.start_sum.transpose();
        let size = square.trace() * (1.0 + LEAST_INERTIA);
        let torque = self.torque - centre.cross(&self.push);
        let inertia = Matrix3::identity() * size - square;
        inertia
            .try_inverse()
            .map(|inverse| inverse * torque)
            .filter(|angle| angle.iter().all(|x| x.is_finite()))
    }
}
