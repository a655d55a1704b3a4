//! `cargo xtask book`: regenerates all pages with measured figures.
//!
//! | Question                                         | Read                         |
//! |--------------------------------------------------|------------------------------|
//! | the pages                                        | [`Page`]                     |
//! | work-precision curve of a scene                  | [`nucleus_measure::trade`]   |
//! | the paper's advice, tested                       | [`nucleus_measure::advice`]  |
//! | stress tests                                     | [`nucleus_measure::extremes`] |
//! | comparison with closed-form solutions            | [`nucleus_measure::validation`] |
//! | design experiments                               | [`nucleus_measure::experiments`] |
//! | cost of a feature                                | [`mod@features`]             |
//! | speed of caches                                  | [`mod@caches`]               |
//! | cost and error, compared with other solvers      | [`mod@bench`]                |
//! | recipes with their pictures                      | [`mod@cookbook`]             |

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::{Command, ExitStatus};
use std::time::Instant;
use std::{env, fs};

use anyhow::{Context, ensure};
use clap::ValueEnum;
use nucleus_measure::{advice, clock, experiments, report, result_cache, trade};

use crate::bench::{self, caches, features};
use crate::cookbook;

/// Pages to regenerate.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// Pages to regenerate [default: all]
    #[arg(long, value_delimiter = ',')]
    only: Vec<Page>,
}

/// A page of the book, or a folder of pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Page {
    /// `docs/trade`: error against time for scenes of the gallery
    Trade,
    /// `docs/advice.md`: the paper's advice, tested
    Advice,
    /// `docs/extremes.md`: stress tests
    Extremes,
    /// `docs/validation.md`: the solver compared with closed-form solutions
    Validation,
    /// `docs/experiments.md`: design experiments, prototype and solver
    Experiments,
    /// `docs/caches.md`: speed of writing, reading, seeking and playing caches
    Caches,
    /// `docs/features.md`: cost of each feature, on and off
    Features,
    /// `docs/contact.md`: cost of contact compared with other solvers, and penetrations
    Contact,
    /// `docs/cookbook.md`: recipes with their pictures
    Cookbook,
    /// `docs/benchmarks.md`: error against time, compared with other solvers; takes half an hour
    Benchmarks,
}

/// Repetitions of each sheet of the page on features; the median counts.
const FEATURE_RUNS: u32 = 9;

/// The scenes whose work-precision curve is in the book.
const SCENES: [&str; 4] =
    ["cloth/tablecloth", "cloth/flag", "cloth/drape_on_sphere", "collision/fast_sphere"];

/// Options of the sweep: the first second, which includes the first contacts of each scene, at few settings.
/// `nucleus trade SCENE` by itself sweeps fewer, and adds those near the one that it recommends.
const SWEEP: [&str; 8] =
    ["--frames", "24", "--evaluations", "24,96,384", "--substeps", "1,4", "--iterations", "4"];

/// Regenerates the requested pages.
pub fn run(root: &Path, options: &Options) -> anyhow::Result<()> {
    let asked_for = |page: &&Page| options.only.is_empty() || options.only.contains(page);
    for page in Page::value_variants().iter().filter(asked_for) {
        let start = Instant::now();
        match page {
            Page::Trade => trades(root)?,
            Page::Advice => advices(root)?,
            Page::Extremes => by_command(root, "extremes", "extremes.md")?,
            Page::Validation => by_command(root, "validate", "validation.md")?,
            Page::Experiments => experiments(root)?,
            Page::Caches => caches(root)?,
            Page::Features => features(root)?,
            Page::Contact => bench::run(&bench::Options::of_contact(root))?,
            Page::Cookbook => {
                cookbook::write(root, |folder, arguments| {
                    let arguments: Vec<&OsStr> = arguments.iter().map(OsString::as_os_str).collect();
                    Ok(nucleus_in(root, folder, &arguments)?.success())
                })?;
            }
            Page::Benchmarks => bench::run(&bench::Options::of_benchmarks(root))?,
        }
        eprintln!("{page:?}: {:.0} s", start.elapsed().as_secs_f64());
    }
    Ok(())
}

