//! States the commit of the source, where there is one, for `nucleus --version`.

use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output =
            Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
    };
    // The log changes with every commit, the head file only with the branch.
    let log = git(&["rev-parse", "--git-path", "logs/HEAD"]);
    println!("cargo::rerun-if-changed={}", log.as_deref().unwrap_or("build.rs"));
    let commit = git(&["show", "--no-patch", "--format= (%h, %cs)", "--abbrev=10", "HEAD"]);
    println!("cargo::rustc-env=NUCLEUS_COMMIT={}", commit.map(|one| format!(" {one}")).unwrap_or_default());
}
