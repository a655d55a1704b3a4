//! `nucleus trade`: error against time of a scene's settings.

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

use crate::options::{self, FrameRange};
use crate::output::say;
use crate::process::Outcome;
use crate::progress::SweepProgress;
use crate::{files, output, process, quality};

mod page;

/// Default length of the comparison, in seconds from the start.
const DEFAULT_SECONDS: f64 = 2.0;

/// Default error of the recommendation, as a share.
const DEFAULT_ERROR: f64 = 0.01;

/// Measures the error and the time of many settings of a scene, and recommends one.
///
/// The error is the distance from a reference: the same scene in double precision with more and smaller time steps.
/// Finished runs are stored, so an interrupted sweep continues. Writes a page with pictures, a table (.csv) and JSON.
#[derive(Debug, Args)]
pub struct Trade {
    /// The scene (.ron).
    scene: PathBuf,
    /// Frames to compare: a count that includes the start frame (`48`) or a range (`10..58`); default: 2 seconds.
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Recommend the cheapest setting with at most this error (`1%`).
    #[arg(long, value_parser = quality::error)]
    error: Option<f64>,
    /// Recommend the most accurate setting that takes at most this time per frame on one core (`30ms`).
    #[arg(long, value_parser = quality::time, conflicts_with = "error")]
    time: Option<f64>,
    /// Write the recommended setting into the scene, or into another file. Comments are kept.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    apply: Option<Option<PathBuf>>,
    /// Resistance models to try; default: that of the scene.
    #[arg(long, value_name = "MODEL")]
    resistance_model: Option<ResistanceModels>,
    /// Substeps to try.
    #[arg(long, value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=10_000))]
    substeps: Vec<u32>,
    /// Collision iterations to try.
    #[arg(long, value_delimiter = ',', value_parser = clap::value_parser!(u32).range(0..=10_000))]
    iterations: Vec<u32>,
    /// Evaluations to try, for the physical model.
    #[arg(long, value_delimiter = ',', value_parser = options::positive)]
    evaluations: Vec<f64>,
    /// Factors for stretch, compression and shear resistance to try, for the classic model.
    #[arg(long, value_name = "FACTORS", value_delimiter = ',', value_parser = options::positive)]
    resistance_factors: Vec<f64>,
    /// Runs in parallel; default: one per core.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Ignore stored results and do all runs again.
    #[arg(long)]
    rerun: bool,
    /// The folder for the page, the table and JSON.
    #[arg(short, long, default_value = ".")]
    out: PathBuf,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// Resistance models to try.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ResistanceModels {
    /// Resistances are iteration counts, as in Maya.
    Classic,
    /// Resistances are stiffnesses.
    Physical,
    Both,
}

impl Trade {
    /// Runs the settings that are not stored yet, and reports the recommendation.
    pub fn run(self) -> Result<Outcome> {
        let Some((mut scene, _, text)) = files::open_scene(&self.scene, self.frames)?.report()? else {
            return Ok(Outcome::InvalidInput);
        };
        if self.frames.is_none() {
            let frames = (DEFAULT_SECONDS * scene.time.fps).ceil() as i64;
            scene.time.end = scene.time.end.min(scene.time.start.saturating_add(frames));
        }
        let subject = match Benchmark::new(&scene) {
            Ok(subject) => subject,
            Err(error) => return problem(error),
        };
        let store = quality::store(&subject);
        if self.rerun {
            store.clear()?;
        }
        process::listen_for_signals()?;
        match self.run_sweep(&subject, &store) {
            Ok(found) => self.report(&subject, &store, &found, &text),
            Err(TradeError::Interrupted) => {
                say!("interrupted: finished runs are stored; the same command continues the sweep");
                Ok(Outcome::Interrupted)
            }
            Err(TradeError::Cache(error)) => Err(error.into()),
            Err(error) => problem(error),
        }
    }

    fn run_sweep(&self, subject: &Benchmark, store: &ResultCache) -> Result<SweepResult, TradeError> {
        let mut progress = SweepProgress::new();
        let found = run_sweep(
            subject,
            &self.wishes(),
            store,
            SweepControl {
                workers: options::thread_count(self.jobs),
                progress: &mut |done| progress.show(done),
                should_continue: &|| !process::is_interrupted(),
            },
        );
        progress.end();
        process::files_are_closed();
        found
    }

