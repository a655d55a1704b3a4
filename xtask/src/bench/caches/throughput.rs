//! Speed of writing, reading and seeking caches.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};
use serde_json::Value;

use super::target::Target;
use crate::bench::table::{Table, figure};

/// Points along a side, frames, and whether compression is `--compact`.
const SHEETS: [(u32, u32, bool); 3] = [(129, 600, false), (129, 60, true), (1000, 40, false)];
/// Frames of 129² points in 10 GB.
const LARGE: u32 = 67_500;

/// Targets: megabytes per second written and read, milliseconds per seek in a file of 10 GB.
const WRITE: f64 = 300.0;
const READ: f64 = 2000.0;
const SEEK: f64 = 5.0;

/// Speed of writing and reading, of three sheets.
pub fn throughput(root: &Path, folder: &Path) -> anyhow::Result<(Table, Vec<Target>)> {
    let head =
        ["sheet", "packing", "write MB/s", "read MB/s", "packed", "recorder, bytes per point", "reader, MB"];
    let mut table = Table::new("Speed and memory", &head);
    let mut targets = Vec::new();
    for (side, frames, is_compact) in SHEETS {
        let mut runs = Vec::new();
        for _ in 0..3 {
            runs.push(example(root, folder, side, frames, is_compact, None)?);
        }
        let median = |key: &str| {
            let mut all: Vec<f64> = runs.iter().filter_map(|run| run[key].as_f64()).collect();
            all.sort_by(f64::total_cmp);
            all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
        };
        let packing = if is_compact { "`--compact`" } else { "usual" };
        let keys = ["write_mb_s", "read_mb_s", "packed", "recorder_bytes_per_point", "reader_mb"];
        let cells = [format!("{side}²"), packing.to_owned()];
        table.row(cells.into_iter().chain(keys.map(|key| figure(median(key)))));
        if !is_compact {
            targets.push(Target::above(&format!("writing {side}², MB/s"), WRITE, median("write_mb_s")));
            targets.push(Target::above(&format!("reading {side}², MB/s"), READ, median("read_mb_s")));
        }
    }
    table.note("Memory is the peak that recorder and reader add to the process, meshes included: a few frames, independent of the length of the run.");
    table.note("The file includes the mesh, which is a larger share of 60 frames than of 600.");
    Ok((table, targets))
}

/// Time to a random frame of a cache of 10 GB.
pub fn large(root: &Path, folder: &Path) -> anyhow::Result<(Table, Vec<Target>)> {
    let value = example(root, folder, 129, LARGE, false, None)?;
    let mut table = Table::new("A file of 10 GB", &["", "median ms", "99 of 100 ms"]);
    let mut row = |name: &str, key: &str| {
        let times = [0, 1].map(|k| figure(value[key][k].as_f64().unwrap_or(f64::NAN)));
        table.row([name.to_owned()].into_iter().chain(times));
    };
    row("seek, cold file cache", "cold_seek_ms");
    row("seek, warm file cache", "seek_ms");
    let number = |key: &str| figure(value[key].as_f64().unwrap_or(f64::NAN));
    table.note(format!(
        "{} GB, {LARGE} frames of 129²: opened in {} ms, written at {} MB/s, read at {} MB/s with {} MB of memory.",
        number("gigabytes"), number("open_ms"), number("write_mb_s"), number("read_mb_s"), number("reader_mb"),
    ));
    let cold = |k: usize| value["cold_seek_ms"][k].as_f64().unwrap_or(f64::NAN);
    let targets = vec![
        Target::below("seek in 10 GB with a cold file cache, median ms", SEEK, cold(0)),
        Target::below("the same, 99 of 100", SEEK, cold(1)),
    ];
    Ok((table, targets))
}

/// Runs the throughput example of the cache crate; its results as JSON.
pub fn example(
    root: &Path,
    folder: &Path,
    side: u32,
    frames: u32,
    is_compact: bool,
    keep: Option<&Path>,
) -> anyhow::Result<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args([
        "run",
        "--quiet",
        "--release",
        "--package",
        "nucleus-cache",
        "--example",
        "throughput",
        "--",
    ]);
    command.args([side.to_string(), frames.to_string()]).args(is_compact.then_some("compact"));
    command.args(keep.map(|path| format!("keep={}", path.display())));
    let output =
        command.current_dir(root).env("TMPDIR", folder).output().context("cargo cannot be started")?;
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "throughput {side} {frames}: {said}");
    Ok(serde_json::from_slice(&output.stdout)?)
}
