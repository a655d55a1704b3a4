//! Runs as child processes of this machine, several at once.
//!
//! Each run is a process of its own, so that a crash, an exhausted memory or a kill costs that run alone. A child holds
//! the reading end of a pipe from this process and ends its run cleanly when the pipe closes: after Ctrl-C, and also when
//! this process is killed.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::error::{WedgeError, at};
use crate::folder::WedgeFolder;
use crate::plan::{PlanHeader, PlannedRun};
use crate::result::{RunOutcome, RunResult, SolvedFrames};

/// Exit code of a child whose run another process is at.
pub const BUSY: i32 = 75;

/// Exit code of a child that was asked to end.
const INTERRUPTED: i32 = 130;

/// Interval at which the request to stop is looked at.
const POLL: Duration = Duration::from_millis(50);

/// Executes runs as child processes.
#[derive(Debug)]
pub struct Pool<'a> {
    /// The command of a child, without the arguments for its run: usually the path of `nucleus`.
    pub command: &'a [OsString],
    /// The folder of the wedge.
    pub folder: &'a WedgeFolder,
    /// Facts about the plan.
    pub header: &'a PlanHeader,
    /// Runs at once.
    pub jobs: usize,
    /// Further arguments of every child.
    pub options: &'a [OsString],
}

/// An event of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// Its process has started.
    Started {
        /// The number of the run.
        run: u32,
    },
    /// It has reached a frame.
    Frame {
        /// The number of the run.
        run: u32,
        /// The frame.
        frame: i64,
    },
    /// It has ended.
    Ended {
        /// The number of the run.
        run: u32,
        /// Its result; `None` if another process is at it.
        result: Option<RunResult>,
    },
}

/// The pipes of the children, by slot.
type Pipes = Mutex<Vec<Option<ChildStdin>>>;

impl Pool<'_> {
    /// Executes runs until all have ended, or `should_stop`: then it asks the running ones to end, and waits for them.
    ///
    /// # Errors
    /// When a process cannot be started or a result cannot be written. The other runs end first.
    pub fn run(
        &self,
        runs: &[PlannedRun],
        should_stop: &dyn Fn() -> bool,
        on_event: &mut dyn FnMut(Event),
    ) -> Result<(), WedgeError> {
        let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
        let jobs = self.jobs.clamp(1, runs.len().max(1));
        let pipes: Pipes = Mutex::new((0..jobs).map(|_| None).collect());
        let (sender, events) = channel();
        std::thread::scope(|scope| {
            for slot in 0..jobs {
                let sender = sender.clone();
                let (next, stop, pipes) = (&next, &stop, &pipes);
                scope.spawn(move || {
                    while let Some(run) = runs.get(next.fetch_add(1, Ordering::SeqCst)) {
                        if stop.load(Ordering::SeqCst) {
                            return;
                        }
                        let ended = self.one(run, slot, pipes, stop, &sender);
                        let is_error = ended.is_err();
                        if sender.send(ended.map(|result| Event::Ended { run: run.run, result })).is_err()
                            || is_error
                        {
                            return;
                        }
                    }
                });
            }
            drop(sender);
            let mut first_error = None;
            loop {
                match events.recv_timeout(POLL) {
                    Ok(Ok(event)) => on_event(event),
                    Ok(Err(error)) => {
                        first_error.get_or_insert(error);
                        stop.store(true, Ordering::SeqCst);
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => break,
                }
                if should_stop() && !stop.swap(true, Ordering::SeqCst) {
                    locked(&pipes).iter_mut().for_each(|pipe| drop(pipe.take()));
                }
            }
            first_error.map_or(Ok(()), Err)
        })
    }

    /// Executes one run and returns its result.
    fn one(
        &self,
        run: &PlannedRun,
        slot: usize,
        pipes: &Pipes,
        stop: &AtomicBool,
        events: &Sender<Result<Event, WedgeError>>,
    ) -> Result<Option<RunResult>, WedgeError> {
        let begin = Instant::now();
        let log = self.folder.log(&run.name);
        let mut child = self.start(run, &log)?;
        {
            let mut pipes = locked(pipes);
            // A request to stop that arrived since the start closes the pipe at once.
            let pipe = child.stdin.take();
            pipes[slot] = pipe.filter(|_| !stop.load(Ordering::SeqCst));
        }
        // The receiver outlives all senders.
        let send = |event| drop(events.send(Ok(event)));
        send(Event::Started { run: run.run });
        let lines = child.stdout.take().map(|out| BufReader::new(out).lines());
        for line in lines.into_iter().flatten().map_while(Result::ok) {
            if let Some(frame) = frame_of(&line) {
                send(Event::Frame { run: run.run, frame });
            }
        }
        let status = child.wait().map_err(|source| at(&log, source))?;
        locked(pipes)[slot] = None;
        if status.code() == Some(BUSY) {
            return Ok(None);
        }
        self.result(run, status, begin.elapsed()).map(Some)
    }

    fn start(&self, run: &PlannedRun, log: &Path) -> Result<Child, WedgeError> {
        let [program, fixed @ ..] = self.command else {
            return Err(WedgeError::Scheduler("there is no command to start runs with".to_owned()));
        };
        let messages = File::create(log).map_err(|source| at(log, source))?;
        let mut command = Command::new(program);
        command.args(fixed).arg("wedge").arg("--out").arg(self.folder.root());
        command.args(["--task", &run.run.to_string()]).args(["--at-once", &self.jobs.to_string()]);
        command.args(self.options).current_dir(&self.header.directory);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(messages);
        command.spawn().map_err(|source| at(Path::new(program), source))
    }

    /// The result that the child has written; else what its end says.
    fn result(&self, run: &PlannedRun, status: ExitStatus, time: Duration) -> Result<RunResult, WedgeError> {
        if status.code().is_some()
            && let Some(result) = self.folder.result(&run.name)?
        {
            return Ok(result);
        }
        let log = self.folder.log(&run.name);
        let (outcome, error) = match status.code() {
            None => (RunOutcome::Killed, format!("the process of the run was ended by the system: {status}")),
            Some(INTERRUPTED) => (RunOutcome::Interrupted, "it was asked to end".to_owned()),
            Some(_) => {
                let said = fs::read_to_string(&log).unwrap_or_default();
                let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no message");
                (RunOutcome::Failed, format!("{last} ({status})"))
            }
        };
        let result = RunResult {
            outcome,
            error: Some(error),
            seconds: time.as_secs_f64(),
            earlier: SolvedFrames::default(),
            at_once: self.jobs as u32,
            machine: machine(),
            report: None,
        };
        self.folder.write_result(&run.name, &result)?;
        Ok(result)
    }
}

