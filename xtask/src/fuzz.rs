//! Mutates Maya scenes for some minutes, and keeps those that break the import.

use std::fs;
use std::panic;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result, bail};
use clap::Args;

#[path = "../../crates/nucleus-maya/tests/mutations/mutate.rs"]
mod mutate;

use mutate::{Random, check, mutated};

/// Options of the fuzzer.
#[derive(Args)]
pub struct Options {
    /// How long it runs, in minutes.
    #[arg(long, default_value_t = 10.0)]
    minutes: f64,
    /// A further folder of scenes to mutate.
    #[arg(long)]
    scenes: Option<PathBuf>,
    /// Where the random numbers begin; default: the time.
    #[arg(long)]
    seed: Option<u64>,
}

/// Longest scene that is mutated, in bytes; mutations of longer ones mostly hit arrays of numbers.
const MAX_BYTES: usize = 200_000;

/// Runs the fuzzer. Inputs that break the import are kept in `tests/maya/`, which all later runs mutate, too.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    let own = root.join("tests/maya");
    let mut corpus = scenes(&own)?;
    if let Some(folder) = &options.scenes {
        corpus.extend(scenes(folder)?);
    }
    let seed = options.seed.unwrap_or_else(|| {
        SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64)
    });
    let (mut random, start) = (Random(seed), Instant::now());
    let (mut runs, mut broken, mut slowest) = (0u64, 0, Duration::ZERO);
    let limit = Duration::from_secs_f64(60.0 * options.minutes);
    while start.elapsed() < limit {
        let [a, b] = [0, 1].map(|_| random.below(corpus.len()));
        let text = mutated(&corpus[a], &corpus[b], &mut random);
        let one = Instant::now();
        let copy = text.clone();
        if panic::catch_unwind(|| check(copy)).is_err() {
            let path = own.join(format!("fuzz_{seed:x}_{runs}.ma"));
            fs::write(&path, &text).with_context(|| format!("cannot write `{}`", path.display()))?;
            println!("kept `{}`", path.display());
            broken += 1;
            if broken == 20 {
                break;
            }
        }
        slowest = slowest.max(one.elapsed());
        runs += 1;
    }
    println!(
        "{runs} mutations of {} scenes in {:.0} s, seed {seed}: {broken} broke the import; the slowest took {} ms",
        corpus.len(),
        start.elapsed().as_secs_f64(),
        slowest.as_millis()
    );
    if broken > 0 { bail!("{broken} inputs broke the import") } else { Ok(()) }
}

/// The scenes of a folder.
fn scenes(folder: &Path) -> Result<Vec<Vec<u8>>> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .with_context(|| format!("cannot read `{}`", folder.display()))?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|end| end == "ma"))
        .collect();
    files.sort();
    let read = |path: PathBuf| fs::read(&path).with_context(|| format!("cannot read `{}`", path.display()));
    let all: Vec<Vec<u8>> = files.into_iter().map(read).collect::<Result<_>>()?;
    Ok(all.into_iter().filter(|text| text.len() <= MAX_BYTES).collect())
}
