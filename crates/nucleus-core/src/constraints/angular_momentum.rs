//! Angular momentum: what holds a cloth together has no torque, but sweeps over it do.
//!
//! A projection moves two points along the line between them, where they are at that moment. The velocities of the step are
//! differences to its start s, so their angular momentum is Σ m s × x / h, and a sweep changes it. Links that turn within
//! the step lose it, in proportion to the step. Links under tension, corrected one after the other, add to it, always in the
//! same sense: each correction is a lever of the next. A cushion under pressure began to spin by itself.
//!
//! After the sweeps of a time step the cloth is turned about its centre of mass, by the small angle that takes the torque
//! away. Distances within the cloth stay as they are.
//!
//! `damp` has a torque too, because it acts across links as well as along them: a cushion that is blown up would turn, and
//! a spinning sheet would stop in empty space. The velocities of the same cloths are turned in the same way. Elsewhere damping
//! stills the rotation that contact and links leave.

use nalgebra::{Matrix3, Vector3};

use crate::input::frame::Pressure;
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::state::State;

/// Share of the moment of inertia that is added about every axis: points in one line have none about it.
const LEAST_INERTIA: f64 = 1e-9;

/// Whether the sweeps of a cloth have to lose their torque in a frame: where the cloth moves freely (`is_free`), or its pressure
/// is that of closed chambers. The gas that an open chamber loses takes momentum with it, and cloth that lies on the ground
/// would creep by the rounding of what takes the torque away.
pub fn keeps_angular_momentum<R: Real>(cloth: &ClothModel<R>, pressure: &Pressure, is_free: bool) -> bool {
    let has_links = cloth.stretch.len() > 0; // particles have none
    has_links
        && match pressure {
            Pressure::Off => is_free,
            pressure => cloth.pressure.is_closed(pressure),
        }
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
    let start_and_push = |row: usize, anchor: Vector3<f64>| {
        let [now, predicted, velocity] =
            [state.displacement[row], state.predicted[row], state.velocity[row]].map(vector);
        [anchor + predicted - velocity * h, now - predicted]
    };
    let Some(moments) = Moments::of(rows.clone(), state, start_and_push) else { return };
    let Some(angle) = moments.turn(moments.torque()) else { return };
    for row in rows.map(|row| row as usize) {
        let back = angle.cross(&moments.offset(state, row));
        let moved = &mut state.displacement[row];
        for axis in 0..3 {
            let before = moved.0[axis];
            moved.0[axis] = before - R::from_f64(back[axis]);
            // What is less than the last bit of a displacement is still some of a velocity.
            let rest = back[axis] - (before.to_f64() - moved.0[axis].to_f64());
            state.velocity[row].0[axis] -= R::from_f64(rest / h);
        }
    }
}

/// Calls `work`, which changes the velocities of a cloth by what acts within it, and gives each part that is not pinned the
/// angular momentum that it had before.
pub fn without_torque<R: Real>(
    cloth: &ClothModel<R>,
    state: &mut State<R>,
    work: impl FnOnce(&mut State<R>),
) {
    let mut spins = std::mem::take(&mut state.spins);
    spins.clear();
    let mut remember = |moments: Option<Moments>| spins.push(moments.map(|moments| moments.torque()));
    if cloth.parts.is_empty() {
        remember(Moments::of_velocities(cloth.points(), state));
    }
    cloth.parts.iter().for_each(|part| remember(Moments::of_velocities(part.iter().copied(), state)));
    work(state);
    if cloth.parts.is_empty() {
        spin_as_before(cloth.points(), state, spins[0]);
    }
    let parts = cloth.parts.iter().zip(&spins);
    parts.for_each(|(part, &spin)| spin_as_before(part.iter().copied(), state, spin));
    state.spins = spins;
}

