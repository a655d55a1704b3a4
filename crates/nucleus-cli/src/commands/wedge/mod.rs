//! `nucleus wedge`: many runs of a scene with different values, on this machine or on a farm.

use anyhow::{Result, anyhow, bail, ensure};
use nucleus_cache::shell_word;
use nucleus_wedge::collect::{Collected, collect};
use nucleus_wedge::{Plan, WedgeFolder, parse_selection};
use serde_json::json;

use crate::options::thread_count;
use crate::output::say;
use crate::process::Outcome;
use crate::runs::{Place, execute};
use crate::{files, output, process};

mod options;
mod planning;
mod task;

pub use options::Wedge;

impl Wedge {
    /// Plans, runs and collects.
    pub fn run(self) -> Result<Outcome> {
        let folder = WedgeFolder::new(&self.out)?;
        if let Some(run) = self.task {
            return task::run(&folder, run, self.threads, self.at_once);
        }
        if self.on == Some(Place::Slurm) {
            nucleus_wedge::slurm::check_installed()?;
        }
        let Some(plan) = self.prepared(&folder)? else { return Ok(Outcome::InvalidInput) };
        if self.plan {
            let (count, path) = (plan.runs.len(), folder.plan());
            output::report(&format!(
                "planned {} in `{}`\n",
                crate::figures::count(count, "run"),
                path.display()
            ));
            return Ok(Outcome::Success);
        }
        let selected = match (&self.run, self.collect) {
            (_, true) => Vec::new(),
            (Some(text), _) => {
                parse_selection(text, plan.runs.len()).map_err(|error| anyhow!("`--run`: {error}"))?
            }
            (None, _) => folder.open_runs(&plan)?,
        };
        match self.on {
            Some(Place::Slurm) if self.run.is_none() && !self.collect => {
                self.farm.execute(&folder, &plan, self.threads)?;
                if self.farm.detach {
                    return Ok(Outcome::Success);
                }
            }
            _ => execute(&folder, &plan, &selected, self.jobs(&plan), self.threads)?,
        }
        if process::is_interrupted() {
            say!("interrupted: `nucleus wedge --continue --out {}` finishes the runs", shell_word(&self.out));
            return Ok(Outcome::Interrupted);
        }
        match self.run {
            Some(_) => self.outcome_of(&folder, &plan, &selected),
            None => self.report(&folder, &plan),
        }
    }

    /// The plan: a new one for a scene, else that of the folder. Returns `None` if the scene has errors, which are reported.
    fn prepared(&self, folder: &WedgeFolder) -> Result<Option<Plan>> {
        let is_planned = self.continues || self.collect || self.run.is_some();
        match &self.scene {
            Some(scene) if !is_planned || !folder.plan().exists() => {
                ensure!(
                    !self.collect,
                    "`{}` holds no plan yet, so there is nothing to collect",
                    self.out.display()
                );
                let Some(plan) = planning::plan(self, scene)? else { return Ok(None) };
                folder.create(&plan)?;
                Ok(Some(plan))
            }
            Some(scene) => {
                let plan = folder.read_plan()?;
                let Some(asked) = planning::plan(self, scene)? else { return Ok(None) };
                let varies = !self.vary.is_empty() || self.table.is_some() || self.seeds.is_some();
                let is_same = asked.header.fingerprint == plan.header.fingerprint
                    && (!varies || asked.runs == plan.runs);
                ensure!(
                    is_same,
                    "the plan in `{}` has other runs, or is of another scene (`{}`): name another folder, or continue it with \
                     `nucleus wedge --continue --out {}`",
                    self.out.display(),
                    plan.header.title,
                    shell_word(&self.out)
                );
                Ok(Some(plan))
            }
            None => {
                let plan = folder.read_plan()?;
                ensure!(
                    self.collect || self.continues || self.run.is_some(),
                    "`{}` holds a plan: finish it with `--continue`, or collect it with `--collect`",
                    self.out.display()
                );
                if !self.collect {
                    check_scene(&plan)?;
                }
                Ok(Some(plan))
            }
        }
    }

    /// Runs at once: as many as asked for, else as many as cores and memory allow.
    fn jobs(&self, plan: &Plan) -> usize {
        let cores = thread_count(self.jobs) / if self.jobs.is_some() { 1 } else { self.threads as usize };
        let memory = match plan.header.memory {
            0 => usize::MAX,
            each => (files::memory_limit().0 / each) as usize,
        };
        if self.jobs.is_some() { cores } else { cores.min(memory).max(1) }
    }

    /// The outcome of selected runs, for a scheduler.
    fn outcome_of(&self, folder: &WedgeFolder, plan: &Plan, selected: &[u32]) -> Result<Outcome> {
        let mut outcome = Outcome::Success;
        for run in selected {
            let name = &plan.runs[*run as usize].name;
            let result = folder.result(name)?;
            let is_success = result.as_ref().is_some_and(|result| result.problems().is_empty());
            if !is_success {
                let why = result
                    .map_or("another process is at it".to_owned(), |result| result.problems().join("; "));
                say!("run {name}: {why}");
                outcome = Outcome::Problem;
            }
        }
        Ok(outcome)
    }

    /// Collects and prints the results.
    fn report(&self, folder: &WedgeFolder, plan: &Plan) -> Result<Outcome> {
        let Collected { counts, without_picture, without_cache } = collect(folder, plan, thread_count(None))?;
        for (run, why) in &without_cache {
            let (name, out) = (&plan.runs[*run as usize].name, shell_word(&self.out));
            say!(
                "warning: run {name} is finished, but {why}, so it has no picture: `nucleus wedge --out {out} --run {run}` \
                 makes it again"
            );
        }
        for (name, why) in &without_picture {
            say!("warning: there is no picture of run {name}: {why}");
        }
        let results = folder.results(plan)?;
        let named = plan.runs.iter().zip(&results).filter_map(|(run, result)| {
            let problems = result.as_ref()?.problems();
            (!problems.is_empty()).then(|| format!("run {}: {}\n", run.name, problems.join("; ")))
        });
        let named: Vec<String> = named.collect();
        match self.json {
            true => output::report_json(&json!({ "wedge": {
                "runs": counts.all, "success": counts.success, "problem": counts.problem, "failed": counts.failed,
                "open": counts.open, "without_cache": without_cache.len(), "page": folder.page(), "table": folder.table(),
            }})),
            false => {
                let (page, table) = (folder.page(), folder.table());
                let files = format!("page `{}`, table `{}`", page.display(), table.display());
                output::report(&format!("{}{counts}\n{files}\n", named.concat()));
            }
        }
        Ok(if counts.success == counts.all { Outcome::Success } else { Outcome::Problem })
    }
}

/// Refuses runs of a plan whose scene, or a file that it reads, has changed since.
fn check_scene(plan: &Plan) -> Result<()> {
    if plan.header.fingerprint.is_empty() {
        return Ok(());
    }
    let path = plan.header.directory.join(&plan.header.title);
    let opened = files::open_scene(&path, None)?;
    let Some((_, program)) = &opened.compiled else {
        bail!("`{}` has errors now; `nucleus check` lists them", path.display())
    };
    ensure!(
        plan.header.fingerprint == planning::fingerprint(&opened.text, &path, program),
        "`{}`, or a mesh or map that it reads, has changed since the plan was made: the other runs would not be comparable; \
         restore the file, or start another wedge",
        path.display()
    );
    Ok(())
}
