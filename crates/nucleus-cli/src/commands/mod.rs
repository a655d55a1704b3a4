//! The subcommands: a file each, or a file for several that share their subject.

mod diff;
mod export;
mod extremes;
mod film;
mod import;
mod info;
mod play;
mod recover;
mod reference;
mod render;
mod resume;
mod run;
mod scene;
mod scene_info;
mod shell;
mod templates;
mod trade;
mod validate;
mod watch;
mod wedge;

use anyhow::Result;
use clap::Subcommand;

use crate::process::Outcome;

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    Run(run::Run),
    Wedge(wedge::Wedge),
    Resume(resume::Resume),
    Check(scene::Check),
    Info(info::Info),
    Play(play::Play),
    Render(render::Render),
    Import(import::Import),
    Export(export::Export),
    Diff(diff::Diff),
    Recover(recover::Recover),
    Attrs(reference::Attrs),
    Extremes(extremes::Extremes),
    Trade(trade::Trade),
    Validate(validate::Validate),
    Presets(reference::Presets),
    Checks(reference::Checks),
    Functions(reference::Functions),
    Graph(scene::Graph),
    Fmt(scene::Fmt),
    New(templates::New),
    Completions(shell::Completions),
    Man(shell::Man),
}

impl Command {
    /// Runs the subcommand.
    pub fn run(self) -> Result<Outcome> {
        match self {
            Self::Run(run) => run.run(),
            Self::Wedge(wedge) => wedge.run(),
            Self::Resume(resume) => resume.run(),
            Self::Check(check) => check.run(),
            Self::Play(play) => play.run(),
            Self::Info(info) => info.run(),
            Self::Render(render) => render.run(),
            Self::Import(import) => import.run(),
            Self::Export(export) => export.run(),
            Self::Diff(diff) => diff.run(),
            Self::Recover(recover) => recover.run(),
            Self::Attrs(attrs) => attrs.run(),
            Self::Extremes(extremes) => extremes.run(),
            Self::Trade(trade) => trade.run(),
            Self::Validate(validate) => validate.run(),
            Self::Presets(presets) => presets.run(),
            Self::Checks(checks) => checks.run(),
            Self::Functions(functions) => functions.run(),
            Self::Graph(graph) => graph.run(),
            Self::Fmt(fmt) => fmt.run(),
            Self::New(new) => new.run(),
            Self::Completions(completions) => completions.run(),
            Self::Man(man) => man.run(),
        }
    }
}
