//! Contact among cloths, as the solver goes through it: foresee, find, push apart.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::cloth::Mutual;
use crate::contact::cloth::active::Active;
use crate::contact::cloth::ahead::{Ahead, mean_motion};
use crate::contact::cloth::friction::Memory;
use crate::contact::cloth::near::Motion;
use crate::contact::cloth::paths::Path;
use crate::contact::cloth::search::{Look, search};
use crate::contact::cloth::tangle::SPEED;
use crate::contact::maps::Maps;
use crate::contact::mover::Mover;
use crate::contact::resolve::Tally;
use crate::contact::terms::Terms;
use crate::input::frame::FrameInput;
use crate::math::{Real, Row4, scale, sub};
use crate::output::{Stage, StepObserver};
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Model, Solver};
use crate::state::State;

/// Length of a span in seconds, and the least in time steps: for longer ones more is found, shorter ones are searched more
/// often. A drape takes a seventh longer with twice the length, at 24 and at 96 evaluations.
const SPAN: f64 = 0.01;
const LEAST_STEPS: f64 = 4.0;
/// Radius of the ball that a point is to stay in over a span, in shares of the thickness and of the length of an edge: the
/// max counts.
const BALL: [f64; 2] = [0.4, 0.08];
/// In metres; nothing is foreseen more sharply.
const LEAST_BALL: f64 = 1e-6;
/// Edge lengths that a point is foreseen to go, at most: a line over a longer way would meet all that is on it.
const MAX_COORDINATE: f64 = 2.0;
/// In metres; a way that nothing goes in a frame, and a number in single precision.
const ENDLESS: f64 = 1e9;

impl<R: Real> Solver<R> {
    /// Sets who meets whom in this frame, and carries what is foreseen over to it. Before anchors move.
    pub(crate) fn begin_contact(&mut self, frame: &FrameInput) {
        let Some(mutual) = &mut self.contact.mutual else { return };
        let (cloths, thickest) = (&frame.cloths, &self.contact.maps.thickest);
        let terms: Vec<Option<Terms<R>>> =
            (0..cloths.len()).flat_map(|cloth| terms_of(cloth, frame, thickest)).collect();
        let holds = |terms: &[Option<Terms<R>>]| -> Vec<bool> {
            terms
                .iter()
                .map(|terms| terms.as_ref().is_some_and(|terms| !terms.is_weak(&self.contact.maps)))
                .collect()
        };
        if holds(&terms) != holds(&mutual.terms) {
            mutual.tangle.is_suspected = true; // what was let pass may be amid it
        }
        if !Terms::find_alike(&terms, &mutual.terms) {
            mutual.strayed.fill(true);
        }
        mutual.terms = terms;
        if !mutual.is_on() {
            mutual.strayed.fill(true);
            mutual.active = Active::default(); // what nothing looks after any more holds nothing
        }
        mutual.paths.move_anchors(&self.state.displacement);
        for (began_at, moved) in mutual.began_at.iter_mut().zip(&self.state.displacement) {
            let [x, y, z] = sub(began_at.xyz(), moved.xyz());
            *began_at = Row4([x, y, z, R::ZERO]);
        }
        mutual.span = [mutual.span[0] - 1.0, 0.0];
    }

    /// Forgets what is foreseen for a point that was put somewhere else, among cloths and colliders.
    pub(crate) fn invalidate_bounds(&mut self, row: usize) {
        let Self { contact: ContactSystem { mutual, strayed, .. }, .. } = self;
        let among_cloths = mutual.as_mut().and_then(|mutual| mutual.strayed.get_mut(row));
        strayed.get_mut(row).into_iter().chain(among_cloths).for_each(|strayed| *strayed = true);
    }

    /// How a cloth meets itself and every other cloth that it meets.
    pub(crate) fn mutual_terms(&self, frame: &FrameInput, cloth: usize) -> Vec<Terms<R>> {
        terms_of(cloth, frame, &self.contact.maps.thickest).flatten().collect()
    }

