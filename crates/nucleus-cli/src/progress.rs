//! Progress on standard error: a bar on a terminal, otherwise a line every few seconds.

use std::collections::BTreeMap;
use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use nucleus_measure::trade;
use nucleus_wedge::{Event, PlannedRun, RunOutcome};

use crate::figures;
use crate::output::{is_quiet, say};
use crate::run_statistics::RunStatistics;

/// A bar, if standard error is a terminal.
fn bar(length: u64, template: &str) -> Option<ProgressBar> {
    let bar = (stderr().is_terminal() && !is_quiet()).then(|| ProgressBar::new(length))?;
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    Some(bar)
}

/// Steps of bars that show a share.
const STEPS: u64 = 1000;

/// Progress of a run.
pub struct RunProgress {
    bar: Option<ProgressBar>,
    /// Frames to simulate, and the number of the last one.
    frames: u32,
    last: i64,
    last_line: Instant,
}

impl RunProgress {
    /// Time between two lines.
    const LINE_EVERY: Duration = Duration::from_secs(5);

    /// Progress of a run with this many frames to simulate, up to frame `last`.
    pub fn new(frames: u32, last: i64) -> Self {
        let bar = bar(frames.into(), "{wide_bar} {prefix}, {eta} left, {msg}");
        Self { bar, frames, last, last_line: Instant::now() }
    }

    /// Shows the state after a frame.
    pub fn show(&mut self, frame: i32, statistics: &RunStatistics) {
        let last = self.last;
        match &self.bar {
            Some(bar) => {
                bar.set_prefix(format!("frame {frame} of {last}"));
                bar.set_message(state(statistics));
                bar.set_position(statistics.frames.into());
            }
            None if self.last_line.elapsed() >= Self::LINE_EVERY && !is_quiet() => {
                self.last_line = Instant::now();
                let remaining = self.frames.saturating_sub(statistics.frames);
                let left = (statistics.time / statistics.frames.max(1) * remaining).as_secs();
                say!("frame {frame} of {last}, {left} s left, {}", state(statistics));
            }
            None => {}
        }
    }

    /// Removes the bar.
    pub fn end(self) {
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
    }
}

/// `12.4 ms/frame, strain 1.2 %, gap 0.98, 36 pairs unresolved`.
fn state(statistics: &RunStatistics) -> String {
    let mut state = format!("{} ms/frame", figures::number(statistics.milliseconds()));
    if let Some((strain, _)) = statistics.worst_strain {
        state += &format!(", strain {}", figures::percent(strain));
    }
    if let Some((gap, _)) = statistics.smallest_gap {
        state += &format!(", gap {}", figures::number(gap));
    }
    let unresolved = statistics.pairs_unresolved.total;
    if unresolved > 0 {
        state += &format!(", {} unresolved", figures::count(unresolved as usize, "pair"));
    }
    state
}

/// Progress of an export or a film, which seldom take long: on a terminal only.
pub struct ShareProgress(Option<ProgressBar>);

impl ShareProgress {
    /// Progress of `activity`, such as "exporting".
    pub fn new(activity: &'static str) -> Self {
        let bar = bar(STEPS, "{msg} {wide_bar} {percent} %, {eta} left");
        bar.iter().for_each(|bar| bar.set_message(activity));
        Self(bar)
    }

    /// Shows the share that is done, from 0 to 1.
    pub fn show(&mut self, share: f64) {
        if let Some(bar) = &self.0 {
            bar.set_position((STEPS as f64 * share) as u64);
        }
    }

    /// Removes the bar.
    pub fn end(self) {
        self.0.iter().for_each(ProgressBar::finish_and_clear);
    }
}

/// Progress of a sweep over settings.
pub struct SweepProgress {
    bar: Option<ProgressBar>,
    begin: Instant,
    last_line: Instant,
}

impl SweepProgress {
    /// Time between two lines.
    const LINE_EVERY: Duration = Duration::from_secs(10);

    pub fn new() -> Self {
        Self {
            bar: bar(STEPS, "{wide_bar} {percent} %, {msg}"),
            begin: Instant::now(),
            last_line: Instant::now(),
        }
    }

