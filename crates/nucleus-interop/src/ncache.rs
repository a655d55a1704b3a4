//! Maya's nCache: an XML description, and per sample a big-endian file of nested blocks.
//!
//! Time is counted in ticks, of which a frame has a whole number: 1/6000 s each, or nearly so at rates such as 29.97. The
//! layout is that of caches written by Maya.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::ObjectKind;
use nucleus_core::Particle;

use crate::clip::{Clip, Sample};
use crate::error::ExportError;
use crate::output::{OutFile, Output, node_names};

const TICKS_PER_SECOND: f64 = 6000.0;

/// The width of the length fields in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Width {
    /// `.mc`.
    Bits32,
    /// `.mcx`.
    Bits64,
}

/// Checks that the times of all samples can be stated: ticks are 32-bit numbers.
///
/// # Errors
/// When a sample lies beyond the largest or before the smallest frame.
pub(crate) fn require_times<R: Read + Seek>(clip: &Clip<R>) -> Result<(), ExportError> {
    let largest = i32::MAX / ticks_per_frame(clip.fps());
    let outside = clip.samples().iter().find(|sample| sample.frame_time.abs() > f64::from(largest));
    match outside {
        None => Ok(()),
        Some(sample) => {
            let (frame, frames_per_second) = (sample.frame, clip.fps());
            Err(ExportError::FrameTooLarge { frame, largest, frames_per_second, format: "nCache" })
        }
    }
}

/// Writes `<object>.xml` and `<object>Frame<n>.mc` into a folder.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    width: Width,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let names = node_names(clip.objects().map(|object| object.name.as_str()));
    let per_frame = ticks_per_frame(clip.fps());
    for object in 0..names.len() {
        // Each file states the number of particles, so that number may change.
        if clip.objects().nth(object).is_some_and(|object| object.kind != ObjectKind::Particles) {
            clip.require_constant_topology(object, "nCache")?;
        }
    }
    let mut channels = Vec::with_capacity(names.len());
    for (object, name) in names.iter().enumerate() {
        channels.push(channels_of(clip, object, name)?);
    }
    for index in 0..clip.samples().len() {
        let sample = clip.samples()[index];
        let tick = ticks(sample.frame_time, per_frame);
        for (object, name) in names.iter().enumerate() {
            let file = format!("{name}{}.{}", numbered(&sample, tick, per_frame), width.end());
            let mut file = output.file(folder.join(file))?;
            write_sample(clip, object, index, &channels[object], Frame { tick, width }, &mut file)?;
            output.finish(file)?;
        }
        progress((index + 1) as f64 / clip.samples().len() as f64);
    }
    for (name, channels) in names.iter().zip(&channels) {
        let mut file = output.file(folder.join(format!("{name}.xml")))?;
        file.text(description(clip, channels, width, per_frame));
        output.finish(file)?;
    }
    Ok(())
}

/// A description states the ticks of a frame as a whole number, so frames must lie at its multiples.
fn ticks_per_frame(fps: f64) -> i32 {
    (TICKS_PER_SECOND / fps).round().max(1.0) as i32
}

fn ticks(frames: f64, per_frame: i32) -> i32 {
    (frames * f64::from(per_frame)).round() as i32
}

/// `Frame12` at the end of a frame, `Frame11Tick125` halfway to it.
fn numbered(sample: &Sample, tick: i32, per_frame: i32) -> String {
    match sample.ends_frame() {
        true => format!("Frame{}", sample.frame),
        false => {
            let before = i64::from(sample.frame) - 1;
            format!("Frame{before}Tick{}", i64::from(tick) - before * i64::from(per_frame))
        }
    }
}

/// Name, type and interpretation of a channel.
type Channel = (String, &'static str, &'static str);

const VECTORS: &str = "FloatVectorArray";
const NUMBERS: &str = "DoubleArray";

/// The largest number of single precision, which Maya writes for the lifespan of a particle that lives forever.
const FOREVER: f64 = f32::MAX as f64;

/// A fact about a particle, of its state and the time in seconds.
type Fact = fn(&Particle, f64) -> f64;

/// The channels of particles that are born or die.
const FACTS: [(&str, Fact); 5] = [
    ("mass", |particle, _| particle.mass),
    ("birthTime", |particle, now| now - particle.age),
    ("age", |particle, _| particle.age),
    ("finalLifespanPP", |particle, _| particle.lifespan.min(FOREVER)),
    ("lifespanPP", |particle, _| particle.lifespan.min(FOREVER)),
];

