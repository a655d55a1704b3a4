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
use std::sync::{Mutex, MutexGuard, PoisonError};
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
        let next = AtomicUsize::new(0);
        let jobs = self.jobs.clamp(1, runs.len().max(1));
        let children = Children::new(jobs);
        let (sender, events) = channel();
        std::thread::scope(|scope| {
            for slot in 0..jobs {
                let sender = sender.clone();
                let (next, children) = (&next, &children);
                scope.spawn(move || {
                    while let Some(run) = runs.get(next.fetch_add(1, Ordering::SeqCst)) {
                        if !children.may_start() {
                            return;
                        }
                        let ended = self.one(run, slot, children, &sender);
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
                        children.start_no_more();
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => break,
                }
                if should_stop() {
                    children.ask_to_end();
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
        children: &Children,
        events: &Sender<Result<Event, WedgeError>>,
    ) -> Result<Option<RunResult>, WedgeError> {
        let begin = Instant::now();
        let log = self.folder.log(&run.name);
        let earlier = self.folder.result(&run.name)?;
        let mut child = self.start(run, &log)?;
        children.hold(slot, child.stdin.take());
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
        children.hold(slot, None);
        if status.code() == Some(BUSY) {
            return Ok(None);
        }
        self.result(run, earlier.as_ref(), status, begin.elapsed()).map(Some)
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

    /// The result that the child has written; else what its end says. `earlier`: the result before its start.
    fn result(
        &self,
        run: &PlannedRun,
        earlier: Option<&RunResult>,
        status: ExitStatus,
        time: Duration,
    ) -> Result<RunResult, WedgeError> {
        // A child that finds its run finished writes nothing.
        let is_known = |result: &RunResult| status.success() && result.outcome.is_final();
        let is_new = |result: &RunResult| earlier.is_none_or(|earlier| result.attempt != earlier.attempt);
        if status.code().is_some()
            && let Some(result) = self.folder.result(&run.name)?
            && (is_new(&result) || is_known(&result))
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
            attempt: 0,
            report: None,
        };
        let result = result.after(earlier);
        self.folder.write_result(&run.name, &result)?;
        Ok(result)
    }
}

/// The children of a pool.
struct Children {
    /// Their pipes, by slot.
    pipes: Mutex<Vec<Option<ChildStdin>>>,
    /// No further child is started: after an error, or a request to end.
    starts_no_more: AtomicBool,
    /// The children are asked to end, also those that are being started.
    must_end: AtomicBool,
}

impl Children {
    fn new(slots: usize) -> Self {
        let pipes = Mutex::new((0..slots).map(|_| None).collect());
        Self { pipes, starts_no_more: AtomicBool::new(false), must_end: AtomicBool::new(false) }
    }

    fn may_start(&self) -> bool {
        !self.starts_no_more.load(Ordering::SeqCst)
    }

    fn start_no_more(&self) {
        self.starts_no_more.store(true, Ordering::SeqCst);
    }

    /// Closes all pipes, of which children notice that they are to end.
    fn ask_to_end(&self) {
        self.start_no_more();
        self.must_end.store(true, Ordering::SeqCst);
        self.pipes().iter_mut().for_each(|pipe| drop(pipe.take()));
    }

    /// Holds the pipe of the child in a slot in place of that of the child before.
    fn hold(&self, slot: usize, pipe: Option<ChildStdin>) {
        let mut pipes = self.pipes();
        // A request that arrived since the start of the child closes the pipe at once.
        pipes[slot] = pipe.filter(|_| !self.must_end.load(Ordering::SeqCst));
    }

    fn pipes(&self) -> MutexGuard<'_, Vec<Option<ChildStdin>>> {
        self.pipes.lock().unwrap_or_else(PoisonError::into_inner)
    }
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
    use serde_json::json;

    use super::*;
    use crate::plan::Plan;

    fn result(outcome: RunOutcome) -> RunResult {
        let (error, earlier, machine) = (None, SolvedFrames::default(), String::new());
        RunResult { outcome, error, seconds: 1.0, earlier, at_once: 1, machine, attempt: 1, report: None }
    }

    /// A process that lives until its pipe is closed, and the pipe.
    fn reader() -> (Child, Option<ChildStdin>) {
        let mut child = Command::new("cat").stdin(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
        let pipe = child.stdin.take();
        (child, pipe)
    }

    /// The outcome of a run whose process is this script of a shell.
    fn outcome(script: &str) -> RunOutcome {
        outcome_after(None, script)
    }

    /// The outcome of such a run that has a result of an earlier process.
    fn outcome_after(earlier: Option<RunOutcome>, script: &str) -> RunOutcome {
        let folder = tempfile::tempdir().unwrap();
        let wedge = WedgeFolder::new(&folder.path().join("w")).unwrap();
        let (name, arguments) = ("0000".to_owned(), vec!["run".to_owned()]);
        let run = PlannedRun { run: 0, name, values: Vec::new(), seed: None, arguments };
        let header = PlanHeader::new("a.ron".to_owned(), folder.path().to_owned(), Vec::new());
        let plan = Plan { header, runs: vec![run] };
        wedge.create(&plan).unwrap();
        if let Some(outcome) = earlier {
            wedge.write_result("0000", &result(outcome)).unwrap();
        }
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

    #[test]
    fn a_result_of_an_earlier_process_is_not_that_of_this_one() {
        let interrupted = Some(RunOutcome::Interrupted);
        assert_eq!(outcome_after(interrupted, "echo panicked >&2; exit 101"), RunOutcome::Failed);
        assert_eq!(outcome_after(interrupted, "exit 0"), RunOutcome::Failed);
        // `$2` is the folder of the wedge.
        let written = json!(RunResult { attempt: 2, ..result(RunOutcome::Problem) });
        let write = format!("echo '{written}' > \"$2/results/0000.json\"; exit 1");
        assert_eq!(outcome_after(interrupted, &write), RunOutcome::Problem);
        assert_eq!(
            outcome_after(Some(RunOutcome::Success), "exit 0"),
            RunOutcome::Success,
            "it was finished"
        );
    }

    #[test]
    fn a_request_to_end_reaches_the_children_after_an_error() {
        let children = Children::new(2);
        let [(mut early, early_pipe), (mut late, late_pipe)] = [reader(), reader()];
        children.start_no_more();
        children.hold(0, early_pipe);
        assert!(!children.may_start() && children.pipes()[0].is_some(), "the other runs end first");
        children.ask_to_end();
        children.hold(1, late_pipe);
        assert!(
            children.pipes().iter().all(Option::is_none),
            "also that of a child whose start was under way"
        );
        assert!(early.wait().unwrap().success() && late.wait().unwrap().success());
    }
}
