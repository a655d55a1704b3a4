//! Cloth that meets itself, other cloth, and a ball at 10 m/s: what it costs, and whether anything gets through,
//! counted by an audit that shares nothing with the solver.
//!
//! Every run is done twice: once on the clock, once under audit. Both have to end with the same bits, so what is
//! counted is what was timed.

use anyhow::ensure;
use nucleus_audit::Account;
use nucleus_graph::Simulation;
use nucleus_graph::audit::Closeness;
use nucleus_graph::compile::Program;

use super::accuracy::Meter;
use super::ball::Ball;
use super::report::Report;
use super::table::{Table, figure};
use super::workload::BALL;
use nucleus_measure::clock::{STAGES, Spent, StageClock};

mod peers;
mod scene;

use peers::{PEERS, Peer};
use scene::{Place, Setting};

/// Evaluations in 1/24 s that are worth running.
const EVALUATIONS: [u32; 4] = [24, 48, 96, 192];

/// At which costs are compared.
const TYPICAL: u32 = 48;

/// How many times as fast as the fastest peer without crossings W3 has to be.
const LEAD: f64 = 5.0;

/// How many times the same cloth without self-collision one with it may take, and where.
const MOST_COST: f64 = 3.0;
const COST_SIZE: u32 = 129;

/// How many times as fast two threads have to be.
const PAIR_TARGET: f64 = 1.5;

/// Points along the side of the sheets that growth is measured on, up to 250,000 in all.
const GROWTH: [u32; 4] = [65, 129, 257, 500];

/// What may be added to n log n by chance.
const CHANCE: f64 = 1.1;

/// A workload.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Workload {
    /// W3: a sheet of 1.5 m falls on a ball and onto itself.
    Folds,
    /// W4: a ball at 10 m/s flies into a sheet that hangs by two corners.
    Shot,
    /// W8: five such sheets on one another.
    Layers,
}

impl Workload {
    fn name(self) -> &'static str {
        match self {
            Self::Folds => "W3",
            Self::Shot => "W4",
            Self::Layers => "W8",
        }
    }

    fn frames(self) -> u32 {
        match self {
            Self::Folds | Self::Layers => 96,
            Self::Shot => 24,
        }
    }

    /// The ball that the sheets meet.
    fn ball(self) -> Ball {
        match self {
            Self::Folds | Self::Layers => BALL,
            // From 2 m before the sheet to 8 m behind it in a second.
            Self::Shot => Ball { radius: 0.15, start: [0.5, -0.5, -2.0], flight: [0.0, 0.0, 10.0 / 24.0] },
        }
    }

    fn closeness(self) -> Closeness {
        // What flies through within a frame is only seen on the way.
        if self == Self::Shot { Closeness::Steps } else { Closeness::Frames }
    }
}

/// What came of a run.
struct Outcome {
    size: u32,
    setting: Setting,
    threads: usize,
    spent: Spent,
    shares: [f64; STAGES.len()],
    /// RMS stretch of the lowest sheet at the last frame.
    stretch: f64,
    /// Its largest stretch, and its deepest point in the ball in metres: at the last frame and at the worst.
    largest: [f64; 2],
    depths: [f64; 2],
    /// Pairs that could touch, in a frame.
    pairs: f64,
    hash: u64,
    audit: Option<Account>,
}

impl Outcome {
    fn ms(&self) -> f64 {
        1e3 * if self.threads == 1 { self.spent.processor } else { self.spent.wall }
    }
}

/// Runs a workload at all sizes and settings on one thread, and at one setting on all.
///
/// # Errors
/// When a scene is refused, or a run does not repeat itself.
pub fn run(workload: Workload, sizes: &[u32], threads: &[u32], report: &mut Report) -> anyhow::Result<()> {
    let mut runs = Vec::new();
    for &size in sizes.iter().filter(|size| **size <= workload_limit(workload)) {
        for evaluations in EVALUATIONS {
            let setting = Setting { evaluations, self_collide: workload != Workload::Shot };
            runs.push(timed_and_audited(workload, size, setting, workload.frames())?);
        }
        pair_of_threads(workload, size, threads, report)?;
    }
    report.show(own_table(workload, &runs));
    report.show(stage_table(workload.name(), &runs));
    report.show(peer_table(workload, &runs));
    judge(workload, sizes, &runs, report);
    Ok(())
}

