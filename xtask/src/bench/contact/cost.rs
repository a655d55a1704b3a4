//! What self-collision costs beside the same cloth without it, and how that grows with the number of points.

use super::pile;
use super::run::RunSpec;
use super::scene::{MeshFolder, Setting};
use super::{TYPICAL, Workload};
use crate::bench::report::Report;
use crate::bench::stages;
use crate::bench::table::{Table, figure};
use crate::bench::timed::Timed;

/// Points along the side of the sheets of W3 that are compared, and frames: the fall, and as long again on the ball.
const SIZES: [u32; 2] = [65, 129];
const FRAMES: u32 = 48;

/// How many times the same cloth without self-collision one with it may take, and where.
const MOST_COST: f64 = 3.0;
const COST_SIZE: u32 = 129;

/// The roots of the numbers of points that growth is measured on, up to 250,000 in all.
const GROWTH: [u32; 4] = [65, 129, 257, 500];

/// What may be added to n log n by chance.
const CHANCE: f64 = 1.1;

/// With and without, on W3; and how it grows, on heaps.
///
/// # Errors
/// When a scene is refused.
pub fn run(report: &mut Report) -> anyhow::Result<()> {
    beside_without(report)?;
    scaling(report)
}

/// W3 with self-collision and without.
fn beside_without(report: &mut Report) -> anyhow::Result<()> {
    let head = ["points", "ms without", "ms with", "times", "pairs", "hash"];
    let title =
        format!("Self-collision: W3 with and without, the first {FRAMES} frames, {TYPICAL} evaluations");
    let mut table = Table::new(&title, &head);
    for size in SIZES {
        let run = |self_collide| {
            let setting = Setting { evaluations: TYPICAL, self_collide };
            let run = RunSpec { workload: Workload::Folds, size, setting, frames: FRAMES }.timed(1)?.timed;
            eprintln!("W3 {size}², self-collision {self_collide}: {} ms a frame", figure(run.ms()));
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
        let run = Timed::run(&pile::program(n, setting, &MeshFolder::new()?)?, 1, Some(pile::FRAMES), |_| {});
        eprintln!("heap of {points} points: {} ms a frame", figure(run.ms()));
        runs.push((points, run));
    }
    report.show(growth_table(&runs));
    let rows: Vec<stages::Row> =
        runs.iter().map(|(points, run)| (vec![points.to_string()], run.ms(), run.shares)).collect();
    report.show(stages::table("Heaps: milliseconds a frame by stage", &["points"], &rows));
    if let (Some(first), Some(last)) = (runs.first(), runs.last()) {
        let ratio = nanoseconds(last) / nanoseconds(first);
        let target =
            format!("self-collision grows no worse than n log n from {} to {} points", first.0, last.0);
        report.check_target(target, format!("{} times n log n", figure(ratio)), ratio <= CHANCE);
    }
    Ok(())
}

/// Nanoseconds a frame for each n log n of a run of n points.
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
        "searches",
        "pairs a point, a search",
        "pushes a point",
        "MB",
        "hash",
    ];
    let title = format!("Self-collision: growth, heaps of the same cloth, {TYPICAL} evaluations");
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
    fn what_takes_n_log_n_has_the_same_figure_at_every_size() {
        let setting = Setting { evaluations: 1, self_collide: true };
        let program = pile::program(20, setting, &MeshFolder::new().unwrap()).unwrap();
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
