//! `nucleus trade`: what a scene's settings cost, and how wrong they are.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use nucleus_graph::scene::edit;
use nucleus_measure::report;
use nucleus_measure::result_cache::{ResultCache, write_atomic};
use nucleus_measure::trade::SweepOptions;
use nucleus_measure::trade::{
    Benchmark, Point, Reading, Setting, SweepControl, SweepResult, TradeError, run_sweep,
};
use nucleus_measure::trade::{Choice, for_error, for_time};

use crate::frame_range::FrameRange;
use crate::outcome::Outcome;
use crate::output::say;
use crate::{interrupt, output, quality, scene_file, threads};

mod page;
mod progress;

use progress::Bar;

/// Frames that are compared if none are given: so many seconds from the start.
const SECONDS: f64 = 2.0;

/// The error that is looked for if none is given.
const ERROR: f64 = 0.01;

/// Measures what a scene's settings cost and how wrong they are, and recommends one.
///
/// Every setting is held against a reference: the same scene in double precision with many more and smaller steps. What
/// is finished is kept, so that a sweep that was ended goes on where it was. Writes a page with pictures, a table and
/// JSON.
#[derive(Debug, Args)]
pub struct Trade {
    /// The scene (.ron).
    scene: PathBuf,
    /// Frames to compare: so many (`48`, the start frame among them) or from one to another; 2 seconds if none are given.
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Recommend the cheapest setting with at most this error (`1%`).
    #[arg(long, value_parser = quality::error)]
    error: Option<f64>,
    /// Recommend the most exact setting that takes at most this time a frame, on one core (`30ms`).
    #[arg(long, value_parser = quality::time, conflicts_with = "error")]
    time: Option<f64>,
    /// Write the recommended setting into the scene, or into another file; its comments stay.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    apply: Option<Option<PathBuf>>,
    /// How resistances are read; as the scene has it if none is given.
    #[arg(long)]
    mode: Option<Mode>,
    /// Substeps to try.
    #[arg(long, value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=10_000))]
    substeps: Vec<u32>,
    /// Collision iterations to try.
    #[arg(long, value_delimiter = ',', value_parser = clap::value_parser!(u32).range(0..=10_000))]
    iterations: Vec<u32>,
    /// Evaluations to try, read as Physical.
    #[arg(long, value_delimiter = ',', value_parser = above_nought)]
    evaluations: Vec<f64>,
    /// Factors on stretch, compression and shear resistance to try, read as Classic.
    #[arg(long, value_delimiter = ',', value_parser = above_nought)]
    resistances: Vec<f64>,
    /// Runs side by side; as many as there are cores if none are given.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Do all runs again, whatever is kept.
    #[arg(long)]
    fresh: bool,
    /// The folder to write the page, the table and JSON into.
    #[arg(short, long, default_value = ".")]
    out: PathBuf,
    /// Print JSON instead of words.
    #[arg(long)]
    json: bool,
}

/// Which readings of resistances are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Mode {
    /// Counts of iterations.
    Classic,
    /// Stiffnesses.
    Physical,
    /// Each.
    Both,
}

impl Trade {
    /// Runs what is to be run, and tells what was found.
    pub fn run(self) -> Result<Outcome> {
        let Some((mut scene, _, text)) = scene_file::open(&self.scene, self.frames)?.told()? else {
            return Ok(Outcome::InvalidInput);
        };
        if self.frames.is_none() {
            let frames = (SECONDS * scene.time.fps).ceil() as i64;
            scene.time.end = scene.time.end.min(scene.time.start.saturating_add(frames));
        }
        let subject = match Benchmark::new(&scene) {
            Ok(subject) => subject,
            Err(error) => return trouble(error),
        };
        let store = quality::store(&subject);
        if self.fresh {
            store.clear()?;
        }
        interrupt::listen()?;
        match self.run_sweep(&subject, &store) {
            Ok(found) => self.tell(&subject, &store, &found, &text),
            Err(TradeError::Interrupted) => {
                say!("interrupted: what was finished is kept, and the same command goes on from there");
                Ok(Outcome::Interrupted)
            }
            Err(TradeError::Cache(error)) => Err(error.into()),
            Err(error) => trouble(error),
        }
    }

