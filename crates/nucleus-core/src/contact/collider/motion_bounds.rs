//! Motion bounds of points among colliders: a box that contains a point's displacement over a window of time steps.

use crate::math::{Real, Row4, dot, scale, sub};

/// Distance that anything may move in a candidate interval, in edge lengths.
pub const MAX_TRAVEL: f64 = 2.0;

/// Motion bound: low and high corner of a point's displacement in metres, relative to the moving frame.
pub type MotionBox<R> = [Row4<R>; 2];

/// The motion bounds of a cloth's points.
#[derive(Debug, Clone, Copy)]
pub struct MotionBounds<'a, R> {
    /// One for each row.
    pub boxes: &'a [MotionBox<R>],
    /// Motion of the moving frame in a frame, in metres.
    pub frame_travel: [R; 3],
}

impl<R: Real> MotionBounds<'_, R> {
    /// The bound of one point.
    #[inline(always)]
    pub fn of(&self, point: u32) -> MotionBox<R> {
        self.boxes[point as usize]
    }

    /// Motion of the moving frame up to a time, given as a share of the frame.
    #[inline(always)]
    pub fn travel_at(&self, time: f64) -> [R; 3] {
        travel_at(self.frame_travel, time)
    }
}

/// Motion of a moving frame up to a time, given as a share of the frame.
#[inline(always)]
pub fn travel_at<R: Real>(drift: [R; 3], time: f64) -> [R; 3] {
    scale(drift, R::from_f64(time))
}

/// Margin of a bound on all sides, as a share of the point's predicted motion.
const TRAVEL_MARGIN: f64 = 0.25;

/// Predicts a bound: it contains the start and the end of this step, and the extrapolation of this motion over
/// `steps_left` steps, with a margin. The motion contributes at most `most` to the margin.
pub fn predict_box<R: Real>(
    start: [R; 3],
    now: [R; 3],
    steps_left: R,
    [margin, most]: [R; 2],
) -> MotionBox<R> {
    let mut travel = R::ZERO;
    let end: [R; 3] = std::array::from_fn(|axis| now[axis] + (now[axis] - start[axis]) * steps_left);
    for axis in 0..3 {
        let along = end[axis] - start[axis];
        travel = max(travel, max(along, -along));
    }
    let margin_share = travel * R::from_f64(TRAVEL_MARGIN);
    let margin = margin + if margin_share > most { most } else { margin_share };
    let corner = |side: R, pick: fn(R, R) -> R| {
        let at = |axis: usize| pick(pick(start[axis], now[axis]), end[axis]) + margin * side;
        Row4([at(0), at(1), at(2), R::ZERO])
    };
    [corner(-R::ONE, min), corner(R::ONE, max)]
}

/// The square of the diagonal of a bound, in square metres.
#[inline(always)]
pub fn squared_diagonal<R: Real>([low, high]: &MotionBox<R>) -> R {
    let diagonal = sub(high.xyz(), low.xyz());
    dot(diagonal, diagonal)
}

/// How far a bound extends beyond an older one, in metres: the sum over all axes.
pub fn box_growth<R: Real>(old: &MotionBox<R>, new: &MotionBox<R>) -> R {
    let of_axis = |axis: usize| {
        let beyond = max(old[0].0[axis] - new[0].0[axis], new[1].0[axis] - old[1].0[axis]);
        max(beyond, R::ZERO)
    };
    of_axis(0) + of_axis(1) + of_axis(2)
}

/// Whether one bound contains another.
pub fn box_within<R: Real>(inner: &MotionBox<R>, outer: &MotionBox<R>) -> bool {
    (0..3).all(|axis| outer[0].0[axis] <= inner[0].0[axis] && inner[1].0[axis] <= outer[1].0[axis])
}

/// Whether a bound contains a displacement; `frame_motion` is the motion of the moving frame.
pub fn box_contains<R: Real>([low, high]: &MotionBox<R>, now: [R; 3], frame_motion: [R; 3]) -> bool {
    let now = sub(now, frame_motion);
    (0..3).all(|axis| low.0[axis] <= now[axis] && now[axis] <= high.0[axis])
}

fn min<R: Real>(a: R, b: R) -> R {
    if b < a { b } else { a }
}

fn max<R: Real>(a: R, b: R) -> R {
    if b > a { b } else { a }
}
