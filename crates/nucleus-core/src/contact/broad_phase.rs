//! Broad phase of cloth and colliders: which pairs can touch in a time step, foreseen, found, and watched.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::contact::collider_pass::StepParts;
use crate::contact::foresee::{Foreseen, foresee, gone, is_foreseen, is_within};
use crate::contact::pairs::PairList;
use crate::contact::resolve::Tally;
use crate::contact::search::Search;
use crate::contact::terms::{LEAST_THICKNESS, Terms};
use crate::input::frame::{ColliderFrame, FrameInput};
use crate::math::{Real, dot, sub};
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Model, Solver};

/// Shares of the thickness by which a point may stray from what is foreseen, in a window and in a substep.
const STRAY_NEAR: f64 = 0.05;
const STRAY_FAR: f64 = 0.5;
/// Edge lengths that anything may go while one list of pairs holds.
const MAX_COORDINATE: f64 = 2.0;
/// Time steps for which active pairs are picked.
const WINDOW: f64 = 8.0;

impl<R: Real> Solver<R> {
    /// Makes sure that the active pairs of a cloth are all that can touch in this step. As long as every
    /// point stays where it was foreseen to, nothing needs to be done.
    pub(crate) fn watch_pairs(
        &mut self,
        frame: &FrameInput,
        cloth: usize,
        schedule: &Schedule<R>,
        times: StepInterval,
        tally: &mut Tally,
    ) {
        let step = [times.from, times.to];
        if step[1] <= self.contact.windows[cloth][1] + 1e-9 && !self.has_strayed(cloth, step[1]) {
            return;
        }
        if step[1] > self.contact.spans[cloth][1] + 1e-9 {
            self.begin_span(frame, cloth, times);
        }
        let rest = [step[0], self.contact.spans[cloth][1].min(self.horizon(frame, cloth, times))];
        let window = [step[0], rest[1].min(step[0] + (step[1] - step[0]) * WINDOW)];
        if self.foresee_points(frame, cloth, schedule, step, [window, rest]) {
            self.find_pairs(cloth, schedule, step[0], tally);
        }
        self.contact.windows[cloth] = window;
        let Self {
            pool,
            model: Model { cloths, colliders, .. },
            contact: ContactSystem { pairs, near, drifts, terms, .. },
            ..
        } = self;
        let foreseen = Foreseen { cover: near, drift: drifts[cloth] };
        for list in pairs.iter_mut().filter(|list| list.cloth == cloth) {
            if let Some(terms) = &terms[cloth * colliders.len() + list.collider] {
                let thickness = R::from_f64(terms.thickness);
                list.activate(&foreseen, window, thickness, terms.reach, &cloths[cloth].blocks, pool);
            }
        }
    }

    /// Sets the span that pairs are found for. A collider on its way needs a new list for each stretch of it;
    /// around colliders at rest a pair holds for as long as its points stay where they are foreseen.
    fn begin_span(&mut self, frame: &FrameInput, cloth: usize, times: StepInterval) {
        let touching = |(_, theirs): &(&ColliderState, &ColliderFrame)| theirs.collide;
        let mut colliders = self.contact.collider_states.iter().zip(&frame.colliders).filter(touching);
        if colliders.any(|(collider, _)| collider.moves) {
            self.contact.spans[cloth] = [times.from, self.horizon(frame, cloth, times)];
            self.contact.drifts[cloth] = self.drift(cloth).map(R::from_f64);
            let points = self.model.cloths[cloth].points();
            self.contact.strayed[points.start as usize..points.end as usize].fill(true);
        } else {
            self.contact.spans[cloth] = [0.0, 1.0];
            self.contact.drifts[cloth] = [R::ZERO; 3];
        }
    }

    /// The drift of the max_speed collider that a cloth meets, in metres in a frame: what it takes along stays where it is
    /// for one who goes with it, and whom that one sees moving has room on its way.
    fn drift(&self, cloth: usize) -> [f64; 3] {
        let met = self
            .contact
            .collider_states
            .iter()
            .zip(self.terms_of(cloth))
            .filter(|(_, terms)| terms.is_some());
        let max_speed = met
            .map(|(collider, _)| collider.drift)
            .reduce(|most, drift| if drift.norm_squared() > most.norm_squared() { drift } else { most });
        max_speed.unwrap_or_default().into()
    }

