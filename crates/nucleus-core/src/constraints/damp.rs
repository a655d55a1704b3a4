//! Damping of the relative velocity of linked points, once per substep.
//!
//! `stretchDamp` acts along the links only, `damp` in all directions. Both act on pairs of points, equal and opposite, so
//! they conserve momentum. The torque of `damp` is taken away where that of sweeps is ([`super::angular_momentum`]): such a
//! cloth is not slowed when it moves as a rigid body.

use crate::input::frame::{COUNT_PERIOD, FrameInput};
use crate::math::{Real, Row4, dot};
use crate::model::ClothModel;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

use super::angular_momentum::{keeps_angular_momentum, without_torque};
use super::row_loops::for_all_rows;
use super::strength_map::StrengthGroup;
use super::stretch::LinkGroup;

/// Damps all cloths once, for a substep of this many seconds. `is_free` says which move freely. Reads displacements, writes
/// velocities.
pub fn damp<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    frame: &FrameInput,
    is_free: &[bool],
    substep: f64,
    pool: &ThreadPool,
) {
    for (index, (cloth, settings)) in cloths.iter().zip(&frame.cloths).enumerate() {
        let damping = Damping { stretch_damp: settings.stretch_damp, damp: settings.damp, substep };
        if !cloth.lists.damp || !damping.is_felt() {
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

/// The damping of a cloth in a substep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// `stretchDamp`.
    pub stretch_damp: f64,
    /// `damp`.
    pub damp: f64,
    /// Length of the substep in seconds.
    pub substep: f64,
}

impl Damping {
    /// Whether there is any.
    pub fn is_felt(&self) -> bool {
        self.stretch_damp > 0.0 || self.damp > 0.0
    }

    /// The strength in a link with this factor on `damp`.
    pub fn strength<R: Real>(&self, factor: f64) -> DampStrength<R> {
        // Implicit: a velocity shrinks but never changes its sign, however large the rate.
        let share = |attribute: f64| {
            let rate = attribute.max(0.0) * self.substep / COUNT_PERIOD;
            R::from_f64(rate / (1.0 + rate))
        };
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