    /// Shows how many runs are done.
    pub fn show(&mut self, progress: &trade::Progress) {
        let state = self.state(progress);
        match &self.bar {
            Some(bar) => {
                bar.set_position((progress.done * STEPS as f64) as u64);
                bar.set_message(state);
            }
            None if self.last_line.elapsed() >= Self::LINE_EVERY && !is_quiet() => {
                self.last_line = Instant::now();
                say!("{:.0} %, {state}", 100.0 * progress.done);
            }
            None => {}
        }
    }

    /// Removes the bar.
    pub fn end(self) {
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
    }

    /// `7 of 23 runs done (3 stored), 2 minutes left`.
    fn state(&self, progress: &trade::Progress) -> String {
        let [finished, all] = progress.runs;
        let stored = if progress.kept > 0 { format!(" ({} stored)", progress.kept) } else { String::new() };
        let left = match progress.done {
            done if done > 0.01 => {
                let left = self.begin.elapsed().as_secs_f64() * (1.0 - done) / done;
                format!(", {} left", HumanDuration(Duration::from_secs_f64(left)))
            }
            _ => String::new(),
        };
        format!("{finished} of {all} runs done{stored}{left}")
    }
}

/// Progress of the runs of a wedge.
pub struct WedgeProgress<'a> {
    runs: &'a [PlannedRun],
    bar: Option<ProgressBar>,
    last_line: Instant,
    /// Runs to do, runs that have ended, and how many of them with a problem.
    all: usize,
    ended: usize,
    problems: usize,
    /// The running ones, and the frame of each.
    running: BTreeMap<u32, Option<i64>>,
}

impl<'a> WedgeProgress<'a> {
    /// Time between two lines.
    const LINE_EVERY: Duration = Duration::from_secs(5);

    /// Running runs that are named.
    const MAX_NAMED: usize = 8;

    /// Progress of `all` of the runs of a plan.
    pub fn new(runs: &'a [PlannedRun], all: usize) -> Self {
        let bar = bar(all as u64, "{wide_bar} run {pos} of {len}, {eta} left, {msg}");
        let running = BTreeMap::new();
        Self { runs, bar, last_line: Instant::now(), all, ended: 0, problems: 0, running }
    }

    /// Shows an event. A run with a problem is named at once; the report at the end says what it is.
    pub fn show(&mut self, event: &Event) {
        match event {
            Event::Started { run } => drop(self.running.insert(*run, None)),
            Event::Frame { run, frame } => drop(self.running.insert(*run, Some(*frame))),
            Event::Ended { run, result } => {
                self.running.remove(run);
                self.ended += 1;
                let ending = match result {
                    None => Some("is done by another process"),
                    Some(result) if result.problems().is_empty() => None,
                    Some(result) => Some(match result.outcome {
                        RunOutcome::Success | RunOutcome::Problem => "has a problem",
                        RunOutcome::Failed => "has failed",
                        RunOutcome::Interrupted => "was interrupted",
                        RunOutcome::Killed => "was killed",
                    }),
                };
                if let Some(ending) = ending {
                    self.problems += 1;
                    self.say(&format!("run {} {ending}", self.name(*run)));
                }
            }
        }
        self.show_state();
    }

    fn show_state(&mut self) {
        match &self.bar {
            Some(bar) => {
                bar.set_message(self.state());
                bar.set_position(self.ended as u64);
            }
            None if self.last_line.elapsed() >= Self::LINE_EVERY => {
                self.last_line = Instant::now();
                say!("{} of {} runs ended, {}", self.ended, self.all, self.state());
            }
            None => {}
        }
    }

    /// `2 with problems, running: 0013 frame 34, 0014`.
    fn state(&self) -> String {
        let problems =
            if self.problems > 0 { format!("{} with problems, ", self.problems) } else { String::new() };
        let named = self.running.iter().take(Self::MAX_NAMED).map(|(run, frame)| match frame {
            Some(frame) => format!("{} frame {frame}", self.name(*run)),
            None => self.name(*run).to_owned(),
        });
        let more = if self.running.len() > Self::MAX_NAMED { ", ..." } else { "" };
        format!("{problems}running: {}{more}", named.collect::<Vec<_>>().join(", "))
    }

    fn name(&self, run: u32) -> &str {
        self.runs.get(run as usize).map_or("", |run| run.name.as_str())
    }

    fn say(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => say!("{text}"),
        }
    }

    /// Removes the bar.
    pub fn end(self) {
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
    }
}
