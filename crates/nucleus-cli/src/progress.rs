//! Progress on standard error: a bar on a terminal, otherwise a line every few seconds.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use nucleus_measure::trade;

use crate::figures;
use crate::output::say;
use crate::run_statistics::RunStatistics;

/// A bar, if standard error is a terminal.
fn bar(length: u64, template: &str) -> Option<ProgressBar> {
    let bar = stderr().is_terminal().then(|| ProgressBar::new(length))?;
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
    frames: u32,
    last_line: Instant,
}

impl RunProgress {
    /// Time between two lines.
    const LINE_EVERY: Duration = Duration::from_secs(5);

    /// Progress of a run with this many frames to simulate.
    pub fn new(frames: u32) -> Self {
        let bar = bar(frames.into(), "{wide_bar} frame {pos} of {len}, {eta} left, {msg}");
        Self { bar, frames, last_line: Instant::now() }
    }

    /// Shows the state after a frame.
    pub fn show(&mut self, statistics: &RunStatistics) {
        match &self.bar {
            Some(bar) => {
                bar.set_message(state(statistics));
                bar.set_position(statistics.frames.into());
            }
            None if self.last_line.elapsed() >= Self::LINE_EVERY => {
                self.last_line = Instant::now();
                let remaining = self.frames.saturating_sub(statistics.frames);
                let left = (statistics.time / statistics.frames.max(1) * remaining).as_secs();
                let (frame, frames) = (statistics.frames, self.frames);
                say!("frame {frame} of {frames}, {left} s left, {}", state(statistics));
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
            None if self.last_line.elapsed() >= Self::LINE_EVERY => {
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