    /// Pushes apart all that is too near, once; `squeeze` is the share of every thickness that is kept.
    pub(crate) fn meet(
        &mut self,
        squeeze: f64,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
        watch: &mut dyn StepObserver,
    ) {
        if !self.contact.mutual.as_ref().is_some_and(Mutual::is_on) {
            return;
        }
        watch.enter(Stage::BroadPhase);
        self.watch_contacts(frame, span, tally);
        watch.enter(Stage::Contact);
        let Self { state, pool, contact: ContactSystem { mutual: Some(mutual), maps, .. }, .. } = self else {
            return;
        };
        let Mutual { bodies, terms, active, began_at, tangle, .. } = mutual;
        if tangle.is_there() {
            let most = bodies.edge_length * SPEED * schedule.h;
            let anchors = std::mem::take(&mut state.anchor);
            tangle.work_apart(&anchors, &motion(state, terms, maps, schedule.h), &bodies.cloth, most);
            state.anchor = anchors;
        }
        let memory = Some(Memory { began_at, tangled: tangle.pairs() });
        let squeeze = R::from_f64(squeeze);
        let step = Motion { squeeze, memory, ..motion(state, terms, maps, schedule.h) };
        *tally.contacts.get_mut() += active.sweep(&step, pool);
    }

    /// Holds cloth to itself and to other cloth by what sticks.
    pub(crate) fn stick_to_cloth(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
    ) {
        let sticks = |mutual: &Mutual<R>| mutual.terms.iter().flatten().any(Terms::sticks);
        if self.contact.mutual.as_ref().is_some_and(sticks) {
            self.watch_contacts(frame, span, tally);
            let Self { state, pool, contact: ContactSystem { mutual: Some(mutual), maps, .. }, .. } = self
            else {
                return;
            };
            mutual.active.stick(&motion(state, &mutual.terms, maps, schedule.h), pool);
        }
    }

