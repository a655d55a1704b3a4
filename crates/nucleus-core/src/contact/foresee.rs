//! Where each point is foreseen to be for a while: as long as it stays there, the pairs found for it hold.

use crate::math::{Real, Row4, dot, scale, sub};

/// Where a point is foreseen to stay: low and high corner of its displacement, as seen by one who goes with the drift.
pub type Cover<R> = [Row4<R>; 2];

/// What is foreseen for the points of a cloth, seen by one who goes with the collider that it meets: what that takes
/// along stays where it is.
#[derive(Debug, Clone, Copy)]
pub struct Foreseen<'a, R> {
    /// Of every point.
    pub cover: &'a [Cover<R>],
    /// How far that one goes in a frame, in metres.
    pub drift: [R; 3],
}

impl<R: Real> Foreseen<'_, R> {
    /// One point's.
    #[inline(always)]
    pub fn of(&self, point: u32) -> Cover<R> {
        self.cover[point as usize]
    }

    /// How far the drift has gone at a time of the frame, given as a share of it.
    #[inline(always)]
    pub fn gone(&self, time: f64) -> [R; 3] {
        gone(self.drift, time)
    }
}

/// How far a drift has gone at a time of the frame, given as a share of it.
#[inline(always)]
pub fn gone<R: Real>(drift: [R; 3], time: f64) -> [R; 3] {
    scale(drift, R::from_f64(time))
}

/// Share of a point's expected motion that is added as margin all round.
const MARGIN: f64 = 0.25;

/// What is foreseen for a point: from where it started the step, over where it is now, on to where it will
/// be at the end of the span if it goes on like this, with a margin; of what the motion adds to the margin,
/// at most `most`.
pub fn foresee<R: Real>(start: [R; 3], now: [R; 3], steps_left: R, [margin, most]: [R; 2]) -> Cover<R> {
    let mut travel = R::ZERO;
    let end: [R; 3] = std::array::from_fn(|axis| now[axis] + (now[axis] - start[axis]) * steps_left);
    for axis in 0..3 {
        let far = end[axis] - start[axis];
        travel = max(travel, max(far, -far));
    }
    let stray = travel * R::from_f64(MARGIN);
    let margin = margin + if stray > most { most } else { stray };
    let corner = |side: R, pick: fn(R, R) -> R| {
        let at = |axis: usize| pick(pick(start[axis], now[axis]), end[axis]) + margin * side;
        Row4([at(0), at(1), at(2), R::ZERO])
    };
    [corner(-R::ONE, min), corner(R::ONE, max)]
}

/// The farthest that two places foreseen for a point can be apart.
pub fn spread<R: Real>([low, high]: &Cover<R>) -> R {
    let across: [R; 3] = std::array::from_fn(|axis| high.0[axis] - low.0[axis]);
    dot(across, across).sqrt()
}

/// Whether all that is foreseen in `inner` is foreseen in `outer` too.
pub fn is_within<R: Real>(inner: &Cover<R>, outer: &Cover<R>) -> bool {
    (0..3).all(|axis| outer[0].0[axis] <= inner[0].0[axis] && inner[1].0[axis] <= outer[1].0[axis])
}

/// Whether a point is where it was foreseen to be, when the drift has gone so far.
pub fn is_foreseen<R: Real>([low, high]: &Cover<R>, now: [R; 3], gone: [R; 3]) -> bool {
    let now = sub(now, gone);
    (0..3).all(|axis| low.0[axis] <= now[axis] && now[axis] <= high.0[axis])
}

fn min<R: Real>(a: R, b: R) -> R {
    if b < a { b } else { a }
}

fn max<R: Real>(a: R, b: R) -> R {
    if b > a { b } else { a }
}
