//! `nucleus info`: what a scene or a cache holds.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use super::{cache_info, scene_info};
use crate::outcome::Outcome;
use crate::{cache_file, output, scene_file};

/// Tells what a scene compiles to, or what a cache holds and has lost.
#[derive(Debug, Args)]
pub struct Info {
    /// The scene (.ron) or the cache (.mcap).
    file: PathBuf,
    /// Read every frame of the cache and check it.
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
        if self.verify {
            cache.verify()?;
        }
        match self.json {
            true => output::print_json(&cache_info::as_json(&cache))?,
            false => output::print(&cache_info::as_text(&self.file.display().to_string(), &cache)?)?,
        }
        Ok(if cache.loss().is_none() { Outcome::Fine } else { Outcome::Trouble })
    }

    fn scene(&self) -> Result<Outcome> {
        let Some((scene, program, _)) = scene_file::open(&self.file, None)?.told()? else {
            return Ok(Outcome::Refused);
        };
        let info = scene_info::SceneInfo::of(&scene, &program);
        match self.json {
            true => output::print_json(&info.as_json())?,
            false => output::print(&info.as_text(&self.file.display().to_string())?)?,
        }
        Ok(Outcome::Fine)
    }
}
