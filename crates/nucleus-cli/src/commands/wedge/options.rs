//! The options of `nucleus wedge`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use nucleus_wedge::Sampling;

use crate::options::{FrameRange, Record};
use crate::runs::{FarmOptions, Place};

/// Runs a scene many times with different values, several runs at once.
///
/// Each run is a process of its own and writes a cache with its values in it. The folder holds the plan (plan.json, one
/// line a run), the caches, a page with a contact sheet (wedge.html) and a table (wedge.csv). Ctrl-C closes all caches; after
/// that, and after a kill at any moment, `--continue` resumes the runs that are not finished.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Wedge {
    /// The scene (.ron). Not needed with a folder that holds a plan.
    pub scene: Option<PathBuf>,
    /// An attribute and its values: a list `0.1,1,10`, a range of 5 values `0..20/5`, or an interval `0..20` that
    /// `--samples` samples; `:log` spaces numbers by their logarithm. Several lists and ranges form a grid.
    #[arg(long, value_name = "NODE.ATTRIBUTE=VALUES")]
    pub vary: Vec<String>,
    /// A table of runs (.csv): its first line names the attributes, each further line is a run.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["vary", "samples"])]
    pub table: Option<PathBuf>,
    /// Samples of the intervals.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    pub samples: u32,
    /// How intervals are sampled.
    #[arg(long, value_enum, default_value_t = SamplingName::Latin)]
    pub sampling: SamplingName,
    /// Repeat every run with this many seeds, which displace its start positions by up to a thousandth of an edge and
    /// sample its intervals anew.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..))]
    pub seeds: Option<u32>,
    /// The first seed, also that of the samples.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u32,
    /// The folder of the wedge.
    #[arg(short, long, value_name = "FOLDER")]
    pub out: PathBuf,
    /// Frames of each run: a count that includes the start frame (`48`) or a range (`10..58`); default: those of the scene.
    #[arg(long, allow_hyphen_values = true)]
    pub frames: Option<FrameRange>,
    /// Times and channels to record, as in `nucleus run`.
    #[arg(long, value_name = "WHAT", value_parser = record)]
    pub record: Option<String>,
    /// Frames from one checkpoint to the next, as in `nucleus run`.
    #[arg(long, value_name = "FRAMES")]
    pub checkpoint: Option<u32>,
    /// Audit every time step of each run, as in `nucleus run`.
    #[arg(long)]
    pub audit: bool,
    /// Runs at once; default: as many as cores and memory allow.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: Option<u16>,
    /// Threads of each run. The result does not depend on it.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: u16,
    /// Finish the plan of the folder: resume runs that were interrupted or killed, and start those that failed or are
    /// missing.
    #[arg(long = "continue")]
    pub continues: bool,
    /// Write the plan and run nothing.
    #[arg(long, conflicts_with_all = ["continues", "run", "collect"])]
    pub plan: bool,
    /// Do only these runs of the plan (`7`, `0..19`, `1,4,10..12`), and collect nothing: for other schedulers.
    #[arg(long, value_name = "RUNS")]
    pub run: Option<String>,
    /// Collect the results so far into the page and the table, and run nothing.
    #[arg(long, conflicts_with = "run")]
    pub collect: bool,
    /// Where the runs are done.
    #[arg(long, value_enum, value_name = "PLACE")]
    pub on: Option<Place>,
    #[command(flatten)]
    pub farm: FarmOptions,
    /// Print one JSON object at the end.
    #[arg(long)]
    pub json: bool,
    /// Do this run in this process.
    #[arg(long, hide = true)]
    pub task: Option<u32>,
    /// Runs that are started side by side; with `--task`.
    #[arg(long, hide = true, default_value_t = 1)]
    pub at_once: u32,
}

/// Shown at the end of the help.
const EXAMPLES: &str = "\
Examples:
  nucleus wedge table.ron --vary cloth.bendResistance=0.1,1,10 --vary nucleus1.windSpeed=0..20/5 --seeds 3 --out wind
  nucleus wedge table.ron --vary cloth.bendResistance=0.01..10:log --vary cloth.friction=0..1 --samples 40 --out bend
  nucleus wedge --continue --out wind";

/// How intervals are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SamplingName {
    /// Latin hypercube: one sample in each stratum of each interval.
    Latin,
    /// Independent samples.
    Random,
}

impl From<SamplingName> for Sampling {
    fn from(name: SamplingName) -> Self {
        match name {
            SamplingName::Latin => Self::Latin,
            SamplingName::Random => Self::Random,
        }
    }
}

/// The value of `--record`, if it is one.
fn record(text: &str) -> Result<String, String> {
    text.parse::<Record>().map(|_| text.to_owned())
}
