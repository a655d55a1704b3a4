//! `cargo xtask book`: makes anew every page whose figures are measured.
//!
//! | You want to know...                              | Read                         |
//! |--------------------------------------------------|------------------------------|
//! | which pages there are                            | [`Page`]                     |
//! | how a scene's trade is measured                  | [`nucleus_measure::trade`]   |
//! | whether the paper's advice holds                 | [`nucleus_measure::advice`]  |

use std::path::Path;
use std::process::Command;
use std::time::Instant;
use std::{env, fs};

use anyhow::{Context, ensure};
use clap::ValueEnum;
use nucleus_measure::{advice, machine, report, store, trade};

/// What to make.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// Pages to make [default: all]
    #[arg(long, value_delimiter = ',')]
    only: Vec<Page>,
}

/// A page of the book, or several of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Page {
    /// `docs/trade`: error against time for scenes of the gallery
    Trade,
    /// `docs/advice.md`: the paper's advice, tried
    Advice,
}

/// The scenes whose trade is in the book.
const SCENES: [&str; 4] =
    ["cloth/tablecloth", "cloth/flag", "cloth/drape_on_sphere", "collision/fast_sphere"];

/// Makes what is asked for.
pub fn run(root: &Path, options: &Options) -> anyhow::Result<()> {
    let asked_for = |page: &&Page| options.only.is_empty() || options.only.contains(page);
    for page in Page::value_variants().iter().filter(asked_for) {
        let start = Instant::now();
        match page {
            Page::Trade => trades(root)?,
            Page::Advice => advices(root)?,
        }
        eprintln!("{page:?}: {:.0} s", start.elapsed().as_secs_f64());
    }
    Ok(())
}

/// By the command, as anyone would; runs that are kept from before are not done again.
fn trades(root: &Path) -> anyhow::Result<()> {
    let folder = root.join("docs").join("trade");
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut found = Vec::new();
    for scene in SCENES {
        let mut command = Command::new(&cargo);
        command.args(["run", "--quiet", "--release", "--package", "nucleus-cli", "--", "trade"]);
        command.arg(format!("scenes/{scene}.ron")).arg("--out").arg(&folder).current_dir(root);
        let status = command.status().context("cargo cannot be started")?;
        ensure!(status.success(), "`nucleus trade scenes/{scene}.ron`: {status}");
        let name = scene.rsplit('/').next().unwrap_or(scene);
        let json = fs::read(folder.join(format!("{name}.trade.json")))?;
        found.push((name.to_owned(), serde_json::from_slice::<trade::Trade>(&json)?));
    }
    let index = report::index(&found, &machine::describe().join("\n"));
    Ok(store::write_whole(&folder.join("README.md"), index.as_bytes())?)
}

fn advices(root: &Path) -> anyhow::Result<()> {
    let mut results = Vec::new();
    for experiment in advice::experiments() {
        eprintln!("{}: {}", experiment.claim, experiment.says);
        let findings = (experiment.try_it)();
        for finding in &findings {
            eprintln!("  {}: {}: {}", finding.reading, finding.verdict.words(), finding.because);
        }
        results.push((experiment, findings));
    }
    let page = advice::page(&results, &machine::describe().join("\n"));
    Ok(store::write_whole(&root.join("docs").join("advice.md"), page.as_bytes())?)
}