/// Larger ones take minutes and have no peer.
fn workload_limit(workload: Workload) -> u32 {
    if workload == Workload::Layers { 65 } else { 129 }
}

/// What self-collision costs, and how that grows.
///
/// # Errors
/// When a scene is refused, or a run does not repeat itself.
pub fn cost(report: &mut Report) -> anyhow::Result<()> {
    let head =
        ["points", "ms without", "ms with", "times", "ms per n log n", "to the first", "pairs", "hash"];
    let mut table =
        Table::new("Self-collision: what it costs, W2 and W3 at 48 evaluations, one thread", &head);
    let mut first = None;
    for size in GROWTH {
        // The fall, and as long again on the ball; large sheets only as far as the folds are there.
        let frames = if size > COST_SIZE { 24 } else { 48 };
        let with = |self_collide| {
            once(Workload::Folds, size, Setting { evaluations: TYPICAL, self_collide }, frames, 1)
        };
        let [without, with] = [with(false)?, with(true)?];
        let times = with.ms() / without.ms();
        let points = f64::from(size) * f64::from(size);
        let each = 1e6 * with.ms() / (points * points.ln());
        let ratio = each / *first.get_or_insert(each);
        let cells = [without.ms(), with.ms(), times, each, ratio, with.pairs].map(figure);
        table.row([points.to_string()].into_iter().chain(cells).chain([format!("{:016x}", with.hash)]));
        if size == COST_SIZE {
            let target = format!("self-collision at {size}²: at most {MOST_COST} times the same without");
            report.judge(target, format!("{} times", figure(times)), times <= MOST_COST);
        }
        if Some(&size) == GROWTH.last() {
            let target = format!("self-collision grows no worse than n log n to {points} points");
            report.judge(target, format!("{} times n log n", figure(ratio)), ratio <= CHANCE);
        }
    }
    table.note("Nanoseconds per n log n; 48 frames up to 129², 24 beyond.");
    report.show(table);
    Ok(())
}

fn timed_and_audited(
    workload: Workload,
    size: u32,
    setting: Setting,
    frames: u32,
) -> anyhow::Result<Outcome> {
    let mut outcome = once(workload, size, setting, frames, 1)?;
    let program = program(workload, size, setting)?;
    let mut run = Simulation::<f32>::new(&program, 2);
    run.begin_audit(workload.closeness());
    for _ in 0..frames {
        run.advance(&mut ());
    }
    let hash = run.solver().state_hash();
    ensure!(
        hash == outcome.hash,
        "{} {size}²: hash {:016x}, under audit {hash:016x}",
        workload.name(),
        outcome.hash
    );
    outcome.audit = run.audit().map(|audit| audit.account());
    let (ms, found) = (figure(outcome.ms()), outcome.audit.map_or(0, |account| account.found()));
    eprintln!("{} {size}², {setting}: {ms} ms a frame, {found} found by the audit", workload.name());
    Ok(outcome)
}

