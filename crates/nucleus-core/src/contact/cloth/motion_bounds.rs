//! Motion bounds: a line and a radius that contain a point over a candidate interval. The contacts found for them
//! are complete as long as all points stay inside.
//!
//! The line follows the point's own motion, so neighbours that move together keep their distance: a sheet that
//! falls or swings finds no contact with itself.

use std::ops::Range;

use crate::math::kernel::{Kernel, load};
use crate::math::{Lanes, Real, Row4, add, dot, scale, sub};
use crate::parallel::disjoint::DisjointSlice;
use crate::particles::population::close_up;
use crate::schedule::{StepInterval, TimeInterval};

/// The trajectory of each point over a candidate interval.
#[derive(Debug, Clone, Default)]
pub struct Trajectories<R> {
    /// Displacement at the start of the interval in metres, and the radius.
    pub origin: Vec<Row4<R>>,
    /// Motion over the whole interval, in metres.
    pub travel: Vec<Row4<R>>,
}

/// The motion bound of one point.
#[derive(Debug, Clone, Copy)]
pub struct Trajectory<R> {
    /// Displacement at the start of the interval, in metres.
    pub origin: [R; 3],
    /// Motion over the whole interval, in metres.
    pub travel: [R; 3],
    /// Radius around the line, in metres.
    pub radius: R,
}

impl<R: Real> Trajectory<R> {
    /// The line at a share of the interval.
    #[inline(always)]
    pub fn at(&self, share: R) -> [R; 3] {
        add(self.origin, scale(self.travel, share))
    }
}

impl<R: Real> Trajectories<R> {
    /// Empty trajectories.
    pub fn new(rows: usize) -> Self {
        Self { origin: vec![Row4::ZERO; rows], travel: vec![Row4::ZERO; rows] }
    }

    /// Closes up rows; `kept` are the places of those that remain, which ascend.
    pub fn close_up(&mut self, rows: Range<usize>, kept: &[u32]) {
        let Self { origin, travel } = self;
        close_up(&mut origin[rows.clone()], kept);
        close_up(&mut travel[rows], kept);
    }

    /// The trajectory of one point.
    #[inline(always)]
    pub fn of(&self, point: u32) -> Trajectory<R> {
        let origin = self.origin[point as usize];
        Trajectory { origin: origin.xyz(), travel: self.travel[point as usize].xyz(), radius: origin.0[3] }
    }

    /// Rebases on anchors that move to the points' positions: the end of the last interval becomes the start of
    /// the next.
    pub fn shift_anchors(&mut self, moved: &[Row4<R>]) {
        for ((origin, travel), moved) in self.origin.iter_mut().zip(&mut self.travel).zip(moved) {
            let [x, y, z] = sub(add(origin.xyz(), travel.xyz()), moved.xyz());
            *origin = Row4([x, y, z, origin.0[3]]);
            *travel = Row4::ZERO;
        }
    }

    /// Lends the columns to the tasks of a phase.
    pub fn shared(&mut self) -> SharedTrajectories<'_, R> {
        SharedTrajectories {
            origin: DisjointSlice::new(&mut self.origin),
            travel: DisjointSlice::new(&mut self.travel),
        }
    }
}

/// Trajectories, lent to the tasks of a phase.
#[derive(Clone, Copy)]
pub struct SharedTrajectories<'a, R> {
    origin: DisjointSlice<'a, Row4<R>>,
    travel: DisjointSlice<'a, Row4<R>>,
}

#[allow(unsafe_code)]
impl<R: Real> SharedTrajectories<'_, R> {
    /// Reads a trajectory.
    ///
    /// # Safety
    /// No other task of the phase writes it.
    #[inline(always)]
    pub unsafe fn of(&self, point: u32) -> Trajectory<R> {
        let (origin, travel) = unsafe { (self.origin.get(point), self.travel.get(point)) };
        Trajectory { origin: origin.xyz(), travel: travel.xyz(), radius: origin.0[3] }
    }

    /// Writes a trajectory.
    ///
    /// # Safety
    /// No other task of the phase touches it.
    #[inline(always)]
    pub unsafe fn set(&self, point: u32, trajectory: Trajectory<R>) {
        let ([a, b, c], [x, y, z]) = (trajectory.origin, trajectory.travel);
        unsafe {
            self.origin.set(point, Row4([a, b, c, trajectory.radius]));
            self.travel.set(point, Row4([x, y, z, R::ZERO]));
        }
    }
}

/// Marks the points of a run that are not within their bounds; those marked before stay so.
pub struct MarkViolations<'a, R> {
    /// Displacements in metres, one of each point, as in all columns.
    pub displacement: &'a [Row4<R>],
    /// Of [`Trajectories`].
    pub origin: &'a [Row4<R>],
    /// Of [`Trajectories`].
    pub travel: &'a [Row4<R>],
    /// The marks.
    pub is_violated: &'a mut [bool],
    /// The time, as a share of the candidate interval.
    pub share: R,
}

impl<R: Real> Kernel<R> for MarkViolations<'_, R> {
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run<L: Lanes<R>>(self) {
        let Self { displacement, origin, travel, is_violated, share } = self;
        let share = L::splat(share);
        let width = 4 * L::GROUPS;
        for (run, marks) in is_violated.chunks_mut(width).enumerate() {
            let first = run * width;
            let [x, y, z, _] = load::<R, L>(displacement, first);
            let [a, b, c, radius] = load::<R, L>(origin, first);
            let [u, v, w, _] = load::<R, L>(travel, first);
            let away = [x - (a + u * share), y - (b + v * share), z - (c + w * share)];
            // A displacement that is no number is outside.
            let inside = (radius * radius - dot(away, away)).above_zero();
            for (lane, mark) in marks.iter_mut().enumerate() {
                *mark |= inside & (1 << lane) == 0;
            }
        }
    }
}

/// Share of its radius within which a point keeps its bound in the next interval without a search.
const KEEP_SHARE: f64 = 0.8;

/// Predicts trajectories.
pub struct BoundPredictor<R> {
    /// Start of the step, as a share of the interval.
    step_start: R,
    /// Time steps in the interval.
    steps: R,
}

impl<R: Real> BoundPredictor<R> {
    /// For a step of an interval of the frame.
    pub fn new(now: StepInterval, interval: TimeInterval) -> Self {
        let (step, length) = (now.to - now.from, interval.length());
        Self { step_start: R::from_f64(interval.share_of(now.from)), steps: R::from_f64(length / step) }
    }

    /// Extrapolates the line by this step's motion, and at `rate` per step after it. The radius has a margin for this step.
    #[inline(always)]
    pub fn extrapolate(&self, before: [R; 3], [motion, rate]: [[R; 3]; 2], radius: R) -> Trajectory<R> {
        let left = self.steps * (R::ONE - self.step_start);
        let mean = scale(add(motion, scale(rate, left - R::ONE)), R::ONE / left);
        let residual = sub(motion, mean);
        let travel = scale(mean, self.steps);
        let radius = radius + dot(residual, residual).sqrt();
        Trajectory { origin: sub(before, scale(travel, self.step_start)), travel, radius }
    }

    /// Whether a point with this motion per step stays well within a bound until the interval ends.
    #[inline(always)]
    pub fn stays_within(&self, rest: &Trajectory<R>, before: [R; 3], motion: [R; 3]) -> bool {
        let most = rest.radius * R::from_f64(KEEP_SHARE);
        let off = sub(before, rest.origin);
        let last = add(off, scale(motion, self.steps));
        dot(off, off) <= most * most && dot(last, last) <= most * most
    }
}