fn spin_as_before<R: Real>(
    rows: impl Iterator<Item = u32> + Clone,
    state: &mut State<R>,
    before: Option<Vector3<f64>>,
) {
    let (Some(before), Some(moments)) = (before, Moments::of_velocities(rows.clone(), state)) else { return };
    let Some(turn) = moments.turn(before - moments.torque()) else { return };
    for row in rows.map(|row| row as usize) {
        let added = turn.cross(&moments.offset(state, row));
        (0..3).for_each(|axis| state.velocity[row].0[axis] += R::from_f64(added[axis]));
    }
}

/// Moments of a cloth, relative to an origin. A point at x has a lever s and a push p.
struct Moments {
    origin: Vector3<f64>,
    /// In kg.
    mass: f64,
    /// Σ m x and Σ m s, in kg m.
    sum: Vector3<f64>,
    lever_sum: Vector3<f64>,
    /// Σ m x sᵀ, in kg m².
    square: Matrix3<f64>,
    /// Σ m p and Σ m s × p.
    push: Vector3<f64>,
    torque: Vector3<f64>,
}

impl Moments {
    /// Those of some rows, with the lever and the push of each, given its anchor relative to the origin; `None` where one is
    /// pinned, which takes any torque.
    fn of<R: Real>(
        mut rows: impl Iterator<Item = u32> + Clone,
        state: &State<R>,
        lever_and_push: impl Fn(usize, Vector3<f64>) -> [Vector3<f64>; 2],
    ) -> Option<Self> {
        let (zero, square) = (Vector3::zeros(), Matrix3::zeros());
        let origin = Vector3::from(state.anchor[rows.clone().next()? as usize]);
        let mut all =
            Self { origin, mass: 0.0, sum: zero, lever_sum: zero, square, push: zero, torque: zero };
        let is_free = rows.all(|row| {
            let row = row as usize;
            let inverse_mass = state.displacement[row].0[3].to_f64();
            let mass = 1.0 / inverse_mass;
            let anchor = all.anchor(state, row);
            let place = anchor + vector(state.displacement[row]);
            let [lever, push] = lever_and_push(row, anchor);
            all.mass += mass;
            all.sum += place * mass;
            all.lever_sum += lever * mass;
            all.square += place * lever.transpose() * mass;
            all.push += push * mass;
            all.torque += lever.cross(&push) * mass;
            inverse_mass > 0.0
        });
        is_free.then_some(all)
    }

    /// The lever of a point is its position, and the push its velocity.
    fn of_velocities<R: Real>(rows: impl Iterator<Item = u32> + Clone, state: &State<R>) -> Option<Self> {
        let place_and_velocity = |row: usize, anchor: Vector3<f64>| {
            [anchor + vector(state.displacement[row]), vector(state.velocity[row])]
        };
        Self::of(rows, state, place_and_velocity)
    }

    /// The anchor of a row, relative to the origin.
    fn anchor<R: Real>(&self, state: &State<R>, row: usize) -> Vector3<f64> {
        Vector3::from(state.anchor[row]) - self.origin
    }

    /// The position of a row, relative to the centre of mass.
    fn offset<R: Real>(&self, state: &State<R>, row: usize) -> Vector3<f64> {
        self.anchor(state, row) + vector(state.displacement[row]) - self.sum / self.mass
    }

    /// Σ m s × p about the centre of mass.
    fn torque(&self) -> Vector3<f64> {
        self.torque - (self.sum / self.mass).cross(&self.push)
    }

    /// The turn a about each axis whose push a × (x - c), with the centre of mass c, has this torque.
    fn turn(&self, torque: Vector3<f64>) -> Option<Vector3<f64>> {
        let centre = self.sum / self.mass;
        let square = self.square - centre * self.lever_sum.transpose();
        let size = square.trace() * (1.0 + LEAST_INERTIA);
        let inertia = Matrix3::identity() * size - square;
        let turn = inertia.try_inverse().map(|inverse| inverse * torque);
        turn.filter(|turn| turn.iter().all(|x| x.is_finite()))
    }
}

fn vector<R: Real>(row: Row4<R>) -> Vector3<f64> {
    Vector3::from(row.xyz().map(R::to_f64))
}
