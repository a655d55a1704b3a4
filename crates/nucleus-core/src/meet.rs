//! Contact among cloths, as the solver goes through it: foresee, find, push apart.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::collision::maps::Maps;
use crate::collision::mutual::Mutual;
use crate::collision::mutual::active::{Active, WINDOW, pick};
use crate::collision::mutual::crossings::find_crossings;
use crate::collision::mutual::near::Motion;
use crate::collision::mutual::paths::Path;
use crate::collision::mutual::search::search;
use crate::collision::mutual::tangle::SPEED;
use crate::collision::resolve::Tally;
use crate::collision::terms::Terms;
use crate::columns::Shared;
use crate::frame::FrameInput;
use crate::observe::{Stage, StepObserver};
use crate::scalar::{Real, Row4, add, dot, scale, sub};
use crate::schedule::{Schedule, Span};
use crate::solver::Solver;
use crate::state::State;

/// Radius of the ball that a point is to stay in for a few time steps, in shares of the thickness and of the
/// length of an edge: the larger counts.
const NEAR_BALL: [f64; 2] = [0.1, 0.02];
/// The same for a frame.
const FAR_BALL: [f64; 2] = [0.25, 0.15];
/// Share of the ball of a frame within which a point that stays in it ends a window.
const STAYS: f64 = 0.7;
/// In metres; nothing is foreseen more sharply.
const LEAST_BALL: f64 = 1e-6;
/// Edge lengths that a point is foreseen to go, at most: a line over a longer way would meet all that is on it.
const FARTHEST: f64 = 2.0;
/// In metres; a way that nothing goes in a frame, and a number in single precision.
const ENDLESS: f64 = 1e9;

impl<R: Real> Solver<R> {
    /// Sets who meets whom in this frame, and carries what was found over to it. Before anchors move.
    pub(crate) fn begin_meeting(&mut self, frame: &FrameInput) {
        let Some(mutual) = &mut self.mutual else { return };
        let (cloths, thickest) = (&frame.cloths, &self.maps.thickest);
        let terms: Vec<Option<Terms<R>>> =
            (0..cloths.len()).flat_map(|cloth| terms_of(cloth, frame, thickest)).collect();
        if !Terms::find_alike(&terms, &mutual.terms) {
            mutual.strayed.fill(true);
        }
        let holds = |terms: &[Option<Terms<R>>]| -> Vec<bool> {
            terms.iter().map(|terms| terms.as_ref().is_some_and(|terms| !terms.is_weak(&self.maps))).collect()
        };
        if holds(&terms) != holds(&mutual.terms) {
            mutual.tangle.is_suspected = true; // what was let pass may be amid it
        }
        mutual.terms = terms;
        if mutual.is_on() {
            mutual.far.move_anchors(&self.state.displacement);
            mutual.candidates.forget_places();
        } else {
            mutual.active = Active::default(); // what nothing looks after any more holds nothing
        }
        mutual.window = [0.0; 2];
    }

    /// How a cloth meets itself and every other cloth that it meets.
    pub(crate) fn mutual_terms(&self, frame: &FrameInput, cloth: usize) -> Vec<Terms<R>> {
        terms_of(cloth, frame, &self.maps.thickest).flatten().collect()
    }

    /// Pushes apart all that is too near, once; `squeeze` is the share of every thickness that is kept.
    pub(crate) fn meet(
        &mut self,
        squeeze: f64,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: Span,
        tally: &mut Tally,
        watch: &mut dyn StepObserver,
    ) {
        if !self.mutual.as_ref().is_some_and(Mutual::is_on) {
            return;
        }
        watch.enter(Stage::FindPairs);
        self.watch_contacts(frame, span, tally);
        watch.enter(Stage::Collide);
        let Self { mutual: Some(mutual), state, maps, team, .. } = self else { return };
        let Mutual { bodies, terms, active, tangle, .. } = mutual;
        if tangle.is_there() {
            let most = bodies.edge_length * SPEED * schedule.h;
            let anchors = std::mem::take(&mut state.anchor);
            tangle.work_apart(&anchors, &motion(state, terms, maps, schedule.h), &bodies.cloth, most);
            state.anchor = anchors;
        }
        let step = Motion { squeeze: R::from_f64(squeeze), ..motion(state, terms, maps, schedule.h) };
        *tally.contacts.get_mut() += active.sweep(&step, team);
    }

    /// Holds cloth to itself and to other cloth by what sticks.
    pub(crate) fn stick_to_cloth(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: Span,
        tally: &mut Tally,
    ) {
        let sticks = |mutual: &Mutual<R>| mutual.terms.iter().flatten().any(Terms::sticks);
        if self.mutual.as_ref().is_some_and(sticks) {
            self.watch_contacts(frame, span, tally);
            let Self { mutual: Some(mutual), state, maps, team, .. } = self else { return };
            mutual.active.stick(&motion(state, &mutual.terms, maps, schedule.h), team);
        }
    }

