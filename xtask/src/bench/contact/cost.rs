//! Cost of self-collision compared with the same cloth without it, and its scaling with the number of points.

use super::pile;
use super::run::RunSpec;
use super::scene::Setting;
use super::workload::{TYPICAL, Workload};
use crate::bench::report::Report;
use crate::bench::table::{StageRow, Table, figure};
use crate::bench::timed::Timed;

/// Points along the side of W3 sheets, and frames: the fall, and the same time on the ball.
const SIZES: [u32; 2] = [65, 129];
const FRAMES: u32 = 48;

/// Target cost relative to the same cloth without self-collision, and its size.
const MOST_COST: f64 = 3.0;
const COST_SIZE: u32 = 129;

/// Square roots of the numbers of points of the scaling test, up to 250,000 points.
const GROWTH: [u32; 4] = [65, 129, 257, 500];

/// Tolerance of n log n.
const CHANCE: f64 = 1.1;

/// W3 with and without self-collision, and scaling on piles.
///
/// # Errors
/// When a scene is rejected.
pub fn run(report: &mut Report) -> anyhow::Result<()> {
    with_and_without(report)?;
    scaling(report)
}

/// W3 with self-collision and without.
fn with_and_without(report: &mut Report) -> anyhow::Result<()> {
    let head = ["points", "ms without", "ms with", "times", "pairs", "hash"];
    let title =
        format!("Self-collision: W3 with and without, the first {FRAMES} frames, {TYPICAL} evaluations");
    let mut table = Table::new(&title, &head);
    for size in SIZES {
        let run = |self_collide| {
            let setting = Setting { evaluations: TYPICAL, self_collide };
            let run = RunSpec { workload: Workload::Folds, size, setting, frames: FRAMES }.timed(1)?.timed;
            eprintln!("W3 {size}², self-collision {self_collide}: {} ms per frame", figure(run.ms()));
            anyhow::Ok(run)
        };
        let [without, with] = [run(false)?, run(true)?];
        let times = with.ms() / without.ms();
        let cells = [without.ms(), with.ms(), times, with.pairs].map(figure);
        table.row([format!("{size}²")].into_iter().chain(cells).chain([format!("{:016x}", with.hash)]));
        if size == COST_SIZE {
            let target = format!("self-collision at {size}²: at most {MOST_COST} times the same without");
            report.check_target(target, format!("{} times", figure(times)), times <= MOST_COST);
        }
    }
    report.show(table);
    Ok(())
}

/// Heaps of the same cloth, more and more of it.
fn scaling(report: &mut Report) -> anyhow::Result<()> {
    let mut runs = Vec::new();
    for n in GROWTH {
        let points = pile::sheet(n).positions.len() as f64;
        let setting = Setting { evaluations: TYPICAL, self_collide: true };
        let run =
            Timed::run(&pile::program(n, setting, &tempfile::tempdir()?)?, 1, Some(pile::FRAMES), |_| {});
        eprintln!("heap of {points} points: {} ms per frame", figure(run.ms()));
        runs.push((points, run));
    }
    report.show(growth_table(&runs));
    let rows: Vec<StageRow> =
        runs.iter().map(|(points, run)| (vec![points.to_string()], run.ms(), run.shares)).collect();
    report.show(Table::by_stage("Piles: milliseconds per frame by stage", &["points"], &rows));
    if let (Some(first), Some(last)) = (runs.first(), runs.last()) {
        let ratio = nanoseconds(last) / nanoseconds(first);
        let target =
            format!("self-collision grows no worse than n log n from {} to {} points", first.0, last.0);
        report.check_target(target, format!("{} times n log n", figure(ratio)), ratio <= CHANCE);
    }
    Ok(())
}

/// Nanoseconds per frame over n log n, for n points.
fn nanoseconds((points, run): &(f64, Timed)) -> f64 {
    1e6 * run.ms() / (points * points.ln())
}

fn growth_table(runs: &[(f64, Timed)]) -> Table {
    let head = [
        "points",
        "frames",
        "ms",
        "ns per n log n",
        "to the first",
        "queries",
        "pairs per point and query",
        "contacts per point",
        "MB",
        "hash",
    ];
    let title = format!("Self-collision: scaling, piles of the same cloth, {TYPICAL} evaluations");
    let mut table = Table::new(&title, &head);
    for one in runs {
        let (points, run) = one;
        let each = nanoseconds(one);
        let cells = [
            run.ms(),
            each,
            each / nanoseconds(&runs[0]),
            run.queries,
            run.pairs / run.queries / points,
            run.contacts / points,
            run.megabytes(),
        ];
        let first = [points.to_string(), run.frames.to_string()];
        table.row(first.into_iter().chain(cells.map(figure)).chain([format!("{:016x}", run.hash)]));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn n_log_n_growth_has_the_same_figure_at_every_size() {
        let setting = Setting { evaluations: 1, self_collide: true };
        let program = pile::program(20, setting, &tempfile::tempdir().unwrap()).unwrap();
        let mut run = Timed::run(&program, 1, Some(1), |_| {});
        let mut taking = |points: f64| {
            run.timing.processor = 1e-9 * points * points.ln();
            (points, run.clone())
        };
        let table = growth_table(&[taking(1e3), taking(1e5)]);
        for row in &table.rows {
            let [each, to_first] = [3, 4].map(|column: usize| row[column].parse::<f64>().unwrap());
            assert!((each - 1.0).abs() < 1e-9 && (to_first - 1.0).abs() < 1e-9, "{row:?}");
        }
    }
}
