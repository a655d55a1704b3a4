//! All checks before a merge, in order; stops at the first failure.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use std::{env, fs, iter, thread};

use anyhow::{Context, bail, ensure};

use crate::{files, python, readme, tidy};

/// Minimum uptime of a server command of the README.
const SERVES_FOR: Duration = Duration::from_secs(3);

/// The command of the README that runs all tests, so that no step repeats it.
const TESTS: &str = "cargo test --release --workspace";

/// Seed of the property tests: one commit passes or fails each time. `cargo test` alone draws other cases in every run.
const SEED: (&str, &str) = ("PROPTEST_RNG_SEED", "20260101");

/// Scenes that `nucleus extremes` evaluates; some of them fail by intention, and some run for minutes.
const STRESS_TESTS: &str = "scenes/extremes";

/// Runs all steps, each with a heading and its time.
pub fn run(root: &Path) -> anyhow::Result<()> {
    let start = Instant::now();
    step("format", || cargo(root, &["fmt", "--all", "--check"], &[]))?;
    // With `--release`, lints and pages share build scripts and macros with the build.
    let lints = ["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"];
    step("lints", || cargo(root, &lints, &[]))?;
    let pages = ["doc", "--release", "--workspace", "--no-deps"];
    step("docs", || cargo(root, &pages, &[("RUSTDOCFLAGS", "-D warnings")]))?;
    step("tidy", || tidy::run(root))?;
    step("tools", install_slurm)?;
    step("build", || cargo(root, &["build", "--release", "--package", "nucleus-cli"], &[]))?;
    step("readme, and with it all tests", || readme_commands(root))?;
    step("scenes", || scenes(root))?;
    step("python", || python::run(root))?;
    println!("\nall fine after {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Installs SLURM for its test, where that is possible; the test says so where it is skipped.
fn install_slurm() -> anyhow::Result<()> {
    let runs = |words: &[&str]| {
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).env("DEBIAN_FRONTEND", "noninteractive").stdout(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    if Path::new("/usr/sbin/slurmctld").exists() {
        return Ok(());
    }
    let install = ["apt-get", "install", "-y", "-q", "--no-install-recommends", "slurm-wlm", "munge"];
    if !(runs(&["apt-get", "update", "-q"]) && runs(&install)) {
        println!("SLURM cannot be installed here; its test is skipped");
    }
    Ok(())
}

fn step(name: &str, run: impl FnOnce() -> anyhow::Result<()>) -> anyhow::Result<()> {
    println!("\n== {name}");
    let start = Instant::now();
    run().with_context(|| format!("{name} failed after {:.1} s", start.elapsed().as_secs_f64()))?;
    println!("== {name}: {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

fn cargo(root: &Path, arguments: &[&str], environment: &[(&str, &str)]) -> anyhow::Result<()> {
    let program = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(program);
    command.args(arguments).envs(environment.iter().copied()).current_dir(root);
    succeed(command, &format!("cargo {}", arguments.join(" ")))
}

/// Runs the commands of the README literally, so that they stay correct.
fn readme_commands(root: &Path) -> anyhow::Result<()> {
    let commands = readme::commands(&fs::read_to_string(root.join("README.md")).context("README.md")?);
    ensure!(commands.iter().any(|text| text == TESTS), "README.md does not say `{TESTS}`");
    for text in commands {
        println!("-- {text}");
        remove_old_cache(root, &text)?;
        let mut words = text.split_whitespace();
        let mut command = Command::new(words.next().unwrap_or_default());
        command.args(words).env(SEED.0, SEED.1).current_dir(root);
        if text.split_whitespace().any(|word| word == "play") {
            serve(command, &text)?;
        } else {
            succeed(command, &text)?;
        }
    }
    Ok(())
}

/// Removes the cache of an earlier run of the same command, because `nucleus run` replaces none.
fn remove_old_cache(root: &Path, command: &str) -> anyhow::Result<()> {
    let scene = command.split_whitespace().find(|word| word.ends_with(".ron"));
    let stem = scene.and_then(|scene| Path::new(scene).file_stem());
    let Some(cache) = stem.map(|stem| root.join(stem).with_extension("mcap")) else { return Ok(()) };
    if cache.exists() { fs::remove_file(&cache).context("the cache of an earlier run") } else { Ok(()) }
}

/// Runs every scene with its checks, one per core at a time, but for those that a command of the README has run.
fn scenes(root: &Path) -> anyhow::Result<()> {
    let program = built(root).join("nucleus");
    let all = files::below(&root.join("scenes"))?;
    let stress_tests = root.join(STRESS_TESTS);
    let commands = readme::commands(&fs::read_to_string(root.join("README.md")).context("README.md")?);
    let has_run = |path: &Path| {
        let name = files::name(root, path);
        commands.iter().any(|command| command.split_whitespace().any(|word| word == name))
    };
    let is_scene = |path: &&PathBuf| {
        let is_ron = path.extension().is_some_and(|end| end == "ron");
        is_ron && !path.starts_with(&stress_tests) && !has_run(path)
    };
    let scenes: Vec<_> = all.iter().filter(is_scene).collect();
    ensure!(!scenes.is_empty(), "there are no scenes");
    let next = AtomicUsize::new(0);
    let jobs = thread::available_parallelism().map_or(1, NonZero::get);
    // All scenes run, so that all failures are seen.
    let run_all = || -> Vec<anyhow::Error> {
        let mine = iter::from_fn(|| scenes.get(next.fetch_add(1, Ordering::Relaxed)));
        mine.filter_map(|scene| run_scene(root, &program, scene).err()).collect()
    };
    let failures: Vec<_> = thread::scope(|scope| {
        let jobs: Vec<_> = (0..jobs).map(|_| scope.spawn(run_all)).collect();
        jobs.into_iter().flat_map(|job| job.join().expect("a job does not panic")).collect()
    });
    failures.iter().for_each(|failure| eprintln!("{failure:#}"));
    ensure!(failures.is_empty(), "{} scenes failed", failures.len());
    Ok(())
}

/// Runs a scene on one thread, with its output in one piece.
fn run_scene(root: &Path, program: &Path, scene: &Path) -> anyhow::Result<()> {
    let name = files::name(root, scene);
    let start = Instant::now();
    let mut command = Command::new(program);
    command.arg("run").arg(scene).args(["--record", "none", "--threads", "1"]).current_dir(root);
    let output = command.output().with_context(|| format!("`{name}` cannot be started"))?;
    let [out, err] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    println!("{out}{err}-- {name}: {:.1} s", start.elapsed().as_secs_f64());
    ensure!(output.status.success(), "`{name}`: {}", output.status);
    Ok(())
}

/// Folder of optimised programs.
fn built(root: &Path) -> PathBuf {
    files::target(root).join("release")
}

fn succeed(mut command: Command, name: &str) -> anyhow::Result<()> {
    let status = command.status().with_context(|| format!("`{name}` cannot be started"))?;
    ensure!(status.success(), "`{name}`: {status}");
    Ok(())
}

/// Starts a server and stops it after [`SERVES_FOR`].
fn serve(mut command: Command, name: &str) -> anyhow::Result<()> {
    let mut child = command.spawn().with_context(|| format!("`{name}` cannot be started"))?;
    let result = stays_up(&mut child, name);
    // It may have ended already; then there is nothing to stop.
    let _ = child.kill();
    child.wait()?;
    result
}

fn stays_up(child: &mut Child, name: &str) -> anyhow::Result<()> {
    let start = Instant::now();
    while start.elapsed() < SERVES_FOR {
        match child.try_wait()? {
            Some(status) if !status.success() => bail!("`{name}`: {status}"),
            Some(_) => return Ok(()),
            None => thread::sleep(Duration::from_millis(50)),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_server_passes_if_it_stays_up_and_fails_if_it_exits_with_an_error() {
        let shell = |script: &str| {
            let mut command = Command::new("sh");
            command.args(["-c", script]);
            command
        };
        assert!(serve(shell("exec sleep 60"), "sleep").is_ok());
        assert!(serve(shell("exit 0"), "done").is_ok());
        assert!(serve(shell("exit 3"), "broken").is_err());
        assert!(succeed(shell("exit 3"), "broken").is_err());
    }
}
