//! Bounce between two elements that can both be moved.

use super::near::{Motion, Near};
use crate::contact::bounce::{Bounce, Hit};
use crate::contact::narrow::shortest;
use crate::math::{Real, Row4, add, scale, sub};
use crate::parallel::disjoint::DisjointSlice;

impl<R: Real, const N: usize, const M: usize> Near<R, N, M> {
    /// Gives both sides back part of the speed with which they came together, if they touch at the end of the step. What
    /// one gains in momentum the other loses. Whether they did.
    pub fn bounce(
        &self,
        step: &Motion<'_, R>,
        velocities: DisjointSlice<'_, Row4<R>>,
        rebound: Bounce<R>,
    ) -> bool {
        let Some(terms) = self.terms(step).filter(|terms| terms.bounces()) else { return false };
        let (normal, weights, distance) = shortest(self.now(step));
        let thickness = self.thickness_at(step.terms, step.maps, &weights);
        let bounce = terms.bounce_at(step.maps, self.sides(&weights));
        if bounce <= R::ZERO || !Bounce::touches(distance, thickness) {
            return false;
        }
        #[allow(unsafe_code)]
        // SAFETY: tasks of a phase share no block, and a contact's points are in its task's blocks.
        let velocity = |point: u32| unsafe { velocities.get(point) };
        let predicted = |point: u32| step.mover.predicted(point);
        let hit = Hit {
            predicted: self.between(&weights, predicted),
            displacement: self.between(&weights, |point| step.row(point).xyz()),
            velocity: self.between(&weights, |point| velocity(point).xyz()),
        };
        let gained = sub(Bounce { bounce, ..rebound }.off(&hit, normal, [R::ZERO; 3]), hit.velocity);
        if gained == [R::ZERO; 3] {
            return false;
        }
        let (b, c) = &weights;
        let ours = (0..N).map(|k| (self.ours[k], b[k], b[k] * terms.mobility[0]));
        let theirs = (0..M).map(|k| (self.theirs[k], c[k], -(c[k] * terms.mobility[1])));
        let each = ours
            .chain(theirs)
            .map(|(point, weight, mobility)| (point, weight, mobility * step.row(point).0[3]));
        let larger = |x: R| if x < R::ZERO { -x } else { x };
        let all: R = each.clone().map(|(_, weight, mobility)| weight * larger(mobility)).sum();
        if all <= R::MIN_DENOMINATOR {
            return false;
        }
        for (point, _, mobility) in each {
            let row = velocity(point);
            let [x, y, z] = add(row.xyz(), scale(gained, mobility / all));
            // SAFETY: as above.
            #[allow(unsafe_code)]
            unsafe {
                velocities.set(point, Row4([x, y, z, row.0[3]]));
            }
        }
        true
    }

    /// What a column says of ours less what it says of theirs, at the contact.
    fn between(&self, (b, c): &([R; N], [R; M]), of: impl Fn(u32) -> [R; 3]) -> [R; 3] {
        let ours = (0..N).map(|k| scale(of(self.ours[k]), b[k])).fold([R::ZERO; 3], add);
        (0..M).map(|k| scale(of(self.theirs[k]), c[k])).fold(ours, sub)
    }
}
