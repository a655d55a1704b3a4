//! The last word of a time step: the proof that nothing passed anything.
//!
//! What is not proven is pushed apart again; then by less and less of its thickness, for between two bodies there may be
//! no room for all of it; then held back on its way, each on its own side; then it goes nowhere in this step, except
//! along with what carries it. The places at the start of the step were proven, so going nowhere is proven too: only
//! between bodies that close on it, and pins that cross, is there no such way out, and what is there is let go and
//! counted.

use crate::contact::cloth::Mutual;
use crate::contact::cloth_pass::motion;
use crate::contact::resolve::Tally;
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::output::{Stage, StepObserver};
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Solver};

/// How often each remedy is tried before the next.
const PUSHES: usize = 4;
const SQUEEZES: usize = 6;
const CLIPS: usize = 8;
const STOPS: usize = 32;

/// Attempts after which pushing is over.
const SQUEEZED: usize = PUSHES + SQUEEZES;

impl<R: Real> Solver<R> {
    /// Proves at the end of a time step that nothing passed anything, and sees to it that it is so.
    pub(crate) fn settle(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        tally: &mut Tally,
        watch: &mut dyn StepObserver,
    ) {
        let meets = self.contact.mutual.as_ref().is_some_and(Mutual::is_on);
        for attempt in 0..=SQUEEZED + CLIPS + STOPS {
            watch.enter(Stage::BroadPhase);
            if meets {
                self.watch_contacts(frame, span, tally);
            }
            watch.enter(Stage::Contact);
            let cloths = self.prove_cloths(schedule);
            let [sides, inseparable] = self.prove_sides(frame, schedule, span, tally);
            let open = [cloths, sides];
            let is_last = attempt == SQUEEZED + CLIPS + STOPS;
            if open == [0, 0] || is_last {
                *tally.pairs_unresolved.get_mut() += open[0] + open[1] + inseparable;
            }
            if open == [0, 0] {
                return;
            }
            if attempt < SQUEEZED {
                let squeeze = 0.5f64.powi((attempt + 1).saturating_sub(PUSHES) as i32);
                if open[0] > 0 {
                    self.meet(squeeze, frame, schedule, span, tally, watch);
                }
                self.meet_colliders(squeeze, frame, schedule, span, tally, watch);
            } else if attempt < SQUEEZED + CLIPS {
                self.clip(schedule, tally);
                self.hold_sides(frame, schedule, span, tally);
            } else if !is_last {
                if attempt == SQUEEZED + CLIPS {
                    self.hold_none();
                }
                self.hold_sides(frame, schedule, span, tally);
                self.stop(schedule, tally);
            } else {
                return self.let_go(frame, schedule, span, open[0] > 0, tally);
            }
        }
    }

    fn prove_cloths(&mut self, schedule: &Schedule<R>) -> u64 {
        let Self { state, pool, contact: ContactSystem { mutual: Some(mutual), maps, .. }, .. } = self else {
            return 0;
        };
        let Mutual { active, terms, .. } = mutual;
        active.prove(&motion(state, terms, maps, schedule.h), pool)
    }

    fn clip(&mut self, schedule: &Schedule<R>, tally: &mut Tally) {
        let Self { state, contact: ContactSystem { mutual: Some(mutual), maps, .. }, .. } = self else {
            return;
        };
        let Mutual { active, terms, .. } = mutual;
        *tally.pairs_reverted.get_mut() += active.clip(&motion(state, terms, maps, schedule.h));
    }

    /// Lets contacts that are not proven go nowhere, or where one of their points is held already.
    fn stop(&mut self, schedule: &Schedule<R>, tally: &mut Tally) {
        let Self { state, contact: ContactSystem { mutual: Some(mutual), maps, .. }, .. } = self else {
            return;
        };
        let Mutual { active, held, terms, .. } = mutual;
        *tally.pairs_reverted.get_mut() += active.stop(&motion(state, terms, maps, schedule.h), held);
    }

    /// Begins with no point held but those that are pinned.
    fn hold_none(&mut self) {
        let Self { state, contact: ContactSystem { mutual: Some(mutual), .. }, .. } = self else { return };
        mutual.held.clear();
        mutual.held.extend(state.displacement.iter().map(|row| row.0[3] <= R::ZERO));
    }

    /// Lets contacts that nothing helps be where they are. What they are then is looked at anew.
    fn let_go(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        among_cloths: bool,
        tally: &mut Tally,
    ) {
        self.release_sides(frame, schedule, span, tally);
        if let Some(mutual) = &mut self.contact.mutual {
            mutual.tangle.is_suspected |= among_cloths;
        }
    }
}
