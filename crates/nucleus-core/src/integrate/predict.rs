//! Prediction at the start of a time step, and velocities at its end.
//!
//! Velocities change before points move, and drag acts before the move: recorded output of the original shows this order.
//! So does `damp` of particles.
//!
//! At the end v += (x - p) / h, where p is the predicted displacement, less the motion by which contacts resolve a
//! penetration. The form v = (x - x_start) / h would take velocity from a difference of rounded positions: a free
//! fall of 100 m is then 0.37 m off after a second at 20 substeps a frame.

use std::ops::Range;

use crate::input::frame::FrameInput;
use crate::integrate::aerodynamics::AirForces;
use crate::integrate::move_points::{ExternalForces, MovePoints};
use crate::math::kernel;
use crate::math::{Lanes, Real, Row4};
use crate::model::ClothModel;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::particles::slowing::damped_share;
use crate::schedule::TimeStep;
use crate::state::State;

/// Estimate of the largest speed of each cloth in this frame, in m/s per axis: its largest now, and what gravity adds. Fields,
/// wind and pressure may make it faster.
pub fn max_speeds<R: Real>(cloths: &[ClothModel<R>], state: &State<R>, frame: &FrameInput) -> Vec<f64> {
    let of_cloth = |points: Range<u32>| {
        let rows = &state.velocity[points.start as usize..points.end as usize];
        let zero = R::Lanes::splat(R::ZERO);
        let max = rows.iter().fold(zero, |max, row| (row.lanes().most(zero - row.lanes())).most(max));
        let [x, y, z, _] = max.to_array();
        [x, y, z].map(R::to_f64).into_iter().fold(0.0, f64::max) + frame.gravity.amax() * frame.duration
    };
    cloths.iter().map(|cloth| of_cloth(cloth.points())).collect()
}

/// Applies external forces and moves the points of all cloths but those of free points: writes velocity, displacement and
/// predicted displacement. `seconds_of_forces` says for how long external forces act on a cloth in this step.
pub fn predict<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    now: &TimeStep<'_, R>,
    is_free: &[bool],
    seconds_of_forces: impl Fn(usize) -> f64,
    pool: &ThreadPool,
) {
    let predicted = DisjointSlice::new(&mut state.predicted);
    let columns = MotionColumns {
        displacement: DisjointSlice::new(&mut state.displacement),
        velocity: DisjointSlice::new(&mut state.velocity),
        normal: &state.normal,
        added_wind: &state.added_wind,
        field: &state.field,
    };
    for (index, cloth) in cloths.iter().enumerate().filter(|(index, _)| !is_free[*index]) {
        let prediction = Prediction::new(columns, cloth, now, index, seconds_of_forces(index));
        pool.parallel_for(cloth.blocks.len(), |block| {
            let points = cloth.blocks.range(block);
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            unsafe {
                prediction.move_points(points.clone(), predicted.run(points));
            }
        });
    }
}

/// The prediction of one cloth in one time step.
#[derive(Clone, Copy)]
pub struct Prediction<'a, R> {
    /// The columns that it reads and writes.
    pub columns: MotionColumns<'a, R>,
    cloth: &'a ClothModel<R>,
    forces: ExternalForces<'a, R>,
}

impl<'a, R: Real> Prediction<'a, R> {
    /// That of a cloth, by its index. External forces act for so many seconds, from the start of the step.
    pub fn new(
        columns: MotionColumns<'a, R>,
        cloth: &'a ClothModel<R>,
        now: &TimeStep<'_, R>,
        index: usize,
        seconds: f64,
    ) -> Self {
        let (TimeStep { frame, schedule, .. }, settings) = (*now, &now.frame.cloths[index]);
        let (h, step) = (schedule.h, f64::from(now.index));
        let steps = [step, step + (seconds / h).round()];
        let gravity = gravity_kick(frame.gravity.into(), h, steps, now.max_speeds[index]);
        let air = AirForces::new(frame, settings, cloth.point_mass, seconds);
        let air = air.map(|air| if cloth.has_faces { air } else { air.on_particles() });
        let forces = ExternalForces {
            gravity: if settings.feels_gravity { gravity } else { [R::ZERO; 3] },
            impulse: <[f64; 3]>::from(settings.local_force * seconds).map(R::from_f64),
            air: air.filter(|_| !cloth.triangles.is_empty()),
            air_factors: &[],
            damped: R::from_f64(if cloth.has_faces { 0.0 } else { damped_share(settings, seconds) }),
            seconds: R::from_f64(seconds),
            h: R::from_f64(schedule.h),
        };
        Self { columns, cloth, forces }
    }

