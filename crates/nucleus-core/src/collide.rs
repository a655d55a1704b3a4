//! A collision pass of the solver: find pairs when none hold any more, then keep them all apart.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::Vector3;

use crate::collision::bounce::{Bounce, Hit};
use crate::collision::collider::ColliderState;
use crate::collision::contact::Step;
use crate::collision::foresee::{foresee, is_foreseen, is_within};
use crate::collision::pairs::PairList;
use crate::collision::plane::Ground;
use crate::collision::resolve::{Tally, hold_back, prove, release, resolve};
use crate::collision::search::Search;
use crate::columns::Shared;
use crate::frame::{ColliderFrame, FrameInput, GroundPlane};
use crate::observe::{Stage, StepObserver};
use crate::scalar::{Real, Row4, dot};
use crate::schedule::{Schedule, Span};
use crate::solver::Solver;
use crate::team::Team;

/// Thickness in metres below which none is kept: contact needs some room to prove that nothing passed.
const LEAST_THICKNESS: f64 = 1e-5;
/// Shares of the thickness by which a point may stray from what is foreseen, in a window and in a substep.
const STRAY_NEAR: f64 = 0.05;
const STRAY_FAR: f64 = 0.5;
/// Edge lengths that anything may go while one list of pairs holds.
const FARTHEST: f64 = 2.0;
/// Time steps for which active pairs are picked.
const WINDOW: f64 = 8.0;

/// The sum of two thicknesses in metres.
fn thickness(frame: &FrameInput, cloth: usize, collider: usize) -> f64 {
    (frame.cloths[cloth].thickness + frame.colliders[collider].thickness).max(LEAST_THICKNESS)
}

impl<R: Real> Solver<R> {
    /// One pass over all contacts: the ground plane, then colliders; `squeeze` is the share of every thickness that is
    /// kept.
    pub(crate) fn meet_colliders(
        &mut self,
        squeeze: f64,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: Span,
        tally: &mut Tally,
        watch: &mut dyn StepObserver,
    ) {
        watch.enter(Stage::FindPairs);
        self.lift_from_ground(squeeze, frame, schedule, tally);
        let time = [span.from, span.to];
        for cloth in 0..self.cloths.len() {
            if !self.can_touch(frame, cloth) {
                continue;
            }
            self.watch_pairs(frame, cloth, schedule, span, tally);
            watch.enter(Stage::Collide);
            let Self { colliders, state, collider_states, pairs, team, .. } = self;
            for list in pairs.iter_mut().filter(|list| list.cloth == cloth) {
                let collider = list.collider;
                let view = StepParts { frame, cloth, collider, h: schedule.h, time, span: list.span };
                let mut step = view.of(state, &collider_states[collider]);
                step.thickness = step.thickness * R::from_f64(squeeze);
                resolve(list, &step, team, tally);
                list.trapped.lead_out(&colliders[collider], &step);
            }
        }
    }

    /// How many pairs of a cloth and a collider are not proven to be on their sides at the end of a time step.
    pub(crate) fn prove_sides(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: Span,
        tally: &mut Tally,
    ) -> u64 {
        let mut open = 0;
        self.for_lists(frame, schedule, span, tally, |list, step, team, _| open += prove(list, step, team));
        open
    }

    /// Takes back what is not proven to where it began the time step, and marks its points as held.
    pub(crate) fn hold_sides(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: Span,
        tally: &mut Tally,
    ) {
        let mut held =
            self.mutual.as_mut().map(|mutual| std::mem::take(&mut mutual.held)).unwrap_or_default();
        let mut hold = |point: u32| held.get_mut(point as usize).into_iter().for_each(|held| *held = true);
        self.for_lists(frame, schedule, span, tally, |list, step, _, tally| {
            hold_back(list, step, tally, &mut hold)
        });
        if let Some(mutual) = &mut self.mutual {
            mutual.held = held;
        }
    }

    /// Has the pairs of all points that are not proven found anew.
    pub(crate) fn release_sides(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: Span,
        tally: &mut Tally,
    ) {
        let mut released = Vec::new();
        let mut tell = |point: u32| released.push(point);
        self.for_lists(frame, schedule, span, tally, |list, step, _, _| release(list, step, &mut tell));
        for point in released {
            self.strayed[point as usize] = true;
        }
        self.windows.fill([0.0, 0.0]);
    }

