//! Free points near colliders in a time step: sweeps over their contacts, certificates, fallbacks and restitution.

use crate::contact::collider::contact::{Certificate, ColliderContact, Outcome};
use crate::contact::collider::near_collider::NearCollider;
use crate::contact::collider::near_points::{NearPoint, NearPoints};
use crate::contact::collider::sweep::resolve_contacts;
use crate::contact::response::{CountedTouches, Impact, Restitution};
use crate::contact::time_step::ColliderStep;
use crate::math::{Real, Row4};
use crate::parallel::disjoint::DisjointSlice;

impl<R: Real> NearPoints<R> {
    /// One sweep over the contacts of the points near a collider; of one of them only, if it is given.
    pub fn resolve(
        &mut self,
        at: usize,
        only: Option<u32>,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) {
        for place in self.places(at, only) {
            let NearPoint { point, exit, .. } = self.near[place];
            if let Some(face) = exit {
                collider.push_outward(point, face, step);
                continue;
            }
            if self.near[place].passes {
                let [first, _] = self.near[place].contacts;
                self.contacts[first as usize].resolve(step).count(&self.counters);
                self.near[place].passes = false;
            }
            self.update(place, collider, step);
            let [first, end] = self.near[place].contacts;
            resolve_contacts(DisjointSlice::new(&mut self.contacts), first..end, step, &self.counters);
        }
    }

    /// Applies adhesion between every point near a collider and its nearest face.
    pub fn adhere(&mut self, at: usize, collider: &NearCollider<'_, R>, step: &ColliderStep<'_, R>) {
        for place in self.places(at, None).filter(|_| step.material.has_adhesion()) {
            self.update(place, collider, step);
            let gaps = self.contacts_of(place).iter().map(|contact| (contact.gap(step), contact));
            let nearest = gaps.reduce(|least, next| if next.0 < least.0 { next } else { least });
            nearest.into_iter().for_each(|(_, contact)| contact.adhere(step));
        }
    }

    fn contacts_of(&self, place: usize) -> &[ColliderContact<R, 1, 3>] {
        let [first, end] = self.near[place].contacts;
        &self.contacts[first as usize..end as usize]
    }

    /// Certifies the contacts of the points near a collider; of one of them only, if it is given. Lists the points with a
    /// contact without certificate, and returns the number of these contacts and of inseparable ones.
    pub fn certify(
        &mut self,
        at: usize,
        only: Option<u32>,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) -> [u64; 2] {
        let mut counts = [0; 2];
        for place in self.places(at, only) {
            if self.near[place].exit.is_some() {
                continue;
            }
            self.update(place, collider, step);
            let [first, end] = self.near[place].contacts.map(|at| at as usize);
            let before = counts[0];
            for contact in &mut self.contacts[first..end] {
                let certificate = contact.certify(step);
                counts[0] += u64::from(certificate == Certificate::Unproven);
                counts[1] += u64::from(certificate == Certificate::Inseparable);
            }
            if counts[0] > before {
                self.unproven.push(self.near[place].point);
            }
        }
        counts
    }

    /// The points that [`certify`](Self::certify) has listed wait for fallbacks, once each.
    pub fn begin_fallbacks(&mut self) {
        std::mem::swap(&mut self.unproven, &mut self.waiting);
        self.unproven.clear();
        self.waiting.sort_unstable_by(|a, b| b.cmp(a));
        self.waiting.dedup();
    }

    /// The next point that waits for fallbacks.
    pub fn next_unproven(&mut self) -> Option<u32> {
        self.unproven.clear();
        self.waiting.pop()
    }

    /// Moves a point with the surfaces of its contacts without certificate.
    pub fn revert(&mut self, at: usize, point: u32, step: &ColliderStep<'_, R>) {
        for place in self.places(at, Some(point)) {
            let [first, end] = self.near[place].contacts.map(|at| at as usize);
            for contact in &mut self.contacts[first..end] {
                if contact.certify(step) == Certificate::Unproven {
                    contact.move_with_surface(step);
                    Outcome::Reverted.count(&self.counters);
                }
            }
        }
    }

    /// Applies restitution to the velocities of the points that touch a collider at the end of the step; `frame` is the
    /// length of the frame in seconds.
    pub fn rebound(
        &self,
        at: usize,
        step: &ColliderStep<'_, R>,
        restitution: Restitution<R>,
        velocity: DisjointSlice<'_, Row4<R>>,
        frame: f64,
    ) {
        for place in self.places(at, None) {
            let touches = || self.contacts_of(place).iter().filter_map(|contact| contact.touch(step, frame));
            let Some(counted) = CountedTouches::of(touches()) else { continue };
            for touch in touches().filter(|touch| counted.contain(touch)) {
                let row = step.row(touch.row);
                if touch.coefficient <= R::ZERO || row.0[3] <= R::ZERO {
                    continue;
                }
                let restitution = restitution.at(&touch);
                // SAFETY: the point belongs to this task.
                #[allow(unsafe_code)]
                unsafe {
                    let impact = Impact {
                        predicted: step.writer.predicted(touch.row),
                        displacement: row.xyz(),
                        velocity: velocity.get(touch.row).xyz(),
                    };
                    let [x, y, z] = restitution.velocity_after(&impact, touch.normal, touch.surface);
                    velocity.set(touch.row, Row4([x, y, z, R::ZERO]));
                }
            }
        }
    }

    /// Takes up the smallest gap of the points near a collider at the end of a frame.
    pub fn measure(&mut self, at: usize, step: &ColliderStep<'_, R>) {
        let ratios = self.places(at, None).flat_map(|place| self.contacts_of(place)).map(|contact| {
            // The gap along the plane is no larger than the distance.
            let along = contact.gaps_above_plane(step)[1].to_f64() / step.material.thickness;
            if along < 1.0 { contact.gap_ratio(step) } else { along }
        });
        self.min_gap = ratios.fold(self.min_gap, f64::min);
    }
}
