//! Force fields: gravity, uniform, radial, newton, drag, air, turbulence, vortex and volume axis.
//!
//! As in Nucleus, fields are evaluated once per frame, with the positions and velocities at its start (§3.1); the option
//! `per substep` of this solver evaluates them in each substep. The result is an acceleration per point, which every
//! time step adds to the velocity. Resistance is implicit over the interval in which it is constant, so that it never
//! reverses a motion.
//!
//! | You want to know… | Read |
//! |---|---|
//! | the range and falloff of a field | [`reach`] |
//! | a field | the file of its name |

mod air;
mod drag;
mod gravity;
mod newton;
mod noise;
mod point;
mod radial;
pub mod reach;
mod turbulence;
mod uniform;
mod volume_axis;
mod vortex;

use std::ops::Range;

use nalgebra::Vector3;

use crate::fields::point::PointInField;
use crate::input::fields::{Field, FieldKind};
use crate::input::frame::FrameInput;
use crate::math::{Real, Row4};
use crate::model::{ClothModel, Model};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// Evaluates the fields at all points, for `interval` seconds.
pub fn update_fields<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    frame: &FrameInput,
    interval: f64,
    pool: &ThreadPool,
) {
    state.field.clear();
    if frame.fields.is_empty() {
        return;
    }
    state.field.resize(state.velocity.len(), Row4::ZERO);
    for (index, cloth) in model.cloths.iter().enumerate() {
        update_fields_of((index, cloth), cloth.points(), state, frame, interval, pool);
    }
}

/// Evaluates the fields at some points of a cloth.
pub fn update_fields_of<R: Real>(
    (index, cloth): (usize, &ClothModel<R>),
    rows: Range<u32>,
    state: &mut State<R>,
    frame: &FrameInput,
    interval: f64,
    pool: &ThreadPool,
) {
    let felt: Vec<(&Field, f64)> =
        frame.fields.iter().filter_map(|field| Some((field, field.share_of(index)?))).collect();
    if felt.is_empty() || state.field.is_empty() {
        return;
    }
    let mut column = std::mem::take(&mut state.field);
    let accelerations = DisjointSlice::new(&mut column);
    let points = &*state;
    pool.parallel_for((rows.len() as u32).div_ceil(POINTS_PER_TASK) as usize, |task| {
        let from = rows.start + task as u32 * POINTS_PER_TASK;
        let to = rows.end.min(from + POINTS_PER_TASK);
        // SAFETY: tasks share no row.
        #[allow(unsafe_code)]
        let run = unsafe { accelerations.run(from..to) };
        for (row, acceleration) in (from..to).zip(run) {
            let inverse_mass = cloth.inverse_field_mass(row, points.displacement[row as usize].0[3].to_f64());
            let position = Vector3::from(points.position(row));
            let velocity = Vector3::from(points.velocity[row as usize].xyz().map(R::to_f64));
            let sum: Vector3<f64> = felt
                .iter()
                .map(|(field, share)| field.acceleration(position, velocity, inverse_mass, interval) * *share)
                .sum();
            *acceleration = Row4::new(sum.into(), R::ZERO);
        }
    });
    state.field = column;
}

/// Points per task.
const POINTS_PER_TASK: u32 = 1024;

impl Field {
    /// The factor on the field for a cloth; `None` where it does not act on it.
    fn share_of(&self, cloth: usize) -> Option<f64> {
        self.targets.iter().find(|(target, _)| target.index() == cloth).map(|&(_, share)| share)
    }

    /// The acceleration of a point in m/s²; none where the field does not reach.
    fn acceleration(
        &self,
        position: Vector3<f64>,
        velocity: Vector3<f64>,
        inverse_mass: f64,
        interval: f64,
    ) -> Vector3<f64> {
        let from_center = position - self.reach.center;
        let share = self.reach.share(from_center, matches!(self.kind, FieldKind::Newton { .. }));
        if share == 0.0 {
            return Vector3::zeros();
        }
        let point = PointInField { from_center, velocity, inverse_mass, interval };
        let acceleration = match self.kind {
            FieldKind::Gravity { acceleration } => gravity::acceleration(acceleration),
            FieldKind::Uniform { force } => uniform::acceleration(force, &point),
            FieldKind::Radial { force } => radial::acceleration(force, &point),
            FieldKind::Newton { magnitude, min_distance } => newton::acceleration(
                [magnitude, min_distance, self.reach.attenuation, self.reach.unit],
                &point,
            ),
            // The share belongs to the resistance, which is implicit.
            FieldKind::Drag { magnitude, along, velocity, half_speed } => {
                let share = share * drag::attenuation(point.velocity.norm(), half_speed);
                return drag::acceleration(magnitude * share, along, velocity, &point);
            }
            FieldKind::Air { velocity, rate, component_only, spread } => {
                return air::acceleration(velocity, rate * share, (component_only, spread), &point);
            }
            FieldKind::Turbulence { force, noise } => turbulence::acceleration(force, &noise, &point),
            FieldKind::Vortex { force, axis } => vortex::acceleration(force, axis, &point),
            FieldKind::VolumeAxis(axis) => volume_axis::acceleration(&axis, &point),
        };
        acceleration * share
    }
}
