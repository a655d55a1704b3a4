//! How the way of each point is foreseen: on in a straight line, or beside what it was foreseen to keep to.

use super::paths::Path;
use crate::math::{Real, Row4, add, clamp_length, dot, scale, sub};
use crate::schedule::StepInterval;

/// Share of its ball within which a point that stays in it needs no search as a span begins.
const STAYS: f64 = 0.8;

/// What foreseeing goes by.
pub struct Ahead<R> {
    /// Start of the step, as a share of the span.
    begun: R,
    /// Steps in the span.
    steps: R,
    /// The motion of all points of the cloth in a step, in the mean.
    common: [R; 3],
}

impl<R: Real> Ahead<R> {
    /// For a step of a span of the frame.
    pub fn new(now: StepInterval, span: [f64; 2], common: [R; 3]) -> Self {
        let (step, length) = (now.to - now.from, span[1] - span[0]);
        Self { begun: R::from_f64((now.from - span[0]) / length), steps: R::from_f64(length / step), common }
    }

    /// On through the span at a pace for each step, but no farther from what all do in common than `farthest`; within a
    /// ball that has room for this step's own motion all the same.
    #[inline(always)]
    pub fn on(&self, before: [R; 3], [motion, pace]: [[R; 3]; 2], ball: R, farthest: R) -> Path<R> {
        let most = farthest / (R::ONE - self.begun + R::EPSILON);
        let travel = limited(scale(pace, self.steps), scale(self.common, self.steps), most);
        let missed = sub(motion, scale(travel, R::ONE / self.steps));
        let ball = ball + dot(missed, missed).sqrt();
        Path { from: sub(before, scale(travel, self.begun)), travel, ball }
    }

    /// Whether a point that goes on like that in each step stays well within a ball until the span is over.
    #[inline(always)]
    pub fn stays(&self, rest: &Path<R>, before: [R; 3], motion: [R; 3]) -> bool {
        let most = rest.ball * R::from_f64(STAYS);
        let off = sub(before, rest.from);
        let last = add(off, scale(motion, self.steps));
        dot(off, off) <= most * most && dot(last, last) <= most * most
    }
}

/// The mean motion of some points in a step: what they have in common brings none of them nearer to another.
pub fn mean_motion<R: Real>(start: &[Row4<R>], now: &[Row4<R>]) -> [R; 3] {
    let mut sum = [0.0f64; 3];
    for (start, now) in start.iter().zip(now) {
        let motion = sub(now.xyz(), start.xyz());
        for axis in 0..3 {
            sum[axis] += motion[axis].to_f64();
        }
    }
    sum.map(|x| R::from_f64(x / start.len().max(1) as f64))
}

/// A motion that differs from the common one by `most` at most.
fn limited<R: Real>(motion: [R; 3], common: [R; 3], most: R) -> [R; 3] {
    add(common, clamp_length(sub(motion, common), most))
}
