//! Cost of a link evaluation, and scaling with points and threads.

use super::report::Report;
use super::run::{RunResult, RunSpec, median, same_bits};
use super::table::{Table, figure};
use super::workload::{DENSITY, GRAVITY, Setting, Variant, Workload};

/// A cloth of 10 kN/m.
const fn cloth(evaluations: u32) -> Setting {
    Setting { resistance: 20.0, bend: 0.0, evaluations, variant: Variant::Plain }
}

/// Its stiffness in N/m.
const STIFFNESS: f64 = 10_000.0;

/// Target time of a link evaluation in nanoseconds, on one core at [`LINK_SIZE`].
const LINK_TARGET: f64 = 1.2;
const LINK_SIZE: u32 = 129;

/// Points along the side of the sheets of the scaling test.
const SCALE: [u32; 4] = [129, 257, 513, 1000];

/// Tolerance of linear scaling.
const CHANCE: f64 = 1.05;

/// Target speed-up of two threads, and its size.
const PAIR_TARGET: f64 = 1.6;
const PAIR_SIZE: u32 = 257;

/// Sag of a hanging sheet, compared with ρ g H² / 2K.
///
/// # Errors
/// When the solver rejects a scene, or repeated runs differ.
pub fn sag(repeat: u32, report: &mut Report) -> anyhow::Result<()> {
    let exact = DENSITY * GRAVITY / (2.0 * STIFFNESS);
    let head = ["points", "evaluations", "ms", "sag mm", "error mm", "hash"];
    let mut table = Table::new("Hanging sheet: sag", &head);
    for (size, frames) in [(41, 60), (81, 41)] {
        for evaluations in [24, 96, 384] {
            let full = RunSpec::full(Workload::Hang, size, cloth(evaluations));
            let run = RunSpec { frames, ..full }.run(repeat)?;
            report.keep(&run);
            let sag = -1.0 - run.accuracy.lower_edge;
            let cells = [run.ms(), 1e3 * sag, 1e3 * (sag - exact)].map(figure);
            let spec = [format!("{size}²"), evaluations.to_string()];
            table.row(spec.into_iter().chain(cells).chain([format!("{:016x}", run.hash)]));
        }
    }
    table.note(format!("Exact: {} mm, for 10 kN/m. Measured over the last second.", figure(1e3 * exact)));
    report.show(table);
    Ok(())
}

/// Nanoseconds for one evaluation of one link.
///
/// # Errors
/// When the solver rejects a scene, or repeated runs differ.
pub fn link_cost(sizes: &[u32], repeat: u32, report: &mut Report) -> anyhow::Result<()> {
    let head = ["points", "ms", "link evaluations", "ns each, relax", "ns each, all stages", "hash"];
    let mut table = Table::new("Hanging sheet: the cost of a link, one thread", &head);
    for &size in sizes {
        let full = RunSpec::full(Workload::Hang, size, cloth(48));
        let run = RunSpec { frames: 24, ..full }.run(repeat)?;
        report.keep(&run);
        let each = 1e6 * run.ms() / run.evaluations;
        let relax = each * run.share("relax");
        let cells = [figure(run.ms()), format!("{}", run.evaluations), figure(relax), figure(each)];
        table.row([format!("{size}²")].into_iter().chain(cells).chain([format!("{:016x}", run.hash)]));
        if size == LINK_SIZE {
            let target = format!("at most {LINK_TARGET} ns an evaluation at {LINK_SIZE}², one core");
            report.check_target(target, format!("{} ns", figure(relax)), relax <= LINK_TARGET);
        }
    }
    report.show(table);
    Ok(())
}

/// Time per point up to a million points.
///
/// # Errors
/// When the solver rejects a scene, or repeated runs differ.
pub fn scale(repeat: u32, report: &mut Report) -> anyhow::Result<()> {
    let head = ["points", "ms", "ms per thousand points", "to the first", "build s", "hash"];
    let mut table = Table::new("Hanging sheet: scaling, one thread, 24 evaluations", &head);
    let mut first = None;
    for size in SCALE {
        let full = RunSpec::full(Workload::Hang, size, cloth(24));
        let run = RunSpec { frames: 5, ..full }.run(repeat)?;
        report.keep(&run);
        // A frame among five: the first of them finds all memory untouched.
        let ms = 1e3 * run.of(&run.median_frame);
        let points = f64::from(size) * f64::from(size);
        let each = 1e3 * ms / points;
        let ratio = each / *first.get_or_insert(each);
        let cells = [points.to_string(), figure(ms), figure(each), figure(ratio), figure(run.build)];
        table.row(cells.into_iter().chain([format!("{:016x}", run.hash)]));
        if Some(&size) == SCALE.last() {
            let target = format!("time per point at {points} points no more than at {}²", SCALE[0]);
            report.check_target(target, format!("{} times", figure(ratio)), ratio <= CHANCE);
        }
    }
    table.note("The median of five frames.");
    report.show(table);
    Ok(())
}

/// The same run on several numbers of threads, which take turns so that a busy moment hits all of them.
///
/// # Errors
/// When the solver rejects a scene, or threads change a bit.
pub fn threads(sizes: &[u32], threads: &[u32], repeat: u32, report: &mut Report) -> anyhow::Result<()> {
    let head = ["workload", "points", "threads", "wall ms", "times as fast", "hash"];
    let mut table = Table::new("Threads, 48 evaluations", &head);
    for (workload, frames) in [(Workload::Swing, 24), (Workload::Drape, 48)] {
        for &size in sizes {
            let spec = RunSpec { frames, ..RunSpec::full(workload, size, cloth(48)) };
            let runs = in_turns(&spec, threads, repeat)?;
            for run in &runs {
                report.keep(run);
                let gain = runs[0].timing.wall / run.timing.wall;
                let place = [workload.to_string(), format!("{size}²"), run.spec.threads.to_string()];
                let cells = [figure(1e3 * run.timing.wall), figure(gain), format!("{:016x}", run.hash)];
                table.row(place.into_iter().chain(cells));
                if (size, runs[0].spec.threads, run.spec.threads) == (PAIR_SIZE, 1, 2) {
                    let target = format!("{workload} {size}²: two threads at least {PAIR_TARGET} times one");
                    report.check_target(target, format!("{} times", figure(gain)), gain >= PAIR_TARGET);
                }
            }
        }
    }
    report.show(table);
    Ok(())
}

fn in_turns(spec: &RunSpec, threads: &[u32], repeat: u32) -> anyhow::Result<Vec<RunResult>> {
    let mut runs: Vec<Vec<RunResult>> = vec![Vec::new(); threads.len()];
    for _ in 0..repeat.max(1) {
        for (&threads, runs) in threads.iter().zip(&mut runs) {
            runs.push(RunSpec { threads, ..*spec }.run_once()?);
        }
    }
    let medians: anyhow::Result<Vec<RunResult>> = runs.into_iter().map(median).collect();
    let medians = medians?;
    same_bits(&medians)?;
    Ok(medians)
}
