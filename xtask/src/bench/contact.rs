//! Self-contact, contact of layers, and a ball at 10 m/s: cost and penetrations. An audit, which shares no code with the
//! solver, counts the penetrations.
//!
//! Every run is executed twice, once timed and once audited. Both must end with the same bits, so that the audited run is
//! the timed one.
//!
//! | Question                                 | Module     |
//! |------------------------------------------|------------|
//! | the workloads                            | [`workload`] |
//! | the scenes                               | [`scene`]  |
//! | one run                                  | [`mod@run`] |
//! | figures of other solvers                 | [`peers`]  |
//! | the tables                               | [`tables`] |
//! | cost of self-collision, and its scaling  | [`cost`]   |
//! | the cloth of the scaling test            | [`pile`]   |

use super::report::Report;
use super::table::figure;
use anyhow::ensure;

pub mod cost;
mod peers;
mod pile;
mod run;
mod scene;
mod tables;
mod workload;

use peers::{PEERS, answer};
use run::{RunResult, RunSpec};
use workload::TYPICAL;
pub use workload::Workload;

/// Target speed-up of W3 over the fastest peer without penetrations.
const LEAD: f64 = 5.0;

/// Target speed-up of two threads, and its size.
const PAIR_TARGET: f64 = 1.5;
const PAIR_SIZE: u32 = 129;

/// Runs a workload at all sizes and settings on one thread, and at one setting on all.
///
/// # Errors
/// When a scene is rejected, or repeated runs differ.
pub fn run(workload: Workload, sizes: &[u32], threads: &[u32], report: &mut Report) -> anyhow::Result<()> {
    let mut runs = Vec::new();
    for &size in sizes.iter().filter(|size| **size <= workload.largest()) {
        for &evaluations in workload.evaluations() {
            runs.push(RunSpec::full(workload, size, evaluations).timed_and_audited()?);
        }
        let side_by_side = on_threads(&RunSpec::full(workload, size, TYPICAL), threads, &runs)?;
        report.show(tables::threads(&side_by_side));
        check_thread_targets(&side_by_side, report);
    }
    if runs.is_empty() {
        eprintln!("{}: no size up to {}² was asked for", workload.name(), workload.largest());
        return Ok(()); // nothing passes through nothing
    }
    report.show(tables::own(workload, &runs));
    report.show(tables::by_stage(workload, &runs));
    report.show(tables::compared_with_peers(workload, &runs));
    check_target(workload, sizes, &runs, report);
    Ok(())
}

/// The same run on each number of threads, with identical results required. Reuses known runs.
fn on_threads(spec: &RunSpec, threads: &[u32], known: &[RunResult]) -> anyhow::Result<Vec<RunResult>> {
    let run = |&threads: &u32| {
        let same = |run: &&RunResult| run.spec == *spec && run.timed.threads == threads;
        known.iter().find(same).map_or_else(|| spec.timed(threads), |run| Ok(run.clone()))
    };
    let runs: anyhow::Result<Vec<RunResult>> = threads.iter().map(run).collect();
    let runs = runs?;
    for run in &runs {
        let (name, size) = (spec.workload.name(), spec.size);
        ensure!(run.timed.hash == runs[0].timed.hash, "{name} {size}²: threads change the result");
    }
    Ok(runs)
}

fn check_thread_targets(runs: &[RunResult], report: &mut Report) {
    for run in runs {
        let (spec, first) = (&run.spec, &runs[0].timed);
        if (first.threads, run.timed.threads, spec.size) == (1, 2, PAIR_SIZE) {
            let gain = first.timing.wall / run.timed.timing.wall;
            let (name, size) = (spec.workload.name(), spec.size);
            let target = format!("{name} {size}²: two threads at least {PAIR_TARGET} times one");
            report.check_target(target, format!("{} times", figure(gain)), gain >= PAIR_TARGET);
        }
    }
}

fn check_target(workload: Workload, sizes: &[u32], runs: &[RunResult], report: &mut Report) {
    let found: u64 = runs.iter().filter_map(|run| run.audit).map(|report| report.found()).sum();
    let target = format!("{}: no penetration at any setting", workload.name());
    report.check_target(target, format!("{found} found"), found == 0);
    for &size in sizes {
        let clean =
            PEERS.iter().filter(|peer| (peer.workload, peer.size, peer.left) == (workload, size, "0"));
        let Some(best) = clean.min_by(|a, b| a.ms.total_cmp(&b.ms)) else { continue };
        let speedup = answer(best, runs).map(|run| best.ms / run.ms());
        let target = format!("{} {size}²: at least {LEAD} times as fast as {}", workload.name(), best.name);
        let found = speedup.map_or("no run without penetration at this stretch".to_owned(), |speedup| {
            format!("{} times", figure(speedup))
        });
        report.check_target(target, found, speedup.is_some_and(|speedup| speedup >= LEAD));
    }
}

#[cfg(test)]
mod tests {
    use nucleus_audit::AuditCounts;

    use super::peers::Peer;
    use super::*;

    #[test]
    fn a_run_with_crossings_answers_nobody() {
        let spec = RunSpec { frames: 1, ..RunSpec::full(Workload::Folds, 9, 6) };
        let mut run = spec.timed_and_audited().unwrap();
        let peer = Peer { size: 9, stretch: None, ..PEERS[0] };
        assert!(answer(&peer, std::slice::from_ref(&run)).is_some());
        run.audit = Some(AuditCounts { intersections: 1, ..AuditCounts::default() });
        assert!(answer(&peer, std::slice::from_ref(&run)).is_none());
    }

    #[test]
    fn a_target_is_not_met_by_running_nothing() {
        let mut report = Report::default();
        run(Workload::Layers, &[2000], &[1], &mut report).unwrap();
        assert!(report.targets.is_empty() && report.tables.is_empty());
    }

    #[test]
    fn a_known_run_is_not_repeated_on_threads() {
        let spec = RunSpec { frames: 2, ..RunSpec::full(Workload::Layers, 9, 6) };
        let mut known = spec.timed(1).unwrap();
        let runs = on_threads(&spec, &[1, 3], std::slice::from_ref(&known)).unwrap();
        assert_eq!(runs.iter().map(|run| run.timed.threads).collect::<Vec<_>>(), [1, 3]);
        assert_eq!(runs[0].timed.timing, known.timed.timing);
        // Another result on other threads is found out.
        known.timed.hash ^= 1;
        assert!(on_threads(&spec, &[1, 3], &[known]).is_err());
    }
}
