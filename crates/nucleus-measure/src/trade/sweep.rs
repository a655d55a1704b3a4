//! All runs of a scene: side by side, resumed where they were left.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use nucleus_graph::compile::Program;

use super::found::{Trade, told};
use super::plan::{self, Wishes};
use super::run::{Kept, Run, follow, key};
use super::setting::Setting;
use super::subject::{MOST_APART, Subject, TradeError};
use crate::reference::{self, References, Solved};
use crate::store::Store;
use crate::trajectory::Trajectory;

/// The finished runs of a scene, a line each.
const LIST: &str = "runs.jsonl";

/// How often progress is told.
const TELL_EVERY: Duration = Duration::from_millis(200);

/// How far a sweep is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The share of all work that is done, 0 to 1; what was kept from before counts for none.
    pub done: f64,
    /// Runs that are finished, and those that there are to do.
    pub runs: [usize; 2],
    /// Runs that were kept from before.
    pub kept: usize,
}

/// Who watches a sweep, and may end it.
pub struct Watch<'a> {
    /// Runs side by side, each on a thread of its own.
    pub side_by_side: usize,
    /// Is told how far it is.
    pub tell: &'a mut dyn FnMut(&Progress),
    /// Whether to go on.
    pub should_continue: &'a (dyn Fn() -> bool + Sync),
}

/// What came of a sweep.
pub struct Found {
    /// Every setting, judged.
    pub trade: Trade,
    /// What they were held against; nothing where all are Classic.
    pub references: Option<References>,
    /// Every run, frame by frame.
    pub runs: Vec<Run>,
}

impl Found {
    /// How far the run of a setting was from the reference in each frame; nothing without a reference.
    pub fn apart(&self, setting: &Setting) -> Option<Vec<f64>> {
        let run = self.runs.iter().find(|run| run.setting == *setting)?;
        run.frames.iter().map(|frame| frame.apart.map(|[rms, _]| rms)).collect()
    }
}

/// A run to do.
struct Task {
    setting: Setting,
    bits: u32,
    program: Program,
    work: f64,
}

/// Makes the references, runs everything, and judges it. What is finished is kept in `store` as it comes, and not
/// done again.
///
/// # Errors
/// When the scene cannot be compared, when results cannot be kept, and when it was asked to end.
pub fn measure(
    subject: &Subject,
    wishes: &Wishes,
    store: &Store,
    mut watch: Watch,
) -> Result<Found, TradeError> {
    let settings = plan::settings(subject, wishes)?;
    let known: Vec<Run> = store.list(LIST)?;
    let frames = subject.frames();
    let old = |setting: &Setting| known.iter().find(|run| run.key() == key(setting, 32, frames)).cloned();
    let (kept, open): (Vec<_>, Vec<_>) =
        settings.iter().map(|setting| (setting, old(setting))).partition(|(_, run)| run.is_some());
    let mut runs: Vec<Run> = kept.into_iter().filter_map(|(_, run)| run).collect();
    let tasks = open.iter().map(|(setting, _)| task(subject, setting, 32)).collect::<Result<Vec<_>, _>>()?;

    let mut done = Done {
        progress: Progress { done: 0.0, runs: [0, tasks.len()], kept: runs.len() },
        before: 0.0,
        all: tasks.iter().map(|task| task.work).sum(),
    };
    let references = references(subject, &settings, store, &mut done, &mut watch)?;
    if let Some(both) = &references {
        refuse(subject, both)?;
    }
    let wanted = references.as_ref().map(|both| &both.fine.path);
    work_through(subject, tasks, wanted, &mut done, &mut watch, &mut |run, kept| {
        reference::keep_end(store, &run.key(), &kept.end)?;
        store.append(LIST, &run)?;
        runs.push(run);
        Ok(())
    })?;
    let trade = Trade::new(subject, &runs, references.as_ref());
    trade.keep(store)?;
    Ok(Found { trade, references, runs })
}

/// All objects as they were at the end of a run of a sweep, in the order of the program, in scene units.
///
/// # Errors
/// When they are there and cannot be read.
pub fn end(
    store: &Store,
    subject: &Subject,
    setting: &Setting,
) -> Result<Option<Vec<Vec<[f32; 3]>>>, TradeError> {
    Ok(reference::find_end(store, &key(setting, 32, subject.frames()))?)
}

