//! The motion of points by external forces in a time step, eight points side by side.

use crate::integrate::aerodynamics::{Air, AirForces, AirLanes};
use crate::math::kernel::{Kernel, load, store};
use crate::math::{Lanes, Real, Row4};
use crate::model::strength_maps::AirFactors;

/// The external forces on the points of one cloth in one time step.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExternalForces<'a, R> {
    /// Change of velocity by gravity in m/s.
    pub gravity: [R; 3],
    /// Force on every point times the seconds for which it acts, in N·s.
    pub impulse: [R; 3],
    /// Drag, lift and wind; none in a vacuum or where no air is felt.
    pub air: Option<AirForces>,
    /// Vertex maps of the air, one entry per point of the run; empty where there are none.
    pub air_factors: &'a [AirFactors],
    /// The share of the velocity that `damp` of particles takes.
    pub damped: R,
    /// For how long they act, in seconds.
    pub seconds: R,
    /// Length of the step in seconds.
    pub h: R,
}

/// A run of points to move, by column: one row for each point, and none in a column of what does not act.
pub(super) struct MovePoints<'a, R> {
    /// Displacement in metres, and inverse mass in 1/kg.
    pub displacement: &'a mut [Row4<R>],
    /// Velocity in m/s.
    pub velocity: &'a mut [Row4<R>],
    /// The displacement after the step.
    pub predicted: &'a mut [Row4<R>],
    /// Normals of unit length.
    pub normal: &'a [[R; 3]],
    /// What is added to the wind, in m/s.
    pub added_wind: &'a [Row4<R>],
    /// Acceleration by fields in m/s².
    pub field: &'a [Row4<R>],
    pub forces: ExternalForces<'a, R>,
}

impl<R: Real> Kernel<R> for MovePoints<'_, R> {
    /// Moves the points. A pinned point keeps its velocity, which is that of its pin.
    ///
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run<L: Lanes<R>>(self) {
        let Self { displacement, velocity, predicted, normal, added_wind, field, forces } = self;
        let [gravity, impulse] = [forces.gravity, forces.impulse];
        let gravity = [L::splat(gravity[0]), L::splat(gravity[1]), L::splat(gravity[2])];
        let impulse = [L::splat(impulse[0]), L::splat(impulse[1]), L::splat(impulse[2])];
        let (h, seconds, damped) = (L::splat(forces.h), L::splat(forces.seconds), L::splat(forces.damped));
        // Not a map: closures are not compiled for the lanes.
        let mut uniform = None;
        if let Some(air) = &forces.air {
            let air: Air<R> = air.at(&AirFactors::NONE);
            uniform = Some(AirLanes::<L>::of_points(|_| air));
        }
        for first in (0..displacement.len()).step_by(4 * L::GROUPS) {
            let [x, y, z, inverse_mass] = load::<R, L>(displacement, first);
            let [u, v, w, fourth] = load::<R, L>(velocity, first);
            let before = [u, v, w];
            let mut kicked = before;
            for axis in 0..3 {
                kicked[axis] = kicked[axis] + (gravity[axis] + impulse[axis] * inverse_mass);
            }
            if !field.is_empty() {
                let field = load::<R, L>(field, first);
                for axis in 0..3 {
                    kicked[axis] = kicked[axis] + field[axis] * seconds;
                }
            }
            if let (Some(uniform), Some(mapped)) = (&uniform, &forces.air) {
                let factors = forces.air_factors;
                let mut air = match factors.is_empty() {
                    true => *uniform,
                    false => AirLanes::<L>::of_points(|lane| mapped.at(&at(factors, first + lane))),
                };
                if !added_wind.is_empty() {
                    let added = load::<R, L>(added_wind, first);
                    for axis in 0..3 {
                        air.wind[axis] = air.wind[axis] + added[axis];
                    }
                }
                kicked = air.slow(before, kicked, load_triples::<R, L>(normal, first));
            }
            let mut place = [x, y, z];
            for axis in 0..3 {
                let damped = kicked[axis] - kicked[axis] * damped;
                kicked[axis] = inverse_mass.choose_by_sign(damped, before[axis]);
                place[axis] = place[axis] + kicked[axis] * h;
            }
            let moved = [place[0], place[1], place[2], inverse_mass];
            store::<R, L>(displacement, first, moved);
            store::<R, L>(predicted, first, moved);
            store::<R, L>(velocity, first, [kicked[0], kicked[1], kicked[2], fourth]);
        }
    }
}

/// An entry of a column that is not empty; the last one beyond the end.
#[inline(always)]
fn at<T: Copy>(column: &[T], k: usize) -> T {
    column[k.min(column.len() - 1)]
}

/// Some triples from one on, side by side.
#[inline(always)]
fn load_triples<R: Real, L: Lanes<R>>(column: &[[R; 3]], first: usize) -> [L; 3] {
    [load_axis(column, first, 0), load_axis(column, first, 1), load_axis(column, first, 2)]
}

#[inline(always)]
fn load_axis<R: Real, L: Lanes<R>>(column: &[[R; 3]], first: usize, axis: usize) -> L {
    L::of_groups(|group| {
        let k = first + 4 * group;
        [at(column, k)[axis], at(column, k + 1)[axis], at(column, k + 2)[axis], at(column, k + 3)[axis]]
    })
}
