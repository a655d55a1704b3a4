//! `--on slurm`: the runs as job arrays, and a coordinator that waits for them, submits lost ones again and collects.
//!
//! The coordinator keeps nothing in memory that it needs: it can end at any time and be started again with `--continue`.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::Result;
use clap::{Args, ValueEnum};
use nucleus_wedge::collect::Counts;
use nucleus_wedge::slurm::{Request, Slurm};
use nucleus_wedge::{Plan, RunOutcome, RunResult, SolvedFrames, WedgeFolder};

use crate::output::say;
use crate::{figures, options, process};

/// Where the runs are done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Place {
    /// On this machine.
    Local,
    /// On a cluster, through `sbatch`.
    Slurm,
}

/// Options of `--on slurm`.
#[derive(Debug, Args)]
#[command(next_help_heading = "SLURM")]
pub struct FarmOptions {
    /// The account to charge.
    #[arg(long, requires = "on")]
    account: Option<String>,
    /// The partition.
    #[arg(long, requires = "on")]
    partition: Option<String>,
    /// The time limit of a task, as SLURM writes it (`2:00:00`). A run that reaches it is resumed by the next task.
    #[arg(long, requires = "on")]
    time: Option<String>,
    /// The memory of a task (`4G`); default: twice the estimate for the scene.
    #[arg(long, value_name = "SIZE", requires = "on")]
    task_memory: Option<String>,
    /// Runs that a task does one after another.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    runs_per_task: u16,
    /// Tasks that run at once; default: no limit.
    #[arg(long, value_name = "NUMBER")]
    most_tasks: Option<u32>,
    /// A further option of `sbatch` (`--sbatch=--qos=night`); may be given several times.
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    sbatch: Vec<String>,
    /// The `nucleus` command on the nodes; default: the path of this one.
    #[arg(long, value_name = "PATH")]
    program: Option<PathBuf>,
    /// Times that a lost run is submitted again.
    #[arg(long, value_name = "NUMBER", default_value_t = 3)]
    retries: usize,
    /// Submit the runs and end; `--continue --on slurm` waits for them and collects.
    #[arg(long, requires = "on")]
    pub detach: bool,
    /// Seconds between two looks at the queue.
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = options::positive)]
    poll: f64,
}

impl FarmOptions {
    /// Default options, with further ones of `sbatch`.
    pub fn of(sbatch: Vec<String>, poll: f64) -> Self {
        Self {
            account: None,
            partition: None,
            time: None,
            task_memory: None,
            runs_per_task: 1,
            most_tasks: None,
            sbatch,
            program: None,
            retries: 3,
            detach: false,
            poll,
        }
    }

    /// Submits the open runs and waits until all have ended. Returns early with `--detach`, and after Ctrl-C.
    pub fn execute(&self, folder: &WedgeFolder, plan: &Plan, threads: u16) -> Result<()> {
        let mut slurm = Slurm::new(folder)?;
        let request = self.request(plan, threads)?;
        process::listen_for_signals()?;
        // A run that failed is tried again once per command; a lost one until its attempts are used up.
        let before: Vec<usize> = plan.runs.iter().map(|run| slurm.attempts(run.run)).collect();
        let mut is_first = true;
        let mut last_said = String::new();
        while !process::is_interrupted() {
            // The queue first: a run that ends in between has a result and is in the queue, and is not submitted again.
            let queued = slurm.queued()?;
            let open = folder.open_runs(plan)?;
            let mut missing: Vec<u32> = open.iter().filter(|run| !queued.contains(run)).copied().collect();
            if !is_first {
                missing = self.lost(folder, plan, &slurm, &before, missing)?;
            }
            if !missing.is_empty() {
                slurm.submit(&plan.header, &missing, &request)?;
                say!("submitted {} as `{}`", figures::count(missing.len(), "run"), slurm.job_name());
            }
            if self.detach || (missing.is_empty() && queued.is_empty()) {
                return Ok(());
            }
            is_first = false;
            let results = folder.results(plan)?;
            let said = format!("{}", Counts::of(results.iter().map(Option::as_ref)));
            if said != last_said {
                say!("{said}");
                last_said = said;
            }
            self.wait();
        }
        say!("the jobs go on; `scancel --name={}` ends them", slurm.job_name());
        Ok(())
    }

    /// Of the runs that are neither finished nor queued, those that were lost and have attempts left. Names the others in
    /// their results.
    fn lost(
        &self,
        folder: &WedgeFolder,
        plan: &Plan,
        slurm: &Slurm,
        before: &[usize],
        missing: Vec<u32>,
    ) -> Result<Vec<u32>> {
        let mut lost = Vec::new();
        for run in missing {
            let name = &plan.runs[run as usize].name;
            let result = folder.result(name)?;
            if result.as_ref().is_some_and(|result| result.outcome == RunOutcome::Failed) {
                continue;
            }
            let attempts = slurm.attempts(run) - before[run as usize];
            if attempts <= self.retries {
                lost.push(run);
            } else if result.is_none_or(|result| result.outcome == RunOutcome::Interrupted) {
                folder.write_result(name, &given_up(attempts))?;
            }
        }
        Ok(lost)
    }

    fn request(&self, plan: &Plan, threads: u16) -> Result<Request> {
        let command = match &self.program {
            Some(program) => vec![OsString::from(program)],
            None => process::command()?,
        };
        let estimate =
            (plan.header.memory > 0).then(|| format!("{}M", (2 * plan.header.memory).div_ceil(1 << 20)));
        Ok(Request {
            account: self.account.clone(),
            partition: self.partition.clone(),
            time: self.time.clone(),
            memory: self.task_memory.clone().or(estimate),
            threads,
            runs_per_task: self.runs_per_task.into(),
            at_once: self.most_tasks,
            further: self.sbatch.clone(),
            command,
        })
    }

    /// Waits until the next look at the queue, or until a signal arrives.
    fn wait(&self) {
        let begin = Instant::now();
        while begin.elapsed().as_secs_f64() < self.poll && !process::is_interrupted() {
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

/// The result of a run whose tasks were lost too often.
fn given_up(attempts: usize) -> RunResult {
    RunResult {
        outcome: RunOutcome::Killed,
        error: Some(format!(
            "its task was lost {}; `sacct` and `logs/slurm-*.txt` say why",
            figures::count(attempts, "time")
        )),
        seconds: 0.0,
        earlier: SolvedFrames::default(),
        at_once: 1,
        machine: String::new(),
        attempt: 0,
        report: None,
    }
}
