//! A collision pass of the solver: find pairs when none hold any more, then keep them all apart.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::Vector3;

use crate::collision::contact::Step;
use crate::collision::pairs::{Cover, foresee, is_foreseen};
use crate::collision::plane::Ground;
use crate::collision::resolve::{Tally, resolve};
use crate::columns::Shared;
use crate::frame::FrameInput;
use crate::scalar::Real;
use crate::schedule::Schedule;
use crate::solver::Solver;

/// Thickness in metres below which none is kept: contact needs some room to prove that nothing passed.
const LEAST_THICKNESS: f64 = 1e-5;
/// Share of the thickness by which a point may stray from what is foreseen before pairs are found anew.
const STRAY: f64 = 0.5;

impl<R: Real> Solver<R> {
    /// One pass over all contacts: the ground plane, then colliders.
    pub(crate) fn collide(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        step: u32,
        tally: &mut Tally,
    ) {
        self.lift_from_ground(frame, schedule, tally);
        let steps = f64::from(schedule.substeps * schedule.steps);
        let time = [f64::from(step) / steps, f64::from(step + 1) / steps];
        let end_of_substep = f64::from(step / schedule.steps + 1) / f64::from(schedule.substeps);
        for index in 0..self.pairs.len() {
            let (cloth, collider) = (self.pairs[index].cloth, self.pairs[index].collider);
            if !(frame.cloths[cloth].collide && frame.colliders[collider].collide) {
                self.pairs[index].clear();
                continue;
            }
            let span = [time[0], end_of_substep];
            if time[1] > self.pairs[index].span[1] || self.has_strayed(cloth) {
                self.find_pairs(frame, cloth, schedule, span, tally);
            }
            let Self { cloths: _, state, collider_states, pairs, team, .. } = self;
            let list = &mut pairs[index];
            let view = StepParts { frame, cloth, collider, h: schedule.h, time, span: list.span };
            let step = view.of(state, &collider_states[collider]);
            resolve(list, &step, team, tally);
        }
    }

    /// Finds the pairs of a cloth with every collider, for what is foreseen from now to the end of the span.
    fn find_pairs(
        &mut self,
        frame: &FrameInput,
        cloth: usize,
        schedule: &Schedule<R>,
        span: [f64; 2],
        tally: &mut Tally,
    ) {
        self.foresee_points(frame, cloth, schedule, span);
        let Self { cloths, colliders, state, collider_states, pairs, cover, .. } = self;
        for list in
            pairs.iter_mut().filter(|list| list.cloth == cloth && frame.colliders[list.collider].collide)
        {
            let collider = list.collider;
            let view = StepParts { frame, cloth, collider, h: schedule.h, time: [span[0]; 2], span };
            collider_states[collider].fit(&colliders[collider].skin, span);
            let step = view.of(state, &collider_states[collider]);
            list.find(&cloths[cloth], (&colliders[collider], &collider_states[collider]), cover, &step);
            *tally.pairs.get_mut() += list.len() as u64;
        }
        *tally.broad_phases.get_mut() += 1;
    }

    /// Writes the cover of a cloth's points.
    fn foresee_points(&mut self, frame: &FrameInput, cloth: usize, schedule: &Schedule<R>, span: [f64; 2]) {
        let Self { cloths, state, cover, team, .. } = self;
        let left = (span[1] - span[0]) * frame.duration;
        let margin =
            frame.gravity.norm() * left * left + STRAY * frame.cloths[cloth].thickness.max(LEAST_THICKNESS);
        let (margin, h) = (R::from_f64(margin), R::from_f64(schedule.h));
        let steps_left = R::from_f64(left / schedule.h - 1.0);
        let columns = Shared::new(cover);
        let blocks = &cloths[cloth].blocks;
        team.phase(blocks.len(), |block| {
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            let run: &mut [Cover<R>] = unsafe { columns.run(blocks.range(block)) };
            for (cover, row) in run.iter_mut().zip(blocks.range(block)) {
                let (p, v) = (state.predicted[row as usize].0, state.velocity[row as usize].0);
                let start = std::array::from_fn(|axis| p[axis] - v[axis] * h);
                *cover = foresee(start, state.displacement[row as usize].xyz(), steps_left, margin);
            }
        });
    }

    /// Whether a point of the cloth is not where it was foreseen to be.
    fn has_strayed(&self, cloth: usize) -> bool {
        let strayed = AtomicBool::new(false);
        let blocks = &self.cloths[cloth].blocks;
        self.team.phase(blocks.len(), |block| {
            let mut rows = blocks.range(block).map(|row| row as usize);
            if !rows.all(|row| is_foreseen(&self.cover[row], self.state.displacement[row].xyz())) {
                strayed.store(true, Ordering::Relaxed);
            }
        });
        strayed.into_inner()
    }

    /// Pairs no longer hold; the next pass finds them anew.
    pub(crate) fn forget_pairs(&mut self) {
        self.pairs.iter_mut().for_each(|list| list.span = [0.0, 0.0]);
    }

    fn lift_from_ground(&mut self, frame: &FrameInput, schedule: &Schedule<R>, tally: &Tally) {
        let Some(ground) = &frame.plane else { return };
        let Self { cloths, state, heights, team, .. } = self;
        let normal = ground.normal.try_normalize(0.0).unwrap_or_else(Vector3::y);
        let displacement = Shared::new(&mut state.displacement);
        let predicted = Shared::new(&mut state.predicted);
        let velocity = Shared::new(&mut state.velocity);
        for (cloth, settings) in cloths.iter().zip(&frame.cloths).filter(|(_, settings)| settings.collide) {
            let ground = Ground {
                displacement,
                predicted,
                velocity,
                height: heights,
                normal: [normal.x, normal.y, normal.z].map(R::from_f64),
                thickness: R::from_f64(settings.thickness),
                friction: R::from_f64(settings.friction + ground.friction),
                h: R::from_f64(schedule.h),
            };
            team.phase(cloth.blocks.len(), |block| {
                tally.contacts.fetch_add(ground.lift(cloth.blocks.range(block)), Ordering::Relaxed);
            });
        }
    }
}

/// What a [`Step`] is made of, besides the state.
pub(crate) struct StepParts<'a> {
    pub(crate) frame: &'a FrameInput,
    pub(crate) cloth: usize,
    pub(crate) collider: usize,
    pub(crate) h: f64,
    pub(crate) time: [f64; 2],
    pub(crate) span: [f64; 2],
}

impl StepParts<'_> {
    pub(crate) fn of<'s, R: Real>(
        &self,
        state: &'s mut crate::state::State<R>,
        collider: &'s crate::collision::pairs::ColliderState,
    ) -> Step<'s, R> {
        let (cloth, theirs) = (&self.frame.cloths[self.cloth], &self.frame.colliders[self.collider]);
        Step {
            displacement: Shared::new(&mut state.displacement),
            predicted: Shared::new(&mut state.predicted),
            velocity: Shared::new(&mut state.velocity),
            anchors: &state.anchor,
            collider: [&collider.start, &collider.end],
            time: self.time,
            span: self.span,
            h: R::from_f64(self.h),
            thickness: R::from_f64((cloth.thickness + theirs.thickness).max(LEAST_THICKNESS)),
            friction: R::from_f64(cloth.friction + theirs.friction),
        }
    }
}
