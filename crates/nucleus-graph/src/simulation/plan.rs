//! What is to be solved on the way to a frame.

use nucleus_core::Real;

use crate::attributes::nucleus;

use super::Simulation;

/// A stretch of time of one nucleus, to be solved in one go.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Leap {
    pub(super) universe: usize,
    /// From this frame of the scene to that one.
    pub(super) frames: [f64; 2],
    /// How many frames that is to the nucleus.
    pub(super) elapsed: f64,
    /// What was evaluated before has not been solved: things are elsewhere than the solver has them.
    pub(super) leaps: bool,
    pub(super) substeps: u32,
    /// The first at its time.
    pub(super) is_new_time: bool,
    /// Its nucleus goes back to its initial state first.
    pub(super) begins_anew: bool,
}

impl<R: Real> Simulation<R> {
    /// All evaluations up to a frame, nucleus by nucleus at each. At or before the start frame a nucleus is in
    /// its initial state. When it is not enabled, or its time does not go on, or leaps farther than
    /// `frameJumpLimit` allows, it keeps the state it has.
    pub(super) fn plan(&mut self, frame: i64) -> Vec<Leap> {
        let mut leaps = Vec::new();
        for time in self.times(frame) {
            let moment = self.program.graph().at(time);
            let first = leaps.len();
            for (universe, run) in self.runs.iter_mut().enumerate() {
                let whole = &self.program.universes()[universe];
                let (id, start) = (whole.nucleus(), whole.start() as f64);
                let now = moment.get(id, &nucleus::CURRENT_TIME);
                let (elapsed, from) = (now - run.now, run.evaluated);
                (run.now, run.evaluated) = (now, time);
                let most = (moment.get(id, &nucleus::FRAME_JUMP_LIMIT) as f64).max(self.program.every());
                let goes_on = elapsed > 0.0 && elapsed <= most * (1.0 + 1e-9) && now > start;
                if !goes_on || !moment.get(id, &nucleus::ENABLE) {
                    run.left_out = true;
                    continue;
                }
                let begins_anew = run.left_out && now - elapsed <= start;
                leaps.push(Leap {
                    universe,
                    frames: [from, time],
                    elapsed,
                    leaps: std::mem::take(&mut run.left_out),
                    substeps: moment.get(id, &nucleus::SUB_STEPS) as u32,
                    is_new_time: leaps.len() == first,
                    begins_anew,
                });
            }
        }
        leaps
    }

    /// The times between the frame it is at and another at which everything is evaluated.
    fn times(&self, frame: i64) -> Vec<f64> {
        let parts = (1.0 / self.program.every()).round().max(1.0) as i64;
        let at = |part: i64| {
            if part == parts { frame as f64 } else { frame as f64 - 1.0 + part as f64 / parts as f64 }
        };
        (1..=parts).map(at).collect()
    }
}
