//! Runs as a job array of SLURM, submitted with `sbatch`.
//!
//! The folder of the wedge is on a file system that all nodes share. Each submission is a line of `slurm/jobs.jsonl`, so a
//! coordinator can end and start again. A task of the array is `nucleus wedge --run ...`, which resumes what an earlier
//! attempt left; a task that is preempted is queued again by SLURM.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde::{Deserialize, Serialize};

use crate::error::{WedgeError, at};
use crate::folder::WedgeFolder;
use crate::plan::PlanHeader;

/// Array tasks of a job where the limit of the cluster is unknown.
const MAX_ARRAY: usize = 1000;

/// Seconds before the time limit at which a task is asked to end. SLURM counts in minutes.
const NOTICE: u32 = 60;

/// Resources that a job requests.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Request {
    /// `--account`.
    pub account: Option<String>,
    /// `--partition`.
    pub partition: Option<String>,
    /// `--time` of a task.
    pub time: Option<String>,
    /// `--mem` of a task.
    pub memory: Option<String>,
    /// Threads of a run, `--cpus-per-task`.
    pub threads: u16,
    /// Runs that one task does one after another.
    pub runs_per_task: usize,
    /// Tasks that run at once.
    pub at_once: Option<u32>,
    /// Further options of `sbatch`.
    pub further: Vec<String>,
    /// The command that the nodes start, without its arguments.
    pub command: Vec<OsString>,
}

/// A job array that was submitted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Submission {
    /// Its number.
    pub job: u64,
    /// The runs of each task.
    pub tasks: Vec<Vec<u32>>,
}

/// The submissions of a wedge.
#[derive(Debug)]
pub struct Slurm<'a> {
    folder: &'a WedgeFolder,
    submissions: Vec<Submission>,
}

impl<'a> Slurm<'a> {
    /// The submissions of a wedge so far.
    ///
    /// # Errors
    /// When the list of submissions cannot be read.
    pub fn new(folder: &'a WedgeFolder) -> Result<Self, WedgeError> {
        let path = jobs_file(folder);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(source) => return Err(at(&path, source)),
        };
        // The last line of a coordinator that was killed may be incomplete; its job is found by its results.
        let submissions = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        Ok(Self { folder, submissions })
    }

    /// The name of the jobs of a wedge.
    pub fn job_name(&self) -> String {
        // FNV-1a over 64 bits.
        let bytes = self.folder.root().as_os_str().as_encoded_bytes();
        let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        format!("nucleus-{hash:016x}")
    }

    /// How often a run has been submitted.
    pub fn attempts(&self, run: u32) -> usize {
        self.submissions.iter().filter(|one| one.tasks.iter().flatten().any(|other| *other == run)).count()
    }

    /// The runs that are waiting or running.
    ///
    /// # Errors
    /// When `squeue` cannot be started or fails.
    pub fn queued(&self) -> Result<BTreeSet<u32>, WedgeError> {
        let name = format!("--name={}", self.job_name());
        let said = call(Command::new("squeue").args(["--noheader", "--array", "--format=%F %K", &name]))?;
        let by_job: BTreeMap<u64, &Submission> = self.submissions.iter().map(|one| (one.job, one)).collect();
        let runs = said.lines().filter_map(|line| {
            let (job, task) = line.trim().split_once(' ')?;
            let submission = by_job.get(&job.parse().ok()?)?;
            submission.tasks.get(task.trim().parse::<usize>().ok()?)
        });
        Ok(runs.flatten().copied().collect())
    }

    /// Submits runs, in as many job arrays as the cluster's limit on their size requires.
    ///
    /// # Errors
    /// When SLURM refuses a job, or a file cannot be written. Jobs that were accepted before are recorded.
    pub fn submit(&mut self, header: &PlanHeader, runs: &[u32], request: &Request) -> Result<(), WedgeError> {
        let tasks: Vec<Vec<u32>> = runs.chunks(request.runs_per_task.max(1)).map(<[u32]>::to_vec).collect();
        for tasks in tasks.chunks(max_array()) {
            let submission = self.submit_array(header, tasks, request)?;
            self.record(&submission)?;
            self.submissions.push(submission);
        }
        Ok(())
    }

    fn submit_array(
        &self,
        header: &PlanHeader,
        tasks: &[Vec<u32>],
        request: &Request,
    ) -> Result<Submission, WedgeError> {
        let script = self.write_script(tasks, request)?;
        let limit = request.at_once.map(|limit| format!("%{limit}")).unwrap_or_default();
        let logs = self.folder.root().join("logs").join("slurm-%A_%a.txt");
        let mut sbatch = Command::new("sbatch");
        sbatch.args(["--parsable", "--requeue", "--open-mode=append", "--ntasks=1"]);
        sbatch.arg(format!("--job-name={}", self.job_name()));
        sbatch.arg(format!("--array=0-{}{limit}", tasks.len() - 1));
        sbatch.arg(format!("--signal=B:TERM@{NOTICE}"));
        sbatch.arg(format!("--cpus-per-task={}", request.threads.max(1)));
        sbatch.arg(joined("--chdir=", &header.directory)).arg(joined("--output=", &logs));
        let options = [
            ("--account", &request.account),
            ("--partition", &request.partition),
            ("--time", &request.time),
            ("--mem", &request.memory),
        ];
        for (name, value) in options {
            sbatch.args(value.iter().map(|value| format!("{name}={value}")));
        }
        sbatch.args(&request.further).arg(script);
        let said = call(&mut sbatch)?;
        let number = said.trim().split(';').next().and_then(|job| job.parse().ok());
        let job = number.ok_or_else(|| {
            WedgeError::Scheduler(format!("`sbatch` said no job number but `{}`", said.trim()))
        })?;
        Ok(Submission { job, tasks: tasks.to_vec() })
    }

    /// Writes the script of a job, and the list of its tasks.
    fn write_script(&self, tasks: &[Vec<u32>], request: &Request) -> Result<PathBuf, WedgeError> {
        let folder = self.folder.root().join("slurm");
        let number = self.submissions.len();
        let (list, script) =
            (folder.join(format!("{number:04}.txt")), folder.join(format!("{number:04}.sh")));
        let lines =
            tasks.iter().map(|runs| runs.iter().map(u32::to_string).collect::<Vec<_>>().join(",") + "\n");
        let command: Vec<String> =
            request.command.iter().map(|word| quoted(&word.to_string_lossy())).collect();
        let text = format!(
            "#!/bin/sh\n\
             # One task of a wedge. It resumes what an earlier attempt left.\n\
             runs=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\n\
             exec {} wedge --out {} --jobs 1 --threads {} --run \"$runs\"\n",
            quoted(&list.to_string_lossy()),
            command.join(" "),
            quoted(&self.folder.root().to_string_lossy()),
            request.threads.max(1)
        );
        let write = || -> io::Result<()> {
            fs::create_dir_all(&folder)?;
            fs::write(&list, lines.collect::<String>())?;
            fs::write(&script, text)
        };
        write().map_err(|source| at(&script, source))?;
        Ok(script)
    }

    /// Appends a submission to the list, on a line of its own even after an incomplete one.
    fn record(&self, submission: &Submission) -> Result<(), WedgeError> {
        let path = jobs_file(self.folder);
        let write = || -> io::Result<()> {
            let incomplete =
                fs::read(&path).is_ok_and(|bytes| bytes.last().is_some_and(|last| *last != b'\n'));
            let mut line = if incomplete { vec![b'\n'] } else { Vec::new() };
            serde_json::to_writer(&mut line, submission)?;
            line.push(b'\n');
            let mut file = OpenOptions::new().create(true).append(true).open(&path)?;
            file.write_all(&line)?;
            file.sync_all()
        };
        write().map_err(|source| at(&path, source))
    }
}