    fn run_sweep(&self, subject: &Benchmark, store: &ResultCache) -> Result<SweepResult, TradeError> {
        let mut bar = Bar::new();
        let found = run_sweep(
            subject,
            &self.wishes(),
            store,
            SweepControl {
                workers: threads::count(self.jobs),
                progress: &mut |progress| bar.show(progress),
                should_continue: &|| !interrupt::asked(),
            },
        );
        bar.end();
        interrupt::run_is_over();
        found
    }

    fn wishes(&self) -> SweepOptions {
        SweepOptions {
            readings: match self.mode {
                None => Vec::new(),
                Some(Mode::Classic) => vec![Reading::Classic],
                Some(Mode::Physical) => vec![Reading::Physical],
                Some(Mode::Both) => vec![Reading::Physical, Reading::Classic],
            },
            substeps: self.substeps.clone(),
            collision_iterations: self.iterations.clone(),
            evaluations: self.evaluations.clone(),
            resistances: self.resistances.clone(),
        }
    }

    fn tell(
        &self,
        subject: &Benchmark,
        store: &ResultCache,
        found: &SweepResult,
        text: &str,
    ) -> Result<Outcome> {
        let trade = &found.trade;
        let choice = match self.time {
            Some(ms) => for_time(trade, ms),
            None => for_error(trade, self.error.unwrap_or(ERROR)),
        };
        let stem = self.scene.file_stem().context("the scene has no name")?.to_string_lossy().into_owned();
        let wanted = self.error.unwrap_or(ERROR);
        let html = page::of(&stem, subject, store, found, choice.point(), wanted)?;
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("cannot make the folder `{}`", self.out.display()))?;
        let path = |end: &str| self.out.join(format!("{stem}.trade.{end}"));
        let json = serde_json::to_string_pretty(trade)? + "\n";
        let files = [("html", html), ("csv", report::csv(trade)), ("json", json)];
        for (end, content) in &files {
            write_atomic(&path(end), content.as_bytes())?;
        }
        if self.json {
            output::tell_json(&serde_json::to_value(trade)?);
        } else {
            let names = files.map(|(end, _)| format!("`{}`", path(end).display()));
            let said = format!("{}\n{}", report::text(trade), self.recommendation(&choice, trade.floor));
            output::tell(&format!("{said}written to {}\n", names.join(", ")));
        }
        if let (Some(apply), Some(point)) = (&self.apply, choice.point()) {
            self.apply(apply.as_ref(), subject, &point.setting, text)?;
        }
        let asked = self.error.is_some() || self.time.is_some();
        Ok(match choice {
            Choice::Found(_) => Outcome::Fine,
            Choice::Nearest(_) | Choice::Unresolved(_) if !asked => Outcome::Fine,
            _ => Outcome::Trouble,
        })
    }

    /// What to take, in words.
    fn recommendation(&self, choice: &Choice, floor: Option<f64>) -> String {
        let costs = |point: &Point| {
            let error = report::percent(point.error.unwrap_or_default());
            format!("{}, {} ms a frame, error {error}", point.setting, report::figure(point.ms))
        };
        let wanted = match self.time {
            Some(ms) => format!("a time of {} ms", report::figure(ms)),
            None => format!("an error of {}", report::percent(self.error.unwrap_or(ERROR))),
        };
        match choice {
            Choice::Found(point) => format!("recommended for {wanted}: {}\n", costs(point)),
            Choice::Nearest(point) => format!("no setting reaches {wanted}; the nearest: {}\n", costs(point)),
            Choice::Unresolved(point) => format!(
                "{wanted} cannot be told from none, since the references themselves differ by {}; the most exact as far as can \
                 be told: {}\n",
                report::percent(floor.unwrap_or_default()),
                costs(point)
            ),
            Choice::None => "no setting is sound: nothing can be recommended\n".to_owned(),
        }
    }

    /// Writes the scene with a setting: the user's text, with nothing changed but the attributes.
    fn apply(&self, to: Option<&PathBuf>, subject: &Benchmark, setting: &Setting, text: &str) -> Result<()> {
        let edited = edit::edit(text, &subject.edits(setting))?;
        let to = to.unwrap_or(&self.scene);
        write_atomic(to, edited.as_bytes())?;
        say!("`{}` now has {setting}", to.display());
        Ok(())
    }
}

/// Says why there is nothing to find.
fn trouble(error: TradeError) -> Result<Outcome> {
    say!("error: {error}");
    Ok(Outcome::Trouble)
}

fn above_nought(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("has to be a number above 0".to_owned()),
    }
}
