//! Bounce: what hit something leaves it with part of its speed, once the velocities of a step are known.

use crate::contact::bounce::{Bounce, Hit};
use crate::contact::cloth::Mutual;
use crate::contact::cloth_pass::motion;
use crate::contact::collider_pass::StepParts;
use crate::input::frame::FrameInput;
use crate::math::{Real, Row4, add};
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Solver};

impl<R: Real> Solver<R> {
    /// Gives back, after the step, part of the speed to what hit something that bounces.
    pub(crate) fn bounce(&mut self, frame: &FrameInput, schedule: &Schedule<R>, span: StepInterval) {
        // Slower than gravity makes things anew in every step nothing bounces.
        let slowest = R::from_f64(2.0 * frame.gravity.norm() * schedule.h);
        let rebound = Bounce { bounce: R::ZERO, slowest, h: R::from_f64(schedule.h) };
        self.bounce_off_ground(rebound, span);
        for cloth in 0..self.model.cloths.len() {
            self.bounce_off_colliders(frame, rebound, span.to, cloth);
        }
        self.bounce_off_cloth(schedule, rebound);
    }

    fn bounce_off_ground(&mut self, rebound: Bounce<R>, span: StepInterval) {
        for cloth in 0..self.model.cloths.len() {
            let Some(terms) = self.contact.ground_terms[cloth].filter(|terms| terms.bounces()) else {
                continue;
            };
            for row in self.model.cloths[cloth].points() {
                let (sides, hit) = (([row], [], &([R::ONE], [])), self.hit(row as usize));
                let thickness = terms.thickness_at(&self.contact.maps, sides, R::from_f64(terms.thickness));
                let rebound = Bounce { bounce: terms.bounce_at(&self.contact.maps, sides), ..rebound };
                let Some(plane) = self.contact.ground.in_step(span) else { return };
                let height = plane.height_now(row, hit.displacement);
                if rebound.bounce > R::ZERO && Bounce::touches(height, thickness) {
                    let surface = plane.velocity(row, hit.displacement, rebound.h);
                    let velocity = rebound.off(&hit, plane.normal(), surface);
                    self.set_velocity(row as usize, velocity);
                }
            }
        }
    }

    fn bounce_off_colliders(&mut self, frame: &FrameInput, rebound: Bounce<R>, end: f64, cloth: usize) {
        for index in 0..self.contact.pairs.len() {
            let collider = self.contact.pairs[index].collider;
            if self.contact.pairs[index].cloth != cloth {
                continue;
            }
            let terms = self.terms_of(cloth)[collider].filter(|terms| terms.bounces());
            let Some(terms) = terms else { continue };
            for active in 0..self.contact.pairs[index].active.point_face.len() {
                let Self { state, contact: ContactSystem { collider_states, pairs, maps, .. }, .. } = self;
                let pair = pairs[index].point_face[pairs[index].active.point_face[active] as usize];
                let (h, span) = (rebound.h.to_f64(), pairs[index].span);
                let view = StepParts { terms, maps, h, time: [end; 2], span };
                let touch = pair.touch(&view.of(state, &collider_states[collider]), frame.duration);
                let bounce = terms.bounce_at(maps, (pair.points, [], &([R::ONE], [])));
                if let Some((normal, surface)) = touch.filter(|_| bounce > R::ZERO) {
                    let row = pair.points[0] as usize;
                    let rebound = Bounce { bounce, ..rebound };
                    self.set_velocity(row, rebound.off(&self.hit(row), normal, surface));
                }
            }
        }
    }

    fn bounce_off_cloth(&mut self, schedule: &Schedule<R>, rebound: Bounce<R>) {
        let Self { state, pool, contact: ContactSystem { mutual: Some(mutual), maps, .. }, .. } = self else {
            return;
        };
        let Mutual { active, terms, .. } = mutual;
        if !terms.iter().flatten().any(|terms| terms.bounces()) {
            return;
        }
        let mut velocities = std::mem::take(&mut state.velocity);
        active.bounce(
            &motion(state, terms, maps, schedule.h),
            DisjointSlice::new(&mut velocities),
            rebound,
            pool,
        );
        state.velocity = velocities;
    }

    fn hit(&self, row: usize) -> Hit<R> {
        Hit {
            predicted: add(
                self.state.predicted[row].xyz(),
                add(self.state.led[row].xyz(), self.state.parted[row].xyz()),
            ),
            displacement: self.state.displacement[row].xyz(),
            velocity: self.state.velocity[row].xyz(),
        }
    }

    /// Sets the velocity of a point that is not pinned.
    fn set_velocity(&mut self, row: usize, [x, y, z]: [R; 3]) {
        if self.state.displacement[row].0[3] > R::ZERO {
            self.state.velocity[row] = Row4([x, y, z, R::ZERO]);
        }
    }
}
