//! How far a sweep is, on standard error: a bar on a terminal, a line now and then anywhere else.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use nucleus_measure::trade::Progress;

use crate::output::say;

/// How often a line is printed where there is no terminal.
const LINE_EVERY: Duration = Duration::from_secs(10);

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Shows how far a sweep is.
pub struct Bar {
    bar: Option<ProgressBar>,
    begun: Instant,
    last: Instant,
}

impl Bar {
    /// Begins.
    pub fn new() -> Self {
        let bar = stderr().is_terminal().then(|| ProgressBar::new(STEPS));
        if let (Some(bar), Ok(style)) = (&bar, ProgressStyle::with_template("{wide_bar} {percent} %, {msg}"))
        {
            bar.set_style(style);
        }
        Self { bar, begun: Instant::now(), last: Instant::now() }
    }

    /// It is so far.
    pub fn show(&mut self, progress: &Progress) {
        let words = self.words(progress);
        match &self.bar {
            Some(bar) => {
                bar.set_position((progress.done * STEPS as f64) as u64);
                bar.set_message(words);
            }
            None if self.last.elapsed() >= LINE_EVERY => {
                self.last = Instant::now();
                say!("{:.0} %, {words}", 100.0 * progress.done);
            }
            None => {}
        }
    }

    /// Takes the bar away.
    pub fn end(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }

    /// `run 7 of 23, 2 minutes left`.
    fn words(&self, progress: &Progress) -> String {
        let [finished, all] = progress.runs;
        let kept =
            if progress.kept > 0 { format!(" ({} kept from before)", progress.kept) } else { String::new() };
        let left = match progress.done {
            done if done > 0.01 => {
                let left = self.begun.elapsed().as_secs_f64() * (1.0 - done) / done;
                format!(", {} left", HumanDuration(Duration::from_secs_f64(left)))
            }
            _ => String::new(),
        };
        format!("{finished} of {all} runs done{kept}{left}")
    }
}
