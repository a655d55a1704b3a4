//! The certificate of a contact among cloths, and its first fallback in the safeguard: truncation at a division plane.

use crate::contact::ccd::{Separation, separated_throughout};
use crate::contact::cloth::contact::{ClothContact, ClothStep};
use crate::contact::narrow_phase::{ElementPositions, shortest_line};
use crate::math::{Real, add, dot, max, sub};

/// Share of the distance to a division plane that a point may move: the rest is the gap at the start of the next
/// step.
const MAX_PLANE_APPROACH: f64 = 0.9;
/// Factor on the rounding error by which two elements must be separated at the start of a step. A pair that is
/// certified at the end of one step must be separated at the start of the next, though the rounding error grows
/// with displacement.
pub(super) const START_TOLERANCE: f64 = 0.25;
/// Smallest share of a gap on either side of a division plane.
const MIN_PLANE_SHARE: f64 = 0.05;

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// Certifies that the two did not pass through each other in this step; may set another normal that proves
    /// it. A pair that was not separated at the start of the step is accepted.
    #[inline]
    pub fn certify(&mut self, step: &ClothStep<'_, R>) -> bool {
        if self.is_certified() || self.certainly_exceeds(step, R::ZERO) {
            return true;
        }
        let now = self.end_positions(step);
        self.gap(&now) > rounding_error(&now)
            || self.may_interpenetrate(step)
            || self.certify_along_other_line(step, now)
    }

    /// Whether the scene lets the two pass through each other, because collisions are carried out in part.
    #[cold]
    pub(super) fn may_interpenetrate(&self, step: &ClothStep<'_, R>) -> bool {
        let Some(material) = self.material(step) else { return true };
        let map = &step.material_maps.strength;
        let mut points = self.ours.iter().chain(&self.theirs);
        let all = material.strength.iter().any(|&side| side < R::ONE);
        material.is_partial(step.material_maps) && (all || points.any(|&point| map[point as usize] < R::ONE))
    }

    #[cold]
    fn certify_along_other_line(&mut self, step: &ClothStep<'_, R>, now: ElementPositions<R, N, M>) -> bool {
        let before = self.start_positions(step);
        let least = min_gaps(&now);
        if shortest_line(before).2 <= least[0] {
            return true;
        }
        match separated_throughout([&before, &now], least) {
            Some(Separation::Along(normal)) => self.normal = normal,
            Some(Separation::Subdivided) => self.clear_normal(),
            None => return false,
        }
        true
    }

    /// Clears the normal: none holds for all of the step, and the next step looks for one.
    pub(super) fn clear_normal(&mut self) {
        self.normal = [R::ZERO; 3];
    }

    /// Whether the two are separated throughout the step.
    pub(super) fn separated_throughout(
        &self,
        before: &ElementPositions<R, N, M>,
        now: &ElementPositions<R, N, M>,
    ) -> bool {
        separated_throughout([before, now], min_gaps(now)).is_some()
    }

    /// Planar divide and truncate: places a plane between the two elements at a share by approach speed, and
    /// scales back the motion of each point that would cross it. Both sides then stay on theirs, even if other
    /// contacts scale their points back farther. The plane moves with the island of the two, so that it is not braked.
    pub fn truncate(&mut self, step: &ClothStep<'_, R>) {
        let drift = self.drift(step);
        let before = self.start_positions(step);
        let now = self.positions(step.origins, |point| sub(step.row(point).xyz(), drift));
        let (normal, _, _) = shortest_line(before);
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
        let share = most(R::from_f64(MIN_PLANE_SHARE), share);
        let share = -most(-share, -R::from_f64(1.0 - MIN_PLANE_SHARE));
        let plane = rear + (front - rear) * share;
        let rounding_error = rounding_error(&now);
        for k in 0..N {
            let heights = [dot(normal, before.0[k]) - plane, dot(normal, now.0[k]) - plane];
            self.truncate_point(step, self.ours[k], heights, rounding_error);
        }
        for k in 0..M {
            let heights = [plane - dot(normal, before.1[k]), plane - dot(normal, now.1[k])];
            self.truncate_point(step, self.theirs[k], heights, rounding_error);
        }
    }

    /// Scales back the motion of a point so that it stops before a plane, given its heights above it at both ends
    /// of the step. The remaining height exceeds rounding error.
    fn truncate_point(&self, step: &ClothStep<'_, R>, point: u32, [before, now]: [R; 2], rounding_error: R) {
        let mut row = step.row(point);
        let clearance = max(before * R::from_f64(1.0 - MAX_PLANE_APPROACH), rounding_error);
        if now >= clearance || before - now <= R::MIN_DENOMINATOR || row.0[3] <= R::ZERO {
            return;
        }
        let share = max((before - clearance) / (before - now), R::ZERO);
        let start = add(step.start(point), self.drift(step));
        for axis in 0..3 {
            row.0[axis] = start[axis] + (row.0[axis] - start[axis]) * share;
        }
        // What moved it without velocity before does not become velocity.
        step.writer.truncate(point, row, share);
    }
}

/// The smallest gaps at the start and at the end of a step that exceed rounding error.
fn min_gaps<R: Real, const N: usize, const M: usize>(now: &ElementPositions<R, N, M>) -> [R; 2] {
    let rounding_error = rounding_error(now);
    [rounding_error * R::from_f64(START_TOLERANCE), rounding_error]
}

/// Rounding error of a gap in metres. Positions are relative to anchors, so it grows with displacement and
/// element size.
#[inline(always)]
pub(super) fn rounding_error<R: Real, const N: usize, const M: usize>(at: &ElementPositions<R, N, M>) -> R {
    let size = |[x, y, z]: [R; 3]| max(x, -x) + max(y, -y) + max(z, -z);
    (size(at.0[0]) + size(at.1[0])) * (R::EPSILON * R::from_f64(4.0))
}
