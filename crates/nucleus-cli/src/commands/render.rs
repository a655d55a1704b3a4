//! `nucleus render`: a run as a picture, still or moving.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use nucleus_cache::{ObjectKind, Playback};
use nucleus_view::{Bounds, Camera, Colouring, Film, Image, Style};

use crate::outcome::Outcome;
use crate::{cache_file, figures, output};

/// Draws a frame of a cache as a PNG, or the whole run as an animated PNG.
#[derive(Debug, Args)]
pub struct Render {
    /// The cache (.mcap).
    file: PathBuf,
    /// The frame to draw; the last one if none is given.
    #[arg(long, conflicts_with = "animate", allow_negative_numbers = true)]
    frame: Option<i32>,
    /// The picture to write; the cache's name with `.png` if none is given.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Width and height in pixels.
    #[arg(long, default_value = "1280x720", value_parser = parse_size)]
    size: [u32; 2],
    /// Draw all frames, as an animated PNG.
    #[arg(long)]
    animate: bool,
    /// Draw only every so many frames.
    #[arg(long, default_value_t = 1, requires = "animate", value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Colour cloth by its strain; full colour at this strain (0.05 is 5 %).
    #[arg(long, value_name = "FULL_SCALE", num_args = 0..=1, default_missing_value = "0.05")]
    strain: Option<f32>,
    /// Draw the edges of faces.
    #[arg(long)]
    wireframe: bool,
}

impl Render {
    /// Draws it.
    pub fn run(self) -> Result<Outcome> {
        let mut cache = cache_file::open_and_warn(&self.file)?;
        let out = match &self.out {
            Some(out) => out.clone(),
            None => {
                PathBuf::from(self.file.file_stem().context("the cache has no name")?).with_extension("png")
            }
        };
        let drawn = match self.animate {
            true => self.animate(&mut cache, &out)?,
            false => self.still(&mut cache, &out)?,
        };
        let size = figures::bytes(std::fs::metadata(&out)?.len());
        output::print(&format!("{drawn} in `{}` ({size})\n", out.display()))?;
        Ok(Outcome::Fine)
    }

    fn still(&self, cache: &mut Playback, out: &Path) -> Result<String> {
        let moment = cache_file::moment(cache, self.frame)?;
        let frame = cache.moments()[moment].frame;
        let camera = camera(cache, moment, self.size)?;
        // The floor is that of the whole run, found from a few of its frames.
        let every = cache.moments().len() / 24;
        Film::of(cache, every, self.style())?.seen_by(camera).moment(moment)?.write_png(out)?;
        Ok(format!("frame {frame}"))
    }

    fn animate(&self, cache: &mut Playback, out: &Path) -> Result<String> {
        let mut film = Film::of(cache, self.every as usize, self.style())?;
        film.write(out)?;
        Ok(figures::count(film.len(), "frame"))
    }

    fn style(&self) -> Style {
        let colouring = match self.strain {
            Some(full_scale) => Colouring::Strain { full_scale },
            None => Colouring::Objects,
        };
        Style { size: self.size, colouring, wireframe: self.wireframe, ..Style::default() }
    }
}

/// A camera that holds what is simulated as it is at this moment; all objects, if nothing is.
fn camera(cache: &mut Playback, moment: usize, size: [u32; 2]) -> Result<Camera> {
    let (mut stage, mut all) = (Bounds::default(), Bounds::default());
    for object in 0..cache.objects().len() {
        let positions = cache.positions(object, moment)?;
        all.include(&positions);
        if cache.objects()[object].kind != ObjectKind::Collider {
            stage.include(&positions);
        }
    }
    Ok(Camera::framing(if stage.is_empty() { &all } else { &stage }, size))
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let sides =
        text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    match sides {
        Some(sides) if sides.iter().all(|side| (1..=Image::LARGEST_SIDE).contains(side)) => Ok(sides),
        Some(_) => Err(format!("each side must be 1 to {} pixels", Image::LARGEST_SIDE)),
        None => Err("write it as 1280x720".to_owned()),
    }
}