    /// How far ahead is foreseen: to the end of the substep, or as long as nothing goes farther than a few
    /// edges. Boxes over a longer way would meet everything on it.
    fn horizon(&self, frame: &FrameInput, cloth: usize, times: StepInterval) -> f64 {
        let (step, end_of_substep) = ([times.from, times.to], times.end_of_substep);
        let model = &self.model.cloths[cloth];
        let points = model.points();
        let rows = &self.state.velocity[points.start as usize..points.end as usize];
        let squares = rows.iter().map(|row| dot(row.xyz(), row.xyz()).to_f64());
        let max_speed = squares.fold(0.0, f64::max).sqrt() * frame.duration;
        let ways =
            self.contact.collider_states.iter().zip(&frame.colliders).filter(|(_, theirs)| theirs.collide);
        let farthest = ways.map(|(collider, _)| collider.way).fold(max_speed, f64::max);
        let length = step[1] - step[0];
        let steps = (MAX_COORDINATE * model.edge_length / (farthest * length)).floor().max(1.0);
        // A step more than it takes to the end is no step.
        if step[0] + steps * length >= end_of_substep - length / 2.0 {
            end_of_substep
        } else {
            step[0] + steps * length
        }
    }

    /// Finds the pairs of a cloth with every collider, for all points of which something new is foreseen.
    fn find_pairs(&mut self, cloth: usize, schedule: &Schedule<R>, now: f64, tally: &mut Tally) {
        let Self {
            state,
            pool,
            model: Model { cloths, colliders, .. },
            contact: ContactSystem { collider_states, pairs, far, spans, drifts, strayed, terms, maps, .. },
            ..
        } = self;
        let span = spans[cloth];
        let foreseen = Foreseen { cover: far, drift: drifts[cloth] };
        let mut freed = Vec::new();
        for list in pairs.iter_mut().filter(|list| list.cloth == cloth) {
            let collider = list.collider;
            let Some(terms) = terms[cloth * colliders.len() + collider] else {
                list.clear();
                continue;
            };
            list.span = span;
            collider_states[collider].fit(&colliders[collider], span);
            let state_of = &collider_states[collider];
            let view = StepParts { terms, maps, h: schedule.h, time: [now; 2], span };
            let step = &view.of(state, state_of);
            let (cloth, collider) = (&cloths[cloth], &colliders[collider]);
            let shifts =
                span.map(|time| Vector3::from(foreseen.gone(time).map(R::to_f64)) - state_of.origin(time));
            Search { cloth, collider, state: state_of, foreseen, strayed, step, shifts }.run(list, pool);
            if terms.traps {
                list.trapped.begin(cloth.points(), collider, state_of, step);
                list.trapped.look(collider, state_of, step, |point| freed.push(point));
            } else {
                list.trapped.forget();
            }
            *tally.pairs.get_mut() += list.len() as u64;
        }
        *tally.broad_phases.get_mut() += 1;
        let points = cloths[cloth].points();
        strayed[points.start as usize..points.end as usize].fill(false);
        // Their contacts were found from the inside.
        freed.into_iter().for_each(|point| strayed[point as usize] = true);
    }