/// Whether the particles of an object have numbers of their own at any sample.
fn has_individual_particles<R: Read + Seek>(clip: &mut Clip<R>, object: usize) -> Result<bool, ExportError> {
    for sample in 0..clip.samples().len() {
        if clip.particles(object, sample)?.is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The channels of an object: positions for a mesh; for particles ids, count, positions, velocities where they are recorded,
/// and what differs by particle.
fn channels_of<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    name: &str,
) -> Result<Vec<Channel>, ExportError> {
    if !clip.object(object).faces.is_empty() {
        return Ok(vec![(name.to_owned(), VECTORS, "positions")]);
    }
    let mut kinds = vec![("id", NUMBERS), ("count", NUMBERS), ("position", VECTORS)];
    if clip.velocities(object, clip.samples().len() - 1)?.is_some() {
        kinds.push(("velocity", VECTORS));
    }
    if has_individual_particles(clip, object)? {
        kinds.extend(FACTS.map(|(kind, _)| (kind, NUMBERS)));
    }
    Ok(kinds.into_iter().map(|(kind, holds)| (format!("{name}_{kind}"), holds, kind)).collect())
}

fn description<R: Read + Seek>(clip: &Clip<R>, channels: &[Channel], width: Width, per_frame: i32) -> String {
    let ticks: Vec<i32> = clip.samples().iter().map(|sample| ticks(sample.frame_time, per_frame)).collect();
    let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
    let (sampling, rate) = sampling(&ticks, per_frame);
    let lines = channels.iter().enumerate().map(|(index, (name, holds, kind))| {
        format!(
            "    <channel{index} ChannelName=\"{name}\" ChannelType=\"{holds}\" ChannelInterpretation=\"{kind}\" \
             SamplingType=\"{sampling}\" SamplingRate=\"{rate}\" StartTime=\"{first}\" EndTime=\"{last}\"/>\n"
        )
    });
    format!(
        "<?xml version=\"1.0\"?>\n<Autodesk_Cache_File>\n  <cacheType Type=\"OneFilePerFrame\" Format=\"{}\"/>\n  \
         <time Range=\"{first}-{last}\"/>\n  <cacheTimePerFrame TimePerFrame=\"{per_frame}\"/>\n  \
         <cacheVersion Version=\"2.0\"/>\n  <extra>written by Nucleus</extra>\n  <Channels>\n{}  </Channels>\n\
         </Autodesk_Cache_File>\n",
        width.word(),
        lines.collect::<String>(),
    )
}

/// The type and the rate of the sampling: the distance of neighbouring samples in ticks, the least one if it varies.
fn sampling(ticks: &[i32], per_frame: i32) -> (&'static str, i64) {
    let steps = || ticks.windows(2).map(|pair| i64::from(pair[1]) - i64::from(pair[0]));
    let per_frame = i64::from(per_frame);
    let (least, most) = (steps().min().unwrap_or(per_frame), steps().max().unwrap_or(per_frame));
    (if least == most { "Regular" } else { "Irregular" }, least)
}

/// The time of a file and the width of its length fields.
#[derive(Clone, Copy)]
struct Frame {
    tick: i32,
    width: Width,
}

fn write_sample<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    sample: usize,
    channels: &[Channel],
    frame: Frame,
    file: &mut OutFile,
) -> Result<(), ExportError> {
    let positions = clip.positions(object, sample)?;
    let count = positions.len();
    let particles = clip.particles(object, sample)?;
    let now = clip.samples()[sample].frame_time / clip.fps();
    let mut body = Vec::new();
    for (name, holds, kind) in channels {
        let data = match *kind {
            "id" => match &particles {
                Some(particles) => numbers(particles.iter().map(|particle| particle.id as f64)),
                None => numbers((0..count).map(|id| id as f64)),
            },
            "count" => numbers([count as f64]),
            "velocity" => vectors(&clip.velocities(object, sample)?.unwrap_or_else(|| vec![[0.0; 3]; count])),
            _ => match FACTS.iter().find(|(fact, _)| fact == kind) {
                Some((_, fact)) => numbers(particles.iter().flatten().map(|particle| fact(particle, now))),
                None => vectors(&positions),
            },
        };
        let (tag, size) = match *holds {
            NUMBERS => (b"DBLA", data.len() / size_of::<f64>()),
            _ => (b"FVCA", count),
        };
        frame.width.block(b"CHNM", &[name.as_bytes(), b"\0"].concat(), &mut body);
        frame.width.block(b"SIZE", &(size as u32).to_be_bytes(), &mut body);
        frame.width.block(tag, &data, &mut body);
    }
    file.bytes(&frame.width.head(frame.tick));
    file.bytes(&frame.width.group(b"MYCH", &body));
    Ok(())
}

fn numbers(values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    values.into_iter().flat_map(f64::to_be_bytes).collect()
}

fn vectors(values: &[[f32; 3]]) -> Vec<u8> {
    values.as_flattened().iter().flat_map(|x| x.to_be_bytes()).collect()
}

