//! Many pictures: as a film, or each in a file of its own.

use std::fs;
use std::io::{ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use nucleus_cache::atomic_file::AtomicFile;
use nucleus_view::{AnimationWriter, Film, GifWriter, Image};

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// One picture.
    Still,
    /// An animated PNG.
    Png,
    Gif,
    /// A film by ffmpeg.
    Film,
    /// A picture for each frame.
    Sequence,
}

impl Way {
    /// What a name asks for.
    pub fn of(out: &Path, animate: bool) -> Result<Self> {
        let name = out.file_name().unwrap_or_default().to_string_lossy();
        let end = out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        Ok(match end.as_str() {
            "png" if name.contains('#') => Self::Sequence,
            "png" if animate => Self::Png,
            "png" => Self::Still,
            "gif" => Self::Gif,
            "mp4" | "mov" | "webm" => Self::Film,
            _ => bail!(
                "`{name}` is not .png, .gif, .mp4, .mov or .webm; `####` in a .png stands for frame numbers"
            ),
        })
    }
}

/// Writes a film; gives what was written, as a name. Nothing has its name before it is whole.
pub fn write<R: Read + Seek>(
    film: &mut Film<R>,
    out: &Path,
    way: Way,
    size: [u32; 2],
    told: &mut dyn FnMut(f64),
) -> Result<PathBuf> {
    match way {
        Way::Gif => {
            let mut file = GifWriter::create(out, size, film.fps())?;
            each(film, told, |image, _| Ok(file.push(image)?))?;
            file.finish()?;
        }
        Way::Film => {
            let unwritten = || format!("cannot write `{}`", out.display());
            let file = AtomicFile::create(out).with_context(unwritten)?;
            encode(film, file.temporary(), muxer(out), size, told)?;
            file.commit().with_context(unwritten)?;
        }
        Way::Sequence => {
            if let Some(folder) = out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                fs::create_dir_all(folder).with_context(|| format!("cannot make `{}`", folder.display()))?;
            }
            each(film, told, |image, frame| picture(image, &numbered(out, frame)))?;
        }
        Way::Still | Way::Png => {
            let mut file = AnimationWriter::create(out, size, film.fps())?;
            each(film, told, |image, _| Ok(file.push(image)?))?;
            file.finish()?;
        }
    }
    Ok(out.to_owned())
}

/// Writes one picture.
pub fn picture(image: &Image, out: &Path) -> Result<()> {
    Ok(image.write_png(out)?)
}

fn each<R: Read + Seek>(
    film: &mut Film<R>,
    told: &mut dyn FnMut(f64),
    mut take: impl FnMut(&Image, i32) -> Result<()>,
) -> Result<()> {
    for place in 0..film.len() {
        take(&film.picture(place)?, film.frame(place))?;
        told((place + 1) as f64 / film.len() as f64);
    }
    Ok(())
}

/// The name with the first run of `#` exchanged for the number of a frame.
fn numbered(out: &Path, frame: i32) -> PathBuf {
    let name = out.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let begin = name.find('#').unwrap_or(name.len());
    let width = name[begin..].bytes().take_while(|&byte| byte == b'#').count();
    out.with_file_name(format!("{}{frame:0width$}{}", &name[..begin], &name[begin + width..]))
}

/// What ffmpeg calls the format of a film.
fn muxer(out: &Path) -> &'static str {
    let end = out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    ["mov", "webm"].into_iter().find(|known| *known == end).unwrap_or("mp4")
}

/// Hands the pictures to ffmpeg.
fn encode<R: Read + Seek>(
    film: &mut Film<R>,
    out: &Path,
    muxer: &str,
    size: [u32; 2],
    told: &mut dyn FnMut(f64),
) -> Result<()> {
    let mut ffmpeg = start_ffmpeg(out, muxer, size, film.fps())?;
    let mut pipe = ffmpeg.stdin.take().context("ffmpeg takes no pictures")?;
    let sent =
        each(film, told, |image, _| pipe.write_all(image.bytes()).context("ffmpeg takes no more pictures"));
    drop(pipe);
    let mut said = String::new();
    if let Some(mut stderr) = ffmpeg.stderr.take() {
        stderr.read_to_string(&mut said)?;
    }
    let status = ffmpeg.wait()?;
    ensure!(status.success(), "ffmpeg could not write the film: {}", said.trim());
    sent
}

/// How pictures become a film: sides that are even, as players want them; colours as most of them take them to be,
/// BT.709 at half the resolution, and told so, for else they are guessed from the size.
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
    // Smooth shading in few colours shows bands where bits are spared.
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
    fn the_name_says_what_is_written() {
        let way = |name: &str| Way::of(Path::new(name), false).unwrap();
        assert_eq!(way("a.png"), Way::Still);
        assert_eq!(way("a.GIF"), Way::Gif);
        assert_eq!(way("a/b.####.png"), Way::Sequence);
        assert_eq!(way("a.mp4"), Way::Film);
        assert!(Way::of(Path::new("a.jpg"), true).is_err());
    }

    #[test]
    fn a_run_of_hashes_becomes_the_number_of_the_frame() {
        assert_eq!(numbered(Path::new("f/a.####.png"), 12), Path::new("f/a.0012.png"));
        assert_eq!(numbered(Path::new("#.png"), 123), Path::new("123.png"));
    }
}
