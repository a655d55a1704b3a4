//! `nucleus recover`: what survives of a damaged cache.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use clap::Args;
use nucleus_cache::atomic_file::AtomicFile;
use nucleus_graph::Simulation;

use crate::outcome::Outcome;
use crate::{cache_file, figures, output, recording, scene_file};

/// Writes what survives of a damaged cache, or of a run that was killed, as a cache that is whole.
///
/// Every frame whose checksum holds is copied bit for bit; the others are named. The damaged file stays as it is.
#[derive(Debug, Args)]
pub struct Recover {
    /// The damaged cache (.mcap, .mcap.part).
    file: PathBuf,
    /// The cache to write; the name without `.part`, or else with `.recovered.mcap`, if none is given.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// The scene that was recorded (.ron): what is lost of run and meshes is taken from it.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Replace a file that exists.
    #[arg(long)]
    force: bool,
}

impl Recover {
    /// Recovers it. What is lost for good is trouble.
    pub fn run(self) -> Result<Outcome> {
        let mut cache = cache_file::open(&self.file)?;
        if let Some(scene) = &self.scene {
            let Some((_, program, text)) = scene_file::open(scene, None)?.told()? else {
                return Ok(Outcome::InvalidInput);
            };
            let simulation = Simulation::new(&program, 1);
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
        output::tell(&format!(
            "`{}`: {loss}\n{frames} in `{}` ({size})\n",
            self.file.display(),
            out.display()
        ));
        if let Some(gone) = loss.unrecoverable() {
            output::tell(&format!("lost for good: {gone}\n"));
        }
        Ok(if loss.unrecoverable().is_some() { Outcome::Trouble } else { Outcome::Fine })
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