/// The two references, from before or new.
fn references(
    subject: &Subject,
    settings: &[Setting],
    store: &Store,
    done: &mut Done,
    watch: &mut Watch,
) -> Result<Option<References>, TradeError> {
    let Some(both) = plan::references(subject, settings) else { return Ok(None) };
    let mut solved = Vec::new();
    let mut tasks = Vec::new();
    for setting in &both {
        match reference::find(store, subject, setting)? {
            Some(kept) => solved.push(kept),
            None => tasks.push(task(subject, setting, 64)?),
        }
    }
    done.all += tasks.iter().map(|task| task.work).sum::<f64>();
    done.progress.runs[1] += tasks.len();
    done.progress.kept += solved.len();
    work_through(subject, tasks, None, done, watch, &mut |run, kept| {
        let made = Solved::of(run, kept);
        made.keep(store)?;
        solved.push(made);
        Ok(())
    })?;
    solved.sort_by(|a, b| a.run.setting.evaluations.total_cmp(&b.run.setting.evaluations));
    let [coarse, fine] = <[Solved; 2]>::try_from(solved).map_err(|_| TradeError::Interrupted)?;
    Ok(Some(References::new(coarse, fine, subject.size)))
}

/// Refuses what nothing can be held against.
fn refuse(subject: &Subject, references: &References) -> Result<(), TradeError> {
    let span = subject.program().time();
    for solved in [&references.coarse, &references.fine] {
        if !solved.run.is_finite() {
            return Err(TradeError::ReferenceLost { frame: span.start + solved.run.frames.len() as i64 + 1 });
        }
    }
    let path = &references.fine.path;
    let (mut first, mut now) = (Vec::new(), Vec::new());
    path.frame(0, &mut first);
    let moves = (1..path.frames()).any(|frame| {
        path.frame(frame, &mut now);
        crate::metrics::distance::distance(&now, &first, subject.size).max > 1e-7
    });
    if !moves {
        return Err(TradeError::NothingMoves { start: span.start, end: span.end });
    }
    let apart = Trade::floor(references);
    match told(apart, MOST_APART) {
        true => Ok(()),
        false => {
            let evaluations =
                [&references.coarse, &references.fine].map(|solved| solved.run.setting.evaluations);
            Err(TradeError::ReferenceDoesNotConverge { evaluations, apart })
        }
    }
}

fn task(subject: &Subject, setting: &Setting, bits: u32) -> Result<Task, TradeError> {
    let work = plan::work(subject, setting, bits)?;
    Ok(Task { setting: *setting, bits, program: subject.at(setting)?, work })
}

/// How much is done, over several rounds of work.
struct Done {
    progress: Progress,
    /// Work of the rounds before.
    before: f64,
    all: f64,
}

/// Does tasks side by side, the longest first, and gives each away as it ends.
fn work_through(
    subject: &Subject,
    mut tasks: Vec<Task>,
    wanted: Option<&Trajectory>,
    done: &mut Done,
    watch: &mut Watch,
    keep: &mut dyn FnMut(Run, Kept) -> Result<(), TradeError>,
) -> Result<(), TradeError> {
    tasks.sort_by(|a, b| b.work.total_cmp(&a.work));
    let (next, milli) = (AtomicUsize::new(0), AtomicU64::new(0));
    let (sender, receiver) = channel();
    let workers = watch.side_by_side.clamp(1, tasks.len().max(1));
    let should_continue = watch.should_continue;
    thread::scope(|scope| {
        for _ in 0..workers {
            let sender = sender.clone();
            scope.spawn(|| worker(subject, &tasks, wanted, &next, &milli, should_continue, sender));
        }
        drop(sender);
        loop {
            let finished = receiver.recv_timeout(TELL_EVERY);
            match finished {
                Ok((run, kept)) => {
                    done.progress.runs[0] += 1;
                    keep(run, kept).inspect_err(|_| next.store(tasks.len(), Ordering::Relaxed))?;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            let share = (done.before + milli.load(Ordering::Relaxed) as f64 / 1e3) / done.all.max(1.0);
            done.progress.done = share.min(1.0);
            (watch.tell)(&done.progress);
        }
        Ok::<(), TradeError>(())
    })?;
    done.before += tasks.iter().map(|task| task.work).sum::<f64>();
    if should_continue() { Ok(()) } else { Err(TradeError::Interrupted) }
}

/// Takes task after task until there is none, or until it is to end.
fn worker(
    subject: &Subject,
    tasks: &[Task],
    wanted: Option<&Trajectory>,
    next: &AtomicUsize,
    milli: &AtomicU64,
    should_continue: &(dyn Fn() -> bool + Sync),
    sender: Sender<(Run, Kept)>,
) {
    while let Some(task) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
        let each = (1e3 * task.work / subject.frames().max(1) as f64) as u64;
        let pulse = || {
            milli.fetch_add(each, Ordering::Relaxed);
            should_continue()
        };
        let finished = match task.bits {
            64 => follow::<f64>(subject, &task.setting, &task.program, wanted, &pulse),
            _ => follow::<f32>(subject, &task.setting, &task.program, wanted, &pulse),
        };
        // Nobody listens any more when results cannot be kept.
        let Some(finished) = finished else { return };
        if sender.send(finished).is_err() {
            return;
        }
    }
}
