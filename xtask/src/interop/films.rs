//! Films by an ffmpeg that is fetched, for machines that have none: the test of films passes over them where none is found.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};

use super::{cargo_with, environment, succeed};

/// A package of Python that has a whole ffmpeg in it, with H.264 and VP9.
const PACKAGE: &str = "imageio-ffmpeg==0.6.0";
/// The test in `crates/nucleus-cli/tests/cli/render.rs`.
const TEST: &str = "render::a_film_has_every_frame_at_its_rate_and_the_colours_of_the_picture";
/// Prints where it is.
const WHERE: &str = "import imageio_ffmpeg; print(imageio_ffmpeg.get_ffmpeg_exe())";

/// Has films written and read back.
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
    // That it is found is sure before: where it is not, the test passes without having written a film.
    succeed(Command::new("ffmpeg").args(["-loglevel", "error", "-version"]).env("PATH", &path))?;
    cargo_with(root, &test, &[("PATH", &path)])
}

/// Fetches ffmpeg; gives the folder in which it has that name.
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
