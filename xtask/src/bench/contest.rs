//! What we need for no more error than a peer.

use super::peers::Peer;
use super::trial::Outcome;
use super::workload::Workload;

/// A sheet that swings to less than this many metres is locked or damped, whatever its strain.
const LEAST_SAG: f64 = 0.95;

/// With more error than this many percent a run is no cloth, and answers nobody, not even a peer that blew up.
const MOST_ERROR: f64 = 100.0;

/// A peer and our answer to it.
#[derive(Debug, Clone, Copy)]
pub struct Contest<'a> {
    /// The peer's figures.
    pub peer: &'a Peer,
    /// Our fastest run of no more error; nothing where no run of ours gets there.
    pub answer: Option<&'a Outcome>,
    /// Our run of least error.
    pub best: &'a Outcome,
}

impl<'a> Contest<'a> {
    /// Answers a peer with the runs of the same workload and size on one thread; nothing where there are none.
    pub fn new(peer: &'a Peer, runs: &'a [Outcome]) -> Option<Self> {
        let same = |run: &&Outcome| {
            let trial = run.trial;
            (trial.workload, trial.size, trial.threads) == (peer.workload, peer.size, 1)
        };
        let ours = || runs.iter().filter(same);
        let enough = ours().filter(|run| no_worse(run, peer));
        let answer = enough.min_by(|a, b| a.ms().total_cmp(&b.ms()));
        let best = ours().min_by(|a, b| error(a).total_cmp(&error(b)))?;
        Some(Self { peer, answer, best })
    }

    /// How many times as long the peer takes; nothing where we do not get there.
    pub fn lead(&self) -> Option<f64> {
        self.answer.map(|answer| self.peer.ms / answer.ms())
    }

    /// Whether we get there, and sooner.
    pub fn is_won(&self) -> bool {
        self.lead().is_some_and(|lead| lead > 1.0)
    }
}

/// The error that a workload is judged by, in percent.
pub fn error(run: &Outcome) -> f64 {
    100.0
        * match run.trial.workload {
            Workload::Swing | Workload::Hang => run.accuracy.strain,
            Workload::Drape => run.accuracy.stretch,
        }
}

fn no_worse(run: &Outcome, peer: &Peer) -> bool {
    let accuracy = &run.accuracy;
    let swings = run.trial.workload != Workload::Swing || accuracy.sag >= LEAST_SAG;
    let depths = [accuracy.depth, accuracy.worst_depth].map(|depth| 1e3 * depth);
    // Where the peer's was not noted, ours has to be nil.
    let allowed = peer.depth.unwrap_or_default();
    let is_drape = run.trial.workload == Workload::Drape;
    let shallow = !is_drape || (0..2).all(|k| depths[k] <= allowed[k]);
    error(run) <= peer.error.min(MOST_ERROR) && swings && shallow
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::accuracy::Accuracy;
    use crate::bench::trial::Trial;
    use crate::bench::workload::Setting;
    use nucleus_measure::clock::Spent;

    const PEER: Peer = Peer {
        name: "peer",
        version: "1",
        setting: "",
        workload: Workload::Drape,
        size: 9,
        ms: 8.0,
        error: 1.0,
        depth: Some([1.0, 2.0]),
    };

    /// A run of so many milliseconds, so much error in percent, and so deep in millimetres.
    fn run(ms: f64, percent: f64, depth: f64) -> Outcome {
        let setting = Setting { resistance: 20.0, bend: 0.0, evaluations: 24 };
        let accuracy = Accuracy {
            strain: percent / 100.0,
            stretch: percent / 100.0,
            max: 0.0,
            worst_max: 0.0,
            sag: 1.0,
            energy: 0.0,
            depth: depth / 1e3,
            worst_depth: depth / 1e3,
            lower_edge: 0.0,
        };
        let spent = Spent { wall: ms / 1e3, processor: ms / 1e3 };
        Outcome {
            trial: Trial { workload: Workload::Drape, size: 9, setting, threads: 1, frames: 1 },
            spent,
            median_frame: spent,
            build: 0.0,
            shares: Default::default(),
            evaluations: 1.0,
            searches: 1.0,
            pairs_unresolved: 0,
            accuracy,
            hash: 0,
        }
    }

    #[test]
    fn the_fastest_run_of_no_more_error_answers() {
        let runs = [run(1.0, 3.0, 0.0), run(2.0, 0.9, 0.0), run(3.0, 0.5, 0.0), run(1.5, 0.5, 4.0)];
        let contest = Contest::new(&PEER, &runs).unwrap();
        assert_eq!((contest.lead(), contest.is_won()), (Some(4.0), true));
        assert_eq!(error(contest.best), 0.5);
    }

    #[test]
    fn being_slower_or_less_exact_is_no_win() {
        assert!(!Contest::new(&PEER, &[run(9.0, 0.5, 0.0)]).unwrap().is_won());
        let inexact = [run(1.0, 3.0, 0.0)];
        let contest = Contest::new(&PEER, &inexact).unwrap();
        assert_eq!((contest.lead(), contest.is_won()), (None, false));
    }

    #[test]
    fn a_peer_that_blew_up_is_not_answered_by_a_run_that_nearly_did() {
        let peer = Peer { error: f64::INFINITY, ..PEER };
        let runs = [run(1.0, 300.0, 0.0), run(1.0, f64::INFINITY, 0.0), run(2.0, 50.0, 0.0)];
        assert_eq!(Contest::new(&peer, &runs).unwrap().lead(), Some(4.0));
        assert!(!Contest::new(&peer, &runs[..2]).unwrap().is_won());
    }

    #[test]
    fn a_locked_sheet_answers_nobody() {
        let swing = |sag: f64| {
            let mut run = run(1.0, 0.1, 0.0);
            (run.trial.workload, run.accuracy.sag) = (Workload::Swing, sag);
            run
        };
        let peer = Peer { workload: Workload::Swing, ..PEER };
        assert!(Contest::new(&peer, &[swing(1.0)]).unwrap().is_won());
        assert!(!Contest::new(&peer, &[swing(0.6)]).unwrap().is_won());
    }

    #[test]
    fn runs_of_another_size_answer_nobody() {
        assert!(Contest::new(&Peer { size: 10, ..PEER }, &[run(1.0, 0.1, 0.0)]).is_none());
    }
}
