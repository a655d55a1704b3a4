//! Motion bounds of points among colliders: a box that contains a point's displacement over a window of time steps.

use crate::math::{Lanes, Real, Row4, max, scale};

/// Distance that anything may move in a candidate interval, in edge lengths.
pub const MAX_TRAVEL: f64 = 2.0;

/// Motion bound: low and high corner of a point's displacement in metres, relative to the moving frame.
pub type MotionBox<R> = [Row4<R>; 2];

/// The motion bounds of a cloth's points.
#[derive(Debug, Clone, Copy)]
pub struct MotionBounds<'a, R> {
    /// One for each row from `first` on.
    pub boxes: &'a [MotionBox<R>],
    /// The row of the first bound.
    pub first: u32,
    /// Motion of the moving frame in a frame, in metres.
    pub frame_travel: [R; 3],
}

impl<R: Real> MotionBounds<'_, R> {
    /// The bound of one point.
    #[inline(always)]
    pub fn of(&self, point: u32) -> MotionBox<R> {
        self.boxes[(point - self.first) as usize]
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

/// The same as the row of a displacement.
#[inline(always)]
pub fn travel_row<R: Real>(drift: [R; 3], time: f64) -> Row4<R> {
    let [x, y, z] = travel_at(drift, time);
    Row4([x, y, z, R::ZERO])
}

/// Margin of a bound on all sides, as a share of the point's predicted motion.
const TRAVEL_MARGIN: f64 = 0.25;

/// Predicts a bound: it contains the start and the end of this step, and the extrapolation of this motion over
/// `steps_left` steps, with a margin. The motion contributes at most `most` to the margin. The fourth lanes do not count.
#[inline(always)]
pub fn predict_box<R: Real>(
    start: R::Lanes,
    now: R::Lanes,
    steps_left: R,
    [margin, most]: [R; 2],
) -> MotionBox<R> {
    let end = now + (now - start) * R::Lanes::splat(steps_left);
    let [x, y, z, _] = (end - start).to_array();
    let travel = [x, y, z].into_iter().fold(R::ZERO, |travel, along| max(travel, max(along, -along)));
    let margin_share = travel * R::from_f64(TRAVEL_MARGIN);
    let margin = R::Lanes::splat(margin + if margin_share > most { most } else { margin_share });
    let corner = |lanes: R::Lanes| {
        let [x, y, z, _] = lanes.to_array();
        Row4([x, y, z, R::ZERO])
    };
    [corner(start.least(now).least(end) - margin), corner(start.most(now).most(end) + margin)]
}

/// How far a bound extends beyond an older one, in metres: the sum over all axes.
#[inline(always)]
pub fn box_growth<R: Real>(old: &MotionBox<R>, new: &MotionBox<R>) -> R {
    let [old, new] = [old, new].map(|corners| corners.map(Row4::lanes));
    let beyond = (old[0] - new[0]).most(new[1] - old[1]).most(R::Lanes::splat(R::ZERO));
    let [x, y, z, _] = beyond.to_array();
    x + y + z
}

/// Whether one bound contains another.
#[inline(always)]
pub fn box_within<R: Real>(inner: &MotionBox<R>, outer: &MotionBox<R>) -> bool {
    let [inner, outer] = [inner, outer].map(|corners| corners.map(Row4::lanes));
    (outer[0] - inner[0]).above_zero() | (inner[1] - outer[1]).above_zero() == 0
}

/// Whether a bound contains a displacement; `frame_motion` is the motion of the moving frame. The fourth lanes do not count.
#[inline(always)]
pub fn box_contains<R: Real>(bound: &MotionBox<R>, now: Row4<R>, frame_motion: Row4<R>) -> bool {
    let ([low, high], now) = (bound.map(Row4::lanes), now.lanes() - frame_motion.lanes());
    ((low - now).above_zero() | (now - high).above_zero()) & 0b111 == 0
}