    /// Does something with all that can touch, of each cloth and collider.
    fn for_lists(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: Span,
        tally: &mut Tally,
        mut work: impl FnMut(&mut PairList<R>, &Step<'_, R>, &Team, &Tally),
    ) {
        for cloth in 0..self.cloths.len() {
            if !self.can_touch(frame, cloth) {
                continue;
            }
            self.watch_pairs(frame, cloth, schedule, span, tally);
            let Self { state, collider_states, pairs, team, .. } = self;
            for list in pairs.iter_mut().filter(|list| list.cloth == cloth) {
                let (collider, time) = (list.collider, [span.from, span.to]);
                let view = StepParts { frame, cloth, collider, h: schedule.h, time, span: list.span };
                work(list, &view.of(state, &collider_states[collider]), team, tally);
            }
        }
    }

    /// Whether a cloth meets any collider in this frame.
    fn can_touch(&self, frame: &FrameInput, cloth: usize) -> bool {
        frame.cloths[cloth].collide && frame.colliders.iter().any(|collider| collider.collide)
    }

    /// Makes sure that the active pairs of a cloth are all that can touch in this step. As long as every
    /// point stays where it was foreseen to, nothing needs to be done.
    fn watch_pairs(
        &mut self,
        frame: &FrameInput,
        cloth: usize,
        schedule: &Schedule<R>,
        times: Span,
        tally: &mut Tally,
    ) {
        let step = [times.from, times.to];
        if step[1] <= self.windows[cloth][1] + 1e-9 && !self.has_strayed(cloth) {
            return;
        }
        if step[1] > self.spans[cloth][1] + 1e-9 {
            self.begin_span(frame, cloth, times);
        }
        let rest = [step[0], self.spans[cloth][1].min(self.horizon(frame, cloth, times))];
        let window = [step[0], rest[1].min(step[0] + (step[1] - step[0]) * WINDOW)];
        if self.foresee_points(frame, cloth, schedule, [window, rest]) {
            self.find_pairs(frame, cloth, schedule, step[0], tally);
        }
        self.windows[cloth] = window;
        let Self { cloths, pairs, near, .. } = self;
        for list in pairs.iter_mut().filter(|list| list.cloth == cloth) {
            let thickness = thickness(frame, cloth, list.collider);
            list.activate(near, window, R::from_f64(thickness), &cloths[cloth].blocks);
        }
    }

    /// Sets the span that pairs are found for. A collider on its way needs a new list for each stretch of it;
    /// around colliders at rest a pair holds for as long as its points stay where they are foreseen.
    fn begin_span(&mut self, frame: &FrameInput, cloth: usize, times: Span) {
        let touching = |(_, theirs): &(&ColliderState, &ColliderFrame)| theirs.collide;
        let mut colliders = self.collider_states.iter().zip(&frame.colliders).filter(touching);
        if colliders.any(|(collider, _)| collider.moves) {
            self.spans[cloth] = [times.from, self.horizon(frame, cloth, times)];
            let points = self.cloths[cloth].points();
            self.strayed[points.start as usize..points.end as usize].fill(true);
        } else {
            self.spans[cloth] = [0.0, 1.0];
        }
    }

    /// How far ahead is foreseen: to the end of the substep, or as long as nothing goes farther than a few
    /// edges. Boxes over a longer way would meet everything on it.
    fn horizon(&self, frame: &FrameInput, cloth: usize, times: Span) -> f64 {
        let (step, end_of_substep) = ([times.from, times.to], times.end_of_substep);
        let model = &self.cloths[cloth];
        let points = model.points();
        let rows = &self.state.velocity[points.start as usize..points.end as usize];
        let squares = rows.iter().map(|row| dot(row.xyz(), row.xyz()).to_f64());
        let fastest = squares.fold(0.0, f64::max).sqrt() * frame.duration;
        let ways = self.collider_states.iter().zip(&frame.colliders).filter(|(_, theirs)| theirs.collide);
        let farthest = ways.map(|(collider, _)| collider.way).fold(fastest, f64::max);
        let length = step[1] - step[0];
        let steps = (FARTHEST * model.edge_length / (farthest * length)).floor().max(1.0);
        // A step more than it takes to the end is no step.
        if step[0] + steps * length >= end_of_substep - length / 2.0 {
            end_of_substep
        } else {
            step[0] + steps * length
        }
    }

    /// Finds the pairs of a cloth with every collider, for all points of which something new is foreseen.
    fn find_pairs(
        &mut self,
        frame: &FrameInput,
        cloth: usize,
        schedule: &Schedule<R>,
        now: f64,
        tally: &mut Tally,
    ) {
        let Self { cloths, colliders, state, collider_states, pairs, far, spans, strayed, .. } = self;
        let span = spans[cloth];
        let mut freed = Vec::new();
        for list in pairs.iter_mut().filter(|list| list.cloth == cloth) {
            let collider = list.collider;
            if !frame.colliders[collider].collide {
                list.clear();
                continue;
            }
            list.span = span;
            collider_states[collider].fit(&colliders[collider], span);
            let state_of = &collider_states[collider];
            let view = StepParts { frame, cloth, collider, h: schedule.h, time: [now; 2], span };
            let step = &view.of(state, state_of);
            let (cloth, collider) = (&cloths[cloth], &colliders[collider]);
            let unproven = &tally.unproven;
            Search { cloth, collider, state: state_of, cover: far, strayed, unproven, step }.run(list);
            list.trapped.begin(cloth.points(), collider, state_of, step);
            list.trapped.look(collider, state_of, step, |point| freed.push(point));
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
        [window, rest]: [[f64; 2]; 2],
    ) -> bool {
        let Self { cloths, state, near, far, strayed, team, .. } = self;
        let thickness = frame.cloths[cloth].thickness.max(LEAST_THICKNESS);
        let most = R::from_f64(cloths[cloth].edge_length);
        let reach = |time: [f64; 2], stray: f64| {
            let left = (time[1] - time[0]) * frame.duration;
            let margin = frame.gravity.norm() * left * left / 2.0 + stray * thickness;
            (R::from_f64(left / schedule.h - 1.0), [R::from_f64(margin), most])
        };
        let (soon, late) = (reach(window, STRAY_NEAR), reach(rest, STRAY_FAR));
        let (near, far, strayed) = (Shared::new(near), Shared::new(far), Shared::new(strayed));
        let any = AtomicBool::new(false);
        let blocks = &cloths[cloth].blocks;
        team.phase(blocks.len(), |block| {
            for row in blocks.range(block) {
                let start = state.start[row as usize].xyz();
                let now = state.displacement[row as usize].xyz();
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

    /// Whether a point of the cloth is not where it was foreseen to be.
    fn has_strayed(&self, cloth: usize) -> bool {
        let foreseen =
            |row: u32| is_foreseen(&self.near[row as usize], self.state.displacement[row as usize].xyz());
        let strayed = AtomicBool::new(false);
        let blocks = &self.cloths[cloth].blocks;
        self.team.phase(blocks.len(), |block| {
            if !blocks.range(block).all(foreseen) {
                strayed.store(true, Ordering::Relaxed);
            }
        });
        strayed.into_inner()
    }

    /// Takes pairs over into a new frame, before anchors move; they are found anew if a collider moved or will
    /// move, or if what touches has changed.
    pub(crate) fn take_over_pairs(&mut self, frame: &FrameInput) {
        self.windows.fill([0.0, 0.0]);
        self.spans.fill([0.0, 0.0]);
        let terms = |(collide, thickness): (bool, f64)| if collide { thickness } else { f64::INFINITY };
        let cloths = frame.cloths.iter().map(|cloth| (cloth.collide, cloth.thickness));
        let colliders = frame.colliders.iter().map(|collider| (collider.collide, collider.thickness));
        let same = cloths.clone().chain(colliders.clone()).map(terms).eq(self.terms.iter().copied());
        let moves =
            frame.colliders.iter().any(|collider| !collider.start.is_empty() || !collider.end.is_empty());
        let moved = self.collider_states.iter().any(|collider| collider.moves);
        if !same || moves || moved {
            self.terms = cloths.chain(colliders).map(terms).collect();
            self.strayed.fill(true);
            for cloth in 0..self.cloths.len() {
                if !self.can_touch(frame, cloth) {
                    self.pairs.iter_mut().filter(|list| list.cloth == cloth).for_each(PairList::clear);
                }
            }
            return;
        }
        let Self { pairs, state, far, strayed, .. } = self;
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

    /// Gives back, after the step, part of the speed to the points that hit something that bounces.
    pub(crate) fn bounce(&mut self, frame: &FrameInput, schedule: &Schedule<R>, end: f64) {
        for cloth in 0..self.cloths.len() {
            if let Some(ground) = frame.plane.filter(|_| frame.cloths[cloth].collide) {
                self.bounce_off_ground(frame, schedule, cloth, &ground);
            }
            if self.can_touch(frame, cloth) {
                self.bounce_off_colliders(frame, schedule, end, cloth);
            }
        }
    }

    fn bounce_off_ground(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        cloth: usize,
        ground: &GroundPlane,
    ) {
        let settings = &frame.cloths[cloth];
        let Some(bounce) = bounce_of(frame, schedule, settings.bounce.max(ground.bounce)) else { return };
        let normal = ground.normal.try_normalize(0.0).unwrap_or_else(Vector3::y);
        let normal = [normal.x, normal.y, normal.z].map(R::from_f64);
        let thickness = R::from_f64(settings.thickness);
        for row in self.cloths[cloth].points().map(|row| row as usize) {
            let hit = self.hit(row);
            if Bounce::touches(self.heights[row] + dot(normal, hit.displacement), thickness) {
                self.set_velocity(row, bounce.off(&hit, normal, [R::ZERO; 3]));
            }
        }
    }

    fn bounce_off_colliders(&mut self, frame: &FrameInput, schedule: &Schedule<R>, end: f64, cloth: usize) {
        for index in 0..self.pairs.len() {
            if self.pairs[index].cloth != cloth {
                continue;
            }
            let collider = self.pairs[index].collider;
            let bounce = frame.cloths[cloth].bounce.max(frame.colliders[collider].bounce);
            let Some(bounce) = bounce_of(frame, schedule, bounce) else { continue };
            for active in 0..self.pairs[index].active.point_face.len() {
                let Self { state, collider_states, pairs, .. } = self;
                let pair = pairs[index].point_face[pairs[index].active.point_face[active] as usize];
                let span = pairs[index].span;
                let view = StepParts { frame, cloth, collider, h: schedule.h, time: [end; 2], span };
                let touch = pair.touch(&view.of(state, &collider_states[collider]), frame.duration);
                if let Some((normal, surface)) = touch {
                    let row = pair.points[0] as usize;
                    self.set_velocity(row, bounce.off(&self.hit(row), normal, surface));
                }
            }
        }
    }

    fn hit(&self, row: usize) -> Hit<R> {
        Hit {
            predicted: self.state.predicted[row].xyz(),
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

    fn lift_from_ground(&mut self, squeeze: f64, frame: &FrameInput, schedule: &Schedule<R>, tally: &Tally) {
        let Some(ground) = &frame.plane else { return };
        let Self { cloths, state, heights, team, .. } = self;
        let normal = ground.normal.try_normalize(0.0).unwrap_or_else(Vector3::y);
        let displacement = Shared::new(&mut state.displacement);
        let predicted = Shared::new(&mut state.predicted);
        for (cloth, settings) in cloths.iter().zip(&frame.cloths).filter(|(_, settings)| settings.collide) {
            let ground = Ground {
                displacement,
                predicted,
                start: &state.start,
                height: heights,
                normal: [normal.x, normal.y, normal.z].map(R::from_f64),
                thickness: R::from_f64(settings.thickness * squeeze),
                friction: R::from_f64(settings.friction + ground.friction),
                extra_friction: &state.extra_friction,
                h: R::from_f64(schedule.h),
            };
            team.phase(cloth.blocks.len(), |block| {
                tally.contacts.fetch_add(ground.lift(cloth.blocks.range(block)), Ordering::Relaxed);
            });
        }
    }
}

/// How things bounce in a frame; nothing where they do not.
fn bounce_of<R: Real>(frame: &FrameInput, schedule: &Schedule<R>, bounce: f64) -> Option<Bounce<R>> {
    let slowest = 2.0 * frame.gravity.norm() * schedule.h;
    let (bounce, slowest, h) = (R::from_f64(bounce), R::from_f64(slowest), R::from_f64(schedule.h));
    (bounce > R::ZERO).then_some(Bounce { bounce, slowest, h })
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
        collider: &'s ColliderState,
    ) -> Step<'s, R> {
        let (cloth, theirs) = (&self.frame.cloths[self.cloth], &self.frame.colliders[self.collider]);
        Step {
            displacement: Shared::new(&mut state.displacement),
            predicted: Shared::new(&mut state.predicted),
            start: &state.start,
            anchors: &state.anchor,
            collider: [&collider.start, &collider.end],
            time: self.time,
            span: self.span,
            h: R::from_f64(self.h),
            thickness: R::from_f64(thickness(self.frame, self.cloth, self.collider)),
            friction: R::from_f64(cloth.friction + theirs.friction),
            extra_friction: &state.extra_friction,
        }
    }
}