    fn wishes(&self) -> SweepOptions {
        SweepOptions {
            readings: match self.resistance_model {
                None => Vec::new(),
                Some(ResistanceModels::Classic) => vec![Reading::Classic],
                Some(ResistanceModels::Physical) => vec![Reading::Physical],
                Some(ResistanceModels::Both) => vec![Reading::Physical, Reading::Classic],
            },
            substeps: self.substeps.clone(),
            collision_iterations: self.iterations.clone(),
            evaluations: self.evaluations.clone(),
            resistances: self.resistance_factors.clone(),
        }
    }

    fn report(
        &self,
        subject: &Benchmark,
        store: &ResultCache,
        found: &SweepResult,
        text: &str,
    ) -> Result<Outcome> {
        let trade = &found.trade;
        let choice = match self.time {
            Some(ms) => for_time(trade, ms),
            None => for_error(trade, self.error.unwrap_or(DEFAULT_ERROR)),
        };
        let stem = self.scene.file_stem().context("the scene has no name")?.to_string_lossy().into_owned();
        let wanted = self.error.unwrap_or(DEFAULT_ERROR);
        let html = page::of(&stem, subject, store, found, choice.point(), wanted)?;
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("cannot create the folder `{}`", self.out.display()))?;
        let path = |end: &str| self.out.join(format!("{stem}.trade.{end}"));
        let json = serde_json::to_string_pretty(trade)? + "\n";
        let files = [("html", html), ("csv", report::csv(trade)), ("json", json)];
        for (end, content) in &files {
            write_atomic(&path(end), content.as_bytes())?;
        }
        if self.json {
            output::report_json(&serde_json::to_value(trade)?);
        } else {
            let names = files.map(|(end, _)| format!("`{}`", path(end).display()));
            let said = format!("{}\n{}", report::text(trade), self.recommendation(&choice, trade.floor));
            output::report(&format!("{said}wrote {}\n", names.join(", ")));
        }
        if let (Some(apply), Some(point)) = (&self.apply, choice.point()) {
            self.apply(apply.as_ref(), subject, &point.setting, text)?;
        }
        let is_requested = self.error.is_some() || self.time.is_some();
        Ok(match choice {
            Choice::Found(_) => Outcome::Success,
            Choice::Nearest(_) | Choice::Unresolved(_) if !is_requested => Outcome::Success,
            _ => Outcome::Problem,
        })
    }

    /// The recommendation in words.
    fn recommendation(&self, choice: &Choice, floor: Option<f64>) -> String {
        let costs = |point: &Point| {
            let error = report::percent(point.error.unwrap_or_default());
            format!("{}, {} ms per frame, error {error}", point.setting, report::figure(point.ms))
        };
        let wanted = match self.time {
            Some(ms) => format!("a time of {} ms", report::figure(ms)),
            None => format!("an error of {}", report::percent(self.error.unwrap_or(DEFAULT_ERROR))),
        };
        match choice {
            Choice::Found(point) => format!("recommended for {wanted}: {}\n", costs(point)),
            Choice::Nearest(point) => format!("no setting reaches {wanted}; the nearest: {}\n", costs(point)),
            Choice::Unresolved(point) => format!(
                "the uncertainty of the reference, {}, is larger than {wanted}; the most accurate setting within that \
                 uncertainty: {}\n",
                report::percent(floor.unwrap_or_default()),
                costs(point)
            ),
            Choice::None => "no setting is usable: there is no recommendation\n".to_owned(),
        }
    }

    /// Writes the text of the scene with only the attributes of the setting changed.
    fn apply(&self, to: Option<&PathBuf>, subject: &Benchmark, setting: &Setting, text: &str) -> Result<()> {
        let edited = edit::edit(text, &subject.edits(setting))?;
        let to = to.unwrap_or(&self.scene);
        write_atomic(to, edited.as_bytes())?;
        say!("`{}` now has {setting}", to.display());
        Ok(())
    }
}

/// Reports why a scene has no recommendation.
fn problem(error: TradeError) -> Result<Outcome> {
    say!("error: {error}");
    Ok(Outcome::Problem)
}
