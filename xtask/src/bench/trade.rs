//! Time against error: a workload at many settings, compared with other solvers.

use super::comparison::{self, Comparison};
use super::peers::{PEERS, SOURCE};
use super::report::Report;
use super::run::{RunResult, RunSpec};
use super::table::{Table, figure};
use super::workload::{Setting, Variant, Workload};
use nucleus_measure::clock::STAGES;

/// Evaluations of the table by stage.
const TYPICAL: u32 = 48;

/// Runs a workload at all sizes and settings on one thread.
///
/// # Errors
/// When the solver rejects a scene, or repeated runs differ.
pub fn run(workload: Workload, sizes: &[u32], repeat: u32, report: &mut Report) -> anyhow::Result<()> {
    let (varied, plain): (Vec<_>, Vec<_>) = sizes
        .iter()
        .flat_map(|&size| settings(workload, size).into_iter().map(move |setting| (size, setting)))
        .partition(|(_, setting)| setting.variant != Variant::Plain);
    let mut runs = Vec::new();
    for &(size, setting) in plain.iter().chain(&varied) {
        let run = RunSpec::full(workload, size, setting).run(repeat)?;
        report.keep(&run);
        runs.push(run);
    }
    report.show(own_table(workload, &runs));
    report.show(stage_table(workload, &runs));
    // The peers ran without tethers, and not of each is it known which elements collide.
    let comparable = &runs[..plain.len()];
    let comparisons: Vec<Comparison> = PEERS
        .iter()
        .filter(|peer| peer.workload == workload && sizes.contains(&peer.size))
        .filter_map(|peer| Comparison::new(peer, comparable))
        .collect();
    report.show(contest_table(workload, &comparisons));
    check_target(workload, sizes, &comparisons, report);
    if workload == Workload::Swing {
        check_goals(&runs, report);
    }
    Ok(())
}

/// Settings to run. Large sheets converge only with many evaluations, and the largest counts take too long.
fn settings(workload: Workload, size: u32) -> Vec<Setting> {
    let evaluations: &[u32] = match (workload, size) {
        (Workload::Drape, 257..) => &[48, 96],
        (Workload::Drape, _) => &[24, 48, 96, 192, 384],
        (_, 257..) => &[48, 96, 192, 384],
        (_, 65..) => &[12, 18, 24, 48, 96, 192, 384, 768, 1536, 2304],
        _ => &[12, 18, 24, 48, 96, 192, 384, 768, 1536],
    };
    let variants: &[(f64, f64)] = match workload {
        Workload::Swing | Workload::Hang => &[(20.0, 0.0), (200.0, 0.0), (2000.0, 0.0)],
        Workload::Drape => &[(20.0, 0.0), (20.0, 0.1)],
    };
    let each = |&(resistance, bend): &(f64, f64)| {
        let setting = move |&evaluations| Setting { resistance, bend, evaluations, variant: Variant::Plain };
        evaluations.iter().map(setting)
    };
    let (variant, of_variant): (_, &[u32]) = match workload {
        Workload::Swing => (Variant::Tethers, &[24, 48, 96, 192, 288, 384]),
        Workload::Drape => (Variant::Points, &[24, 48, 96, 192]),
        Workload::Hang => (Variant::Plain, &[]),
    };
    let of_variant =
        of_variant.iter().map(|&evaluations| Setting { resistance: 20.0, bend: 0.0, evaluations, variant });
    variants.iter().flat_map(each).filter(is_worth_it).chain(of_variant).collect()
}

/// Stiff cloth needs many evaluations to converge; soft cloth has physical strain that more of them do not reduce. Bending
/// is measured at two settings.
fn is_worth_it(setting: &Setting) -> bool {
    let Setting { resistance, bend, evaluations, .. } = *setting;
    let fits = match resistance {
        ..100.0 => evaluations <= 384,
        100.0..1000.0 => (96..=1536).contains(&evaluations),
        _ => evaluations >= 768,
    };
    fits && (bend == 0.0 || [48, 192].contains(&evaluations))
}

/// Our own runs.
fn own_table(workload: Workload, runs: &[RunResult]) -> Table {
    let errors: &[&str] = match workload {
        Workload::Drape => &["stretch %", "largest %", "depth mm", "worst mm", "queries", "unresolved"],
        _ => &["strain %", "stretch %", "largest %", "sag m", "energy J/kg"],
    };
    let head: Vec<&str> =
        ["points", "ms", "wall"].iter().chain(errors).chain(&["setting", "hash"]).copied().collect();
    let mut table = Table::new(&format!("{workload}: our runs"), &head);
    for run in runs {
        let found = &run.accuracy;
        let errors = match workload {
            Workload::Drape => {
                let depths = [1e3 * found.depth, 1e3 * found.worst_depth];
                let stretches = [1e2 * found.stretch, 1e2 * found.max];
                [stretches, depths, [run.queries, run.pairs_unresolved as f64]].concat()
            }
            _ => vec![1e2 * found.strain, 1e2 * found.stretch, 1e2 * found.max, found.sag, found.energy],
        };
        let cells = [format!("{}²", run.spec.size), figure(run.ms()), figure(1e3 * run.timing.wall)]
            .into_iter()
            .chain(errors.into_iter().map(figure))
            .chain([run.spec.setting.to_string(), format!("{:016x}", run.hash)]);
        table.row(cells);
    }
    table
}