    /// Moves a run of points, and writes their displacements to `predicted` as well.
    ///
    /// # Safety
    /// No other task of the loop touches these points.
    #[allow(unsafe_code)]
    pub unsafe fn move_points(&self, points: Range<u32>, predicted: &mut [Row4<R>]) {
        let forces = ExternalForces { air_factors: self.cloth.air_factors(&points), ..self.forces };
        let MotionColumns { displacement, velocity, normal, added_wind, field } = self.columns;
        let rows = points.start as usize..points.end as usize;
        // SAFETY: the caller's promise.
        unsafe {
            kernel::run(MovePoints {
                displacement: displacement.run(points.clone()),
                velocity: velocity.run(points),
                predicted,
                normal: normal.get(rows.clone()).unwrap_or_default(),
                added_wind: added_wind.get(rows.clone()).unwrap_or_default(),
                field: field.get(rows).unwrap_or_default(),
                forces,
            });
        }
    }
}

/// The columns that a prediction reads and writes.
#[derive(Clone, Copy)]
pub struct MotionColumns<'a, R> {
    /// Displacement in metres, and inverse mass in 1/kg.
    pub displacement: DisjointSlice<'a, Row4<R>>,
    /// Velocity in m/s.
    pub velocity: DisjointSlice<'a, Row4<R>>,
    /// Normals of unit length; empty where no air is felt.
    pub normal: &'a [[R; 3]],
    /// What gusts, wind shadows and pushed air add to the wind in m/s; empty where nothing does.
    pub added_wind: &'a [Row4<R>],
    /// Acceleration by fields in m/s²; empty without fields.
    pub field: &'a [Row4<R>],
}

/// Adds the position corrections of the time step to the velocities, over `h` seconds. Motion that resolves a
/// penetration is no velocity and is left out.
pub fn update_velocities<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    h: f64,
    is_free: &[bool],
    pool: &ThreadPool,
) {
    let State { displacement, predicted, velocity, depenetration, bearing_depenetration, .. } = state;
    let depenetration = [&depenetration[..], &bearing_depenetration[..]];
    let velocity = DisjointSlice::new(velocity);
    let h = R::from_f64(h);
    for cloth in cloths.iter().zip(is_free).filter(|(_, is_free)| !**is_free).map(|(cloth, _)| cloth) {
        pool.parallel_for(cloth.blocks.len(), |block| {
            let points = cloth.blocks.range(block);
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            let velocity = unsafe { velocity.run(points.clone()) };
            let rows = points.start as usize..points.end as usize;
            let of_block = [&displacement[rows.clone()], &predicted[rows.clone()]];
            add_corrections(
                of_block,
                depenetration.map(|column| column.get(rows.clone()).unwrap_or_default()),
                velocity,
                h,
            );
        });
    }
}

/// Adds the corrections of a run of points to their velocities, over `h` seconds. Both columns of `depenetration` are empty
/// where the scene has no contact.
pub fn add_corrections<R: Real>(
    [displacement, predicted]: [&[Row4<R>]; 2],
    depenetration: [&[Row4<R>]; 2],
    velocity: &mut [Row4<R>],
    h: R,
) {
    let per_h = R::Lanes::splat(R::ONE / h);
    for (k, ((d, p), v)) in displacement.iter().zip(predicted).zip(velocity).enumerate() {
        let corrected = d.lanes() - p.lanes();
        let without_depenetration =
            |corrected, column: &[Row4<R>]| column.get(k).map_or(corrected, |row| corrected - row.lanes());
        let corrected = depenetration.into_iter().fold(corrected, without_depenetration);
        *v = Row4((v.lanes() + corrected * per_h).to_array());
    }
}

/// Changes of velocity by gravity whose sum is exact.
///
/// A velocity of 8 m/s holds steps of 1e-6 m/s; at 1000 substeps gravity adds 4e-4 each. Each of them rounded the same
/// way makes the fall up to 0.1 % wrong. Each kick, from one step to another, therefore adds a whole number of last bits,
/// and the next one takes the remainder.
fn gravity_kick<R: Real>(gravity: [f64; 3], h: f64, [from, to]: [f64; 2], max_speed: f64) -> [R; 3] {
    let grid = last_bit::<R>(max_speed);
    let whole = |sum: f64| (sum / grid).round() * grid;
    gravity.map(|g| R::from_f64(whole(g * h * to) - whole(g * h * from)))
}

/// The spacing of floating-point numbers about as large as `x`.
fn last_bit<R: Real>(x: f64) -> f64 {
    let bits = if size_of::<R>() == 4 { -24 } else { -53 };
    // A power of two not below x, by its exponent bits; for zero and tiny x, a floor far below any speed.
    let exponent = ((x.max(1e-6).to_bits() >> 52) as i32 - 1023) + 1;
    f64::from_bits(((1023 + exponent + bits) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gravity_kicks_add_up_to_gravity_times_time_for_any_number_of_steps() {
        for steps in [1u32, 20, 1000, 24_000] {
            let h = 1.0 / f64::from(steps);
            let kick = |k: u32| {
                let steps = [k, k + 1].map(f64::from);
                gravity_kick::<f32>([0.0, -9.8, 0.0], h, steps, 9.8)[1]
            };
            let sum = (0..steps).fold(0.0f32, |v, k| v + kick(k));
            assert!((f64::from(sum) / -9.8 - 1.0).abs() < 1e-7, "{steps}: {sum}");
        }
    }
}
