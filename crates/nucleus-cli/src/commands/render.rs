//! `nucleus render`: draws a cache as a still, an animation, a film or a sequence of pictures.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use nucleus_cache::Playback;
use nucleus_view::{Background, Camera, Colouring, Film, GifWriter, Image, Style};

use super::film::{self, Interrupted, OutputKind};
use crate::object_names;
use crate::options::{self, FrameRange};
use crate::process::Outcome;
use crate::progress::ShareProgress;
use crate::{figures, files, output, process};

/// Draws a cache: a frame as a PNG or EXR, or the run as an animated PNG, a GIF, a film, or a picture per frame.
///
/// The name of the output determines its kind: `hang.png` is a still, or an animated PNG with --animate; `hang.exr` is a
/// still with linear colours; `hang.gif` is a GIF; `hang.mp4`, `.mov` and `.webm` are films, for which ffmpeg must be
/// installed; `frames/hang.####.png` (or `.exr`) is a picture per frame, with the frame number.
#[derive(Debug, Args)]
pub struct Render {
    /// The cache (.mcap).
    file: PathBuf,
    /// The frame to draw; default: the last one.
    #[arg(long, conflicts_with_all = ["animate", "frames"], allow_negative_numbers = true)]
    frame: Option<i32>,
    /// The file to write; default: the name of the cache with `.png`.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Width and height in pixels.
    #[arg(long, default_value = "1280x720", value_parser = parse_size)]
    size: [u32; 2],
    /// Draw all frames as an animated PNG.
    #[arg(long)]
    animate: bool,
    /// Frames to draw: a count (`48`) or a range (`10..58`); default: all.
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Draw every Nth frame.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    every: Option<u32>,
    /// The camera of the scene; `none` selects an automatic camera. Default: the first camera of the scene.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["eye", "target"])]
    camera: Option<String>,
    /// Position of the camera in scene units, `x,y,z`; default: automatic.
    #[arg(long, value_parser = parse_point, allow_hyphen_values = true)]
    eye: Option<[f32; 3]>,
    /// The point at the centre of the picture in scene units, `x,y,z`; default: the centre of the run.
    #[arg(long, value_parser = parse_point, allow_hyphen_values = true)]
    target: Option<[f32; 3]>,
    /// Vertical field of view in degrees, with --eye or --target; default: 30.
    #[arg(long, value_parser = parse_view)]
    fov: Option<f32>,
    /// Colour cloth by its strain, with full colour at this strain (0.05 is 5 %).
    #[arg(long, value_name = "FULL_SCALE", num_args = 0..=1, default_missing_value = "0.05", value_parser = parse_strain)]
    strain: Option<f32>,
    /// Draw the edges of the faces.
    #[arg(long)]
    wireframe: bool,
    /// Draw the surface of particles as a mesh, instead of the particles: for liquids.
    #[arg(long)]
    surface: bool,
    /// What is behind the objects: `studio`, a colour `#rrggbb`, or `none` for a still with opacities and without a floor.
    #[arg(long, value_name = "BACKGROUND", default_value = "studio", value_parser = parse_background)]
    background: Background,
    /// An object that is not drawn, by its name or a pattern with `*` and `?`; may be given several times. It casts no shadow,
    /// and the automatic camera does not frame it.
    #[arg(long, value_name = "NAME")]
    hide: Vec<String>,
    /// Colour of an object, `cloth=#aa3322`, or of several, `drop*=#3366aa`; may be given several times.
    #[arg(long, value_name = "NAME=COLOUR", value_parser = parse_tint)]
    tint: Vec<(String, [f32; 3])>,
    /// Samples along each side of a pixel, for smooth edges.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=8))]
    samples: u32,
}

/// Vertical field of view in degrees of a camera of `--eye` or `--target`.
const DEFAULT_VIEW: f32 = 30.0;