    /// Makes sure that the contacts are all that can touch in this step. As long as every point stays where
    /// it was foreseen to, nothing needs to be done.
    pub(crate) fn watch_contacts(&mut self, frame: &FrameInput, span: Span, tally: &mut Tally) {
        let Some(mutual) = &mut self.mutual else { return };
        let is_new = span.to > mutual.window[1] + 1e-9;
        if is_new {
            let end = (span.from + (span.to - span.from) * WINDOW).min(1.0);
            mutual.window = [span.from, end.max(span.to)];
            mutual.left.fill(true);
        } else if !self.find_who_left(span) {
            return;
        }
        if self.foresee(frame, span, is_new) {
            let Self { mutual: Some(mutual), cloths, state, team, .. } = self else { return };
            let now = mutual.window[0];
            search(mutual, cloths, &state.anchor, now, team);
            *tally.pairs.get_mut() += mutual.candidates.list.len() as u64;
            *tally.broad_phases.get_mut() += 1;
        }
        let Self { mutual: Some(mutual), cloths, state, team, .. } = self else { return };
        if is_new && (mutual.tangle.is_suspected || mutual.tangle.is_there()) {
            find_crossings(mutual, cloths, &state.anchor, &state.displacement);
        }
        pick(mutual, cloths.len(), &state.anchor, &state.start, team);
    }

    /// Marks the points that are not where they were foreseen to be at the end of the step. Whether there
    /// are any.
    fn find_who_left(&mut self, span: Span) -> bool {
        let Self { mutual: Some(mutual), cloths, state, team, .. } = self else { return false };
        let Mutual { window: [from, to], left, near, .. } = mutual;
        let share = R::from_f64((span.to - *from) / (*to - *from));
        let any = AtomicBool::new(false);
        let left = Shared::new(left);
        for cloth in cloths.iter() {
            team.phase(cloth.blocks.len(), |block| {
                let mut any_here = false;
                for row in cloth.blocks.range(block) {
                    let keeps = near.of(row).holds(share, state.displacement[row as usize].xyz(), R::ZERO);
                    any_here |= !keeps;
                    // SAFETY: blocks do not overlap.
                    #[allow(unsafe_code)]
                    unsafe {
                        left.set(row, !keeps);
                    }
                }
                any.fetch_or(any_here, Ordering::Relaxed);
            });
        }
        any.into_inner()
    }

