//! Tables of a workload: our runs, stages, threads, and comparison with peers.

use nucleus_graph::audit::Closeness;

use super::peers::{PEERS, answer};
use super::run::RunResult;
use super::workload::{TYPICAL, Workload};
use crate::bench::peers::SOURCE;
use crate::bench::table::{Table, figure};

/// All runs of a workload.
pub fn own(workload: Workload, runs: &[RunResult]) -> Table {
    let head = [
        "points",
        "ms",
        "wall",
        "stretch %",
        "largest %",
        "worst %",
        "depth mm",
        "worst mm",
        "found",
        "inside",
        "setting",
        "hash",
    ];
    let mut table = Table::new(&format!("{}: our runs", workload.name()), &head);
    for run in runs {
        let report = run.audit.unwrap_or_default();
        let [largest, worst] = run.largest.map(|stretch| 1e2 * stretch);
        let [depth, worst_depth] = run.depths.map(|depth| 1e3 * depth);
        let cells = [
            run.ms(),
            1e3 * run.timed.timing.wall,
            1e2 * run.stretch,
            largest,
            worst,
            depth,
            worst_depth,
            report.found() as f64,
            report.current_intersections as f64,
        ];
        let setting = [run.spec.setting.to_string(), format!("{:016x}", run.timed.hash)];
        table.row([format!("{}²", run.spec.size)].into_iter().chain(cells.map(figure)).chain(setting));
    }
    let scope = match workload.closeness() {
        Closeness::Frames => "edges inside faces at the ends of frames",
        Closeness::Steps => "pairs that passed through each other between consecutive states of the solver",
    };
    table.note(format!("Found: {scope}, over the whole run. Inside: edges inside faces at the last frame."));
    table
}

/// Time by stage at the typical setting.
pub fn by_stage(workload: Workload, runs: &[RunResult]) -> Table {
    let typical = runs.iter().filter(|run| run.spec.setting.evaluations == TYPICAL);
    let row = |run: &RunResult| (vec![format!("{}²", run.spec.size)], run.ms(), run.timed.shares);
    let title = format!("{}: milliseconds per frame by stage, {TYPICAL} evaluations", workload.name());
    Table::by_stage(&title, &["points"], &typical.map(row).collect::<Vec<_>>())
}

/// The same run on several numbers of threads, with the speed-up relative to the first.
pub fn threads(runs: &[RunResult]) -> Table {
    let head = ["points", "threads", "wall ms", "times as fast", "hash"];
    let title = runs.first().map(|run| {
        let spec = &run.spec;
        format!("{} {}²: threads, {}", spec.workload.name(), spec.size, spec.setting)
    });
    let mut table = Table::new(&title.unwrap_or_default(), &head);
    for run in runs {
        let wall = run.timed.timing.wall;
        let cells = [1e3 * wall, runs[0].timed.timing.wall / wall].map(figure);
        let first = [format!("{}²", run.spec.size), run.timed.threads.to_string()];
        table.row(first.into_iter().chain(cells).chain([format!("{:016x}", run.timed.hash)]));
    }
    table
}

/// Each peer with our fastest run of no more stretch and no penetration.
pub fn compared_with_peers(workload: Workload, runs: &[RunResult]) -> Table {
    let head = [
        "points",
        "peer",
        "its ms",
        "its stretch %",
        "penetrations",
        "our ms",
        "our stretch %",
        "times as fast",
    ];
    let title = format!("{}: fastest run with no more stretch and no penetration", workload.name());
    let mut table = Table::new(&title, &head);
    for peer in PEERS.iter().filter(|peer| peer.workload == workload) {
        if !runs.iter().any(|run| run.spec.size == peer.size) {
            continue;
        }
        let ours = answer(peer, runs);
        let number = |x: Option<f64>| x.map_or("-".to_owned(), figure);
        table.row([
            format!("{}²", peer.size),
            peer.name.to_owned(),
            figure(peer.ms),
            number(peer.stretch),
            peer.left.to_owned(),
            number(ours.map(RunResult::ms)),
            number(ours.map(|run| 1e2 * run.stretch)),
            ours.map_or("missed".to_owned(), |run| figure(peer.ms / run.ms())),
        ]);
    }
    table.note(SOURCE);
    table
}
