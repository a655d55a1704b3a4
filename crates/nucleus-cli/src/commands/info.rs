//! `nucleus info`: what a scene or a cache holds.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use super::{cache_info, scene_info};
use crate::outcome::Outcome;
use crate::{cache_file, output, scene_file};

/// Bytes of a cache that is verified, and whose channels are counted, without being asked to.
const COUNTED: u64 = 500_000_000;

/// Tells what a scene compiles to, or what a cache holds and has lost.
#[derive(Debug, Args)]
pub struct Info {
    /// The scene (.ron) or the cache (.mcap).
    file: PathBuf,
    /// Read every frame of the cache, check it, and count the bytes of each channel, in a file larger than 500 MB too.
    #[arg(long)]
    verify: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

impl Info {
    /// Prints it. Frames that are lost are trouble.
    pub fn run(self) -> Result<Outcome> {
        if cache_file::is_cache(&self.file) { self.cache() } else { self.scene() }
    }

    fn cache(&self) -> Result<Outcome> {
        let mut cache = cache_file::open(&self.file)?;
        // All frames have to be unpacked for that, which takes a while in a large file.
        let is_verified = self.verify || cache.bytes() <= COUNTED;
        let sizes = if is_verified {
            cache.verify()?;
            Some(cache.sizes()?)
        } else {
            None
        };
        match self.json {
            true => output::print_json(&cache_info::as_json(&cache, sizes.as_ref()))?,
            false => output::print(&cache_info::as_text(
                &self.file.display().to_string(),
                &cache,
                sizes.as_ref(),
            )?)?,
        }
        Ok(if cache.corruption().is_intact() { Outcome::Fine } else { Outcome::Trouble })
    }

    fn scene(&self) -> Result<Outcome> {
        let Some((scene, program, _)) = scene_file::open(&self.file, None)?.told()? else {
            return Ok(Outcome::InvalidInput);
        };
        let info = scene_info::SceneInfo::of(&scene, &program);
        match self.json {
            true => output::print_json(&info.as_json())?,
            false => output::print(&info.as_text(&self.file.display().to_string())?)?,
        }
        Ok(Outcome::Fine)
    }
}
