//! The proof that two elements did not pass each other in a step, and what is done where there is none.

use super::near::{Motion, Near};
use crate::contact::apart::{Apart, apart};
use crate::contact::narrow::{Places, shortest};
use crate::math::{Real, Row4, add, dot, max, sub};

/// Share of the way to a plane that a point is let go: the rest is the gap that the next step starts with.
const ROOM_USED: f64 = 0.9;
/// Share of the grain by which two have to be apart at the start of a step: what was proven at the end of one has to be
/// apart at the start of the next, though the grain grows with the way that points have come.
pub(super) const AT_START: f64 = 0.25;
/// Least and most share of a gap that one side may use up when both come nearer.
const LEAST_SHARE: f64 = 0.05;

impl<R: Real, const N: usize, const M: usize> Near<R, N, M> {
    /// Whether it is certain that the two did not pass each other in this step. Takes up another direction
    /// if that proves it. What was not apart when the step began has nothing to lose.
    #[inline]
    pub fn prove(&mut self, step: &Motion<'_, R>) -> bool {
        if self.meeting.certified {
            return true;
        }
        let now = self.now(step);
        self.gap(&now) > grain(&now) || self.may_pass(step) || self.prove_otherwise(step, now)
    }

    /// Whether the scene lets the two pass through each other: a collision that is carried out in part is none that holds.
    #[cold]
    pub(super) fn may_pass(&self, step: &Motion<'_, R>) -> bool {
        let Some(terms) = self.terms(step) else { return true };
        let map = &step.maps.strength;
        let mut points = self.ours.iter().chain(&self.theirs);
        let all = terms.strength.iter().any(|&side| side < R::ONE);
        terms.is_weak(step.maps) && (all || points.any(|&point| map[point as usize] < R::ONE))
    }

    #[cold]
    fn prove_otherwise(&mut self, step: &Motion<'_, R>, now: Places<R, N, M>) -> bool {
        let before = self.before(step);
        let least = leasts(&now);
        if shortest(before).2 <= least[0] {
            return true;
        }
        match apart([&before, &now], least) {
            Some(Apart::Along(normal)) => self.normal = normal,
            Some(Apart::ByParts) => self.forget_side(),
            None => return false,
        }
        true
    }

    /// Forgets the direction: none holds for all of the step, and the next looks for one anew.
    pub(super) fn forget_side(&mut self) {
        self.normal = [R::ZERO; 3];
    }

    /// Whether it is certain that the two stay apart all through the step.
    pub(super) fn stays(&self, before: &Places<R, N, M>, now: &Places<R, N, M>) -> bool {
        apart([before, now], leasts(now)).is_some()
    }

    /// Stops the points that would pass a plane between the two, before it: each is taken back along its own
    /// way of this step. Both sides then stay on theirs, whatever else takes their points back farther.
    pub fn clip(&mut self, step: &Motion<'_, R>) {
        let (before, now) = (self.before(step), self.now(step));
        let (normal, _, _) = shortest(before);
        self.normal = normal;
        let most = |x: R, y: R| if y > x { y } else { x };
        let rear = before.1.iter().map(|&q| dot(normal, q)).fold(-R::ONE / R::MIN_DENOMINATOR, most);
        let front = -before.0.iter().map(|&x| -dot(normal, x)).fold(-R::ONE / R::MIN_DENOMINATOR, most);
        let came = |from: &[[R; 3]], to: &[[R; 3]], sign: R| {
            let each = from.iter().zip(to).map(|(&from, &to)| dot(normal, sub(to, from)) * sign);
            each.fold(R::ZERO, most)
        };
        let (ours, theirs) = (came(&before.0, &now.0, -R::ONE), came(&before.1, &now.1, R::ONE));
        let sum = ours + theirs;
        let share = if sum > R::ZERO { theirs / sum } else { R::from_f64(0.5) };
        let share = most(R::from_f64(LEAST_SHARE), share);
        let share = -most(-share, -R::from_f64(1.0 - LEAST_SHARE));
        let plane = rear + (front - rear) * share;
        let grain = grain(&now);
        for k in 0..N {
            let heights = [dot(normal, before.0[k]) - plane, dot(normal, now.0[k]) - plane];
            self.stop_before(step, self.ours[k], heights, grain);
        }
        for k in 0..M {
            let heights = [plane - dot(normal, before.1[k]), plane - dot(normal, now.1[k])];
            self.stop_before(step, self.theirs[k], heights, grain);
        }
    }

    /// Takes a point back to before a plane, given its height above it at both ends of the step; no nearer than what
    /// can be told from touching.
    fn stop_before(&self, step: &Motion<'_, R>, point: u32, [before, now]: [R; 2], grain: R) {
        let mut row = step.row(point);
        let room = max(before * R::from_f64(1.0 - ROOM_USED), grain);
        if now >= room || before - now <= R::MIN_DENOMINATOR || row.0[3] <= R::ZERO {
            return;
        }
        let share = max((before - room) / (before - now), R::ZERO);
        let start = step.start(point);
        for axis in 0..3 {
            row.0[axis] = start[axis] + (row.0[axis] - start[axis]) * share;
        }
        step.mover.put(point, row);
    }

    /// Lets all points of the two go nowhere in this step, or all along with one that is `held`: what moves as one
    /// passes no part of itself.
    pub fn stop(&mut self, step: &Motion<'_, R>, held: &mut [bool]) {
        let points = || self.ours.iter().chain(&self.theirs).copied();
        let carrier = points().find(|&point| held[point as usize]);
        let motion = carrier.map_or([R::ZERO; 3], |point| sub(step.row(point).xyz(), step.start(point)));
        for point in points() {
            let mut row = step.row(point);
            if row.0[3] > R::ZERO {
                let [x, y, z] = add(step.start(point), motion);
                row = Row4([x, y, z, row.0[3]]);
                step.mover.put(point, row);
            }
            held[point as usize] = true;
        }
    }
}

/// What a gap has to be at the start and at the end of a step to be one.
fn leasts<R: Real, const N: usize, const M: usize>(now: &Places<R, N, M>) -> [R; 2] {
    let grain = grain(now);
    [grain * R::from_f64(AT_START), grain]
}

/// What a gap may be off by, by rounding, in metres: places are reckoned from anchors, so it goes by how far the points
/// are from there, and by how large the elements are.
#[inline(always)]
pub(super) fn grain<R: Real, const N: usize, const M: usize>(at: &Places<R, N, M>) -> R {
    let size = |[x, y, z]: [R; 3]| max(x, -x) + max(y, -y) + max(z, -z);
    (size(at.0[0]) + size(at.1[0])) * (R::EPSILON * R::from_f64(4.0))
}