    /// Writes what is foreseen for a cloth's points in a window, and for those that are new, or that may
    /// stray in it from what was foreseen for the rest of the substep, that too. Whether there were any.
    fn foresee_points(
        &mut self,
        frame: &FrameInput,
        cloth: usize,
        schedule: &Schedule<R>,
        step: [f64; 2],
        [window, rest]: [[f64; 2]; 2],
    ) -> bool {
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { near, far, drifts, strayed, .. },
            ..
        } = self;
        let [gone_before, gone_now] = step.map(|time| gone(drifts[cloth], time));
        let thickness = frame.cloths[cloth].thickness.max(LEAST_THICKNESS);
        let most = R::from_f64(cloths[cloth].edge_length);
        let reach = |time: [f64; 2], stray: f64| {
            let left = (time[1] - time[0]) * frame.duration;
            let margin = frame.gravity.norm() * left * left / 2.0 + stray * thickness;
            (R::from_f64(left / schedule.h - 1.0), [R::from_f64(margin), most])
        };
        let (soon, late) = (reach(window, STRAY_NEAR), reach(rest, STRAY_FAR));
        let (near, far, strayed) =
            (DisjointSlice::new(near), DisjointSlice::new(far), DisjointSlice::new(strayed));
        let any = AtomicBool::new(false);
        let blocks = &cloths[cloth].blocks;
        pool.parallel_for(blocks.len(), |block| {
            for row in blocks.range(block) {
                let start = sub(state.start[row as usize].xyz(), gone_before);
                let now = sub(state.displacement[row as usize].xyz(), gone_now);
                let cover = foresee(start, now, soon.0, soon.1);
                // SAFETY: blocks do not overlap.
                #[allow(unsafe_code)]
                unsafe {
                    near.set(row, cover);
                    if strayed.get(row) || !is_within(&cover, &far.get(row)) {
                        far.set(row, foresee(start, now, late.0, late.1));
                        strayed.set(row, true);
                        any.store(true, Ordering::Relaxed);
                    }
                }
            }
        });
        any.into_inner()
    }

    /// Whether a point of the cloth is not where it was foreseen to be at a time of the frame.
    fn has_strayed(&self, cloth: usize, now: f64) -> bool {
        let gone = gone(self.contact.drifts[cloth], now);
        let foreseen = |row: u32| {
            is_foreseen(&self.contact.near[row as usize], self.state.displacement[row as usize].xyz(), gone)
        };
        let strayed = AtomicBool::new(false);
        let blocks = &self.model.cloths[cloth].blocks;
        self.pool.parallel_for(blocks.len(), |block| {
            if !blocks.range(block).all(foreseen) {
                strayed.store(true, Ordering::Relaxed);
            }
        });
        strayed.into_inner()
    }

    /// Takes pairs over into a new frame, before anchors move; they are found anew if a collider moved or will
    /// move, or if what touches has changed.
    pub(crate) fn take_over_pairs(&mut self, frame: &FrameInput) {
        self.contact.windows.fill([0.0, 0.0]);
        self.contact.spans.fill([0.0, 0.0]);
        let is_same = self.take_up_terms(frame);
        let moves =
            frame.colliders.iter().any(|collider| !collider.start.is_empty() || !collider.end.is_empty());
        let moved = self.contact.collider_states.iter().any(|collider| collider.moves);
        if !is_same || moves || moved {
            self.contact.strayed.fill(true);
            for cloth in 0..self.model.cloths.len() {
                if !self.can_touch(cloth) {
                    self.contact
                        .pairs
                        .iter_mut()
                        .filter(|list| list.cloth == cloth)
                        .for_each(PairList::clear);
                }
            }
            return;
        }
        let Self { state, contact: ContactSystem { pairs, far, strayed, .. }, .. } = self;
        // They are looked at in every frame.
        for &(point, _) in pairs.iter().flat_map(|list| &list.trapped.points) {
            strayed[point as usize] = true;
        }
        for ([low, high], moved) in far.iter_mut().zip(&state.displacement) {
            for axis in 0..3 {
                low.0[axis] -= moved.0[axis];
                high.0[axis] -= moved.0[axis];
            }
        }
        pairs.iter_mut().for_each(|list| list.move_anchors(&state.displacement));
    }

    /// Sets how every cloth meets colliders and the ground; whether pairs are found as before.
    fn take_up_terms(&mut self, frame: &FrameInput) -> bool {
        let settings = || frame.cloths.iter().zip(&self.contact.maps.thickest);
        let with_ground = |(cloth, &thickest)| {
            frame.plane.as_ref().and_then(|ground| Terms::with_ground(cloth, ground, thickest))
        };
        let terms: Vec<_> = settings()
            .flat_map(|(cloth, &thickest)| {
                frame.colliders.iter().map(move |collider| Terms::with_collider(cloth, collider, thickest))
            })
            .collect();
        self.contact.ground_terms = settings().map(with_ground).collect();
        let is_same = Terms::find_alike(&terms, &self.contact.terms);
        self.contact.terms = terms;
        is_same
    }
}