impl Render {
    /// Draws and writes the output.
    pub fn run(self) -> Result<Outcome> {
        let mut cache = files::open_cache_and_warn(&self.file)?;
        let out = match &self.out {
            Some(out) => out.clone(),
            None => {
                PathBuf::from(self.file.file_stem().context("the cache has no name")?).with_extension("png")
            }
        };
        files::refuse_own_input(&self.file, &out)?;
        let kind = OutputKind::of(&out, self.animate, self.out.is_some())?;
        self.check_options(&cache, kind)?;
        files::make_folder_of(&out)?;
        let is_still = matches!(kind, OutputKind::Still | OutputKind::Sequence);
        ensure!(
            is_still || self.background != Background::Transparent,
            "a film has no opacities; `--background none` is for a .png or .exr, or for pictures as `frames/####.png`"
        );
        let drawn = match kind {
            OutputKind::Still => self
                .still(&mut cache, &out)
                .map_err(|error| files::with_remedy(error, &self.file, "--frame"))?,
            kind => {
                process::listen_for_signals()?;
                match self.film(&mut cache, &out, kind) {
                    // Unfinished files are removed on the way here.
                    Err(error) if error.is::<Interrupted>() => return Ok(Outcome::Interrupted),
                    drawn => drawn.map_err(|error| files::with_remedy(error, &self.file, "--frames"))?,
                }
            }
        };
        output::report(&format!("{drawn}\n"));
        Ok(Outcome::Success)
    }

    /// Refuses options that would have no effect.
    fn check_options(&self, cache: &Playback, kind: OutputKind) -> Result<()> {
        if kind == OutputKind::Still {
            let several = [
                (self.frames.is_some(), "--frames"),
                (self.every.is_some(), "--every"),
                (self.animate, "--animate"),
            ];
            if let Some((_, option)) = several.iter().find(|(is_given, _)| *is_given) {
                bail!(
                    "`{option}` is for several frames, and the output is a still: `--animate` makes an animated .png; a .gif, \
                     .mp4, .mov or .webm is a film; `####.png` in the name is a picture per frame"
                );
            }
        }
        ensure!(
            kind == OutputKind::Still || self.frame.is_none(),
            "`--frame` is for a still (.png or .exr); `--frames` selects those of a film"
        );
        ensure!(
            self.fov.is_none() || self.eye.is_some() || self.target.is_some(),
            "`--fov` is for a camera of `--eye` or `--target`; other cameras have their own"
        );
        ensure!(
            !self.surface || files::has_particles(cache),
            "`--surface` is for particles, and the cache has none"
        );
        Ok(())
    }

    fn still(&self, cache: &mut Playback, out: &Path) -> Result<String> {
        let moment = files::moment(cache, self.frame)?;
        let frame = cache.time_samples()[moment].frame;
        // Camera and floor are those of the whole run, estimated from 24 of its frames.
        let (every, scene_camera) = (cache.time_samples().len() / 24, self.scene_camera(cache)?);
        let film = Film::of(cache, every, self.style(cache, out)?)?;
        let camera = self.with_options(film.camera())?;
        film::picture(&look_through(film.seen_by(camera), scene_camera).moment(moment)?, out)?;
        Ok(format!("frame {frame} in {}", sized(out)?))
    }

    fn film(&self, cache: &mut Playback, out: &Path, kind: OutputKind) -> Result<String> {
        ensure!(!cache.time_samples().is_empty(), "the cache holds no frame");
        let scene_camera = self.scene_camera(cache)?;
        let frames = self.frames.map(|frames| files::frames_of(frames, cache, &self.file)).transpose()?;
        let mut film = Film::of(cache, self.every.unwrap_or(1) as usize, self.style(cache, out)?)?;
        if let Some((first, last)) = frames {
            film = film.between(first, last).with_context(|| format!("frames {first} to {last}"))?;
        }
        let recorded = film.len();
        if kind == OutputKind::Gif {
            film = film.at_most(GifWriter::MAX_FPS);
        }
        let camera = self.with_options(film.camera())?;
        let mut film = look_through(film.seen_by(camera), scene_camera);
        let mut progress = ShareProgress::new("drawing");
        let result = film::write(&mut film, out, kind, self.size, &mut |share| progress.show(share));
        progress.end();
        let place = result?;
        let count = match film.len() {
            all if all == recorded => figures::count(all, "frame"),
            some => format!("{some} of {}", figures::count(recorded, "frame")),
        };
        let note = match film.len() < recorded {
            true => format!("; a GIF shows at most {} pictures a second", GifWriter::MAX_FPS),
            false => String::new(),
        };
        Ok(match kind {
            OutputKind::Sequence => format!("{count} in `{}`", place.display()),
            _ => format!("{count} in {}{note}", sized(out)?),
        })
    }

