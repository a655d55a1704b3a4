//! The player in a browser: time to the first picture, and time per frame when scrubbing.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use serde_json::Value;

use super::target::Target;
use super::throughput::example;
use crate::bench::table::{Table, figure};

/// Frames of 129² points in 2 GB.
const FRAMES: u32 = 13_500;
/// The browser driver.
const DRIVER: &str = "puppeteer-core@24";
/// Possible paths of Chromium.
const PLACES: [&str; 3] = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

/// Milliseconds per frame of a 60 Hz screen.
const REFRESH: f64 = 1e3 / 60.0;
/// Limit of an immediate response, in milliseconds.
const AT_ONCE: f64 = 1e3;

/// The table of the page, with a note if there is no browser; and the targets.
pub fn table(root: &Path, folder: &Path) -> anyhow::Result<(Table, Vec<Target>)> {
    let mut table = Table::new("The player", &["a cache of 2 GB, 129²", "median ms", "99 of 100 ms"]);
    let Some(chromium) = PLACES.iter().map(Path::new).find(|path| path.exists()) else {
        table.note("There was no Chromium here.");
        return Ok((table, Vec::new()));
    };
    let cache = folder.join("player.mcap");
    example(root, folder, 129, FRAMES, false, Some(&cache))?;
    let player = nucleus_view::serve(&cache, 0)?;
    let value = drive(&install(folder)?, chromium, &player.url())?;
    fs::remove_file(cache)?;
    let both = |key: &str| [0, 1].map(|k| figure(value[key][k].as_f64().unwrap_or(f64::NAN)));
    for (name, key) in [
        ("fetch the bytes of a random frame from the server", "fetch"),
        ("decompress: zstd, checksum, floats", "unpack"),
        ("update: normals, bounds, upload", "update"),
        ("draw, 1280 x 720, without a graphics card", "draw"),
    ] {
        table.row([name.to_owned()].into_iter().chain(both(key)));
    }
    let number = |key: &str| figure(value[key].as_f64().unwrap_or(f64::NAN));
    table.note(format!(
        "From the request of the page to the first picture: {} ms. {}, headless; a screen of 60 Hz leaves 16.7 ms.",
        number("opened"),
        value["browser"].as_str().unwrap_or_default()
    ));
    let median = |key: &str| value[key][0].as_f64().unwrap_or(f64::NAN);
    let frame = median("fetch") + median("unpack") + median("update");
    let opened = value["opened"].as_f64().unwrap_or(f64::NAN);
    let targets = vec![
        Target::below("opening a cache of 2 GB in the player, ms", AT_ONCE, opened),
        Target::below("scrubbing 129² at 60 Hz without drawing, ms per frame", REFRESH, frame),
    ];
    Ok((table, targets))
}

fn install(folder: &Path) -> anyhow::Result<PathBuf> {
    if !folder.join("node_modules/puppeteer-core").exists() {
        let mut npm = Command::new("npm");
        npm.args(["install", "--no-audit", "--no-fund", "--prefix"]).arg(folder).arg(DRIVER);
        ensure!(npm.status().context("npm cannot be started")?.success(), "npm cannot install {DRIVER}");
    }
    let script = folder.join("player.mjs");
    fs::write(&script, include_str!("player.mjs"))?;
    Ok(script)
}

fn drive(script: &Path, chromium: &Path, url: &str) -> anyhow::Result<Value> {
    let output =
        Command::new("node").arg(script).arg(chromium).arg(url).output().context("node cannot be started")?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Ok(serde_json::from_slice(&output.stdout)?)
}
