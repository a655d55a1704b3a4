//! How far a run is, on standard error: a bar on a terminal, a line now and then anywhere else.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::account::Account;
use crate::figures;
use crate::output::say;

/// How often a line is printed where there is no terminal.
const LINE_EVERY: Duration = Duration::from_secs(5);

/// Shows how far a run is.
pub enum Progress {
    /// On a terminal.
    Bar(ProgressBar),
    /// Into a file or a pipe.
    Lines {
        /// Frames in all.
        frames: u32,
        /// When the last line was printed.
        last: Instant,
    },
}

impl Progress {
    /// Begins, for so many frames to simulate.
    pub fn new(frames: u32) -> Self {
        if !stderr().is_terminal() {
            return Self::Lines { frames, last: Instant::now() };
        }
        let bar = ProgressBar::new(frames.into());
        let template = "{wide_bar} frame {pos} of {len}, {eta} left, {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self::Bar(bar)
    }

    /// A frame has been simulated.
    pub fn show(&mut self, account: &Account) {
        match self {
            Self::Bar(bar) => {
                bar.set_message(state(account));
                bar.set_position(account.frames.into());
            }
            Self::Lines { frames, last } if last.elapsed() >= LINE_EVERY => {
                *last = Instant::now();
                let left = account.spent / account.frames.max(1) * (*frames - account.frames.min(*frames));
                let left = left.as_secs();
                say!("frame {} of {frames}, {left} s left, {}", account.frames, state(account));
            }
            Self::Lines { .. } => {}
        }
    }

    /// Takes the bar away.
    pub fn end(self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// `12.4 ms/frame, strain 1.2 %, gap 0.98, 36 pairs unresolved`.
fn state(account: &Account) -> String {
    let mut state = format!("{} ms/frame", figures::number(account.milliseconds()));
    if let Some((strain, _)) = account.worst_strain {
        state += &format!(", strain {}", figures::percent(strain));
    }
    if let Some((gap, _)) = account.smallest_gap {
        state += &format!(", gap {}", figures::number(gap));
    }
    let unresolved = account.pairs_unresolved.total;
    if unresolved > 0 {
        state += &format!(", {} unresolved", figures::count(unresolved as usize, "pair"));
    }
    state
}

/// Shows how far something other than a run is, on a terminal only: it seldom takes long.
pub struct Steps(Option<ProgressBar>);

impl Steps {
    /// Begins; `what` is being done.
    pub fn new(what: &'static str) -> Self {
        let bar = stderr().is_terminal().then(|| ProgressBar::new(1000));
        if let (Some(bar), Ok(style)) =
            (&bar, ProgressStyle::with_template("{msg} {wide_bar} {percent} %, {eta} left"))
        {
            bar.set_style(style);
            bar.set_message(what);
        }
        Self(bar)
    }

    /// So much is done, from 0 to 1.
    pub fn show(&mut self, share: f64) {
        if let Some(bar) = &self.0 {
            bar.set_position((1000.0 * share) as u64);
        }
    }

    /// Takes the bar away.
    pub fn end(self) {
        if let Some(bar) = self.0 {
            bar.finish_and_clear();
        }
    }
}
