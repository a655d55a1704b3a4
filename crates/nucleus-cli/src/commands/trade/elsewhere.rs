//! The runs of a sweep as runs of plans: first the references, then the settings, which are measured against them.
//!
//! States are too large for a result: they are files in the folder `states` of the plan, which all processes share.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use nucleus_measure::result_cache::ResultCache;
use nucleus_measure::trade::run::{Run, RunStates, Trajectory};
use nucleus_measure::trade::{Benchmark, RemoteRun, TradeError};
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
    /// The folder of states.
    states: PathBuf,
}

/// The trajectory of the finer reference among the states.
const TARGET: &str = "target.path";

/// Reads a run from the text in a plan.
pub fn remote(text: &str) -> Result<Remote, String> {
    serde_json::from_str(text).map_err(|error| error.to_string())
}

impl Remote {
    fn cache(&self) -> ResultCache {
        ResultCache::new(&self.states, "states")
    }

    fn files(&self) -> [String; 2] {
        let key = format!("{}-f{}", self.run.setting.key(), self.run.bits);
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
        let target = match self.run.bits {
            64 => None,
            _ => cache.read(TARGET)?.as_deref().and_then(Trajectory::from_bytes),
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
    pub fn run(
        &self,
        runs: &[RemoteRun],
        target: Option<&Trajectory>,
    ) -> Result<Vec<(Run, RunStates)>, TradeError> {
        let done = self.planned(runs, target);
        done.map_err(|error| TradeError::Elsewhere(format!("{error:#}")))?.ok_or(TradeError::Interrupted)
    }

    fn planned(
        &self,
        runs: &[RemoteRun],
        target: Option<&Trajectory>,
    ) -> Result<Option<Vec<(Run, RunStates)>>> {
        let is_timed = runs.iter().any(|run| run.bits != 64);
        let stage = self.parts.stage(if is_timed { "settings" } else { "references" }, is_timed)?;
        let states = self.parts.folder()?;
        let remotes: Vec<Remote> = runs
            .iter()
            .map(|run| Remote { run: *run, subject: self.subject.name(), states: states.clone() })
            .collect();
        let jobs = match is_timed && stage.is_local() {
            true => {
                say!("settings are timed, so each runs alone, one after another");
                Some(1)
            }
            false => self.jobs,
        };
        if let (Some(target), Some(first)) = (target, remotes.first()) {
            first.cache().write(TARGET, &target.to_bytes())?;
        }
        let parts = remotes.iter().map(|remote| self.arguments(remote)).collect::<Result<_>>()?;
        let Some(found) = stage.execute::<Run>("trade", parts, jobs)? else { return Ok(None) };
        let with_states = remotes.iter().zip(found).map(|(remote, run)| Ok((run, remote.read()?)));
        with_states.collect::<Result<_>>().map(Some)
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
