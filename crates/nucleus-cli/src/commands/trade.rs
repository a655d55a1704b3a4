//! `nucleus trade`: error against time of a scene's settings.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::{Args, ValueEnum};
use nucleus_graph::scene::{Scene, edit};
use nucleus_measure::report;
use nucleus_measure::result_cache::{ResultCache, write_atomic};
use nucleus_measure::trade::SweepOptions;
use nucleus_measure::trade::{
    Benchmark, Choice, Progress, Quantity, Reading, RemoteStage, Request, Setting, Survey, SweepControl,
    SweepResult, TradeError, Wish, run_sweep,
};

use crate::options::{self, FrameRange};
use crate::output::say;
use crate::process::Outcome;
use crate::progress::SweepProgress;
use crate::runs::PartOptions;
use crate::{files, output, process, quality};

mod elsewhere;
mod page;

use elsewhere::{Remote, RemoteSweep};

/// Least length of the comparison by default, in seconds from the start; and with `--thorough`.
const DEFAULT_SECONDS: f64 = 1.0;
const THOROUGH_SECONDS: f64 = 2.0;
/// Its largest length by default: the time of a sweep grows with it.
const MOST_SECONDS: f64 = 4.0;

/// What a longer sweep adds, at the end of a short one.
const MORE: &str = "`--thorough` compares two seconds, tries more settings and resolves smaller errors, in two to five \
                    times the time; `--frames` compares others\n";

/// Default error of the recommendation, as a share.
const DEFAULT_ERROR: f64 = 0.01;

/// Measures the error and the time of many settings of a scene, and recommends one.
///
/// Errors are differences from a reference: the same scene in double precision with more and smaller time steps. Position,
/// stretch, shape, silhouette and energy are measured each; a setting meets an error only if all of them do, the noise of the reference included. A quantity that the reference does not resolve at the wanted error does not decide, and is named. A few settings are tried first, then those near the best. Finished runs are stored, so an interrupted sweep continues. Writes a page with pictures, a table (.csv) and JSON.
#[derive(Debug, Args)]
pub struct Trade {
    /// The scene (.ron).
    scene: PathBuf,
    /// Frames to compare: a count that includes the start frame (`48`) or a range (`30..40`), before which every run
    /// simulates the scene from its start, so a late range costs as much as all frames up to its end; default: 1 second, and
    /// up to 4 where the cloth is stretched most later.
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Recommend the cheapest setting with at most this error (`1%`) in every quantity.
    #[arg(long, value_parser = quality::error)]
    error: Option<f64>,
    #[command(flatten)]
    bounds: Bounds,
    /// Recommend the most accurate setting that takes at most this time per frame on one core (`30ms`).
    #[arg(long, value_parser = quality::time, conflicts_with_all = ["error", "position", "strain", "worst_strain", "shape", "silhouette", "energy"])]
    time: Option<f64>,
    /// Write the recommended setting into the scene, or the scene with it to another file. Comments are kept.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    apply: Option<Option<PathBuf>>,
    /// Let `--apply` replace another file.
    #[arg(long, requires = "apply")]
    force: bool,
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
    /// Compare 2 seconds, try the whole grid of evaluations, substeps and collision iterations, and use finer
    /// references: two to five times as long.
    #[arg(long)]
    thorough: bool,
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
    #[command(flatten)]
    parts: PartOptions,
    /// Do this run in this process.
    #[arg(long, hide = true, value_name = "JSON", value_parser = elsewhere::remote)]
    part: Option<Remote>,
}

/// Wanted errors of single quantities.
#[derive(Debug, Args)]
struct Bounds {
    /// Wanted error of positions, RMS over points and comparable frames, over the cloth's size.
    #[arg(long, value_name = "ERROR", value_parser = quality::error)]
    position: Option<f64>,
    /// Wanted error of the strain that 99 % of the edges stay below (`3%`: three percentage points).
    #[arg(long, value_name = "ERROR", value_parser = quality::error)]
    strain: Option<f64>,
    /// Wanted error of the largest strain.
    #[arg(long, value_name = "ERROR", value_parser = quality::error)]
    worst_strain: Option<f64>,
    /// Wanted distance of the surfaces in the last frame, over the cloth's size.
    #[arg(long, value_name = "ERROR", value_parser = quality::error)]
    shape: Option<f64>,
    /// Wanted difference of the outlines in the last frame, over their area.
    #[arg(long, value_name = "ERROR", value_parser = quality::error)]
    silhouette: Option<f64>,
    /// Wanted error of kinetic plus potential energy, over that of a fall by the cloth's own size.
    #[arg(long, value_name = "ERROR", value_parser = quality::error)]
    energy: Option<f64>,
}

