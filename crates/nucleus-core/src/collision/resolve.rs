//! One collision pass: every pair is kept apart once, points against faces last.

use std::sync::atomic::{AtomicU64, Ordering};

use super::contact::{Outcome, Pair, Step};
use super::pairs::PairList;
use crate::columns::Shared;
use crate::scalar::Real;
use crate::team::Team;

/// How often the pairs of one point are gone through while they still push it about.
const ROUNDS: usize = 4;

/// What collision passes have done. Whole numbers, so that the order of adding does not matter.
#[derive(Debug, Default)]
pub struct Tally {
    /// Contacts that pushed.
    pub contacts: AtomicU64,
    /// Points that were caught on the far side.
    pub caught: AtomicU64,
    /// Pairs for which no plane held.
    pub crossed: AtomicU64,
    /// Pairs found by the broad phase.
    pub pairs: AtomicU64,
    /// Runs of the broad phase.
    pub broad_phases: AtomicU64,
}

impl Tally {
    fn count(&self, outcome: Outcome) -> bool {
        match outcome {
            Outcome::Apart => return false,
            Outcome::Pushed => self.contacts.fetch_add(1, Ordering::Relaxed),
            Outcome::Caught => self.caught.fetch_add(1, Ordering::Relaxed),
            Outcome::Tangled => self.crossed.fetch_add(1, Ordering::Relaxed),
        };
        outcome != Outcome::Tangled
    }
}

/// Keeps every pair of the list apart once.
pub fn resolve<R: Real>(list: &mut PairList<R>, step: &Step<'_, R>, team: &Team, tally: &Tally) {
    for pair in &mut list.edge_edge {
        tally.count(pair.resolve(step));
    }
    for pair in &mut list.face_point {
        tally.count(pair.resolve(step));
    }
    let runs = &list.runs;
    let pairs = Shared::new(&mut list.point_face);
    team.phase(runs.len(), |block| {
        // SAFETY: the runs of two blocks do not overlap, and neither do their points.
        #[allow(unsafe_code)]
        let run = unsafe { pairs.run(runs[block].clone()) };
        run.chunk_by_mut(|a, b| a.points == b.points).for_each(|pairs| settle_point(pairs, step, tally));
    });
}

/// Goes through the pairs of one point until none pushes it any more.
fn settle_point<R: Real>(pairs: &mut [Pair<R, 1, 3>], step: &Step<'_, R>, tally: &Tally) {
    for _ in 0..ROUNDS {
        let mut pushed = 0;
        for pair in pairs.iter_mut() {
            pushed += usize::from(tally.count(pair.resolve(step)));
        }
        if pushed == 0 || pairs.len() == 1 {
            return;
        }
    }
}
