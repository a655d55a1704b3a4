//! One file per subcommand.

mod attrs;
mod cache_info;
mod check;
mod diff;
mod export;
mod extremes;
mod film;
mod fmt;
mod graph;
mod info;
mod new;
mod play;
mod presets;
mod recover;
mod render;
mod resume;
mod run;
mod scene_info;
mod trade;
mod validate;

use anyhow::Result;
use clap::Subcommand;

use crate::outcome::Outcome;

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    Run(run::Run),
    Resume(resume::Resume),
    Check(check::Check),
    Info(info::Info),
    Play(play::Play),
    Render(render::Render),
    Export(export::Export),
    Diff(diff::Diff),
    Recover(recover::Recover),
    Attrs(attrs::Attrs),
    Extremes(extremes::Extremes),
    Trade(trade::Trade),
    Validate(validate::Validate),
    Presets(presets::Presets),
    Graph(graph::Graph),
    Fmt(fmt::Fmt),
    New(new::New),
}

impl Command {
    /// Does it.
    pub fn run(self) -> Result<Outcome> {
        match self {
            Self::Run(run) => run.run(),
            Self::Resume(resume) => resume.run(),
            Self::Check(check) => check.run(),
            Self::Play(play) => play.run(),
            Self::Info(info) => info.run(),
            Self::Render(render) => render.run(),
            Self::Export(export) => export.run(),
            Self::Diff(diff) => diff.run(),
            Self::Recover(recover) => recover.run(),
            Self::Attrs(attrs) => attrs.run(),
            Self::Extremes(extremes) => extremes.run(),
            Self::Trade(trade) => trade.run(),
            Self::Validate(validate) => validate.run(),
            Self::Presets(presets) => presets.run(),
            Self::Graph(graph) => graph.run(),
            Self::Fmt(fmt) => fmt.run(),
            Self::New(new) => new.run(),
        }
    }
}
