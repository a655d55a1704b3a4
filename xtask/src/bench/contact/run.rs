//! A run of a workload at a setting: timed, measured, and repeated under audit.

use anyhow::ensure;
use nucleus_audit::AuditCounts;
use nucleus_graph::Simulation;
use nucleus_graph::compile::Program;

use super::scene::{self, Setting};
use super::workload::Workload;
use crate::bench::accuracy::Meter;
use crate::bench::table::figure;
use crate::bench::timed::{Timed, state_hash};

/// Specification of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunSpec {
    pub workload: Workload,
    /// Points along each side of a sheet.
    pub size: u32,
    pub setting: Setting,
    /// Frames to run.
    pub frames: u32,
}

/// Result of a run.
#[derive(Debug, Clone)]
pub struct RunResult {
    pub spec: RunSpec,
    pub timed: Timed,
    /// RMS stretch of the lowest sheet at the last frame.
    pub stretch: f64,
    /// Its maximum stretch, at the last frame and over all frames.
    pub largest: [f64; 2],
    /// Maximum depth of its points in the ball in metres, at the last frame and over all frames.
    pub depths: [f64; 2],
    /// Result of the audit, if there was one.
    pub audit: Option<AuditCounts>,
}

impl RunResult {
    /// Milliseconds a frame, as in [`Timed::ms`].
    pub fn ms(&self) -> f64 {
        self.timed.ms()
    }
}

impl RunSpec {
    /// A full run.
    pub fn full(workload: Workload, size: u32, evaluations: u32) -> Self {
        let setting = Setting { evaluations, self_collide: workload != Workload::Shot };
        Self { workload, size, setting, frames: workload.frames() }
    }

    /// A timed run.
    ///
    /// # Errors
    /// When the scene is rejected.
    pub fn timed(&self, threads: u32) -> anyhow::Result<RunResult> {
        let Self { workload, size, .. } = *self;
        let mut meter = Meter::new(&scene::lowest_sheet(workload, size), size, Some(workload.ball()));
        let timed = Timed::run(&self.program()?, threads, Some(self.frames), |state| meter.frame(state));
        let found = meter.finish();
        Ok(RunResult {
            spec: *self,
            timed,
            stretch: found.stretch,
            largest: [found.max, found.worst_max],
            depths: [found.depth, found.worst_depth],
            audit: None,
        })
    }

    /// A timed run on one thread, repeated under audit.
    ///
    /// # Errors
    /// When the scene is rejected, or the two differ.
    pub fn timed_and_audited(&self) -> anyhow::Result<RunResult> {
        let Self { workload, size, setting, frames } = *self;
        let mut result = self.timed(1)?;
        let mut run = Simulation::<f32>::new(&self.program()?, 2);
        run.begin_audit(workload.closeness());
        for _ in 0..frames {
            run.advance(&mut ());
        }
        let (hash, timed) = (state_hash(&run), result.timed.hash);
        ensure!(hash == timed, "{} {size}²: hash {timed:016x}, under audit {hash:016x}", workload.name());
        result.audit = run.audit().map(|audit| audit.account());
        let (ms, found) = (figure(result.ms()), result.audit.map_or(0, |report| report.found()));
        eprintln!("{} {size}², {setting}: {ms} ms per frame, {found} found by the audit", workload.name());
        Ok(result)
    }

    fn program(&self) -> anyhow::Result<Program> {
        scene::program(self.workload, self.size, self.setting, tempfile::tempdir()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_workload_is_timed_and_audited_with_the_same_bits() {
        for workload in [Workload::Folds, Workload::Shot, Workload::Layers] {
            let run = RunSpec { frames: 3, ..RunSpec::full(workload, 9, 6) }.timed_and_audited().unwrap();
            let report = run.audit.expect("it was audited");
            assert!(run.ms() > 0.0 && run.stretch.is_finite());
            assert!(run.largest[0] <= run.largest[1] && run.depths[0] <= run.depths[1]);
            // On the way every time step is followed, and a ball that flies fast splits them.
            let steps = if workload == Workload::Shot { 9 } else { 0 };
            assert!(report.motions >= steps && (steps > 0 || report.motions == 0), "{report:?}");
        }
    }
}
