//! The runs of a sweep as runs of plans: the references, the settings, which are measured against them, and each round of
//! settings near the best.
//!
//! States are too large for a result: they are files in the folder `states` of the plan, which all processes share.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use nucleus_measure::result_cache::ResultCache;
use nucleus_measure::trade::run::{Run, RunStates, Trajectory, key};
use nucleus_measure::trade::{Benchmark, RemoteRun, RemoteStage, TradeError};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::output::say;
use crate::runs::{PartOptions, part_report};

/// A run of a sweep, as a line of a plan holds it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Remote {
    /// The run.
    #[serde(flatten)]
    run: RemoteRun,
    /// Fingerprints of the scene and the solver.
    subject: String,
    /// Its skipped and its compared frames.
    window: [usize; 2],
    /// The name of the reference that it is measured against; empty without one.
    against: String,
    /// The folder of states.
    states: PathBuf,
}

/// The name of the trajectory of a reference among the states.
fn target_file(reference: &str) -> String {
    format!("{reference}.target")
}

/// Reads a run from the text in a plan.
pub fn remote(text: &str) -> Result<Remote, String> {
    serde_json::from_str(text).map_err(|error| error.to_string())
}

impl Remote {
    fn cache(&self) -> ResultCache {
        ResultCache::new(&self.states, "states")
    }

    fn files(&self) -> [String; 2] {
        let key = key(&self.run.setting, self.run.bits, self.window);
        [format!("{key}.path"), format!("{key}.end.json")]
    }

    /// Does the run, and returns its report for the result of a run of a plan.
    pub fn report(&self, subject: &Benchmark) -> Result<Value> {
        part_report(&self.execute(subject)?, &[])
    }

    /// Does the run, and keeps its states as files.
    fn execute(&self, subject: &Benchmark) -> Result<Run> {
        ensure!(
            subject.name() == self.subject,
            "the scene, a file that it reads, or this build of nucleus differs from those of the plan"
        );
        let cache = self.cache();
        let target = match self.against.as_str() {
            "" => None,
            reference => {
                let bytes = cache.read(&target_file(reference))?;
                let missing =
                    || format!("the reference `{reference}` is missing in `{}`", cache.folder().display());
                Some(bytes.as_deref().and_then(Trajectory::from_bytes).with_context(missing)?)
            }
        };
        let program = subject.at(&self.run.setting)?;
        let done = self.run.run(subject, &program, target.as_ref(), &|| true);
        let (run, states) = done.context("the run was stopped")?;
        let [path, end] = self.files();
        if let Some(trajectory) = &states.trajectory {
            cache.write(&path, &trajectory.to_bytes())?;
        }
        cache.write(&end, &serde_json::to_vec(&states.end)?)?;
        Ok(run)
    }

    /// The states of the run when it has ended.
    fn read(&self) -> Result<RunStates> {
        let cache = self.cache();
        let [path, end] = self.files();
        let missing = || format!("`{end}` is missing in `{}`", cache.folder().display());
        let bytes = cache.read(&end)?.with_context(missing)?;
        let trajectory = cache.read(&path)?.as_deref().and_then(Trajectory::from_bytes);
        Ok(RunStates { trajectory, end: serde_json::from_slice(&bytes).with_context(missing)? })
    }
}

/// A sweep whose runs are runs of plans.
pub struct RemoteSweep<'a> {
    /// Where and how they are done.
    pub parts: &'a PartOptions,
    /// Runs at once that are not timed.
    pub jobs: Option<u16>,
    /// The path of the scene.
    pub scene: &'a Path,
    /// The scene and its facts.
    pub subject: &'a Benchmark,
}

impl RemoteSweep<'_> {
    /// Does runs as runs of a plan. References are not timed, and run side by side; settings are timed, so each runs alone on
    /// a machine.
    pub fn run(&self, stage: &RemoteStage) -> Result<Vec<(Run, RunStates)>, TradeError> {
        let done = self.planned(stage);
        done.map_err(|error| TradeError::Elsewhere(format!("{error:#}")))?.ok_or(TradeError::Interrupted)
    }

    fn planned(&self, sweep: &RemoteStage) -> Result<Option<Vec<(Run, RunStates)>>> {
        let is_timed = sweep.round.is_some();
        let stage = self.parts.stage(&folder_of(sweep), is_timed)?;
        let remotes = self.remotes(sweep)?;
        let jobs = if is_timed && stage.is_local() { Some(1) } else { self.jobs };
        if is_timed && stage.is_local() && (sweep.finer, sweep.round) == (0, Some(0)) {
            say!("settings are timed, so each runs alone, one after another");
        }
        if let (Some((_, trajectory)), Some(first)) = (&sweep.target, remotes.first()) {
            first.cache().write(&target_file(&first.against), &trajectory.to_bytes())?;
        }
        let parts = remotes.iter().map(|remote| self.arguments(remote)).collect::<Result<_>>()?;
        let Some(found) = stage.execute::<Run>("trade", parts, jobs)? else { return Ok(None) };
        let with_states = remotes.iter().zip(found).map(|(remote, run)| Ok((run, remote.read()?)));
        with_states.collect::<Result<_>>().map(Some)
    }

    /// The runs of a stage as lines of a plan.
    fn remotes(&self, sweep: &RemoteStage) -> Result<Vec<Remote>> {
        let states = self.parts.folder()?;
        let against = sweep.target.as_ref().map(|(name, _)| name.clone()).unwrap_or_default();
        let remote = |run: &RemoteRun| Remote {
            run: *run,
            subject: self.subject.name(),
            window: self.subject.window(),
            against: against.clone(),
            states: states.clone(),
        };
        Ok(sweep.runs.iter().map(remote).collect())
    }

    /// The name of a run, and the arguments of `nucleus trade` for it.
    fn arguments(&self, remote: &Remote) -> Result<(String, Vec<String>)> {
        let scene = self.scene.to_str().ok_or_else(|| anyhow!("the path of the scene is not UTF-8"))?;
        let [before, end] = self.subject.span();
        let first = if self.subject.skipped() == 0 { before } else { before + 1 };
        let frames = format!("--frames={first}..{end}");
        let part = format!("--part={}", serde_json::to_string(remote)?);
        let name = format!("{} ({} bits)", remote.run.setting, remote.run.bits);
        Ok((name, vec![scene.to_owned(), frames, part]))
    }
}

/// The folder of a stage: `references`, `settings`, `settings-1`; with finer references `finer-settings`.
fn folder_of(sweep: &RemoteStage) -> String {
    let stage = match sweep.round {
        None => "references".to_owned(),
        Some(0) => "settings".to_owned(),
        Some(round) => format!("settings-{round}"),
    };
    "finer-".repeat(sweep.finer) + &stage
}