fn once(
    workload: Workload,
    size: u32,
    setting: Setting,
    frames: u32,
    threads: usize,
) -> anyhow::Result<Outcome> {
    let program = program(workload, size, setting)?;
    let mut run = Simulation::<f32>::new(&program, threads);
    let mut meter = Meter::new(&scene::lowest_sheet(workload, size), size, Some(workload.ball()));
    let mut stages = StageClock::default();
    let (mut all, mut pairs) = (Spent::default(), 0.0);
    for _ in 0..frames {
        let (spent, account) = Spent::on(|| {
            let account = run.advance(&mut stages).report;
            stages.stop();
            account
        });
        all = Spent { wall: all.wall + spent.wall, processor: all.processor + spent.processor };
        pairs += account.pairs as f64 / f64::from(frames);
        meter.frame(run.state());
    }
    let found = meter.finish();
    let share = |all: f64| all / f64::from(frames);
    Ok(Outcome {
        size,
        setting,
        threads,
        spent: Spent { wall: share(all.wall), processor: share(all.processor) },
        shares: stages.shares(),
        stretch: found.stretch,
        largest: [found.max, found.worst_max],
        depths: [found.depth, found.worst_depth],
        pairs,
        hash: run.solver().state_hash(),
        audit: None,
    })
}

fn program(workload: Workload, size: u32, setting: Setting) -> anyhow::Result<Program> {
    scene::program(workload, size, setting, Place::new()?)
}

fn pair_of_threads(
    workload: Workload,
    size: u32,
    threads: &[u32],
    report: &mut Report,
) -> anyhow::Result<()> {
    let setting = Setting { evaluations: TYPICAL, self_collide: workload != Workload::Shot };
    let runs: anyhow::Result<Vec<Outcome>> = threads
        .iter()
        .map(|&threads| once(workload, size, setting, workload.frames(), threads as usize))
        .collect();
    let runs = runs?;
    let head = ["points", "threads", "wall ms", "times as fast", "hash"];
    let mut table = Table::new(&format!("{} {size}²: threads, {setting}", workload.name()), &head);
    for run in &runs {
        ensure!(run.hash == runs[0].hash, "{} {size}²: threads change the result", workload.name());
        let gain = runs[0].spent.wall / run.spent.wall;
        let cells = [figure(1e3 * run.spent.wall), figure(gain), format!("{:016x}", run.hash)];
        table.row([format!("{size}²"), run.threads.to_string()].into_iter().chain(cells));
        if (runs[0].threads, run.threads, size) == (1, 2, COST_SIZE) {
            let target = format!("{} {size}²: two threads at least {PAIR_TARGET} times one", workload.name());
            report.judge(target, format!("{} times", figure(gain)), gain >= PAIR_TARGET);
        }
    }
    report.show(table);
    Ok(())
}

fn own_table(workload: Workload, runs: &[Outcome]) -> Table {
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
        let account = run.audit.unwrap_or_default();
        let cells = [
            run.ms(),
            1e3 * run.spent.wall,
            1e2 * run.stretch,
            1e2 * run.largest[0],
            1e2 * run.largest[1],
            1e3 * run.depths[0],
            1e3 * run.depths[1],
            account.found() as f64,
            account.inside as f64,
        ];
        let setting = [run.setting.to_string(), format!("{:016x}", run.hash)];
        table.row([format!("{}²", run.size)].into_iter().chain(cells.map(figure)).chain(setting));
    }
    let seen = match workload.closeness() {
        Closeness::Frames => "edges inside faces at the ends of frames",
        Closeness::Steps => {
            "pairs that passed through each other on the way from one state that the solver shows to the next"
        }
    };
    table.note(format!("Found: {seen}, over the whole run. Inside: edges inside faces at the last frame."));
    table
}

fn stage_table(name: &str, runs: &[Outcome]) -> Table {
    let typical: Vec<&Outcome> = runs.iter().filter(|run| run.setting.evaluations == TYPICAL).collect();
    let used: Vec<usize> =
        (0..STAGES.len()).filter(|&k| typical.iter().any(|run| run.shares[k] > 0.002)).collect();
    let names = used.iter().map(|&k| STAGES[k].1);
    let head: Vec<&str> = ["points", "ms"].into_iter().chain(names).collect();
    let mut table =
        Table::new(&format!("{name}: milliseconds a frame by stage, {TYPICAL} evaluations"), &head);
    for run in typical {
        let stages = used.iter().map(|&k| figure(run.ms() * run.shares[k]));
        table.row([format!("{}²", run.size), figure(run.ms())].into_iter().chain(stages));
    }
    table
}

