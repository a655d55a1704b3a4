//! Output of `nucleus render`: a still, an animation, a film by ffmpeg, or a sequence of pictures.

use std::fmt;
use std::io::{ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::thread;

use anyhow::{Context, Result, bail, ensure};
use nucleus_cache::atomic_file::AtomicFile;
use nucleus_view::{AnimationWriter, Film, GifWriter, Image};

use crate::process;

/// Kinds of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutputKind {
    /// A PNG or EXR.
    Still,
    AnimatedPng,
    Gif,
    /// A film that ffmpeg encodes.
    Film,
    /// A PNG or EXR per frame.
    Sequence,
}

impl OutputKind {
    /// The kind that a file name implies. `may_be_pattern`: a `#` in it stands for the frame number.
    pub fn of(out: &Path, animate: bool, may_be_pattern: bool) -> Result<Self> {
        let name = out.file_name().unwrap_or_default().to_string_lossy();
        let end = out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        Ok(match end.as_str() {
            "png" | "exr" if may_be_pattern && name.contains('#') => Self::Sequence,
            "png" if animate => Self::AnimatedPng,
            "png" | "exr" => Self::Still,
            "gif" => Self::Gif,
            "mp4" | "mov" | "webm" => Self::Film,
            _ => bail!(
                "`{name}` does not end with .png, .exr, .gif, .mp4, .mov or .webm; `####` in the name of a .png or .exr stands for the frame number"
            ),
        })
    }
}

/// Writes the frames of a film and returns the path. `report` receives the share that is done, from 0 to 1.
///
/// A file has its final name only when it is complete.
pub fn write<R: Read + Seek>(
    film: &mut Film<R>,
    out: &Path,
    kind: OutputKind,
    size: [u32; 2],
    report: &mut dyn FnMut(f64),
) -> Result<PathBuf> {
    match kind {
        OutputKind::Gif => {
            let mut file = GifWriter::create(out, size)?;
            each(film, report, |image, shown| Ok(file.push(image, shown.seconds)?))?;
            file.finish()?;
        }
        OutputKind::Film => {
            let unwritten = || format!("cannot write `{}`", out.display());
            let file = AtomicFile::create(out).with_context(unwritten)?;
            encode(film, file.temporary(), muxer(out), size, report)?;
            file.commit().with_context(unwritten)?;
        }
        OutputKind::Sequence => {
            each(film, report, |image, shown| {
                let out = numbered(out, shown.frame);
                Ok(if is_exr(&out) { image.write_exr(out) } else { image.write_png_fast(out) }?)
            })?;
        }
        OutputKind::Still | OutputKind::AnimatedPng => {
            let mut file = AnimationWriter::create(out, size)?;
            each(film, report, |image, shown| Ok(file.push(image, shown.seconds)?))?;
            file.finish()?;
        }
    }
    Ok(out.to_owned())
}

/// The command was interrupted; its unfinished files are gone.
#[derive(Debug)]
pub struct Interrupted;

impl fmt::Display for Interrupted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("interrupted")
    }
}

impl std::error::Error for Interrupted {}

/// Writes one picture.
pub fn picture(image: &Image, out: &Path) -> Result<()> {
    Ok(if is_exr(out) { image.write_exr(out) } else { image.write_png(out) }?)
}

/// Whether a file is an EXR picture by its name.
pub fn is_exr(out: &Path) -> bool {
    out.extension().is_some_and(|end| end.eq_ignore_ascii_case("exr"))
}

/// When a picture is shown.
struct Shown {
    frame: i32,
    seconds: f64,
}

/// Draws each picture, and passes it to `take` in another thread, which encodes it while the next one is drawn.
fn each<R: Read + Seek>(
    film: &mut Film<R>,
    report: &mut dyn FnMut(f64),
    mut take: impl FnMut(&Image, &Shown) -> Result<()> + Send,
) -> Result<()> {
    let (pictures, drawn) = mpsc::sync_channel::<(Image, Shown)>(1);
    thread::scope(|scope| {
        let taker = scope.spawn(move || drawn.iter().try_for_each(|(image, shown)| take(&image, &shown)));
        let sent = draw_all(film, report, |image, shown| pictures.send((image, shown)).is_ok());
        drop(pictures);
        let taken = taker.join().expect("a writer does not panic");
        // Ctrl-C reaches ffmpeg too, whose end then is no error of its own.
        if taken.is_err() && process::is_interrupted() {
            bail!(Interrupted);
        }
        // A picture is refused after an error of `take`, which then is the cause.
        taken.and(sent)
    })
}

