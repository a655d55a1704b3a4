//! Exports of `nucleus export` read by other tools: Blender, Pixar's USD, VTK, Foxglove's types, rerun and Khronos' glTF
//! validator; meshes that Pixar's USD and trimesh write, read by nucleus; and films, written with an ffmpeg ([`films`]).
//!
//! Compares each export with the cache, read by the independent `mcap` package, point by point.

mod films;
mod process;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail, ensure};
use serde_json::Value;

use crate::files;
use process::{cargo, environment, succeed};

/// Options of the interoperability check.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Cache whose exports to check, instead of the sample and a scene of the gallery.
    cache: Vec<PathBuf>,
    /// Only write films, with a downloaded ffmpeg.
    #[arg(long, conflicts_with = "cache")]
    films: bool,
}

/// The scripts; each prints its results as one line of JSON.
const SCRIPTS: [(&str, &str); 6] = [
    ("cache.py", include_str!("interop/cache.py")),
    ("blender.py", include_str!("interop/blender.py")),
    ("inputs.py", include_str!("interop/inputs.py")),
    ("scenes.py", include_str!("interop/scenes.py")),
    ("viewers.py", include_str!("interop/viewers.py")),
    ("gltf.js", include_str!("interop/gltf.js")),
];

/// Virtual environments: Blender needs an older numpy than rerun.
const ENVIRONMENTS: [(&str, &[&str]); 2] = [
    (
        "readers",
        &[
            "bpy==5.0.1",
            "numpy<2",
            "usd-core==26.11",
            "vtk==9.7.2",
            "trimesh==5.2.0",
            "mcap==1.6.0",
            "zstandard",
        ],
    ),
    (
        "viewers",
        &[
            "rerun-sdk==0.41.0",
            "mcap==1.6.0",
            "mcap-protobuf-support==0.6.0",
            "foxglove-schemas-protobuf",
            "numpy",
        ],
    ),
];
const VALIDATOR: &str = "gltf-validator@2.0.0-dev.3.10";

/// Installs missing tools, exports, and runs every reader.
pub fn run(root: &Path, options: &Options) -> anyhow::Result<()> {
    let place = files::target(root).join("interop");
    fs::create_dir_all(&place)?;
    if options.films {
        return films::run(root, &place);
    }
    install(&place)?;
    for (name, text) in SCRIPTS {
        fs::write(place.join(name), text)?;
    }
    cargo(
        root,
        &["build", "--release", "--package", "nucleus-cli", "--package", "nucleus-interop", "--examples"],
    )?;
    let caches = if options.cache.is_empty() { own_caches(root, &place)? } else { options.cache.clone() };
    let mut failed = check_inputs(root, &place)?;
    for cache in caches {
        println!("\n== {}", cache.display());
        let folder = place.join("files");
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        export(root, &cache, &folder)?;
        failed += check(&place, &cache, &folder)?;
    }
    ensure!(failed == 0, "{failed} files are not read as they were written");
    films::run(root, &place)
}

/// The sample, which has all unusual features, and the start of a real run.
fn own_caches(root: &Path, place: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let [sample, drape] = ["sample.mcap", "drape.mcap"].map(|name| place.join(name));
    let release = files::target(root).join("release");
    for cache in [&sample, &drape] {
        // Caches are never overwritten without a flag.
        if cache.exists() {
            fs::remove_file(cache)?;
        }
    }
    succeed(Command::new(release.join("examples/sample")).arg(&sample))?;
    let scene = root.join("scenes/cloth/drape_on_sphere.ron");
    let mut run = Command::new(release.join("nucleus"));
    // Checks of later frames fail; only the cache matters here.
    run.arg("run").arg(scene).args(["--frames", "24", "-o"]).arg(&drape).status()?;
    ensure!(drape.exists(), "the scene was not recorded");
    Ok(vec![sample, drape])
}

fn export(root: &Path, cache: &Path, folder: &Path) -> anyhow::Result<()> {
    let nucleus = files::target(root).join("release/nucleus");
    for format in ["obj", "ply", "pc2", "mdd", "usda", "usdc", "glb", "vtu", "mc", "mcx", "foxglove"] {
        let out = match format {
            "usda" | "usdc" | "glb" => format!("run.{format}"),
            "foxglove" => "run.foxglove.mcap".to_owned(),
            folder => folder.to_owned(),
        };
        let mut command = Command::new(&nucleus);
        succeed(command.arg("export").arg(cache).args(["--as", format, "-o"]).arg(folder.join(out)))?;
    }
    Ok(())
}

/// Lets nucleus read meshes of other tools; returns the number that differ.
fn check_inputs(root: &Path, place: &Path) -> anyhow::Result<usize> {
    println!("\n== inputs");
    let nucleus = files::target(root).join("release/nucleus");
    let mut command = Command::new(python(place, "readers"));
    verdicts(command.arg(place.join("inputs.py")).arg(nucleus).arg(place.join("inputs")), "inputs.py")
}

/// Runs every reader; returns the number of differing exports.
fn check(place: &Path, cache: &Path, folder: &Path) -> anyhow::Result<usize> {
    let mut failed = 0;
    for (program, script) in [
        (python(place, "readers"), "blender.py"),
        (python(place, "readers"), "scenes.py"),
        (python(place, "viewers"), "viewers.py"),
        ("node".into(), "gltf.js"),
    ] {
        let mut command = Command::new(&program);
        command.arg(place.join(script)).arg(cache).arg(folder);
        failed += verdicts(command.env("NODE_PATH", place.join("node/node_modules")), script)?;
    }
    Ok(failed)
}

fn python(place: &Path, environment: &str) -> PathBuf {
    place.join(environment).join("bin/python")
}

/// Runs a script and prints its results; returns the number that differ.
fn verdicts(command: &mut Command, script: &str) -> anyhow::Result<usize> {
    let output = command.output();
    let output =
        output.with_context(|| format!("`{}` cannot be started", command.get_program().display()))?;
    let said = String::from_utf8_lossy(&output.stdout);
    let found = said.lines().rev().find_map(|line| serde_json::from_str::<Vec<Value>>(line).ok());
    let Some(rows) = found.filter(|_| output.status.success()) else {
        bail!("{script}: {}\n{said}{}", output.status, String::from_utf8_lossy(&output.stderr));
    };
    Ok(rows.iter().map(report).filter(|fine| !fine).count())
}

/// Prints a result; returns whether it matches.
fn report(row: &Value) -> bool {
    let word = |key: &str| row[key].as_str().unwrap_or_default();
    let status = match (row["trouble"].as_str(), row["error"].as_f64()) {
        (Some(trouble), _) => format!("FAILED: {trouble}"),
        (None, Some(error)) => format!("error {error:.1e}"),
        (None, None) => "same".to_owned(),
    };
    println!("{:<34} {:<28} {status}", word("what"), word("reader"));
    row["trouble"].is_null()
}

fn install(place: &Path) -> anyhow::Result<()> {
    for (name, packages) in ENVIRONMENTS {
        environment(place, name, packages)?;
    }
    let node = place.join("node");
    if !node.join("node_modules/gltf-validator").exists() {
        println!("-- installing {VALIDATOR} into {}", node.display());
        fs::create_dir_all(&node)?;
        let mut npm = Command::new("npm");
        npm.args(["install", "--no-audit", "--no-fund", "--prefix"]).arg(&node).arg(VALIDATOR);
        succeed(&mut npm)?;
    }
    Ok(())
}