impl Width {
    fn end(self) -> &'static str {
        match self {
            Self::Bits32 => "mc",
            Self::Bits64 => "mcx",
        }
    }

    /// The name of the format in a description.
    fn word(self) -> &'static str {
        match self {
            Self::Bits32 => "mcc",
            Self::Bits64 => "mcx",
        }
    }

    /// Appends a tag and a length.
    fn length(self, tag: &[u8; 4], length: usize, out: &mut Vec<u8>) {
        out.extend_from_slice(tag);
        match self {
            Self::Bits32 => out.extend_from_slice(&(length as u32).to_be_bytes()),
            Self::Bits64 => {
                out.extend_from_slice(&[0; 4]);
                out.extend_from_slice(&(length as u64).to_be_bytes());
            }
        }
    }

    /// Appends a block, padded with zeros; the stated length excludes the padding.
    fn block(self, tag: &[u8; 4], data: &[u8], out: &mut Vec<u8>) {
        let step = if self == Self::Bits32 { 4 } else { 8 };
        self.length(tag, data.len(), out);
        out.extend_from_slice(data);
        out.resize(out.len() + (data.len().next_multiple_of(step) - data.len()), 0);
    }

    /// A group of blocks.
    fn group(self, kind: &[u8; 4], blocks: &[u8]) -> Vec<u8> {
        let mut out = Vec::with_capacity(blocks.len() + 20);
        self.length(if self == Self::Bits32 { b"FOR4" } else { b"FOR8" }, 4 + blocks.len(), &mut out);
        out.extend_from_slice(kind);
        out.extend_from_slice(blocks);
        out
    }

    /// The header of a file of one sample.
    fn head(self, tick: i32) -> Vec<u8> {
        let mut blocks = Vec::new();
        self.block(b"VRSN", b"0.1\0", &mut blocks);
        self.block(b"STIM", &tick.to_be_bytes(), &mut blocks);
        self.block(b"ETIM", &tick.to_be_bytes(), &mut blocks);
        self.group(b"CACH", &blocks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(hex: &str) -> Vec<u8> {
        let digits: Vec<u8> = hex.bytes().filter(u8::is_ascii_hexdigit).collect();
        digits
            .chunks(2)
            .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap())
            .collect()
    }

    fn sample(width: Width, tick: i32, name: &str, tag: &[u8; 4], size: u32, data: &[u8]) -> Vec<u8> {
        let mut body = Vec::new();
        width.block(b"CHNM", &[name.as_bytes(), b"\0"].concat(), &mut body);
        width.block(b"SIZE", &size.to_be_bytes(), &mut body);
        width.block(tag, data, &mut body);
        [width.head(tick), width.group(b"MYCH", &body)].concat()
    }

    /// The first bytes of a file that Maya wrote: 349 points of `nClothShape1` at frame 3.
    #[test]
    fn a_32_bit_file_begins_with_the_bytes_that_maya_writes() {
        let maya = bytes(
            "464f5234 00000028 43414348 5652534e 00000004 302e3100 5354494d 00000004 000002ee 4554494d 00000004
             000002ee 464f5234 0000108c 4d594348 43484e4d 0000000d 6e436c6f 74685368 61706531 00000000
             53495a45 00000004 0000015d 46564341 0000105c",
        );
        let ours = sample(Width::Bits32, 750, "nClothShape1", b"FVCA", 349, &[0; 12 * 349]);
        assert_eq!(ours[..maya.len()], maya);
        assert_eq!(ours.len(), 4292, "the length of that file");
    }

    /// Blocks of a file that Maya wrote with 64-bit lengths. Maya leaves the four bytes after a tag undefined; here they
    /// are zero.
    #[test]
    fn blocks_of_64_bit_have_the_layout_that_maya_writes() {
        let head = bytes(
            "464f5238 00000000 00000000 0000004c 43414348 5652534e 00000000 00000000 00000004 302e3100 00000000
             5354494d 00000000 00000000 00000004 000000fa 00000000 4554494d 00000000 00000000 00000004 000000fa
             00000000",
        );
        assert_eq!(Width::Bits64.head(250), head);
        let mut name = Vec::new();
        Width::Bits64.block(b"CHNM", b"nParticleShape1_count\0", &mut name);
        assert_eq!(name.len(), 16 + 24);
        assert_eq!(name[12..16], [0, 0, 0, 22]);
    }

    #[test]
    fn frames_lie_at_multiples_of_the_ticks_of_a_frame() {
        for (fps, per_frame) in [(24.0, 250), (30.0, 200), (23.976, 250), (29.97, 200), (59.94, 100)] {
            assert_eq!(ticks_per_frame(fps), per_frame, "{fps}");
        }
        assert_eq!((ticks(1.0, 250), ticks(-1.0, 200), ticks(2.5, 250)), (250, -200, 625));
    }

    #[test]
    fn sampling_is_regular_if_all_steps_are_the_same_number_of_ticks() {
        assert_eq!(sampling(&[250, 375, 500], 250), ("Regular", 125));
        assert_eq!(sampling(&[83, 167, 250], 250), ("Irregular", 83));
        assert_eq!(sampling(&[500], 250), ("Regular", 250));
    }
}