    /// Writes what is foreseen for the window, for the points that left what was foreseen before; for those
    /// that stray in it from what was foreseen for the frame, that too. Whether there were any.
    fn foresee(&mut self, frame: &FrameInput, span: Span, is_new: bool) -> bool {
        let Self { mutual: Some(mutual), cloths, state, team, .. } = self else { return false };
        let Mutual { far, near, window, strayed, left, .. } = mutual;
        let ahead = Ahead::new(span, *window, mean_motion(&state.start, &state.displacement));
        let (near, far, strayed) = (near.shared(), far.shared(), Shared::new(strayed));
        let any = AtomicBool::new(false);
        for (cloth, settings) in cloths.iter().zip(&frame.cloths) {
            let thickness = settings.thickness.max(settings.self_collision.thickness);
            let ball = |[of_thickness, of_edge]: [f64; 2]| {
                R::from_f64((of_thickness * thickness).max(of_edge * cloth.edge_length).max(LEAST_BALL))
            };
            let balls = [ball(NEAR_BALL), ball(FAR_BALL)];
            // A free point is small on any way: what is near its line is found along it.
            let is_free = cloth.skin.triangles.is_empty();
            let farthest = R::from_f64(if is_free { ENDLESS } else { FARTHEST * cloth.edge_length });
            team.phase(cloth.blocks.len(), |block| {
                for row in cloth.blocks.range(block).filter(|&row| left[row as usize]) {
                    let before = state.start[row as usize].xyz();
                    let motion = sub(state.displacement[row as usize].xyz(), before);
                    let soon = ahead.in_window(before, motion, balls[0]);
                    // SAFETY: blocks do not overlap.
                    #[allow(unsafe_code)]
                    unsafe {
                        let known = (!strayed.get(row)).then(|| far.of(row));
                        // In the first window of a frame there is none before.
                        let last = (window[0] > 0.0).then(|| near.of(row).from);
                        let known = known.filter(|later| !is_new || ahead.stays(later, before, motion, last));
                        if let Some(kept) = known.and_then(|later| ahead.keep(soon, &later, before, motion)) {
                            near.set(row, kept);
                            continue;
                        }
                        let later = ahead.in_frame(before, motion, balls, farthest);
                        far.set(row, later);
                        near.set(row, ahead.keep(soon, &later, before, motion).unwrap_or(soon));
                        strayed.set(row, true);
                        any.store(true, Ordering::Relaxed);
                    }
                }
            });
        }
        any.into_inner()
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

/// What foreseeing goes by.
struct Ahead<R> {
    /// Start and end of the window, as shares of the frame.
    window: [R; 2],
    /// Start of the step, as a share of the window.
    begun: R,
    /// Steps in a window and in a frame.
    steps: [R; 2],
    /// The motion of all points in a step, in the mean.
    common: [R; 3],
}

impl<R: Real> Ahead<R> {
    fn new(span: Span, window: [f64; 2], common: [R; 3]) -> Self {
        let (step, length) = (span.to - span.from, window[1] - window[0]);
        Self {
            window: window.map(R::from_f64),
            begun: R::from_f64((span.from - window[0]) / length),
            steps: [R::from_f64(length / step), R::from_f64(1.0 / step)],
            common,
        }
    }

    /// On through the window as in this step.
    #[inline(always)]
    fn in_window(&self, before: [R; 3], motion: [R; 3], ball: R) -> Path<R> {
        let travel = scale(motion, self.steps[0]);
        Path { from: sub(before, scale(travel, self.begun)), travel, ball }
    }

    /// On through the frame as in this step, but no farther from what all do in common than `farthest`; within a ball
    /// that has room for this step all the same.
    #[inline(always)]
    fn in_frame(&self, before: [R; 3], motion: [R; 3], [soon, ball]: [R; 2], farthest: R) -> Path<R> {
        let now = self.window[0] + (self.window[1] - self.window[0]) * self.begun;
        let most = farthest / (R::ONE - now + R::EPSILON);
        let travel = limited(scale(motion, self.steps[1]), scale(self.common, self.steps[1]), most);
        let missed = sub(motion, scale(travel, R::ONE / self.steps[1]));
        let room = dot(missed, missed).sqrt() * R::from_f64(1.5) + soon;
        let ball = if room > ball { room } else { ball };
        Path { from: sub(before, scale(travel, now)), travel, ball }
    }

    /// Whether a point that goes on as in this step, or as from its place at the start of the window before, keeps to
    /// what is foreseen for the frame. Who will leave anyway is best looked at now, with all the others.
    #[inline(always)]
    fn stays(&self, later: &Path<R>, before: [R; 3], motion: [R; 3], last: Option<[R; 3]>) -> bool {
        let length = self.window[1] - self.window[0];
        let travel = scale(later.travel, length);
        let off = sub(before, later.at(self.window[0]));
        let most = later.ball * R::from_f64(STAYS);
        let leaves = |way: [R; 3]| {
            let there = add(off, sub(way, travel));
            dot(there, there) > most * most
        };
        !leaves(scale(motion, self.steps[0])) || last.is_some_and(|last| !leaves(sub(before, last)))
    }

    /// What is foreseen for the window, given what is foreseen for the frame: `soon`, if that keeps to it. A point that
    /// trembles is not where this step would take it in the next; it stays beside what was foreseen for the frame.
    /// Nothing if it is no longer there.
    #[inline(always)]
    fn keep(&self, soon: Path<R>, later: &Path<R>, before: [R; 3], motion: [R; 3]) -> Option<Path<R>> {
        if self.is_kept(&soon, later) {
            return Some(soon);
        }
        let length = self.window[1] - self.window[0];
        let step = R::ONE / self.steps[1];
        let half = R::from_f64(0.5);
        let amid = self.window[0] + length * self.begun + step * half;
        let off = sub(add(before, scale(motion, half)), later.at(amid));
        let room = later.ball - dot(off, off).sqrt();
        let own = sub(motion, scale(later.travel, step));
        let need = dot(own, own).sqrt() * half;
        if room <= need * R::from_f64(1.0 + 1e-3) {
            return None;
        }
        let wished = soon.ball * R::from_f64(4.0) + need + need;
        let ball = if wished < room { wished } else { room };
        Some(Path { from: add(off, later.at(self.window[0])), travel: scale(later.travel, length), ball })
    }

    /// Whether a point that keeps to `soon` from now to the end of the window keeps to `later` too.
    #[inline(always)]
    fn is_kept(&self, soon: &Path<R>, later: &Path<R>) -> bool {
        let now = self.window[0] + (self.window[1] - self.window[0]) * self.begun;
        later.holds(now, soon.at(self.begun), soon.ball)
            && later.holds(self.window[1], soon.at(R::ONE), soon.ball)
    }
}

/// A time step as contacts see it.
pub(crate) fn motion<'a, R: Real>(
    state: &'a mut State<R>,
    terms: &'a [Option<Terms<R>>],
    maps: &'a Maps<R>,
    h: f64,
) -> Motion<'a, R> {
    Motion {
        displacement: Shared::new(&mut state.displacement),
        predicted: Shared::new(&mut state.predicted),
        start: &state.start,
        terms,
        maps,
        h: R::from_f64(h),
        squeeze: R::ONE,
    }
}

/// The mean motion of all points in a step: what they have in common brings none nearer to another.
fn mean_motion<R: Real>(start: &[Row4<R>], now: &[Row4<R>]) -> [R; 3] {
    let mut sum = [0.0f64; 3];
    for (start, now) in start.iter().zip(now) {
        let motion = sub(now.xyz(), start.xyz());
        for axis in 0..3 {
            sum[axis] += motion[axis].to_f64();
        }
    }
    sum.map(|x| R::from_f64(x / start.len().max(1) as f64))
}

/// A motion that differs from the common one by `most` at most.
fn limited<R: Real>(motion: [R; 3], common: [R; 3], most: R) -> [R; 3] {
    let own = sub(motion, common);
    let length = dot(own, own).sqrt();
    if length > most { add(common, scale(own, most / length)) } else { motion }
}