fn locked(pipes: &Pipes) -> std::sync::MutexGuard<'_, Vec<Option<ChildStdin>>> {
    pipes.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The frame of a line of `nucleus run --json`.
fn frame_of(line: &str) -> Option<i64> {
    #[derive(serde::Deserialize)]
    struct Line {
        frame: i64,
    }
    serde_json::from_str::<Line>(line).ok().map(|line| line.frame)
}

/// The name of this machine.
pub fn machine() -> String {
    let name = |path| fs::read_to_string(path).ok().map(|name: String| name.trim().to_owned());
    let set = || std::env::var("HOSTNAME").or_else(|_| std::env::var("COMPUTERNAME")).ok();
    name("/proc/sys/kernel/hostname").or_else(set).unwrap_or_default()
}

/// Calls `closed` when the pipe from the parent closes. For a child process of a [`Pool`].
///
/// # Errors
/// When no thread can be started.
pub fn when_parent_ends(closed: impl FnOnce() + Send + 'static) -> io::Result<()> {
    let wait = move || {
        // Nothing is ever sent through the pipe.
        let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
        closed();
    };
    std::thread::Builder::new().name("parent".to_owned()).spawn(wait).map(drop)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use crate::plan::Plan;

    /// The outcome of a run whose process is this script of a shell.
    fn outcome(script: &str) -> RunOutcome {
        let folder = tempfile::tempdir().unwrap();
        let wedge = WedgeFolder::new(&folder.path().join("w")).unwrap();
        let (name, arguments) = ("0000".to_owned(), vec!["run".to_owned()]);
        let run = PlannedRun { run: 0, name, values: Vec::new(), seed: None, arguments };
        let header = PlanHeader::new("a.ron".to_owned(), folder.path().to_owned(), Vec::new());
        let plan = Plan { header, runs: vec![run] };
        wedge.create(&plan).unwrap();
        let command = ["sh", "-c", script].map(OsString::from);
        let pool = Pool { command: &command, folder: &wedge, header: &plan.header, jobs: 1, options: &[] };
        let mut results = Vec::new();
        let mut take = |event| match event {
            Event::Ended { result, .. } => results.push(result),
            Event::Started { .. } | Event::Frame { .. } => {}
        };
        pool.run(&plan.runs, &|| false, &mut take).unwrap();
        let result = results.pop().flatten().unwrap();
        assert_eq!(wedge.result("0000").unwrap(), Some(result.clone()), "the result is in its file");
        result.outcome
    }

    #[test]
    fn a_process_without_a_result_is_named_by_how_it_ended() {
        assert_eq!(outcome("echo no >&2; exit 2"), RunOutcome::Failed);
        assert_eq!(outcome("kill -9 $$"), RunOutcome::Killed);
        // Asked twice to end: there was no time for a result, and nothing is wrong with the run.
        assert_eq!(outcome("exit 130"), RunOutcome::Interrupted);
    }
}