/// Milliseconds by stage at a typical setting.
fn stage_table(workload: Workload, runs: &[RunResult]) -> Table {
    let typical: Vec<&RunResult> =
        runs.iter().filter(|run| run.spec.setting.evaluations == TYPICAL).collect();
    let used: Vec<usize> =
        (0..STAGES.len()).filter(|&k| typical.iter().any(|run| run.shares[k] > 0.002)).collect();
    let names = used.iter().map(|&k| STAGES[k].1);
    let head: Vec<&str> = ["points", "ms"].into_iter().chain(names).chain(["setting", "hash"]).collect();
    let mut table = Table::new(&format!("{workload}: milliseconds per frame by stage"), &head);
    for run in typical {
        let stages = used.iter().map(|&k| figure(run.ms() * run.shares[k]));
        let cells = [format!("{}²", run.spec.size), figure(run.ms())];
        let of_run = [run.spec.setting.to_string(), format!("{:016x}", run.hash)];
        table.row(cells.into_iter().chain(stages).chain(of_run));
    }
    table
}

/// The peers, each with our fastest run of no more error.
fn contest_table(workload: Workload, comparisons: &[Comparison]) -> Table {
    let head = ["points", "peer", "its ms", "its error %", "our ms", "our error %", "", "our setting"];
    let mut table = Table::new(&format!("{workload}: fastest run with no more error than each peer"), &head);
    for comparison in comparisons {
        let peer = comparison.peer;
        let name = [peer.name, peer.version, peer.setting].join(" ");
        let run = comparison.answer.unwrap_or(comparison.best);
        let standing = match comparison.speedup() {
            Some(speedup) if speedup > 1.0 => format!("{} x faster", figure(speedup)),
            Some(speedup) => format!("missed: {} x slower", figure(1.0 / speedup)),
            None => "missed: our least error".to_owned(),
        };
        table.row([
            format!("{}²", peer.size),
            name.trim_end().to_owned(),
            figure(peer.ms),
            figure(peer.error),
            figure(run.ms()),
            figure(comparison::error(run)),
            standing,
            run.spec.setting.to_string(),
        ]);
    }
    table.note(SOURCE);
    table
}

fn check_target(workload: Workload, sizes: &[u32], comparisons: &[Comparison], report: &mut Report) {
    for &size in sizes {
        let here: Vec<&Comparison> =
            comparisons.iter().filter(|comparison| comparison.peer.size == size).collect();
        let lost = here.iter().filter(|comparison| !comparison.is_ahead());
        let lost: Vec<String> =
            lost.map(|comparison| format!("{} {}", comparison.peer.name, comparison.peer.setting)).collect();
        let leads = here.iter().filter_map(|comparison| comparison.speedup());
        let least = leads.fold(f64::INFINITY, f64::min);
        if here.is_empty() {
            continue;
        }
        let found = match lost.is_empty() {
            true => format!("{} of {}, by {} x or more", here.len(), here.len(), figure(least)),
            false => format!("{} of {}, not {}", here.len() - lost.len(), here.len(), lost.join(", ")),
        };
        let target = format!("{workload} {size}²: ahead of every peer at no more error");
        report.check_target(target, found, lost.is_empty());
    }
}

/// What the sheet that swings down is to cost at most: points along a side, RMS strain, milliseconds per frame.
const GOALS: [(u32, f64, f64); 3] = [(65, 0.0025, 10.0), (129, 0.005, 40.0), (257, 0.005, 200.0)];

fn check_goals(runs: &[RunResult], report: &mut Report) {
    for (size, strain, ms) in GOALS {
        let here: Vec<&RunResult> = runs.iter().filter(|run| run.spec.size == size).collect();
        if here.is_empty() {
            continue;
        }
        let fit = here.into_iter().filter(|run| run.accuracy.strain <= strain);
        let fastest = fit.min_by(|a, b| a.ms().total_cmp(&b.ms()));
        let found = fastest.map_or("no run has so little strain".to_owned(), |run| {
            format!("{} ms, {} %: {}", figure(run.ms()), figure(1e2 * run.accuracy.strain), run.spec.setting)
        });
        let target = format!("W1 {size}²: at most {} % of strain in {ms} ms", 1e2 * strain);
        report.check_target(target, found, fastest.is_some_and(|run| run.ms() <= ms));
    }
}