/// Draws all pictures until one is refused.
fn draw_all<R: Read + Seek>(
    film: &mut Film<R>,
    report: &mut dyn FnMut(f64),
    mut give: impl FnMut(Image, Shown) -> bool,
) -> Result<()> {
    for place in 0..film.len() {
        if process::is_interrupted() {
            bail!(Interrupted);
        }
        let shown = Shown { frame: film.frame(place), seconds: film.duration(place) };
        if !give(film.picture(place)?, shown) {
            break;
        }
        report((place + 1) as f64 / film.len() as f64);
    }
    Ok(())
}

/// The path with the first run of `#` replaced by a frame number of at least that many digits.
fn numbered(out: &Path, frame: i32) -> PathBuf {
    let name = out.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let begin = name.find('#').unwrap_or(name.len());
    let width = name[begin..].bytes().take_while(|&byte| byte == b'#').count();
    out.with_file_name(format!("{}{frame:0width$}{}", &name[..begin], &name[begin + width..]))
}

/// The name of the film's format in ffmpeg.
fn muxer(out: &Path) -> &'static str {
    let end = out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    ["mov", "webm"].into_iter().find(|known| *known == end).unwrap_or("mp4")
}

/// Pipes the pictures to ffmpeg.
fn encode<R: Read + Seek>(
    film: &mut Film<R>,
    out: &Path,
    muxer: &str,
    size: [u32; 2],
    report: &mut dyn FnMut(f64),
) -> Result<()> {
    let fps = film.fps();
    let mut ffmpeg = start_ffmpeg(out, muxer, size, fps)?;
    let mut pipe = ffmpeg.stdin.take().context("ffmpeg has no standard input")?;
    let sent = each(film, report, |image, shown| {
        let mut ticks = 0..(shown.seconds * fps).round() as usize;
        let sent = ticks.try_for_each(|_| pipe.write_all(image.bytes()));
        sent.context("ffmpeg stopped before the last picture")
    });
    drop(pipe);
    let mut said = String::new();
    if let Some(mut stderr) = ffmpeg.stderr.take() {
        stderr.read_to_string(&mut said)?;
    }
    let status = ffmpeg.wait()?;
    if let Err(error) = &sent
        && error.is::<Interrupted>()
    {
        return sent;
    }
    ensure!(status.success(), "ffmpeg could not write the film: {}", said.trim());
    sent
}

/// Encoding that players support: even sides, and BT.709 colours at half resolution. The colour space is tagged, because
/// players otherwise guess it from the size.
const PICTURES: [&str; 10] = [
    "-vf",
    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
    "-colorspace",
    "bt709",
    "-color_primaries",
    "bt709",
    "-color_trc",
    "bt709",
    "-color_range",
    "tv",
];

fn start_ffmpeg(out: &Path, muxer: &str, [width, height]: [u32; 2], fps: f64) -> Result<Child> {
    let mut command = Command::new("ffmpeg");
    command.args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]);
    command.args(["-s", &format!("{width}x{height}"), "-r", &fps.to_string(), "-i", "-"]).args(PICTURES);
    // Smooth shading shows bands at lower quality.
    command.args(match muxer {
        "webm" => ["-crf", "24", "-b:v", "0"],
        _ => ["-crf", "16", "-movflags", "+faststart"],
    });
    command.args(["-f", muxer]).arg(out);
    let started = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
    started.map_err(|error| match error.kind() {
        ErrorKind::NotFound => {
            anyhow::anyhow!("ffmpeg is not installed; write a .gif, or pictures as `frames/####.png`")
        }
        _ => anyhow::Error::from(error).context("ffmpeg cannot be started"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_determines_the_kind_of_output() {
        let kind = |name: &str| OutputKind::of(Path::new(name), false, true).unwrap();
        assert_eq!(kind("a.png"), OutputKind::Still);
        assert_eq!(kind("a.GIF"), OutputKind::Gif);
        assert_eq!([kind("a.exr"), kind("a.EXR")], [OutputKind::Still; 2]);
        assert_eq!([kind("a/b.####.png"), kind("b.#.exr")], [OutputKind::Sequence; 2]);
        assert_eq!(kind("a.mp4"), OutputKind::Film);
        assert!(OutputKind::of(Path::new("a.jpg"), true, true).is_err());
    }

    #[test]
    fn a_run_of_hashes_becomes_the_frame_number() {
        assert_eq!(numbered(Path::new("f/a.####.png"), 12), Path::new("f/a.0012.png"));
        assert_eq!(numbered(Path::new("#.png"), 123), Path::new("123.png"));
    }
}