/// Runs `nucleus trade`; it resumes from finished runs.
fn trades(root: &Path) -> anyhow::Result<()> {
    let folder = root.join("docs").join("trade");
    let mut found = Vec::new();
    for scene in SCENES {
        let path = format!("scenes/{scene}.ron");
        let trade: [&OsStr; 4] = ["trade".as_ref(), path.as_ref(), "--out".as_ref(), folder.as_ref()];
        let arguments: Vec<&OsStr> = trade.into_iter().chain(SWEEP.iter().map(OsStr::new)).collect();
        let status = nucleus(root, &arguments)?;
        ensure!(status.success(), "`nucleus trade {path}`: {status}");
        let name = scene.rsplit('/').next().unwrap_or(scene);
        let json = fs::read(folder.join(format!("{name}.trade.json")))?;
        found.push((name.to_owned(), serde_json::from_slice::<trade::Trade>(&json)?));
    }
    let index = report::index(&found, &clock::describe_machine().join("\n"));
    Ok(result_cache::write_atomic(&folder.join("README.md"), index.as_bytes())?)
}

/// Builds and runs the command in release mode.
fn nucleus(root: &Path, arguments: &[&OsStr]) -> anyhow::Result<ExitStatus> {
    nucleus_in(root, root, arguments)
}

/// The same in a folder.
fn nucleus_in(root: &Path, folder: &Path, arguments: &[&OsStr]) -> anyhow::Result<ExitStatus> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["run", "--quiet", "--release", "--manifest-path"]).arg(root.join("Cargo.toml"));
    command.args(["--package", "nucleus-cli", "--"]).args(arguments);
    command.current_dir(folder).status().context("cargo cannot be started")
}

/// A page that a command writes. Exit code 1 reports failures, which the page lists, and is accepted.
fn by_command(root: &Path, command: &str, page: &str) -> anyhow::Result<()> {
    let page = root.join("docs").join(page);
    let status = nucleus(root, &[command.as_ref(), "--write".as_ref(), page.as_ref()])?;
    ensure!(matches!(status.code(), Some(0 | 1)), "`nucleus {command}`: {status}");
    Ok(())
}

fn experiments(root: &Path) -> anyhow::Result<()> {
    let mut results = Vec::new();
    for experiment in experiments::experiments() {
        eprintln!("{}", experiment.name);
        results.push((experiment, experiment.run()?));
    }
    let page = experiments::page(&results, &clock::describe_machine().join("\n"));
    Ok(result_cache::write_atomic(&root.join("docs").join("experiments.md"), page.as_bytes())?)
}

fn caches(root: &Path) -> anyhow::Result<()> {
    let machine = clock::describe_machine().join("\n");
    let page = format!("{}\n{machine}\n\n{}", caches::HEAD, caches::tables(root)?);
    Ok(result_cache::write_atomic(&root.join("docs").join("caches.md"), page.as_bytes())?)
}

fn features(root: &Path) -> anyhow::Result<()> {
    let table = features::table(FEATURE_RUNS)?;
    let machine = clock::describe_machine().join("\n");
    let page = format!("{}\n{machine}\n\n{table}\n{}", features::HEAD, features::alone::table()?);
    Ok(result_cache::write_atomic(&root.join("docs").join("features.md"), page.as_bytes())?)
}

fn advices(root: &Path) -> anyhow::Result<()> {
    let mut results = Vec::new();
    for experiment in advice::experiments() {
        eprintln!("{}: {}", experiment.claim, experiment.says);
        let claim_results = (experiment.run)();
        for result in &claim_results {
            eprintln!("  {}: {}: {}", result.reading, result.status.words(), result.reason);
        }
        results.push((experiment, claim_results));
    }
    let page = advice::page(&results, &clock::describe_machine().join("\n"));
    Ok(result_cache::write_atomic(&root.join("docs").join("advice.md"), page.as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_index_of_the_book_links_every_page_and_names_every_option() {
        let root = crate::files::root();
        let index = fs::read_to_string(root.join("docs/README.md")).unwrap();
        for page in Page::value_variants() {
            let verb = page.to_possible_value().unwrap();
            assert!(index.contains(&format!("| `{}` |", verb.get_name())), "{page:?}");
        }
        for entry in fs::read_dir(root.join("docs")).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".md") && name != "README.md" {
                assert!(index.contains(&format!("[`{name}`]({name})")), "{name}");
            }
        }
    }
}