/// Our fastest run of no more error and nothing inside anything.
fn answer<'a>(peer: &Peer, runs: &'a [Outcome]) -> Option<&'a Outcome> {
    let clean = |run: &&Outcome| run.audit.is_some_and(|account| account.found() == 0);
    let good =
        |run: &&Outcome| run.size == peer.size && peer.stretch.is_none_or(|most| 1e2 * run.stretch <= most);
    runs.iter().filter(clean).filter(good).min_by(|a, b| a.ms().total_cmp(&b.ms()))
}

fn peer_table(workload: Workload, runs: &[Outcome]) -> Table {
    let head = [
        "points",
        "peer",
        "its ms",
        "its stretch %",
        "crossings left",
        "our ms",
        "our stretch %",
        "times as fast",
    ];
    let title = format!("{}: what we need for no more stretch and no crossing at all", workload.name());
    let mut table = Table::new(&title, &head);
    let sizes = |peer: &&Peer| runs.iter().any(|run| run.size == peer.size);
    for peer in PEERS.iter().filter(|peer| peer.workload == workload).filter(sizes) {
        let ours = answer(peer, runs);
        let number = |x: Option<f64>| x.map_or("-".to_owned(), figure);
        table.row([
            format!("{}²", peer.size),
            peer.name.to_owned(),
            figure(peer.ms),
            number(peer.stretch),
            peer.left.to_owned(),
            number(ours.map(Outcome::ms)),
            number(ours.map(|run| 1e2 * run.stretch)),
            ours.map_or("missed".to_owned(), |run| figure(peer.ms / run.ms())),
        ]);
    }
    table.note(super::peers::SOURCE);
    table
}

fn judge(workload: Workload, sizes: &[u32], runs: &[Outcome], report: &mut Report) {
    let found: u64 = runs.iter().filter_map(|run| run.audit).map(|account| account.found()).sum();
    let target = format!("{}: nothing passes through anything, at any setting", workload.name());
    report.judge(target, format!("{found} found"), found == 0);
    for &size in sizes {
        let clean =
            PEERS.iter().filter(|peer| (peer.workload, peer.size, peer.left) == (workload, size, "0"));
        let Some(best) = clean.min_by(|a, b| a.ms.total_cmp(&b.ms)) else { continue };
        let lead = answer(best, runs).map(|run| best.ms / run.ms());
        let target = format!("{} {size}²: at least {LEAD} times as fast as {}", workload.name(), best.name);
        let found = lead
            .map_or("no clean run of so little stretch".to_owned(), |lead| format!("{} times", figure(lead)));
        report.judge(target, found, lead.is_some_and(|lead| lead >= LEAD));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_workload_is_timed_and_audited_with_the_same_bits() {
        for workload in [Workload::Folds, Workload::Shot, Workload::Layers] {
            let setting = Setting { evaluations: 6, self_collide: true };
            let run = timed_and_audited(workload, 9, setting, 3).unwrap();
            let account = run.audit.expect("it was audited");
            assert!(run.ms() > 0.0 && run.stretch.is_finite());
            // On the way every time step is followed, and a ball that flies fast splits them.
            let steps = if workload == Workload::Shot { 9 } else { 0 };
            assert!(account.motions >= steps && (steps > 0 || account.motions == 0), "{account:?}");
        }
    }

    #[test]
    fn a_run_with_crossings_answers_nobody() {
        let setting = Setting { evaluations: 6, self_collide: true };
        let mut run = timed_and_audited(Workload::Folds, 9, setting, 1).unwrap();
        let peer = Peer { size: 9, stretch: None, ..PEERS[0] };
        assert!(answer(&peer, std::slice::from_ref(&run)).is_some());
        run.audit = Some(Account { overlaps: 1, ..Account::default() });
        assert!(answer(&peer, std::slice::from_ref(&run)).is_none());
    }
}
