//! A run of a workload at a setting, timed and measured.

use anyhow::{Context, ensure};
use nucleus_core::{FrameInput, Solver};

use super::accuracy::{Accuracy, Meter};
use super::workload::{Scene, Setting, Workload};
use nucleus_measure::clock::{STAGES, StageClock, Timing};

/// Specification of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunSpec {
    /// The workload.
    pub workload: Workload,
    /// Points along each side of the cloth.
    pub size: u32,
    /// The setting.
    pub setting: Setting,
    /// Threads.
    pub threads: u32,
    /// Frames to run.
    pub frames: u32,
}

/// Result of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunResult {
    /// Its specification.
    pub spec: RunSpec,
    /// Time in the stepping calls, per frame.
    pub timing: Timing,
    /// Time of the median frame.
    pub median_frame: Timing,
    /// Seconds to build the solver.
    pub build: f64,
    /// Share of each of [`STAGES`] in the time.
    pub shares: [f64; STAGES.len()],
    /// Link evaluations in a frame.
    pub evaluations: f64,
    /// Broad-phase queries per frame.
    pub queries: f64,
    /// Pairs of elements unresolved at the end of a time step, over all time steps.
    pub pairs_unresolved: u64,
    /// Its errors.
    pub accuracy: Accuracy,
    /// Hash of the last state.
    pub hash: u64,
}

impl RunResult {
    /// Milliseconds per frame: processor time with one thread, which load disturbs least; wall time with more, which includes
    /// waiting.
    pub fn ms(&self) -> f64 {
        1e3 * self.of(&self.timing)
    }

    /// The clock of [`RunResult::ms`].
    pub fn of(&self, timing: &Timing) -> f64 {
        if self.spec.threads == 1 { timing.processor } else { timing.wall }
    }

    /// The share of a stage, by its name in [`STAGES`].
    pub fn share(&self, stage: &str) -> f64 {
        STAGES.iter().zip(self.shares).filter(|((_, name), _)| *name == stage).map(|(_, share)| share).sum()
    }
}

impl RunSpec {
    /// A full run on one thread.
    pub fn full(workload: Workload, size: u32, setting: Setting) -> Self {
        Self { workload, size, setting, threads: 1, frames: workload.frames() }
    }

    /// Runs `repeat` times and returns the run of the median time.
    ///
    /// # Errors
    /// When the solver rejects the scene, or two runs differ.
    pub fn run(&self, repeat: u32) -> anyhow::Result<RunResult> {
        let runs: anyhow::Result<Vec<RunResult>> = (0..repeat.max(1)).map(|_| self.run_once()).collect();
        median(runs?)
    }

    /// Runs once.
    ///
    /// # Errors
    /// When the solver rejects the scene.
    pub fn run_once(&self) -> anyhow::Result<RunResult> {
        let Scene { sheet, builder, frame } = self.workload.scene(self.size, &self.setting)?;
        let mut meter = Meter::new(&sheet, self.size, self.workload.ball());
        let (build, mut solver) = Timing::of_process(|| Solver::<f32>::new(builder, self.threads as usize));
        let mut stages = StageClock::default();
        let mut frames = Vec::with_capacity(self.frames as usize);
        let (mut queries, mut pairs_unresolved) = (0.0, 0);
        for _ in 0..self.frames {
            let (timing, report) = Timing::of_process(|| {
                let report = solver.step(&frame, &mut stages);
                stages.stop();
                report
            });
            frames.push(timing);
            queries += f64::from(report.broad_phases) / f64::from(self.frames);
            pairs_unresolved += report.pairs_unresolved;
            meter.frame(&solver);
        }
        Ok(RunResult {
            spec: *self,
            timing: mean(&frames),
            median_frame: median_frame(&frames),
            build: build.wall,
            shares: stages.shares(),
            evaluations: link_evaluations(&solver, &frame),
            queries,
            pairs_unresolved,
            accuracy: meter.finish(),
            hash: solver.state_hash(),
        })
    }
}

/// The run of the median time; all must have the same hash.
///
/// # Errors
/// When there are none, or they differ.
pub fn median(mut runs: Vec<RunResult>) -> anyhow::Result<RunResult> {
    same_bits(&runs)?;
    runs.sort_by(|a, b| a.ms().total_cmp(&b.ms()));
    let middle = runs.len() / 2;
    runs.into_iter().nth(middle).context("there was no run")
}

/// Fails unless all runs end with the same bits.
///
/// # Errors
/// Names the first two hashes that differ.
pub fn same_bits(runs: &[RunResult]) -> anyhow::Result<()> {
    for pair in runs.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let (workload, size) = (a.spec.workload, a.spec.size);
        ensure!(
            a.hash == b.hash,
            "{workload} at {size}, {}: hash {:016x} on {} threads, {:016x} on {}",
            a.spec.setting,
            a.hash,
            a.spec.threads,
            b.hash,
            b.spec.threads
        );
    }
    Ok(())
}

fn link_evaluations(solver: &Solver<f32>, frame: &FrameInput) -> f64 {
    solver.passes(frame).iter().filter(|pass| pass.name == "stretch").map(|pass| pass.evaluations()).sum()
}

fn mean(frames: &[Timing]) -> Timing {
    let count = frames.len().max(1) as f64;
    let mean = |of: fn(&Timing) -> f64| frames.iter().map(of).sum::<f64>() / count;
    Timing { wall: mean(|timing| timing.wall), processor: mean(|timing| timing.processor) }
}

fn median_frame(frames: &[Timing]) -> Timing {
    let median = |of: fn(&Timing) -> f64| {
        let mut all: Vec<f64> = frames.iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or_default()
    };
    Timing { wall: median(|timing| timing.wall), processor: median(|timing| timing.processor) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::workload::Variant;

    fn small(workload: Workload, threads: u32) -> RunResult {
        let setting = Setting { resistance: 20.0, bend: 0.0, evaluations: 6, variant: Variant::Plain };
        RunSpec { workload, size: 9, setting, threads, frames: 4 }.run(2).unwrap()
    }

    #[test]
    fn every_workload_runs_and_gives_the_same_bits_on_any_number_of_threads() {
        for workload in [Workload::Swing, Workload::Drape, Workload::Hang] {
            let runs = [1, 2, 3].map(|threads| small(workload, threads));
            same_bits(&runs).unwrap();
            assert!(runs.iter().all(|run| run.ms() > 0.0 && run.accuracy.strain.is_finite()));
        }
    }

    #[test]
    fn different_bits_are_an_error_that_names_both() {
        let runs = [small(Workload::Hang, 1), small(Workload::Swing, 2)];
        let error = same_bits(&runs).unwrap_err().to_string();
        assert!(runs.iter().all(|run| error.contains(&format!("{:016x}", run.hash))), "{error}");
    }

    #[test]
    fn links_count_once_per_evaluation() {
        // 9 by 9 points in quads: 8 links in each of 9 rows and 9 columns, 6 times.
        assert_eq!(small(Workload::Hang, 1).evaluations, 2.0 * 8.0 * 9.0 * 6.0);
    }

    #[test]
    fn the_shares_of_the_stages_sum_to_one() {
        let run = small(Workload::Drape, 1);
        assert!((run.shares.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        assert!(run.share("relax") > 0.0 && run.share("collide") > 0.0);
    }
}