/// Refuses a machine without SLURM.
///
/// # Errors
/// When `sbatch` cannot be started.
pub fn check_installed() -> Result<(), WedgeError> {
    call(Command::new("sbatch").arg("--version")).map(drop)
}

fn jobs_file(folder: &WedgeFolder) -> PathBuf {
    folder.root().join("slurm").join("jobs.jsonl")
}

/// The most tasks of a job array on this cluster.
fn max_array() -> usize {
    let config = call(Command::new("scontrol").args(["show", "config"])).unwrap_or_default();
    let line = config.lines().find_map(|line| line.trim().strip_prefix("MaxArraySize"));
    let size = line.and_then(|rest| rest.trim().trim_start_matches('=').trim().parse::<usize>().ok());
    // Indices are below the limit.
    size.map_or(MAX_ARRAY, |size| size.saturating_sub(1)).max(1)
}

fn joined(option: &str, path: &Path) -> OsString {
    let mut all = OsString::from(option);
    all.push(path);
    all
}

/// A word in single quotes for a shell.
fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// The output of a program of SLURM.
fn call(command: &mut Command) -> Result<String, WedgeError> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.stdin(Stdio::null()).output().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => WedgeError::Scheduler(format!(
            "SLURM is not installed here: there is no `{name}`; use a machine that submits jobs, or leave out `--on slurm`"
        )),
        _ => WedgeError::Scheduler(format!("`{name}` cannot be started: {error}")),
    })?;
    let Output { status, stdout, stderr } = output;
    if status.success() {
        return Ok(String::from_utf8_lossy(&stdout).into_owned());
    }
    let said = String::from_utf8_lossy(&stderr);
    Err(WedgeError::Scheduler(format!("`{name}` failed: {}", said.trim())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_for_the_shell() {
        assert_eq!(quoted("it's; rm"), r"'it'\''s; rm'");
    }

    #[test]
    fn submissions_survive_a_coordinator_that_was_killed_while_it_wrote() {
        let folder = tempfile::tempdir().unwrap();
        let wedge = WedgeFolder::new(folder.path()).unwrap();
        fs::create_dir_all(wedge.root().join("slurm")).unwrap();
        let slurm = Slurm { folder: &wedge, submissions: Vec::new() };
        let one = Submission { job: 7, tasks: vec![vec![0, 1], vec![2]] };
        slurm.record(&one).unwrap();
        let path = jobs_file(&wedge);
        let bytes = [fs::read(&path).unwrap(), b"{\"job\":8,\"ta".to_vec()].concat();
        fs::write(&path, bytes).unwrap();
        slurm.record(&Submission { job: 9, ..one.clone() }).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let read: Vec<Submission> = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        assert_eq!(read.iter().map(|one| one.job).collect::<Vec<_>>(), [7, 9]);
        let slurm = Slurm { folder: &wedge, submissions: read };
        assert_eq!([0, 2, 3].map(|run| slurm.attempts(run)), [2, 2, 0]);
    }
}
