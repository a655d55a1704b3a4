//! Runs as child processes of this one.

use std::ffi::OsString;

use anyhow::Result;
use nucleus_wedge::{Plan, PlannedRun, Pool, WedgeFolder};

use crate::process;
use crate::progress::WedgeProgress;

/// Executes runs in child processes, `jobs` at once.
pub fn execute(folder: &WedgeFolder, plan: &Plan, selected: &[u32], jobs: usize, threads: u16) -> Result<()> {
    if selected.is_empty() {
        return Ok(());
    }
    process::listen_for_signals()?;
    let runs: Vec<PlannedRun> = selected.iter().map(|run| plan.runs[*run as usize].clone()).collect();
    let jobs = jobs.min(runs.len());
    let mut progress = WedgeProgress::new(&plan.runs, runs.len());
    let options: [OsString; 2] = ["--threads".into(), threads.to_string().into()];
    let command = process::command()?;
    let pool = Pool { command: &command, folder, header: &plan.header, jobs, options: &options };
    let result = pool.run(&runs, &process::is_interrupted, &mut |event| progress.show(&event));
    progress.end();
    process::files_are_closed();
    Ok(result?)
}