    /// Makes sure that the contacts are all that can touch in this step. As long as every point stays where
    /// it was foreseen to, nothing needs to be done.
    pub(crate) fn watch_contacts(&mut self, frame: &FrameInput, now: StepInterval, tally: &mut Tally) {
        let Some(mutual) = &mut self.contact.mutual else { return };
        let is_late = now.to <= mutual.span[1] + 1e-9;
        let since = mutual.span[0];
        if is_late {
            if !self.find_strays(now) {
                return;
            }
        } else {
            let least = (now.to - now.from) * LEAST_STEPS;
            // As many spans of one length as come nearest to that.
            let length = least.max(1.0 / (frame.duration / SPAN).round().max(1.0));
            let end = (now.from + length).min(1.0);
            mutual.span = [now.from, end.max(now.to)];
            if mutual.tangle.may_be_there() {
                mutual.strayed.fill(true);
            }
        }
        self.foresee(frame, now, since, is_late);
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { mutual: Some(mutual), maps, .. },
            ..
        } = self
        else {
            return;
        };
        let begun = (now.from - mutual.span[0]) / (mutual.span[1] - mutual.span[0]);
        let moved = [&state.start[..], &state.displacement[..]];
        search(
            mutual,
            Look { cloths, anchors: &state.anchor, moved, begun, strength: &maps.strength },
            is_late,
            pool,
        );
        *tally.pairs.get_mut() += mutual.active.len();
        *tally.broad_phases.get_mut() += 1;
    }

    /// Marks the points that are not where they were foreseen to be at the end of the step. Whether there
    /// are any.
    fn find_strays(&mut self, now: StepInterval) -> bool {
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { mutual: Some(mutual), .. },
            ..
        } = self
        else {
            return false;
        };
        let Mutual { span: [from, to], strayed, paths, .. } = mutual;
        let share = R::from_f64((now.to - *from) / (*to - *from));
        let any = AtomicBool::new(false);
        let strayed = DisjointSlice::new(strayed);
        for cloth in cloths.iter() {
            pool.parallel_for(cloth.blocks.len(), |block| {
                let mut any_here = false;
                for row in cloth.blocks.range(block) {
                    let keeps = paths.of(row).holds(share, state.displacement[row as usize].xyz());
                    any_here |= !keeps;
                    // SAFETY: blocks do not overlap.
                    #[allow(unsafe_code)]
                    unsafe {
                        strayed.set(row, !keeps);
                    }
                }
                any.fetch_or(any_here, Ordering::Relaxed);
            });
        }
        any.into_inner()
    }

    /// Writes what is foreseen for the points that strayed from what was foreseen before. As a span begins, those that stay
    /// where they are foreseen to be as the last one ends are foreseen to stay there. `since` is when the last one began.
    fn foresee(&mut self, frame: &FrameInput, now: StepInterval, since: f64, is_late: bool) {
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { mutual: Some(mutual), .. },
            ..
        } = self
        else {
            return;
        };
        let Mutual { paths, began_at, span, strayed, active, .. } = mutual;
        let of_last = R::from_f64((now.to - now.from) / (now.from - since).max(now.to - now.from));
        let (paths, strayed) = (paths.shared(), DisjointSlice::new(strayed));
        for (cloth, settings) in cloths.iter().zip(&frame.cloths) {
            let rows = cloth.points().start as usize..cloth.points().end as usize;
            let common = mean_motion(&state.start[rows.clone()], &state.displacement[rows]);
            let ahead = Ahead::new(now, *span, common);
            let thickness = settings.thickness.max(settings.self_collision.thickness);
            let [of_thickness, of_edge] = BALL;
            let ball = (of_thickness * thickness).max(of_edge * cloth.edge_length).max(LEAST_BALL);
            // A free point is small on any way: what is near its line is found along it.
            let is_free = cloth.skin.triangles.is_empty();
            let farthest = if is_free { ENDLESS } else { MAX_COORDINATE * cloth.edge_length };
            let (ball, farthest) = (R::from_f64(ball), R::from_f64(farthest));
            pool.parallel_for(cloth.blocks.len(), |block| {
                for row in cloth.blocks.range(block) {
                    let before = state.start[row as usize].xyz();
                    let motion = sub(state.displacement[row as usize].xyz(), before);
                    // A point that trembles is not where this step would take it: if there is one, the span before tells
                    // better.
                    let gone =
                        (!is_late && now.from > since).then(|| sub(before, began_at[row as usize].xyz()));
                    let pace = gone.map_or(motion, |gone| scale(gone, of_last));
                    // SAFETY: blocks do not overlap.
                    #[allow(unsafe_code)]
                    unsafe {
                        if !strayed.get(row) {
                            if is_late {
                                continue;
                            }
                            let last = paths.of(row);
                            let rest = Path { from: last.at(R::ONE), travel: [R::ZERO; 3], ball: last.ball };
                            if ahead.stays(&rest, before, motion) || ahead.stays(&rest, before, pace) {
                                paths.set(row, rest);
                                continue;
                            }
                            strayed.set(row, true);
                        }
                        paths.set(row, ahead.on(before, [motion, pace], ball, farthest));
                    }
                }
            });
        }
        if !is_late {
            active.carry_slips(&state.start, began_at);
            began_at.clone_from(&state.start);
        }
    }
}

/// How a cloth meets each cloth, itself among them.
fn terms_of<'a, R: Real>(
    cloth: usize,
    frame: &'a FrameInput,
    thickest: &'a [f64],
) -> impl Iterator<Item = Option<Terms<R>>> + 'a {
    let own = &frame.cloths[cloth];
    frame.cloths.iter().enumerate().map(move |(at, other)| match at == cloth {
        true => Terms::with_itself(other, thickest[cloth]),
        false => Terms::between([own, other], [thickest[cloth], thickest[at]], frame.layer_range),
    })
}

/// A time step as contacts see it.
pub(crate) fn motion<'a, R: Real>(
    state: &'a mut State<R>,
    terms: &'a [Option<Terms<R>>],
    maps: &'a Maps<R>,
    h: f64,
) -> Motion<'a, R> {
    let State { displacement, predicted, led, parted, start, .. } = state;
    Motion {
        mover: Mover::new([displacement, led, parted], predicted),
        start,
        memory: None,
        terms,
        maps,
        h: R::from_f64(h),
        squeeze: R::ONE,
    }
}
