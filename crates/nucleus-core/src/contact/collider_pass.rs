//! A collision pass of the solver: find pairs when none hold any more, then keep them all apart.

use std::sync::atomic::Ordering;

use crate::contact::collider::ColliderState;
use crate::contact::collider_contact::Step;
use crate::contact::ground::GroundContact;
use crate::contact::maps::Maps;
use crate::contact::mover::Mover;
use crate::contact::pairs::PairList;
use crate::contact::resolve::{Tally, hold_back, prove, release, resolve, stick};
use crate::contact::terms::Terms;
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::output::{Stage, StepObserver};
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Model, Solver};
use crate::state::State;

impl<R: Real> Solver<R> {
    /// One pass over all contacts: the ground plane, then colliders; `squeeze` is the share of every thickness that is
    /// kept.
    pub(crate) fn meet_colliders(
        &mut self,
        squeeze: f64,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
        watch: &mut dyn StepObserver,
    ) {
        watch.enter(Stage::BroadPhase);
        self.lift_from_ground(squeeze, schedule, span, tally);
        for cloth in 0..self.model.cloths.len() {
            if !self.can_touch(cloth) {
                continue;
            }
            self.watch_pairs(frame, cloth, schedule, span, tally);
            watch.enter(Stage::Contact);
            self.work_on(cloth, schedule, span, |list, step, colliders, pool| {
                let step = step.squeezed(squeeze);
                resolve(list, &step, pool, tally);
                list.trapped.lead_out(&colliders[list.collider], &step);
            });
        }
    }

    /// Holds cloth to the ground and to colliders by what sticks.
    pub(crate) fn stick_to_colliders(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
    ) {
        if frame.plane.is_some() && self.contact.ground_terms.iter().flatten().any(Terms::sticks) {
            self.on_ground(1.0, schedule, span, |ground, points| ground.adhere(points));
        }
        for cloth in 0..self.model.cloths.len() {
            if self.terms_of(cloth).iter().flatten().any(Terms::sticks) {
                self.watch_pairs(frame, cloth, schedule, span, tally);
                self.work_on(cloth, schedule, span, |list, step, _, pool| {
                    if step.terms.sticks() {
                        stick(list, &step, pool);
                    }
                });
            }
        }
    }

    /// How many pairs of a cloth and a collider are open and how many inseparable at the end of a time step.
    pub(crate) fn prove_sides(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
    ) -> [u64; 2] {
        let mut counts = [0; 2];
        self.for_lists(frame, schedule, span, tally, |list, step, pool, _| {
            let [open, inseparable] = prove(list, step, pool);
            counts = [counts[0] + open, counts[1] + inseparable];
        });
        counts
    }

    /// Takes back what is not proven to where it began the time step, and marks its points as held.
    pub(crate) fn hold_sides(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
    ) {
        let mut held =
            self.contact.mutual.as_mut().map(|mutual| std::mem::take(&mut mutual.held)).unwrap_or_default();
        let mut hold = |point: u32| held.get_mut(point as usize).into_iter().for_each(|held| *held = true);
        self.for_lists(frame, schedule, span, tally, |list, step, _, tally| {
            hold_back(list, step, tally, &mut hold)
        });
        if let Some(mutual) = &mut self.contact.mutual {
            mutual.held = held;
        }
    }

    /// Has the pairs of all points that are not proven found anew.
    pub(crate) fn release_sides(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
    ) {
        let mut released = Vec::new();
        let mut tell = |point: u32| released.push(point);
        self.for_lists(frame, schedule, span, tally, |list, step, _, _| release(list, step, &mut tell));
        for point in released {
            self.contact.strayed[point as usize] = true;
        }
        self.contact.windows.fill([0.0, 0.0]);
    }

