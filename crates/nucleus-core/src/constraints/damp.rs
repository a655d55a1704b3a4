//! Damping of the relative velocity of linked points, at the end of a substep or, where it is strong, of time steps within it.
//!
//! One sweep that takes most of a relative velocity comes late, and its result depends on the order of the links: of a triangle
//! of 1 m that swings about a side with a `damp` of 8, the angle after a second is 4.6° with one sweep in 1/72 s and 1.5° in the
//! limit. So a sweep takes [`MOST_DECAY`] at most, if there are enough time steps.
//!
//! `stretchDamp` acts along the links only, `damp` in all directions. Both act on pairs of points, equal and opposite, so
//! they conserve momentum. The torque of `damp` is taken away where that of sweeps is ([`super::angular_momentum`]): such a
//! cloth is not slowed when it moves as a rigid body.

use crate::input::frame::{COUNT_PERIOD, ClothFrame, FrameInput, ResistanceModel};
use crate::math::{Real, Row4, dot};
use crate::model::ClothModel;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::Schedule;
use crate::state::State;

use super::angular_momentum::{keeps_angular_momentum, without_torque};
use super::row_loops::for_all_rows;
use super::strength_map::StrengthGroup;
use super::stretch::LinkGroup;

/// Damps the cloths that are due at the end of a time step of the schedule, counted from the start of the frame. `is_free` says
/// which move freely. Reads displacements, writes velocities.
pub fn damp<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    frame: &FrameInput,
    (schedule, step): (&Schedule<R>, u32),
    is_free: &[bool],
    pool: &ThreadPool,
) {
    for (index, (cloth, settings)) in cloths.iter().zip(&frame.cloths).enumerate() {
        let damping = Damping::new(settings, schedule, frame.resistance);
        if !cloth.lists.damp || !damping.is_felt() || !damping.times.is_due(schedule, step) {
            continue;
        }
        let has_torque =
            damping.damp > 0.0 && keeps_angular_momentum(cloth, &settings.pressure, is_free[index]);
        match has_torque {
            true => without_torque(cloth, state, |state| sweep(cloth, state, &damping, pool)),
            false => sweep(cloth, state, &damping, pool),
        }
    }
}

fn sweep<R: Real>(cloth: &ClothModel<R>, state: &mut State<R>, damping: &Damping, pool: &ThreadPool) {
    let State { displacement, velocity, .. } = state;
    let velocity = DisjointSlice::new(velocity);
    for_all_rows(pool, &cloth.blocks, &cloth.stretch, |batch| {
        let (links, factors) = (cloth.stretch.batch(batch), cloth.strength_maps.damp.batch(batch));
        // SAFETY: interior rows of two blocks, and interface rows of one colour, share no point.
        #[allow(unsafe_code)]
        unsafe {
            relax(velocity, displacement, links, factors, damping);
        }
    });
}

/// When velocities are damped: sweeps in a substep, spread over its time steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampTimes {
    /// Sweeps in a substep.
    pub sweeps: u32,
    /// Time from sweep to sweep in seconds.
    pub interval: f64,
    /// Whether a sweep is an implicit step, not an exponential.
    is_implicit: bool,
}

/// Rate of damping times the time between two sweeps, at most.
const MOST_DECAY: f64 = 0.1;

impl DampTimes {
    /// For a rate in units of 1/24 s.
    ///
    /// Classic takes implicit steps: of a recorded sheet with a `damp` of 4, half of whose points stay down on a table, 69 of
    /// 162 do with exponentials.
    pub fn new<R: Real>(rate: f64, schedule: &Schedule<R>, resistance: ResistanceModel) -> Self {
        let substep = schedule.h * f64::from(schedule.steps);
        let decay = rate.max(0.0) * substep / COUNT_PERIOD;
        let sweeps = (decay / MOST_DECAY).ceil().clamp(1.0, f64::from(schedule.steps)) as u32;
        let is_implicit = resistance == ResistanceModel::Classic;
        Self { sweeps, interval: substep / f64::from(sweeps), is_implicit }
    }

