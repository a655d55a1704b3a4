//! Other programs: cargo, and Python with packages of its own.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};

/// The Python version of Blender's module.
const PYTHON: &str = "python3.11";

/// Installs Python packages into a virtual environment, unless present; returns its Python.
pub fn environment(place: &Path, name: &str, packages: &[&str]) -> anyhow::Result<PathBuf> {
    let folder = place.join(name);
    let (stamp, python) = (folder.join("installed"), folder.join("bin/python"));
    if fs::read_to_string(&stamp).is_ok_and(|known| known == packages.join("\n")) {
        return Ok(python);
    }
    println!("-- installing {} into {}", packages.join(", "), folder.display());
    succeed(Command::new(PYTHON).args(["-m", "venv"]).arg(&folder))?;
    succeed(Command::new(&python).args(["-m", "pip", "install", "-q"]).args(packages))?;
    fs::write(stamp, packages.join("\n"))?;
    Ok(python)
}

/// Runs cargo at the root.
pub fn cargo(root: &Path, arguments: &[&str]) -> anyhow::Result<()> {
    cargo_with(root, arguments, &[])
}

/// Runs cargo at the root with environment variables.
pub fn cargo_with(root: &Path, arguments: &[&str], variables: &[(&str, &OsStr)]) -> anyhow::Result<()> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    succeed(Command::new(program).args(arguments).current_dir(root).envs(variables.iter().copied()))
}

/// Runs a command, which must succeed.
pub fn succeed(command: &mut Command) -> anyhow::Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().with_context(|| format!("`{name}` cannot be started"))?;
    ensure!(status.success(), "`{name}`: {status}");
    Ok(())
}
