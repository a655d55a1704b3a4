//! `nucleus recover`: a complete cache from the intact parts of a damaged one.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use clap::Args;
use nucleus_cache::atomic_file::AtomicFile;
use nucleus_graph::Simulation;

use crate::process::Outcome;
use crate::{figures, files, output, recording};

/// Writes the intact parts of a damaged cache, or of a killed run, as a complete cache.
///
/// Frames with a valid checksum are copied bit for bit; the others are listed. The damaged file is not changed.
#[derive(Debug, Args)]
pub struct Recover {
    /// The damaged cache (.mcap, .mcap.part).
    file: PathBuf,
    /// The cache to write; default: the name without `.part`, or with `.recovered.mcap`.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// The recorded scene (.ron), which supplies lost facts about the run and lost meshes.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Replace an existing file.
    #[arg(long)]
    force: bool,
}

impl Recover {
    /// Recovers the cache. Data that is lost for good is a problem.
    pub fn run(self) -> Result<Outcome> {
        let mut cache = files::open_cache(&self.file)?;
        if let Some(scene) = &self.scene {
            let Some((_, program, text)) = files::open_scene(scene, None)?.report()? else {
                return Ok(Outcome::InvalidInput);
            };
            let simulation: Simulation = Simulation::new(&program, 1);
            let run = recording::of_scene(&simulation, (scene, &text))?;
            let objects = recording::objects(&simulation).into_iter().map(|(_, object)| object).collect();
            cache
                .restore_from_scene(&run, objects)
                .map_err(|fault| anyhow!("`{}`: {fault}", scene.display()))?;
        }
        let out = self.out()?;
        ensure!(out != self.file, "a damaged file is not overwritten; give another name with `-o`");
        if out.exists() && !self.force {
            bail!("`{}` exists; `--force` replaces it, `-o` names another file", out.display());
        }
        let unwritten = || format!("cannot write `{}`", out.display());
        let mut target = AtomicFile::create(&out).with_context(unwritten)?;
        cache.verify()?;
        let recovered = cache.recover(&mut target);
        let recovered = recovered.with_context(|| format!("cannot recover to `{}`", out.display()))?;
        target.commit().with_context(unwritten)?;
        let frames = figures::count(recovered.frames, "frame");
        let size = figures::bytes(recovered.bytes);
        let loss = cache.corruption();
        output::report(&format!(
            "`{}`: {loss}\n{frames} in `{}` ({size})\n",
            self.file.display(),
            out.display()
        ));
        if let Some(gone) = loss.unrecoverable() {
            output::report(&format!("lost for good: {gone}\n"));
        }
        Ok(if loss.unrecoverable().is_some() { Outcome::Problem } else { Outcome::Success })
    }

    fn out(&self) -> Result<PathBuf> {
        if let Some(out) = &self.out {
            return Ok(out.clone());
        }
        let stem = self.file.file_stem().context("the cache has no name")?;
        let is_part = self.file.extension().is_some_and(|end| end == "part");
        let name =
            if is_part { PathBuf::from(stem) } else { Path::new(stem).with_extension("recovered.mcap") };
        Ok(self.file.with_file_name(name))
    }
}