    /// Does something with all that can touch, of each cloth and collider.
    fn for_lists(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
        mut work: impl FnMut(&mut PairList<R>, &Step<'_, R>, &ThreadPool, &Tally),
    ) {
        for cloth in 0..self.model.cloths.len() {
            if self.can_touch(cloth) {
                self.watch_pairs(frame, cloth, schedule, span, tally);
                self.work_on(cloth, schedule, span, |list, step, _, pool| work(list, &step, pool, tally));
            }
        }
    }

    /// Does something with the pairs of a cloth and each collider that it meets.
    fn work_on(
        &mut self,
        cloth: usize,
        schedule: &Schedule<R>,
        span: StepInterval,
        mut work: impl FnMut(&mut PairList<R>, Step<'_, R>, &[crate::model::ColliderModel], &ThreadPool),
    ) {
        let Self {
            state,
            pool,
            model: Model { colliders, .. },
            contact: ContactSystem { collider_states, pairs, terms, maps, .. },
            ..
        } = self;
        for list in pairs.iter_mut().filter(|list| list.cloth == cloth) {
            let Some(terms) = terms[cloth * colliders.len() + list.collider] else { continue };
            let view = StepParts { terms, maps, h: schedule.h, time: [span.from, span.to], span: list.span };
            let collider = list.collider;
            work(list, view.of(state, &collider_states[collider]), colliders, pool);
        }
    }

    /// How a cloth meets each collider in this frame.
    pub(crate) fn terms_of(&self, cloth: usize) -> &[Option<Terms<R>>] {
        let colliders = self.model.colliders.len();
        self.contact.terms.get(cloth * colliders..(cloth + 1) * colliders).unwrap_or_default()
    }

    /// Whether a cloth meets any collider in this frame.
    pub(crate) fn can_touch(&self, cloth: usize) -> bool {
        self.terms_of(cloth).iter().any(Option::is_some)
    }

    fn lift_from_ground(&mut self, squeeze: f64, schedule: &Schedule<R>, span: StepInterval, tally: &Tally) {
        self.on_ground(squeeze, schedule, span, |ground, points| {
            tally.contacts.fetch_add(ground.resolve(points), Ordering::Relaxed);
        });
    }

    /// Does something with the points of all cloths that meet the ground, block by block.
    fn on_ground(
        &mut self,
        squeeze: f64,
        schedule: &Schedule<R>,
        span: StepInterval,
        work: impl Fn(&GroundContact<'_, R>, std::ops::Range<u32>) + Sync,
    ) {
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { ground, ground_terms, maps, .. },
            ..
        } = self;
        let Some(plane) = ground.in_step(span) else { return };
        let State { displacement, predicted, led, parted, start, .. } = state;
        let mover = Mover::new([displacement, led, parted], predicted);
        for (cloth, terms) in cloths.iter().zip(ground_terms) {
            let Some(terms) = *terms else { continue };
            let ground = GroundContact {
                mover,
                start,
                plane,
                squeeze: R::from_f64(squeeze),
                terms,
                maps,
                h: R::from_f64(schedule.h),
            };
            pool.parallel_for(cloth.blocks.len(), |block| work(&ground, cloth.blocks.range(block)));
        }
    }
}

/// What a [`Step`] is made of, besides the state.
pub(crate) struct StepParts<'a, R> {
    pub(crate) terms: Terms<R>,
    pub(crate) maps: &'a Maps<R>,
    pub(crate) h: f64,
    pub(crate) time: [f64; 2],
    pub(crate) span: [f64; 2],
}

impl<R: Real> StepParts<'_, R> {
    pub(crate) fn of<'s>(&'s self, state: &'s mut State<R>, collider: &'s ColliderState) -> Step<'s, R> {
        let State { displacement, predicted, led, parted, start, anchor, .. } = state;
        Step {
            mover: Mover::new([displacement, led, parted], predicted),
            start,
            anchors: anchor,
            collider: [&collider.start, &collider.end],
            time: self.time,
            span: self.span,
            h: R::from_f64(self.h),
            thickness: R::from_f64(self.terms.thickness),
            squeeze: R::ONE,
            terms: self.terms,
            maps: self.maps,
        }
    }
}
