//! `cargo xtask bench`: cost and error of the solver, compared with other solvers on the same workloads.
//!
//! | Question                                         | Module        |
//! |--------------------------------------------------|---------------|
//! | the workloads, and the ball of some              | [`workload`]  |
//! | error measures                                   | [`accuracy`]  |
//! | clocks and stages                                | [`nucleus_measure::clock`] |
//! | one run                                          | [`mod@run`]   |
//! | time against error at many settings              | [`trade`]     |
//! | figures of other solvers                         | [`peers`]     |
//! | comparison at equal error                        | [`comparison`] |
//! | self-contact, layers, and a fast ball            | [`contact`]   |
//! | contact scenes of the gallery                    | [`gallery`]   |
//! | a timed scene                                    | [`timed`]     |
//! | cost of a link, a million points, threads        | [`scaling`]   |
//! | particles: free, colliding, liquid               | [`particles`] |
//! | cost of each feature                             | [`features`]  |
//! | speed of caches                                  | [`caches`]    |
//! | collected results                                | [`report`]    |
//! | the page and the CSV file                        | [`output`]    |

use std::path::{Path, PathBuf};

use clap::ValueEnum;

mod accuracy;
pub mod caches;
mod comparison;
mod contact;
pub mod features;
mod gallery;
mod mesh;
mod output;
mod particles;
mod peers;
mod report;
mod run;
mod scaling;
mod table;
mod timed;
mod trade;
mod workload;

use report::Report;
use workload::Workload;

/// Parts to run, and output files.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// Points along each side of the cloth
    #[arg(long, value_delimiter = ',', default_values_t = [33, 65, 129, 257],
        value_parser = clap::value_parser!(u32).range(3..=2000))]
    sizes: Vec<u32>,
    /// Numbers of threads to compare; the first is the baseline
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2],
        value_parser = clap::value_parser!(u32).range(1..=256))]
    threads: Vec<u32>,
    /// Parts to run [default: all]
    #[arg(long, value_delimiter = ',')]
    only: Vec<Part>,
    /// Scenes for the part of that name [default: all in scenes/collision]
    #[arg(long, value_delimiter = ',', value_name = "FILE")]
    scenes: Vec<PathBuf>,
    /// Repetitions; the run of the median time counts
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=99))]
    repeat: u32,
    /// Writes every run to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Replaces the tables in this page
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
}

/// A part of the bench.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// A sheet swings down from two corners: time against error
    W1,
    /// A sheet falls on a ball: time against error
    W2,
    /// A sheet falls on a ball and onto itself: time, and penetrations
    W3,
    /// A ball at 10 m/s flies into a hanging sheet
    W4,
    /// Five sheets fall on a ball
    W8,
    /// Cost of self-collision, up to 250,000 points
    #[value(name = "self")]
    SelfCollision,
    /// Contact scenes of the gallery, by stage, on every number of threads
    Scenes,
    /// A sheet hangs: its sag, and the cost of a link
    Hang,
    /// W1 and W2 on more threads
    Threads,
    /// Up to a million points
    Scale,
    /// Up to a million particles: free, colliding, liquid
    Particles,
    /// Features added one by one to the same sheet
    Features,
}

/// Runs the requested parts, and prints each table when it is done.
pub fn run(options: &Options) -> anyhow::Result<()> {
    // Fails before the measurements if a file cannot be written.
    if let Some(path) = &options.write {
        output::check_page(path)?;
    }
    if let Some(path) = &options.csv {
        output::write_csv(path, &[])?;
    }
    let mut report = Report::new(nucleus_measure::clock::describe_machine());
    let asked_for = |part: &&Part| options.only.is_empty() || options.only.contains(part);
    for part in Part::value_variants().iter().filter(asked_for) {
        part.run(options, &mut report)?;
        options.keep(&report)?;
    }
    if !report.targets.is_empty() {
        print!("\n{}", report.target_table());
    }
    Ok(())
}

impl Part {
    fn run(self, options: &Options, report: &mut Report) -> anyhow::Result<()> {
        let Options { sizes, threads, repeat, scenes, .. } = options;
        match self {
            Self::W1 => trade::run(Workload::Swing, sizes, *repeat, report),
            Self::W2 => trade::run(Workload::Drape, sizes, *repeat, report),
            Self::W3 => contact::run(contact::Workload::Folds, sizes, threads, report),
            Self::W4 => contact::run(contact::Workload::Shot, sizes, threads, report),
            Self::W8 => contact::run(contact::Workload::Layers, sizes, threads, report),
            Self::SelfCollision => contact::cost::run(report),
            Self::Scenes => gallery::run(scenes, threads, report),
            Self::Hang => {
                scaling::sag(*repeat, report)?;
                scaling::link_cost(sizes, *repeat, report)
            }
            Self::Threads => scaling::threads(sizes, threads, *repeat, report),
            Self::Scale => scaling::scale(*repeat, report),
            Self::Particles => particles::run(threads, report),
            Self::Features => features::run(*repeat, report),
        }
    }
}

impl Options {
    /// Options of `docs/benchmarks.md`: comparison with other solvers, all sizes.
    pub fn of_benchmarks(root: &Path) -> Self {
        let parts = [Part::W1, Part::W2, Part::Hang, Part::Threads, Part::Scale, Part::Particles];
        Self::of_page(&parts, &[33, 65, 129, 257], root.join("docs/benchmarks.md"))
    }

    /// Options of `docs/contact.md`.
    pub fn of_contact(root: &Path) -> Self {
        let parts = [Part::W3, Part::W4, Part::SelfCollision, Part::Scenes];
        Self::of_page(&parts, &[33, 65], root.join("docs/contact.md"))
    }

    fn of_page(parts: &[Part], sizes: &[u32], page: PathBuf) -> Self {
        Self {
            sizes: sizes.to_vec(),
            threads: vec![1, 2],
            only: parts.to_vec(),
            scenes: Vec::new(),
            repeat: 1,
            csv: None,
            write: Some(page),
        }
    }

    /// Writes the results so far, so that an interrupted bench keeps them.
    fn keep(&self, report: &Report) -> anyhow::Result<()> {
        if let Some(path) = &self.csv {
            output::write_csv(path, &report.runs)?;
        }
        if let Some(path) = &self.write {
            output::write_page(path, report)?;
        }
        Ok(())
    }
}
