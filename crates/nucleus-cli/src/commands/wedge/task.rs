//! One run of a wedge, in this process: resumes the cache of an earlier attempt, and writes the result when it has
//! ended.

use std::fs;
use std::time::Instant;

use anyhow::{Result, anyhow};
use clap::{Parser, Subcommand};
use nucleus_cache::RecordError;
use nucleus_wedge::{
    Plan, PlannedRun, RunOutcome, RunResult, SolvedFrames, WedgeFolder, machine, when_parent_ends,
};
use serde_json::Value;

use crate::commands::extremes::Extremes;
use crate::commands::resume::{Resume, Resumed};
use crate::commands::run::Run;
use crate::commands::trade::Trade;
use crate::commands::validate::Validate;
use crate::output::say;
use crate::process::{self, Outcome};
use crate::resumed_run::is_unresumable;
use crate::run_loop::Finished;

/// The arguments of a run in a plan.
#[derive(Debug, Parser)]
struct Line {
    #[command(subcommand)]
    command: LineCommand,
}

/// The commands that a plan may hold.
#[derive(Debug, Subcommand)]
enum LineCommand {
    Run(Box<Run>),
    Extremes(Box<Extremes>),
    Trade(Box<Trade>),
    Validate(Box<Validate>),
}

/// How a part of a command has ended.
type Ended = (RunOutcome, Option<Value>, Option<String>);

/// Does one run of a plan.
pub fn run(folder: &WedgeFolder, run: u32, threads: u16, at_once: u32) -> Result<Outcome> {
    folder.check_plan()?;
    let (_, planned) = Plan::read_run(&folder.plan(), run)?;
    let Some(_lock) = folder.lock(&planned.name)? else {
        say!("another process is at run {}", planned.name);
        return Ok(Outcome::Busy);
    };
    // It may have ended since the plan was looked at.
    let earlier = folder.result(&planned.name)?;
    let is_finished =
        |result: &RunResult| result.outcome.is_final() && folder.cache_fault(&planned.name, result).is_none();
    if earlier.as_ref().is_some_and(is_finished) {
        return Ok(Outcome::Success);
    }
    process::listen_for_signals()?;
    process::more_files_follow();
    when_parent_ends(process::interrupt)?;
    let begin = Instant::now();
    let (outcome, report, error) =
        execute(folder, &planned, threads).unwrap_or_else(|error| failed(format!("{error:#}")));
    let result = RunResult {
        outcome,
        error,
        seconds: begin.elapsed().as_secs_f64(),
        earlier: SolvedFrames::default(),
        at_once,
        machine: machine(),
        attempt: 0,
        report,
    };
    folder.write_result(&planned.name, &result.after(earlier.as_ref()))?;
    Ok(match outcome {
        RunOutcome::Success => Outcome::Success,
        RunOutcome::Interrupted => Outcome::Interrupted,
        _ => Outcome::Problem,
    })
}

fn failed(why: String) -> Ended {
    (RunOutcome::Failed, None, Some(why))
}

/// Does a part of another command, which leaves nothing to resume.
fn part(find: impl FnOnce() -> Result<Value>) -> Result<Ended> {
    process::end_at_once_when_asked();
    let report = find()?;
    let is_clean = report["summary"]["checks"].as_array().is_none_or(Vec::is_empty);
    Ok((if is_clean { RunOutcome::Success } else { RunOutcome::Problem }, Some(report), None))
}

/// How a run of a scene ended, its report, and why it failed.
fn ended(finished: Option<Finished>) -> Ended {
    match finished {
        None => failed("the scene has errors; the log lists them".to_owned()),
        Some(Finished { outcome, report, .. }) => {
            // A run that could not write its cache lacks frames, unlike one that ran to its end with a problem.
            let lost = report["summary"]["error"].as_str().map(str::to_owned);
            let outcome = match outcome {
                _ if lost.is_some() => RunOutcome::Failed,
                Outcome::Success => RunOutcome::Success,
                Outcome::Interrupted => RunOutcome::Interrupted,
                _ => RunOutcome::Problem,
            };
            (outcome, Some(report), lost)
        }
    }
}

/// Executes the command of a run.
fn execute(folder: &WedgeFolder, planned: &PlannedRun, threads: u16) -> Result<Ended> {
    let words = std::iter::once("nucleus").chain(planned.arguments.iter().map(String::as_str));
    let parsed = Line::try_parse_from(words)
        .map_err(|error| anyhow!("the plan has arguments that `nucleus` does not take: {error}"))?;
    match parsed.command {
        LineCommand::Run(run) => simulate(folder, planned, *run, threads),
        LineCommand::Extremes(extremes) => part(|| extremes.part()),
        LineCommand::Trade(trade) => part(|| trade.part()),
        LineCommand::Validate(validate) => part(|| validate.part()),
    }
}

/// Resumes the cache that an earlier attempt left, else starts the run.
fn simulate(folder: &WedgeFolder, planned: &PlannedRun, run: Run, threads: u16) -> Result<Ended> {
    let cache = folder.cache(&planned.name);
    if folder.can_resume(&planned.name)?
        && let Some(ended) = resume(Resume::within(cache.clone(), threads))?
    {
        return Ok(ended);
    }
    // The files of an attempt that cannot be resumed would block the new one.
    for left in [nucleus_cache::part_path(&cache), cache.clone()] {
        let _ = fs::remove_file(left);
    }
    run.within(cache, threads).execute().map(ended)
}

/// Resumes a run. Returns `None` if its cache is of no use.
///
/// # Errors
/// When the cache may be resumed at another time, for example when the disk is full.
fn resume(resume: Resume) -> Result<Option<Ended>> {
    match resume.execute() {
        Ok(Resumed::Finished(finished)) => Ok(Some(ended(Some(finished)))),
        // The process was killed between the last frame and the result.
        Ok(Resumed::Complete) => Ok(None),
        // A file that the scene reads may be out of reach.
        Ok(Resumed::InvalidScene) => Ok(Some(ended(None))),
        // The cache is replaced only when all its frames are solved again, so it has them still.
        Err(error) if is_replay_interrupted(&error) => Ok(Some((RunOutcome::Interrupted, None, None))),
        Err(error) if is_unresumable(&error) => {
            say!("{error:#}; the run starts again");
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

fn is_replay_interrupted(error: &anyhow::Error) -> bool {
    process::is_interrupted() && matches!(error.downcast_ref(), Some(RecordError::ReplayIncomplete { .. }))
}
