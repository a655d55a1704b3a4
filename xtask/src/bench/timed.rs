//! A timed run of a scene through the graph crate, as the command runs it.

use nucleus_core::StateView;
use nucleus_graph::Simulation;
use nucleus_graph::compile::Program;

use nucleus_measure::clock::{STAGES, StageClock, Timing};

/// Results; means per frame unless stated otherwise.
#[derive(Debug, Clone)]
pub struct Timed {
    pub threads: u32,
    /// Number of frames.
    pub frames: u32,
    /// Time in the stepping calls.
    pub timing: Timing,
    /// Share of each of [`STAGES`] in the time.
    pub shares: [f64; STAGES.len()],
    /// Broad-phase queries.
    pub queries: f64,
    /// Candidate pairs, over all broad-phase queries.
    pub pairs: f64,
    /// Maximum of candidate pairs in a frame.
    pub most_pairs: u64,
    /// Active contacts, over all passes.
    pub contacts: f64,
    /// Peak memory of the process in bytes; `None` on systems that do not report it.
    pub memory: Option<u64>,
    /// Hash of the last state.
    pub hash: u64,
}

impl Timed {
    /// Runs a scene, the first `frames` of it or all, and passes the state after each frame to `seen`.
    pub fn run(
        program: &Program,
        threads: u32,
        frames: Option<u32>,
        mut seen: impl FnMut(&dyn StateView),
    ) -> Self {
        reset_peak();
        let mut run = Simulation::<f32>::new(program, threads as usize);
        let mut stages = StageClock::default();
        let mut all = Self::begun(threads);
        while frames.map_or(!run.is_done(), |frames| all.frames < frames) {
            let (timing, report) = Timing::of_process(|| {
                let report = run.advance(&mut stages).report;
                stages.stop();
                report
            });
            all.frames += 1;
            all.timing.wall += timing.wall;
            all.timing.processor += timing.processor;
            all.queries += f64::from(report.broad_phases);
            all.pairs += report.candidate_pairs as f64;
            all.most_pairs = all.most_pairs.max(report.candidate_pairs);
            all.contacts += report.contacts as f64;
            seen(run.state());
        }
        let hash = state_hash(&run);
        Self { shares: stages.shares(), memory: peak_memory(), hash, ..all.in_the_mean() }
    }

    /// Milliseconds: processor time with one thread, wall time with more.
    pub fn ms(&self) -> f64 {
        1e3 * if self.threads == 1 { self.timing.processor } else { self.timing.wall }
    }

    /// Peak memory in megabytes.
    pub fn megabytes(&self) -> f64 {
        self.memory.map_or(f64::NAN, |bytes| bytes as f64 / 1e6)
    }

    /// Before the first frame.
    fn begun(threads: u32) -> Self {
        Self {
            threads,
            frames: 0,
            timing: Timing::default(),
            shares: Default::default(),
            queries: 0.0,
            pairs: 0.0,
            most_pairs: 0,
            contacts: 0.0,
            memory: None,
            hash: 0,
        }
    }

    fn in_the_mean(self) -> Self {
        let mean = |all: f64| all / f64::from(self.frames.max(1));
        Self {
            timing: Timing { wall: mean(self.timing.wall), processor: mean(self.timing.processor) },
            queries: mean(self.queries),
            pairs: mean(self.pairs),
            contacts: mean(self.contacts),
            ..self
        }
    }
}

/// Hash of the state of a run, over all its nuclei.
pub fn state_hash(run: &Simulation<f32>) -> u64 {
    let mut solvers = run.solvers().map(|solver| solver.state_hash());
    let first = solvers.next().unwrap_or_default();
    solvers.fold(first, |all, one| all.rotate_left(1) ^ one)
}

/// Resets the peak memory of this process; on systems without this feature, figures include earlier runs.
fn reset_peak() {
    // Without this file there is no figure either.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Peak since the last reset, in bytes; `None` on systems that do not report it.
fn peak_memory() -> Option<u64> {
    peak_of(&std::fs::read_to_string("/proc/self/status").ok()?)
}

/// The peak in `/proc/self/status`, in bytes.
fn peak_of(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok().map(|kilobytes: u64| 1024 * kilobytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_is_converted_to_bytes() {
        let status = "VmPeak:\t    9000 kB\nVmHWM:\t    1234 kB\nVmRSS:\t     800 kB\n";
        assert_eq!(peak_of(status), Some(1234 * 1024));
        assert_eq!(peak_of("VmRSS:\t     800 kB\n"), None);
    }
}
