//! Our fastest run with no more error than a peer.

use super::peers::Peer;
use super::run::RunResult;
use super::workload::Workload;

/// A sheet that sags less, in metres, is locked or overdamped, whatever its strain.
const LEAST_SAG: f64 = 0.95;

/// Runs above this error in percent never count, not even against a peer that diverged.
const MOST_ERROR: f64 = 100.0;

/// A peer and our answer to it.
#[derive(Debug, Clone, Copy)]
pub struct Comparison<'a> {
    /// The peer's figures.
    pub peer: &'a Peer,
    /// Our fastest run of no more error, if there is one.
    pub answer: Option<&'a RunResult>,
    /// Our run of least error.
    pub best: &'a RunResult,
}

impl<'a> Comparison<'a> {
    /// Compares a peer with the runs of the same workload and size on one thread; `None` without such runs.
    pub fn new(peer: &'a Peer, runs: &'a [RunResult]) -> Option<Self> {
        let same = |run: &&RunResult| {
            let spec = run.spec;
            (spec.workload, spec.size, spec.threads) == (peer.workload, peer.size, 1)
        };
        let ours = || runs.iter().filter(same);
        let enough = ours().filter(|run| no_worse(run, peer));
        let answer = enough.min_by(|a, b| a.ms().total_cmp(&b.ms()));
        let best = ours().min_by(|a, b| error(a).total_cmp(&error(b)))?;
        Some(Self { peer, answer, best })
    }

    /// Time of the peer over ours; `None` without a run of no more error.
    pub fn speedup(&self) -> Option<f64> {
        self.answer.map(|answer| self.peer.ms / answer.ms())
    }

    /// Whether such a run exists and is faster.
    pub fn is_ahead(&self) -> bool {
        self.speedup().is_some_and(|speedup| speedup > 1.0)
    }
}

/// The error of a workload, in percent.
pub fn error(run: &RunResult) -> f64 {
    100.0
        * match run.spec.workload {
            Workload::Swing | Workload::Hang => run.accuracy.strain,
            Workload::Drape => run.accuracy.stretch,
        }
}

fn no_worse(run: &RunResult, peer: &Peer) -> bool {
    let accuracy = &run.accuracy;
    let swings = run.spec.workload != Workload::Swing || accuracy.sag >= LEAST_SAG;
    let depths = [accuracy.depth, accuracy.worst_depth].map(|depth| 1e3 * depth);
    // If the peer's depth is unknown, ours must be zero.
    let allowed = peer.depth.unwrap_or_default();
    let is_drape = run.spec.workload == Workload::Drape;
    let shallow = !is_drape || (0..2).all(|k| depths[k] <= allowed[k]);
    error(run) <= peer.error.min(MOST_ERROR) && swings && shallow
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::accuracy::Accuracy;
    use crate::bench::run::RunSpec;
    use crate::bench::workload::{Setting, Variant};
    use nucleus_measure::clock::Timing;

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

    /// A run of `ms` milliseconds, `percent` error, and `depth` millimetres.
    fn run(ms: f64, percent: f64, depth: f64) -> RunResult {
        let setting = Setting { resistance: 20.0, bend: 0.0, evaluations: 24, variant: Variant::Plain };
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
        let timing = Timing { wall: ms / 1e3, processor: ms / 1e3 };
        RunResult {
            spec: RunSpec { workload: Workload::Drape, size: 9, setting, threads: 1, frames: 1 },
            timing,
            median_frame: timing,
            build: 0.0,
            shares: Default::default(),
            evaluations: 1.0,
            queries: 1.0,
            pairs_unresolved: 0,
            accuracy,
            hash: 0,
        }
    }

    #[test]
    fn the_fastest_run_of_no_more_error_counts() {
        let runs = [run(1.0, 3.0, 0.0), run(2.0, 0.9, 0.0), run(3.0, 0.5, 0.0), run(1.5, 0.5, 4.0)];
        let comparison = Comparison::new(&PEER, &runs).unwrap();
        assert_eq!((comparison.speedup(), comparison.is_ahead()), (Some(4.0), true));
        assert_eq!(error(comparison.best), 0.5);
    }

    #[test]
    fn being_slower_or_less_exact_is_no_win() {
        assert!(!Comparison::new(&PEER, &[run(9.0, 0.5, 0.0)]).unwrap().is_ahead());
        let inexact = [run(1.0, 3.0, 0.0)];
        let comparison = Comparison::new(&PEER, &inexact).unwrap();
        assert_eq!((comparison.speedup(), comparison.is_ahead()), (None, false));
    }

    #[test]
    fn a_run_that_nearly_diverged_does_not_count_against_a_diverged_peer() {
        let peer = Peer { error: f64::INFINITY, ..PEER };
        let runs = [run(1.0, 300.0, 0.0), run(1.0, f64::INFINITY, 0.0), run(2.0, 50.0, 0.0)];
        assert_eq!(Comparison::new(&peer, &runs).unwrap().speedup(), Some(4.0));
        assert!(!Comparison::new(&peer, &runs[..2]).unwrap().is_ahead());
    }

    #[test]
    fn a_locked_sheet_does_not_count() {
        let swing = |sag: f64| {
            let mut run = run(1.0, 0.1, 0.0);
            (run.spec.workload, run.accuracy.sag) = (Workload::Swing, sag);
            run
        };
        let peer = Peer { workload: Workload::Swing, ..PEER };
        assert!(Comparison::new(&peer, &[swing(1.0)]).unwrap().is_ahead());
        assert!(!Comparison::new(&peer, &[swing(0.6)]).unwrap().is_ahead());
    }

    #[test]
    fn runs_of_another_size_do_not_count() {
        assert!(Comparison::new(&Peer { size: 10, ..PEER }, &[run(1.0, 0.1, 0.0)]).is_none());
    }
}
