//! Films with a downloaded ffmpeg, for machines without one, on which the test of films passes without running.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};

use super::process::{cargo_with, environment, succeed};

/// A Python package that contains ffmpeg with H.264 and VP9.
const PACKAGE: &str = "imageio-ffmpeg==0.6.0";
/// The test in `crates/nucleus-cli/tests/cli/render.rs`.
const TEST: &str = "render::a_film_has_every_frame_at_its_rate_and_the_colours_of_the_picture";
/// Prints the path of its ffmpeg.
const WHERE: &str = "import imageio_ffmpeg; print(imageio_ffmpeg.get_ffmpeg_exe())";

/// Runs the test that writes films and reads them back.
pub fn run(root: &Path, place: &Path) -> anyhow::Result<()> {
    println!("\n== films");
    let folder = install(place)?;
    let paths = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths([folder].into_iter().chain(env::split_paths(&paths)))?;
    let test = [
        "test",
        "--release",
        "--package",
        "nucleus-cli",
        "--test",
        "cli",
        "--",
        "--exact",
        TEST,
        "--nocapture",
    ];
    // Ensures that ffmpeg is found; without it the test passes without writing a film.
    succeed(Command::new("ffmpeg").args(["-loglevel", "error", "-version"]).env("PATH", &path))?;
    cargo_with(root, &test, &[("PATH", &path)])
}

/// Downloads ffmpeg; returns a folder that contains it as `ffmpeg`.
fn install(place: &Path) -> anyhow::Result<PathBuf> {
    let python = environment(place, "films", &[PACKAGE])?;
    let output = Command::new(&python).args(["-c", WHERE]).output();
    let output = output.with_context(|| format!("`{}` cannot be started", python.display()))?;
    let ffmpeg = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    ensure!(ffmpeg.exists(), "{PACKAGE} has no ffmpeg for this machine");
    let folder = place.join("films").join("ffmpeg");
    fs::create_dir_all(&folder)?;
    let name = folder.join(format!("ffmpeg{}", env::consts::EXE_SUFFIX));
    if !name.exists() {
        fs::copy(&ffmpeg, &name)?;
    }
    Ok(folder)
}
