//! A contact pushes its two elements apart.

use super::near::{Motion, Near};
use super::proof::{AT_START, grain};
use super::swept::{first_touch, passes_beside};
use crate::contact::friction::Push;
use crate::contact::narrow::{Places, gap_along, shortest, weigh};
use crate::contact::terms::Terms;
use crate::math::{Real, add, dot, max, scale, sub};

/// Parts in a million of the thickness that count as touching: without it a contact at rest would push
/// for ever at its last bit.
const TOUCH: f64 = 1e-6;

impl<R: Real, const N: usize, const M: usize> Near<R, N, M> {
    /// Pushes the two apart if they are nearer than their thickness; whether they were.
    #[inline]
    pub fn resolve(&mut self, step: &Motion<'_, R>) -> bool {
        let now = self.now(step);
        let touching = R::from_f64(1.0 - TOUCH);
        let gap = self.gap(&now);
        if gap >= self.meeting.thickness * step.squeeze * touching {
            return false;
        }
        let before = self.before(step);
        if self.meeting.is_swept
            && let Some(normal) = first_touch(&before, &now, self.kept_at(step, &before))
        {
            self.normal = normal;
            self.push_back(step, &before, &now);
            return true;
        }
        let (normal, weights, distance) = shortest(now);
        if distance > R::ZERO && gap_along(normal, &before) > grain(&now) * R::from_f64(AT_START) {
            // Apart along this line at both ends of the step: it is theirs from now on.
            self.normal = normal;
            let kept = self.kept(step, &weights);
            if distance >= kept * touching {
                return false;
            }
            self.push(step, &weights, &before, [kept, kept - distance]);
            return true;
        }
        if self.meeting.is_swept
            && let Some(normal) = passes_beside(&before, &now, self.kept_at(step, &before))
        {
            self.normal = normal;
            return false;
        }
        if self.stays(&before, &now) {
            self.normal = normal;
            let kept = self.kept(step, &weights);
            if distance < kept * touching {
                self.push(step, &weights, &before, [kept, kept - distance]);
            }
            self.forget_side();
            return distance < kept * touching;
        }
        if self.may_pass(step) {
            // They are on the other side from now on.
            self.normal = normal;
            let kept = self.kept(step, &weights);
            self.push(step, &weights, &before, [kept, max(kept - distance, R::ZERO)]);
            return true;
        }
        // They may have passed. Back to the side that they were on.
        self.push_back(step, &before, &now);
        true
    }

    /// Pushes the two apart along the contact's direction, where they were nearest when the step began.
    fn push_back(&mut self, step: &Motion<'_, R>, before: &Places<R, N, M>, now: &Places<R, N, M>) {
        let (first, weights, _) = shortest(*before);
        if self.normal == [R::ZERO; 3] {
            self.normal = first;
        }
        let kept = self.kept(step, &weights);
        let depth = kept - dot(self.normal, self.line(now, &weights));
        if depth > R::ZERO {
            self.push(step, &weights, before, [kept, depth]);
        }
    }

    /// Moves both sides by `depth` in all, where `kept` is to be kept, each by its mobility, with friction.
    fn push(
        &mut self,
        step: &Motion<'_, R>,
        weights: &([R; N], [R; M]),
        before: &Places<R, N, M>,
        [kept, depth]: [R; 2],
    ) {
        let Some(terms) = self.terms(step) else { return };
        let line_before = self.line(before, weights);
        // What both sides can yield to comes to a balance by its velocities: nothing that was led is given back here.
        let mut push = Push::new(kept, [dot(self.normal, line_before), kept - depth], R::ZERO, step.h);
        if terms.is_weak(step.maps) {
            push = push.times(terms.strength_at(step.maps, self.sides(weights)));
        }
        let along = [push.length(), push.led].map(|length| scale(self.normal, length));
        let friction = terms.friction_at(step.maps, self.sides(weights));
        let rub = if friction > R::ZERO {
            self.rub(
                step,
                weights,
                line_before,
                along[0],
                [push.pressed, push.led].map(|most| most * friction),
            )
        } else {
            [[R::ZERO; 3]; 2]
        };
        self.part(step, terms, weights, add(along[0], rub[0]), add(along[1], rub[1]));
    }

    /// Moves the two by `moved` from each other, each side by its mobility; `led` is the part of it that is not to
    /// become velocity.
    pub(super) fn part(
        &self,
        step: &Motion<'_, R>,
        terms: &Terms<R>,
        (b, c): &([R; N], [R; M]),
        moved: [R; 3],
        led: [R; 3],
    ) {
        let mobile =
            |point: u32, weight: R, side: usize| step.row(point).0[3] * weight * terms.mobility[side];
        let ours: [R; N] = std::array::from_fn(|k| mobile(self.ours[k], b[k], 0));
        let theirs: [R; M] = std::array::from_fn(|k| mobile(self.theirs[k], c[k], 1));
        let all = (0..N).map(|k| ours[k] * b[k]).sum::<R>() + (0..M).map(|k| theirs[k] * c[k]).sum::<R>();
        if all <= R::MIN_DENOMINATOR {
            return;
        }
        let part = R::ONE / all;
        for k in 0..N {
            self.shift(step, self.ours[k], ours[k] * part, moved, led);
        }
        for k in 0..M {
            self.shift(step, self.theirs[k], -(theirs[k] * part), moved, led);
        }
    }

    #[inline(always)]
    fn shift(&self, step: &Motion<'_, R>, point: u32, part: R, moved: [R; 3], led: [R; 3]) {
        let mut row = step.row(point);
        for axis in 0..3 {
            row.0[axis] += moved[axis] * part;
        }
        step.mover.part(point, row, scale(led, part));
    }

    /// The line from the contact on theirs to the contact on ours.
    #[inline(always)]
    pub(super) fn line(&self, at: &Places<R, N, M>, (b, c): &([R; N], [R; M])) -> [R; 3] {
        sub(weigh(at.0, *b), weigh(at.1, *c))
    }
}
