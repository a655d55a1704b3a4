//! Predict: forces change velocities, velocities move points. Velocity first, and damped before the move:
//! so does the step of the original, as its recorded output shows.

use std::ops::Range;

use crate::integrate::aerodynamics::{Air, AirFactors, AirForces};
use crate::math::{Lanes, Real, Row4};
use crate::parallel::disjoint::DisjointSlice;

/// What drives the points of one cloth in one time step.
#[derive(Debug, Clone, Copy)]
pub struct Drive<'a, R> {
    /// Change of velocity by gravity in m/s.
    pub gravity: [R; 3],
    /// Force on every point times the length of the step, in N·s.
    pub impulse: [R; 3],
    /// The air, where it is felt.
    pub air_forces: Option<AirForces>,
    /// Factors on it, for each point of the run; none where it is felt the same everywhere.
    pub factors: &'a [AirFactors],
    /// Length of the step in seconds.
    pub h: R,
}

/// The columns that a prediction reads and writes.
#[derive(Clone, Copy)]
pub struct Columns<'a, R> {
    /// Displacement and inverse mass.
    pub displacement: DisjointSlice<'a, Row4<R>>,
    /// Velocity.
    pub velocity: DisjointSlice<'a, Row4<R>>,
    /// Displacement before anything holds the point.
    pub predicted: DisjointSlice<'a, Row4<R>>,
    /// Normals, where air is felt.
    pub normal: &'a [Row4<R>],
    /// What gusts add to the wind in m/s; empty in a steady wind.
    pub gust: &'a [Row4<R>],
}

/// Moves a run of points. A pinned point goes on along its line.
///
/// # Safety
/// No other task of the phase touches these points.
#[allow(unsafe_code)]
pub unsafe fn move_points<R: Real>(columns: &Columns<'_, R>, points: Range<u32>, drive: &Drive<'_, R>) {
    // SAFETY: the caller's promise.
    let (displacement, velocity, predicted) = unsafe {
        (
            columns.displacement.run(points.clone()),
            columns.velocity.run(points.clone()),
            columns.predicted.run(points.clone()),
        )
    };
    let four = |[x, y, z]: [R; 3]| R::Lanes::from_array([x, y, z, R::ZERO]);
    let (gravity, impulse, zero) = (four(drive.gravity), four(drive.impulse), R::Lanes::splat(R::ZERO));
    let h = four([drive.h; 3]);
    let everywhere = drive.air_forces.map(|air_forces| air_forces.at(&AirFactors::NONE));
    for (k, ((d, v), p)) in displacement.iter_mut().zip(velocity).zip(predicted).enumerate() {
        let place = d.lanes();
        let inverse_mass = place.splat_last();
        let kick = inverse_mass.choose_by_sign(gravity + impulse * inverse_mass, zero);
        let mut fast = v.lanes() + kick;
        if let Some(air) = &everywhere
            && d.0[3] > R::ZERO
        {
            let own: Option<Air<R>> =
                drive.factors.get(k).zip(drive.air_forces).map(|(factors, air)| air.at(factors));
            let normal = columns.normal[points.start as usize + k];
            let air = own.as_ref().unwrap_or(air);
            let slowed = match columns.gust.get(points.start as usize + k) {
                Some(gust) => air.gusting(gust.xyz()).slow(fast.to_array(), normal.xyz()),
                None => air.slow(fast.to_array(), normal.xyz()),
            };
            fast = Row4(slowed).lanes();
        }
        let moved = Row4((place + fast * h).to_array());
        *v = Row4(fast.to_array());
        *d = moved;
        *p = moved;
    }
}

/// Changes of velocity by gravity that add up right.
///
/// A velocity of 8 m/s holds steps of 1e-6 m/s; at 1000 substeps gravity adds 4e-4 each, and always adding
/// it rounded the same way is up to 0.1 % off. So each step adds a whole number of last bits, and what is
/// left over is carried on to the next.
pub fn gravity_kick<R: Real>(gravity: [f64; 3], h: f64, step: u32, max_speed: f64) -> [R; 3] {
    let grid = last_bit::<R>(max_speed);
    let whole = |sum: f64| (sum / grid).round() * grid;
    gravity.map(|g| R::from_f64(whole(g * h * f64::from(step + 1)) - whole(g * h * f64::from(step))))
}

/// The spacing of numbers about as large as `x`.
fn last_bit<R: Real>(x: f64) -> f64 {
    let bits = if size_of::<R>() == 4 { -24 } else { -53 };
    // A power of two not below x, by its exponent bits; for nought and the tiny, a floor far below any speed.
    let exponent = ((x.max(1e-6).to_bits() >> 52) as i32 - 1023) + 1;
    f64::from_bits(((1023 + exponent + bits) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kicks_add_up_to_gravity_times_time_however_many() {
        for steps in [1u32, 20, 1000, 24_000] {
            let h = 1.0 / f64::from(steps);
            let sum = (0..steps).fold(0.0f32, |v, k| v + gravity_kick::<f32>([0.0, -9.8, 0.0], h, k, 9.8)[1]);
            assert!((f64::from(sum) / -9.8 - 1.0).abs() < 1e-7, "{steps}: {sum}");
        }
    }
}
