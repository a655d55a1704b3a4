//! Commands whose parts are runs of a plan: `nucleus extremes --plan folder`, `nucleus validate --plan folder`.
//!
//! A line of such a plan is the same command for one part. Its result holds what the part has found, with all bits, so the
//! command prints and writes the same as in one process.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use clap::Args;
use nucleus_measure::result_cache::solver_fingerprint;
use nucleus_wedge::collect::collect;
use nucleus_wedge::{Plan, PlanHeader, PlannedRun, RunResult, WedgeFolder, run_name};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::farm::{FarmOptions, Place};
use super::local::execute;
use crate::output::say;
use crate::{figures, options, process};

/// Options of commands whose parts can be runs of a plan.
#[derive(Debug, Args)]
pub struct PartOptions {
    /// Do every part in a process of its own, as a run of the plan in this folder. The same command continues what is left
    /// of an earlier attempt. The figures have the same bits.
    #[arg(long, value_name = "FOLDER")]
    plan: Option<PathBuf>,
    /// Where the parts are done; a cluster needs a folder that its nodes share.
    #[arg(long, value_enum, value_name = "PLACE", requires = "plan")]
    on: Option<Place>,
    /// An option of `sbatch` (`--sbatch=--partition=night`); may be given several times. With `--exclusive`, a part is alone
    /// on its node.
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true, requires = "on")]
    sbatch: Vec<String>,
    /// Seconds between two looks at the queue.
    #[arg(long, hide = true, default_value = "10", value_parser = options::positive)]
    poll: f64,
}

/// The report of a part, for its result: what it has found, and what is wrong with it.
pub fn part_report(found: &impl Serialize, failures: &[String]) -> Result<Value> {
    let check = |failure: &String| json!({ "check": failure, "passed": false });
    let checks: Vec<Value> = failures.iter().map(check).collect();
    let found = serde_json::to_value(found)?;
    Ok(json!({ "summary": { "checks": checks }, "found": found, "solver": solver_fingerprint().name() }))
}

impl PartOptions {
    /// Whether parts are runs of a plan.
    pub fn is_planned(&self) -> bool {
        self.plan.is_some()
    }

    /// Whether every part is alone on its machine, as far as this command goes, so that its time can be measured.
    pub fn is_alone(&self, jobs: Option<u16>) -> bool {
        match self.on {
            Some(Place::Slurm) => self.sbatch.iter().any(|option| option == "--exclusive"),
            _ => jobs == Some(1),
        }
    }

    /// The folder of the plan, as an absolute path.
    pub fn folder(&self) -> Result<PathBuf> {
        let root = self.plan.as_ref().context("there is no folder for the plan")?;
        std::path::absolute(root).with_context(|| format!("`{}`", root.display()))
    }

    /// The options for parts of one stage of a command, with a plan below the folder. Parts that are timed are alone on their
    /// machine.
    pub fn stage(&self, name: &str, is_timed: bool) -> Result<Self> {
        let exclusive = is_timed && self.on == Some(Place::Slurm) && !self.is_alone(None);
        let sbatch = self.sbatch.iter().cloned().chain(exclusive.then(|| "--exclusive".to_owned()));
        let (plan, on) = (Some(self.folder()?.join(name)), self.on);
        Ok(Self { plan, on, sbatch: sbatch.collect(), poll: self.poll })
    }

    /// Whether the parts are done on this machine.
    pub fn is_local(&self) -> bool {
        self.on != Some(Place::Slurm)
    }

    /// Does the parts, each the arguments of a command, and returns what they have found, in their order. Returns `None` after
    /// Ctrl-C.
    pub fn execute<T: DeserializeOwned>(
        &self,
        command: &str,
        parts: Vec<(String, Vec<String>)>,
        jobs: Option<u16>,
    ) -> Result<Option<Vec<T>>> {
        let folder = WedgeFolder::new(&self.folder()?)?;
        if self.on == Some(Place::Slurm) {
            nucleus_wedge::slurm::check_installed()?;
        }
        let plan = prepared(&folder, plan_of(command, parts)?)?;
        match self.on {
            Some(Place::Slurm) => {
                FarmOptions::of(self.sbatch.clone(), self.poll).execute(&folder, &plan, 1)?
            }
            _ => {
                execute(&folder, &plan, &folder.open_runs(&plan)?, options::thread_count(jobs), 1)?;
            }
        }
        if process::is_interrupted() {
            say!("interrupted: the same command does the parts that are left");
            return Ok(None);
        }
        collect(&folder, &plan, 1)?;
        found(&folder, &plan).map(Some)
    }
}

/// The plan of a command: a run for each part.
fn plan_of(command: &str, parts: Vec<(String, Vec<String>)>) -> Result<Plan> {
    let directory = std::env::current_dir().context("the working folder is unknown")?;
    let title = format!("nucleus {command}");
    let count = parts.len();
    let run = |(run, (name, arguments)): (u32, (String, Vec<String>))| PlannedRun {
        run,
        name: run_name(run, count),
        values: vec![name],
        seed: None,
        arguments: std::iter::once(command.to_owned()).chain(arguments).collect(),
    };
    let runs = (0..).zip(parts).map(run).collect();
    Ok(Plan { header: PlanHeader::new(title, directory, vec!["part".to_owned()]), runs })
}

/// The plan of the folder, which is written if there is none.
fn prepared(folder: &WedgeFolder, asked: Plan) -> Result<Plan> {
    if !folder.plan().exists() {
        folder.create(&asked)?;
        return Ok(asked);
    }
    let plan = folder.read_plan()?;
    ensure!(
        plan.runs == asked.runs,
        "the plan in `{}` has other parts (`{}`): name another folder",
        folder.root().display(),
        plan.header.title
    );
    Ok(plan)
}

/// What all parts have found.
fn found<T: DeserializeOwned>(folder: &WedgeFolder, plan: &Plan) -> Result<Vec<T>> {
    let solver = solver_fingerprint().name();
    let results = folder.results(plan)?;
    let mut failed = Vec::new();
    let mut all = Vec::new();
    for (run, result) in plan.runs.iter().zip(&results) {
        match found_by(result.as_ref(), &solver) {
            Ok(found) => all.push(found),
            Err(why) => failed.push(format!("`{}` (run {}): {why}", run.values.join(" "), run.name)),
        }
    }
    ensure!(
        failed.is_empty(),
        "{} of {} did not end well; the same command tries them again:\n{}",
        failed.len(),
        figures::count(plan.runs.len(), "part"),
        failed.join("\n")
    );
    Ok(all)
}

fn found_by<T: DeserializeOwned>(result: Option<&RunResult>, solver: &str) -> Result<T, String> {
    let result = result.ok_or("it has not ended")?;
    let Some(report) = result.report.as_ref().filter(|_| result.outcome.is_final()) else {
        return Err(result.problems().join("; "));
    };
    if report["solver"] != solver {
        return Err(
            "it was computed by another build of nucleus, whose solver has other bits; name another folder"
                .into(),
        );
    }
    serde_json::from_value(report["found"].clone()).map_err(|error| format!("its result is damaged: {error}"))
}