    fn style(&self, cache: &Playback, out: &Path) -> Result<Style> {
        let colouring = match self.strain {
            Some(full_scale) => Colouring::Strain { full_scale },
            None => Colouring::Objects,
        };
        let (mut hidden, mut tints) = (Vec::new(), Vec::new());
        for pattern in &self.hide {
            hidden.extend(object_names::matching(cache, "--hide", pattern)?);
        }
        for (pattern, colour) in &self.tint {
            let names = object_names::matching(cache, "--tint", pattern)?;
            tints.extend(names.into_iter().map(|name| (name, *colour)));
        }
        Ok(Style {
            size: self.size,
            colouring,
            wireframe: self.wireframe,
            surfaces: self.surface,
            background: self.background,
            tints,
            hidden,
            samples: self.samples,
            keeps_linear: film::is_exr(out),
            ..Style::default()
        })
    }

    /// The requested camera of the scene, else its first one.
    fn scene_camera(&self, cache: &Playback) -> Result<Option<nucleus_cache::Camera>> {
        let cameras = &cache.run().cameras;
        if self.eye.is_some() || self.target.is_some() || self.camera.as_deref() == Some("none") {
            return Ok(None);
        }
        let Some(wanted) = &self.camera else { return Ok(cameras.first().cloned()) };
        let found = cameras.iter().find(|camera| camera.name == *wanted);
        let names: Vec<String> = cameras.iter().map(|camera| format!("`{}`", camera.name)).collect();
        let known = || match names.is_empty() {
            true => "the cache has none; add a node of type `camera` to the scene".to_owned(),
            false => format!("there is {}", names.join(", ")),
        };
        found.cloned().map(Some).with_context(|| format!("there is no camera `{wanted}`: {}", known()))
    }

    /// A camera with `--eye`, `--target` and `--fov` applied.
    fn with_options(&self, own: Camera) -> Result<Camera> {
        let target = self.target.unwrap_or(own.target);
        let field_of_view = self.fov.unwrap_or(DEFAULT_VIEW);
        Ok(match (self.eye, self.target) {
            (Some(eye), _) => {
                ensure!(eye != target, "`--eye` and `--target` are one point, so the camera looks nowhere");
                Camera { eye, target, field_of_view, ..own }
            }
            (None, Some(_)) => {
                let eye = [0, 1, 2].map(|axis| own.eye[axis] - own.target[axis] + target[axis]);
                Camera { eye, target, field_of_view, ..own }
            }
            (None, None) => own,
        })
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

/// A colour `#rrggbb` as linear red, green and blue.
fn parse_colour(text: &str) -> Result<[f32; 3], String> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii());
    let channel = |k: usize| u8::from_str_radix(digits?.get(2 * k..2 * k + 2)?, 16).ok();
    match [channel(0), channel(1), channel(2)] {
        // Pictures are encoded with a square root.
        [Some(red), Some(green), Some(blue)] => {
            Ok([red, green, blue].map(|x| (f32::from(x) / 255.0).powi(2)))
        }
        _ => Err(format!("`{text}` is no colour; write it as #rrggbb")),
    }
}

fn parse_background(text: &str) -> Result<Background, String> {
    match text {
        "studio" => Ok(Background::Studio),
        "none" => Ok(Background::Transparent),
        text => parse_colour(text).map(Background::Colour),
    }
}

fn parse_tint(text: &str) -> Result<(String, [f32; 3]), String> {
    let (name, colour) = text.rsplit_once('=').ok_or("write it as name=#rrggbb")?;
    Ok((name.to_owned(), parse_colour(colour)?))
}

fn parse_strain(text: &str) -> Result<f32, String> {
    options::positive(text).map(|strain| strain as f32)
}

fn parse_view(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(angle) if (1.0..=150.0).contains(&angle) => Ok(angle),
        _ => Err("give an angle from 1 to 150 degrees".to_owned()),
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
