//! The Python package: a wheel, and its tests in an environment of its own below the target folder.

use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context, ensure};

use crate::files;

/// What the tests need besides the package.
const NEEDED: [&str; 7] = ["maturin>=1.9,<2", "numpy", "pytest", "matplotlib", "scipy", "mcap", "zstandard"];

/// Builds the wheel with the programs that are built already, installs it, and runs the tests.
pub fn run(root: &Path) -> anyhow::Result<()> {
    // Debian's `python3` comes without these modules.
    let usable =
        Command::new("python3").args(["-c", "import ensurepip, venv"]).stderr(Stdio::null()).status();
    if !usable.is_ok_and(|status| status.success()) {
        println!("there is no `python3` with `venv` here; the Python package is not tested");
        return Ok(());
    }
    let (target, package) = (files::target(root), root.join("python"));
    let environment = target.join("python");
    if !environment.join("bin/python").exists() {
        call(Command::new("python3").args(["-m", "venv"]).arg(&environment))?;
    }
    let python = environment.join("bin/python");
    call(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(NEEDED))?;
    // maturin and its cargo share the target folder, and with it nearly all that is compiled.
    let install =
        ["-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--force-reinstall"];
    let path = environment.join("bin").into_os_string();
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let paths = std::env::join_paths(std::iter::once(path.into()).chain(std::env::split_paths(&paths)))?;
    let mut build = Command::new(&python);
    build.args(install).arg(&package).env("CARGO_TARGET_DIR", &target).env("PATH", paths);
    call(&mut build)?;
    // From another folder, so that the installed package is imported.
    let tests = package.join("tests");
    call(
        Command::new(&python)
            .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
            .arg(tests)
            .current_dir(&environment),
    )
}

fn call(command: &mut Command) -> anyhow::Result<()> {
    let name = format!("{command:?}");
    let status = command.status().with_context(|| format!("{name} cannot be started"))?;
    ensure!(status.success(), "{name}: {status}");
    Ok(())
}
