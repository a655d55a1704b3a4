//! `cargo xtask bench`: how long the solver takes and how wrong it is, beside other solvers on the same workloads.
//!
//! | You want to know...                              | Read          |
//! |--------------------------------------------------|---------------|
//! | what is simulated                                | [`workload`]  |
//! | how error is measured                            | [`accuracy`]  |
//! | where the ball is                                | [`ball`]      |
//! | how time is measured, and stages                 | [`nucleus_measure::clock`] |
//! | one run                                          | [`spec`]     |
//! | which settings are run                           | [`trade`]     |
//! | what other solvers need                          | [`peers`]     |
//! | what counts as being ahead of them               | [`comparison`]   |
//! | cloth that meets itself, other cloth, a fast ball | [`contact`] |
//! | scenes of contact as they are                    | [`gallery`]   |
//! | a scene run on the clock                         | [`timed`]     |
//! | the cost of a link; a million points; threads    | [`scaling`]    |
//! | what each feature costs                          | [`features`]  |
//! | how fast caches are                              | [`caches`]    |
//! | what is kept of a run                            | [`report`]    |

use std::path::{Path, PathBuf};

use clap::ValueEnum;

mod accuracy;
mod ball;
pub mod caches;
mod comparison;
mod contact;
mod csv;
pub mod features;
mod gallery;
mod memory;
mod mesh;
mod page;
mod peers;
mod report;
mod run;
mod scaling;
mod stages;
mod table;
mod timed;
mod trade;
mod workload;

use report::Report;
use workload::Workload;

/// What to run, and where to leave the figures.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// Points along each side of the cloth
    #[arg(long, value_delimiter = ',', default_values_t = [33, 65, 129, 257],
        value_parser = clap::value_parser!(u32).range(3..=2000))]
    sizes: Vec<u32>,
    /// Threads to compare, the first being what the others are held against
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2],
        value_parser = clap::value_parser!(u32).range(1..=256))]
    threads: Vec<u32>,
    /// Parts to run [default: all]
    #[arg(long, value_delimiter = ',')]
    only: Vec<Part>,
    /// Scenes for the part of that name [default: all in scenes/collision]
    #[arg(long, value_delimiter = ',', value_name = "FILE")]
    scenes: Vec<PathBuf>,
    /// Runs of everything; the one of the median time counts
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=99))]
    repeat: u32,
    /// Writes every run to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Puts the tables into this page, in place of those that it has
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
    /// A sheet falls on a ball and onto itself: time, and what gets through
    W3,
    /// A ball at 10 m/s flies into a hanging sheet
    W4,
    /// Five sheets fall on a ball
    W8,
    /// What self-collision costs, up to 250,000 points
    #[value(name = "self")]
    SelfCollision,
    /// Scenes of contact as they are, by stage, on every number of threads
    Scenes,
    /// A sheet hangs: its sag, and the cost of a link
    Hang,
    /// The same on more threads
    Threads,
    /// Up to a million points
    Scale,
    /// One feature after the other on the same sheet
    Features,
}

/// Runs the parts that are asked for, each table printed when it is done.
pub fn run(options: &Options) -> anyhow::Result<()> {
    // What cannot be written is better known before half an hour's work than after it.
    if let Some(path) = &options.write {
        page::check(path)?;
    }
    if let Some(path) = &options.csv {
        csv::write(path, &[])?;
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
            Self::Features => features::run(*repeat, report),
        }
    }
}

impl Options {
    /// What `docs/benchmarks.md` is made with: the bench beside other solvers, all sizes.
    pub fn of_benchmarks(root: &Path) -> Self {
        let parts = [Part::W1, Part::W2, Part::Hang, Part::Threads, Part::Scale];
        Self::of_page(&parts, &[33, 65, 129, 257], root.join("docs/benchmarks.md"))
    }

    /// What `docs/contact.md` is made with.
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

    /// Writes what has been found so far, so that a bench that is stopped has not been for nothing.
    fn keep(&self, report: &Report) -> anyhow::Result<()> {
        if let Some(path) = &self.csv {
            csv::write(path, &report.runs)?;
        }
        if let Some(path) = &self.write {
            page::write(path, report)?;
        }
        Ok(())
    }
}
