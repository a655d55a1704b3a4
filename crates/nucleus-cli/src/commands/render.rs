//! `nucleus render`: a run as a picture, still or moving.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use nucleus_cache::Playback;
use nucleus_view::{Camera, Colouring, Film, Image, Style};

use super::film::{self, Way};
use crate::frame_range::FrameRange;
use crate::outcome::Outcome;
use crate::progress::Steps;
use crate::{cache_file, figures, output};

/// Draws a cache: a frame as a PNG, or the run as an animated PNG, a GIF, a film, or a picture for each frame.
///
/// What is written follows from the name: `hang.png` is a still (with --animate an animated PNG), `hang.gif` a
/// GIF, `hang.mp4`, `.mov` or `.webm` a film if ffmpeg is installed, and `frames/hang.####.png` a picture for each
/// frame, with its number.
///
/// A cache records the ground plane at the start of the run only: a plane that moves is drawn where it starts.
#[derive(Debug, Args)]
pub struct Render {
    /// The cache (.mcap).
    file: PathBuf,
    /// The frame to draw; the last one if none is given.
    #[arg(long, conflicts_with_all = ["animate", "frames"], allow_negative_numbers = true)]
    frame: Option<i32>,
    /// What to write; the cache's name with `.png` if none is given.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Width and height in pixels.
    #[arg(long, default_value = "1280x720", value_parser = parse_size)]
    size: [u32; 2],
    /// Draw all frames, as an animated PNG.
    #[arg(long)]
    animate: bool,
    /// Frames to draw: so many (`48`) or from one to another (`10..58`).
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Draw only every so many frames.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// The camera of the scene to look through; `none` frames the run by itself. The first one if none is given.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["eye", "target"])]
    camera: Option<String>,
    /// Where the eye is, in scene units: `x,y,z`. The camera frames the run by itself if this is not given.
    #[arg(long, value_parser = parse_point, allow_hyphen_values = true)]
    eye: Option<[f32; 3]>,
    /// The point in the middle of the picture, in scene units; that of the run if not given.
    #[arg(long, value_parser = parse_point, allow_hyphen_values = true)]
    target: Option<[f32; 3]>,
    /// Vertical field of view in degrees.
    #[arg(long, default_value_t = 30.0, value_parser = parse_view)]
    fov: f32,
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
        let drawn = match Way::of(&out, self.animate)? {
            Way::Still => self.still(&mut cache, &out)?,
            way => self.film(&mut cache, &out, way)?,
        };
        output::tell(&format!("{drawn}\n"));
        Ok(Outcome::Fine)
    }

    fn still(&self, cache: &mut Playback, out: &Path) -> Result<String> {
        let moment = cache_file::moment(cache, self.frame)?;
        let frame = cache.time_samples()[moment].frame;
        // The floor is that of the whole run, found from a few of its frames.
        let (every, scene_camera) = (cache.time_samples().len() / 24, self.scene_camera(cache)?);
        let mut film = Film::of(cache, every, self.style())?;
        let camera = self.seen_from(film.framing(moment)?);
        film::picture(&look_through(film.seen_by(camera), scene_camera).moment(moment)?, out)?;
        Ok(format!("frame {frame} in {}", sized(out)?))
    }

    fn film(&self, cache: &mut Playback, out: &Path, way: Way) -> Result<String> {
        let start = cache.time_samples().first().context("the cache holds no frame")?.frame;
        let scene_camera = self.scene_camera(cache)?;
        let mut film = Film::of(cache, self.every as usize, self.style())?;
        if let Some(frames) = self.frames {
            let (first, last) = frames.within(start).context("there are not so many frames")?;
            film = film.between(first, last).context("none of these frames was recorded")?;
        }
        let camera = self.seen_from(film.camera());
        let mut film = look_through(film.seen_by(camera), scene_camera);
        let mut steps = Steps::new("drawing");
        let result = film::write(&mut film, out, way, self.size, &mut |share| steps.show(share));
        steps.end();
        let place = result?;
        let count = figures::count(film.len(), "frame");
        Ok(match way {
            Way::Sequence => format!("{count} in `{}`", place.display()),
            _ => format!("{count} in {}", sized(out)?),
        })
    }

    fn style(&self) -> Style {
        let colouring = match self.strain {
            Some(full_scale) => Colouring::Strain { full_scale },
            None => Colouring::Objects,
        };
        Style { size: self.size, colouring, wireframe: self.wireframe, ..Style::default() }
    }

    /// The camera of the scene that is looked through, if any is.
    fn scene_camera(&self, cache: &Playback) -> Result<Option<nucleus_cache::Camera>> {
        let cameras = &cache.run().cameras;
        if self.eye.is_some() || self.target.is_some() || self.camera.as_deref() == Some("none") {
            return Ok(None);
        }
        let Some(wanted) = &self.camera else { return Ok(cameras.first().cloned()) };
        let found = cameras.iter().find(|camera| camera.name == *wanted);
        let names: Vec<String> = cameras.iter().map(|camera| format!("`{}`", camera.name)).collect();
        let known = || match names.is_empty() {
            true => "the cache has none; a scene gets one by a node of type `camera`".to_owned(),
            false => format!("there is {}", names.join(", ")),
        };
        found.cloned().map(Some).with_context(|| format!("there is no camera `{wanted}`: {}", known()))
    }

    /// The camera as it was asked for; what was not asked for is as in `own`.
    fn seen_from(&self, own: Camera) -> Camera {
        let target = self.target.unwrap_or(own.target);
        match (self.eye, self.target) {
            (Some(eye), _) => Camera { eye, target, field_of_view: self.fov, ..own },
            (None, Some(_)) => {
                let eye = [0, 1, 2].map(|axis| own.eye[axis] - own.target[axis] + target[axis]);
                Camera { eye, target, field_of_view: self.fov, ..own }
            }
            (None, None) => own,
        }
    }
}

fn look_through<R>(film: Film<'_, R>, camera: Option<nucleus_cache::Camera>) -> Film<'_, R>
where
    R: std::io::Read + std::io::Seek,
{
    match camera {
        Some(camera) => film.seen_through(camera),
        None => film,
    }
}

/// `` `hang.gif` (1.2 MB) ``.
fn sized(path: &Path) -> Result<String> {
    Ok(format!("`{}` ({})", path.display(), figures::bytes(std::fs::metadata(path)?.len())))
}

fn parse_point(text: &str) -> Result<[f32; 3], String> {
    let numbers: Option<Vec<f32>> =
        text.split(',').map(|x| x.trim().parse().ok().filter(|x: &f32| x.is_finite())).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok([x, y, z]),
        _ => Err("write it as x,y,z".to_owned()),
    }
}

fn parse_view(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(angle) if (1.0..=150.0).contains(&angle) => Ok(angle),
        _ => Err("an angle of 1 to 150 degrees".to_owned()),
    }
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