impl Bounds {
    fn list(&self) -> Vec<(Quantity, f64)> {
        let all = [
            (Quantity::Position, self.position),
            (Quantity::Stretch, self.strain),
            (Quantity::WorstStretch, self.worst_strain),
            (Quantity::Shape, self.shape),
            (Quantity::Silhouette, self.silhouette),
            (Quantity::Energy, self.energy),
        ];
        all.into_iter().filter_map(|(quantity, bound)| Some((quantity, bound?))).collect()
    }
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
        self.refuse_other_file()?;
        let Some((scene, text)) = self.scene()? else { return Ok(Outcome::InvalidInput) };
        let whole = match self.benchmark(&scene) {
            Ok(whole) => whole,
            Err(error) => return problem(error),
        };
        let store = quality::store(&whole);
        if self.rerun {
            self.refuse_old_plan()?;
            store.clear()?;
        }
        process::listen_for_signals()?;
        let measured = self.with_frames(whole, scene, &store).and_then(|subject| {
            let found = self.run_sweep(&subject, &store)?;
            Ok((subject, found))
        });
        match measured {
            Ok((subject, found)) => self.report(&subject, &store, &found, &text),
            Err(TradeError::Interrupted) => {
                say!("interrupted: finished runs are stored; the same command continues the sweep");
                Ok(Outcome::Interrupted)
            }
            Err(TradeError::Cache(error)) => Err(error.into()),
            Err(error) => problem(error),
        }
    }

    /// Does one run of a sweep, and returns its report for the result of a run of a plan.
    pub fn part(&self) -> Result<serde_json::Value> {
        let remote = self.part.as_ref().context("a run of a plan needs `--part`")?;
        let (scene, _) = self.scene()?.context("the scene has errors; the log lists them")?;
        remote.report(&self.benchmark(&scene)?)
    }

    /// The scene with its facts, compared over the frames that are asked for.
    fn benchmark(&self, scene: &Scene) -> Result<Benchmark, TradeError> {
        let whole = Benchmark::new(scene)?;
        match self.frames.and_then(FrameRange::first) {
            Some(first) => whole.comparing_from(first),
            None => Ok(whole),
        }
    }

    /// Refuses to replace a file other than the scene, before the runs.
    fn refuse_other_file(&self) -> Result<()> {
        let Some(to) = self.apply.as_ref().and_then(Option::as_ref) else { return Ok(()) };
        let is_free = !to.exists() || self.force && !to.is_dir() || self.is_scene(to);
        ensure!(is_free, "`{}` exists; replace it with `--force`", to.display());
        Ok(())
    }

    /// Whether a path is that of the scene.
    fn is_scene(&self, path: &Path) -> bool {
        let real = |path: &Path| path.canonicalize().ok();
        real(path).is_some() && real(path) == real(&self.scene)
    }

    /// Refuses to do runs again whose results a folder holds already.
    fn refuse_old_plan(&self) -> Result<()> {
        let is_old = self.parts.is_planned() && self.parts.folder()?.exists();
        ensure!(
            !is_old,
            "the folder of `--plan` has results of an earlier sweep: for `--rerun`, name another folder"
        );
        Ok(())
    }

    /// The scene with the frames that are asked for, and its text; `None` if it has errors, which are reported.
    fn scene(&self) -> Result<Option<(Scene, String)>> {
        let file = files::open_scene(&self.scene, self.frames.map(FrameRange::reached))?;
        let file = if self.part.is_none() { file.with_first_frame() } else { file };
        Ok(file.report()?.map(|(scene, _, text)| (scene, text)))
    }

    /// The scene with the frames to compare: those that are asked for, or those that its survey asks for.
    fn with_frames(
        &self,
        whole: Benchmark,
        mut scene: Scene,
        store: &ResultCache,
    ) -> Result<Benchmark, TradeError> {
        let fps = scene.time.fps;
        let frames = |seconds: f64| (seconds * fps).ceil() as usize;
        let least = frames(if self.thorough { THOROUGH_SECONDS } else { DEFAULT_SECONDS });
        if self.frames.is_some() || whole.frames() <= least {
            return Ok(whole);
        }
        let mut progress = SweepProgress::new();
        let survey = Survey::of(&whole, options::thread_count(self.jobs), store, &mut |done| {
            progress.show(&Progress { done, runs: [0, 1], kept: 0 });
            !process::is_interrupted()
        });
        progress.end();
        let (survey, start) = (survey?, scene.time.start);
        let named = |frame: usize| start.saturating_add_unsigned(frame as u64);
        let wanted = survey.frames(least, fps);
        let compared = if wanted > frames(MOST_SECONDS) { least } else { wanted };
        scene.time.end = named(compared);
        if let Some(busiest) = survey.busiest().filter(|_| wanted > least) {
            let (busiest, end) = (named(busiest), named(compared));
            match compared < wanted {
                true => say!(
                    "warning: frames {start} to {end} are compared, and the cloth is stretched most at frame {busiest}: \
                     `--frames {start}..{}` compares that too, in about {:.0} times the time",
                    named(wanted),
                    wanted as f64 / compared as f64
                ),
                false => {
                    say!("comparing frames {start} to {end}: the cloth is stretched most at frame {busiest}")
                }
            }
        }
        Benchmark::new(&scene)
    }

    fn run_sweep(&self, subject: &Benchmark, store: &ResultCache) -> Result<SweepResult, TradeError> {
        let mut progress = SweepProgress::new();
        let remote = RemoteSweep { parts: &self.parts, jobs: self.jobs, scene: &self.scene, subject };
        let mut elsewhere = |stage: &RemoteStage| remote.run(stage);
        let is_planned = self.parts.is_planned();
        let found = run_sweep(
            subject,
            &self.wishes(),
            &self.wish(),
            store,
            SweepControl {
                workers: options::thread_count(self.jobs),
                progress: &mut |done| progress.show(done),
                should_continue: &|| !process::is_interrupted(),
                elsewhere: if is_planned { Some(&mut elsewhere) } else { None },
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
            is_thorough: self.thorough,
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
        let wish = self.wish();
        let choice = wish.choose(trade);
        let recommendation = report::recommendation(trade, &wish);
        let stem = self.scene.file_stem().context("the scene has no name")?.to_string_lossy().into_owned();
        let html = page::of(&stem, subject, store, found, choice.point(), &recommendation)?;
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("cannot create the folder `{}`", self.out.display()))?;
        let path = |end: &str| self.out.join(format!("{stem}.trade.{end}"));
        let json = report::json(trade, &stem, &wish);
        let files = [
            ("html", html),
            ("csv", report::csv(trade)),
            ("json", serde_json::to_string_pretty(&json)? + "\n"),
        ];
        for (end, content) in &files {
            write_atomic(&path(end), content.as_bytes())?;
        }
        if self.json {
            output::report_json(&json);
        } else {
            let names = files.map(|(end, _)| format!("`{}`", path(end).display()));
            output::report(&format!("{}\n", report::text(trade)));
            output::report_always(&recommendation);
            let more = if self.wishes().is_refined() { MORE } else { "" };
            output::report(&format!("{more}wrote {}\n", names.join(", ")));
        }
        match (&self.apply, &choice) {
            (Some(apply), Choice::Found(point) | Choice::Nearest(point)) => {
                self.apply(apply.as_ref(), subject, &point.setting, text)?;
            }
            (Some(_), Choice::Unresolved(_) | Choice::None) => {
                say!("without a recommendation `--apply` writes nothing");
            }
            (None, _) => {}
        }
        Ok(match choice {
            Choice::Found(_) => Outcome::Success,
            Choice::Nearest(_) | Choice::Unresolved(_) | Choice::None => Outcome::Problem,
        })
    }

    /// The target of the recommendation.
    fn wish(&self) -> Wish {
        let bounds = self.bounds.list();
        match self.time {
            Some(ms) => Wish::Time(ms),
            None if bounds.is_empty() => Wish::Error(Request::every(self.error.unwrap_or(DEFAULT_ERROR))),
            None => Wish::Error(Request { every: self.error, bounds }),
        }
    }

    /// Writes the text of the scene with only the attributes of the setting changed.
    fn apply(&self, to: Option<&PathBuf>, subject: &Benchmark, setting: &Setting, text: &str) -> Result<()> {
        let edited = edit::edit(text, &subject.edits(setting))?;
        let (to, scene) = (to.unwrap_or(&self.scene), self.scene.display());
        let replaced = if to.exists() { ", which it replaces" } else { "" };
        write_atomic(to, edited.as_bytes())?;
        match self.is_scene(to) {
            true => say!("wrote {setting} into `{scene}`"),
            false => say!("wrote `{scene}` with {setting} to `{}`{replaced}", to.display()),
        }
        Ok(())
    }
}

/// Reports why a scene has no recommendation.
fn problem(error: TradeError) -> Result<Outcome> {
    say!("error: {error}");
    Ok(Outcome::Problem)
}