    /// Whether there is a sweep at the end of a time step, counted from the start of the frame. The last is at the end of the
    /// substep.
    pub fn is_due<R: Real>(&self, schedule: &Schedule<R>, step: u32) -> bool {
        let [steps, sweeps] = [schedule.steps, self.sweeps].map(u64::from);
        let done = u64::from(step) % steps;
        done * sweeps / steps < (done + 1) * sweeps / steps
    }

    /// The share of a velocity that a sweep takes at a rate in units of 1/24 s. It shrinks but never changes its sign, however
    /// large the rate.
    pub fn share(&self, rate: f64) -> f64 {
        let decay = rate.max(0.0) * self.interval / COUNT_PERIOD;
        if self.is_implicit { decay / (1.0 + decay) } else { -libm::expm1(-decay) }
    }
}

/// The damping of a cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// `stretchDamp`.
    pub stretch_damp: f64,
    /// `damp`.
    pub damp: f64,
    /// When it acts.
    pub times: DampTimes,
}

impl Damping {
    /// The damping of a cloth with these settings.
    pub fn new<R: Real>(settings: &ClothFrame, schedule: &Schedule<R>, resistance: ResistanceModel) -> Self {
        let &ClothFrame { stretch_damp, damp, .. } = settings;
        Self { stretch_damp, damp, times: DampTimes::new(stretch_damp.max(damp), schedule, resistance) }
    }

    /// Whether there is any.
    pub fn is_felt(&self) -> bool {
        self.stretch_damp > 0.0 || self.damp > 0.0
    }

    /// The strength in a link with this factor on `damp`.
    pub fn strength<R: Real>(&self, factor: f64) -> DampStrength<R> {
        let share = |rate: f64| R::from_f64(self.times.share(rate));
        let all = share(self.damp * factor);
        // `all` has acted along the link too.
        DampStrength { along: share(self.stretch_damp) * (R::ONE - all), all }
    }
}

/// The shares of the relative velocity of two linked points that one sweep removes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampStrength<R> {
    along: R,
    all: R,
}

/// Sweeps the links of `groups` once. `factors` on `damp` has one entry per group, or is empty.
///
/// # Safety
/// No other task of the loop touches the points of `groups`.
#[allow(unsafe_code)]
pub unsafe fn relax<R: Real>(
    velocity: DisjointSlice<'_, Row4<R>>,
    points: &[Row4<R>],
    groups: &[LinkGroup<R>],
    factors: &[StrengthGroup<R>],
    damping: &Damping,
) {
    let everywhere: DampStrength<R> = damping.strength(1.0);
    for (k, group) in groups.iter().enumerate() {
        for lane in 0..4 {
            let [a, b] = group.ends.map(|ends| ends[lane]);
            let own = |factors: &StrengthGroup<R>| damping.strength(factors.above[lane].to_f64());
            let strength = factors.get(k).map_or(everywhere, own);
            let (x_a, x_b) = (points[a as usize].0, points[b as usize].0);
            let total = x_a[3] + x_b[3];
            if total <= R::ZERO {
                continue;
            }
            // SAFETY: the caller's promise.
            let (mut v_a, mut v_b) = unsafe { (velocity.get(a), velocity.get(b)) };
            let d: [R; 3] = std::array::from_fn(|axis| group.span[axis][lane] + (x_b[axis] - x_a[axis]));
            let relative: [R; 3] = std::array::from_fn(|axis| v_b.0[axis] - v_a.0[axis]);
            let along = strength.along * dot(relative, d) / (dot(d, d) + R::MIN_DENOMINATOR);
            for axis in 0..3 {
                let taken = (strength.all * relative[axis] + along * d[axis]) / total;
                v_a.0[axis] += x_a[3] * taken;
                v_b.0[axis] -= x_b[3] * taken;
            }
            // SAFETY: the caller's promise.
            unsafe {
                velocity.set(a, v_a);
                velocity.set(b, v_b);
            }
        }
    }
}
