//! Maya's nCache: an XML description, and big-endian files of nested blocks, one for all frames or one for each.
//!
//! Only files beside the description with its name are read; no name in a file leads elsewhere. Sizes in a file are only
//! believed as far as its bytes reach.

use std::path::{Path, PathBuf};

use crate::ascii::ImportError;

/// Largest file of a cache that is read, in bytes.
const MAX_BYTES: u64 = 4 << 30;

/// Half a tick, with the rounding error of a time that lies exactly between two ticks.
const HALF_TICK: f64 = 0.5 + 1e-6;

/// A cache: its samples in the order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct NCache {
    /// The samples.
    pub samples: Vec<CacheSample>,
    /// Ticks of a frame, in which the samples state their times.
    ticks_per_frame: f64,
}

/// All channels at one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CacheSample {
    /// The frame; a fraction is a time between frames.
    pub frame: f64,
    /// The channels.
    pub channels: Vec<CacheChannel>,
}

/// A channel at one time: `nClothShape1`, `nParticleShape1_position`.
#[derive(Debug, Clone, PartialEq)]
pub struct CacheChannel {
    /// The name.
    pub name: String,
    /// The values.
    pub data: ChannelData,
}

/// The values of a channel.
#[derive(Debug, Clone, PartialEq)]
pub enum ChannelData {
    /// A vector for each point; lengths in scene units.
    Vectors(Vec<[f64; 3]>),
    /// A number for each point, or one for all.
    Numbers(Vec<f64>),
}

impl NCache {
    /// Reads a cache by its description (`.xml`), or a single file of it (`.mc`, `.mcx`) with 250 ticks in a frame.
    ///
    /// # Errors
    /// When a file cannot be read, or is cut off; the message names the file.
    pub fn read(path: &Path) -> Result<Self, ImportError> {
        let is_description = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("xml"));
        let (files, ticks) = if is_description {
            let text = String::from_utf8_lossy(&bytes(path)?).into_owned();
            let ticks = attribute(&text, "TimePerFrame").and_then(|ticks| ticks.parse().ok());
            let end = match attribute(&text, "Format") {
                Some("mcx") => "mcx",
                Some("mcc" | "mc") => "mc",
                _ => return Err(malformed(path, "the description names no format of nCache")),
            };
            (files_of(path, end)?, ticks.filter(|ticks: &f64| *ticks > 0.0).unwrap_or(250.0))
        } else {
            (vec![path.to_owned()], 250.0)
        };
        let mut cache = Self { samples: Vec::new(), ticks_per_frame: ticks };
        for file in files {
            cache.add(&file)?;
        }
        cache.samples.sort_by(|a, b| a.frame.total_cmp(&b.frame));
        Ok(cache)
    }

    /// Objects with positions: the names of their shapes.
    pub fn objects(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for channel in self.samples.iter().flat_map(|sample| &sample.channels) {
            if let Some(name) = channel.object().filter(|name| !names.contains(name)) {
                names.push(name);
            }
        }
        names
    }

    /// The sample at a frame, to half a tick: times are whole ticks, and a fraction of a frame need not be. `None` if there
    /// is none.
    pub fn sample_at(&self, frame: f64) -> Option<&CacheSample> {
        self.samples.iter().find(|sample| (sample.frame - frame).abs() * self.ticks_per_frame <= HALF_TICK)
    }

    /// The positions of an object at a frame, to half a tick; `None` if the cache has none there.
    pub fn positions(&self, object: &str, frame: f64) -> Option<&[[f64; 3]]> {
        self.sample_at(frame)?.positions(object)
    }

    /// The samples before and after a frame, and the share of the later one. `None` outside of the recording, and where the
    /// samples are further apart than a frame and than the closest ones of the cache: frames are missing there.
    pub fn samples_around(&self, frame: f64) -> Option<([&CacheSample; 2], f64)> {
        let after = self.samples.partition_point(|sample| sample.frame <= frame);
        let pair = [self.samples.get(after.checked_sub(1)?)?, self.samples.get(after)?];
        let distance = pair[1].frame - pair[0].frame;
        let is_gap = (distance - self.interval()) * self.ticks_per_frame > 2.0 * HALF_TICK;
        (!is_gap).then(|| (pair, (frame - pair[0].frame) / distance))
    }

    /// The distance of samples in frames: one, or that of the closest if they are further apart.
    fn interval(&self) -> f64 {
        let distances = self.samples.windows(2).map(|pair| pair[1].frame - pair[0].frame);
        let least = distances.filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least.max(1.0) } else { 1.0 }
    }

    /// The whole frames at which an object has positions, in order.
    pub fn whole_frames(&self, object: &str) -> Vec<i32> {
        let has =
            |sample: &&CacheSample| sample.channels.iter().any(|channel| channel.object() == Some(object));
        let frames = self.samples.iter().filter(has).map(|sample| sample.frame);
        let mut frames: Vec<i32> =
            frames.filter(|frame| frame.fract() == 0.0).map(|frame| frame as i32).collect();
        frames.dedup();
        frames
    }

    /// The time of a tick in frames; a whole number within half a tick of it, where a frame has no whole number of ticks.
    fn frame_at(&self, tick: f64) -> f64 {
        let frame = tick / self.ticks_per_frame;
        let is_whole = (frame - frame.round()).abs() * self.ticks_per_frame <= HALF_TICK;
        if is_whole { frame.round() } else { frame }
    }

    /// Adds the samples of a file.
    fn add(&mut self, file: &Path) -> Result<(), ImportError> {
        let all = bytes(file)?;
        let cut = || malformed(file, "the file is cut off, or is no nCache");
        let mut reader = Reader::of(&all).ok_or_else(cut)?;
        let mut tick = 0.0;
        while let Some(group) = reader.group() {
            let (kind, mut blocks) = group.ok_or_else(cut)?;
            let mut sample = CacheSample { frame: self.frame_at(tick), channels: Vec::new() };
            let mut name = String::new();
            while let Some(block) = blocks.block() {
                let (tag, data) = block.ok_or_else(cut)?;
                match &tag {
                    b"STIM" if &kind == b"CACH" => tick = f64::from(whole(data).ok_or_else(cut)?),
                    b"TIME" => sample.frame = self.frame_at(f64::from(whole(data).ok_or_else(cut)?)),
                    b"CHNM" => name = String::from_utf8_lossy(data).trim_end_matches('\0').to_owned(),
                    b"FVCA" | b"DVCA" | b"DBLA" | b"FBCA" => {
                        sample
                            .channels
                            .push(CacheChannel { name: std::mem::take(&mut name), data: values(&tag, data) });
                    }
                    _ => {}
                }
            }
            if &kind == b"MYCH" {
                self.samples.push(sample);
            }
        }
        Ok(())
    }
}

impl CacheSample {
    /// The positions of an object.
    pub fn positions(&self, object: &str) -> Option<&[[f64; 3]]> {
        self.channels.iter().find(|channel| channel.object() == Some(object))?.vectors()
    }

    /// A channel.
    pub fn channel(&self, name: &str) -> Option<&CacheChannel> {
        self.channels.iter().find(|channel| channel.name == name)
    }
}

impl CacheChannel {
    /// The vectors, if it has any.
    pub fn vectors(&self) -> Option<&[[f64; 3]]> {
        match &self.data {
            ChannelData::Vectors(vectors) => Some(vectors),
            ChannelData::Numbers(_) => None,
        }
    }

    /// The object whose positions these are.
    pub fn object(&self) -> Option<&str> {
        if !matches!(self.data, ChannelData::Vectors(_)) {
            return None;
        }
        const OTHERS: [&str; 10] = [
            "_velocity",
            "_acceleration",
            "_worldPosition",
            "_worldVelocity",
            "_worldVelocityInObjectSpace",
            "_rgbPP",
            "_force",
            "_angularVelocityPP",
            "_rotationPP",
            "_normal",
        ];
        match self.name.strip_suffix("_position") {
            Some(object) => Some(object),
            None if OTHERS.iter().any(|other| self.name.ends_with(other)) => None,
            None => Some(&self.name),
        }
    }
}

/// The data files of a description: one with its name, else one for each frame.
fn files_of(description: &Path, end: &str) -> Result<Vec<PathBuf>, ImportError> {
    let single = description.with_extension(end);
    if single.is_file() {
        return Ok(vec![single]);
    }
    let stem = description.file_stem().unwrap_or_default().to_string_lossy().into_owned() + "Frame";
    let folder =
        description.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let io = |source| ImportError::Io { file: folder.to_owned(), source };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(io)? {
        let path = entry.map_err(io)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let is_frame = |rest: &str| rest.starts_with(|c: char| c.is_ascii_digit() || c == '-');
        if name.ends_with(&format!(".{end}")) && name.strip_prefix(&stem).is_some_and(is_frame) {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(malformed(description, "there is no data file beside the description"));
    }
    Ok(files)
}

fn bytes(path: &Path) -> Result<Vec<u8>, ImportError> {
    let io = |source| ImportError::Io { file: path.to_owned(), source };
    let about = std::fs::metadata(path).map_err(io)?;
    if !about.is_file() {
        return Err(ImportError::NoFile { file: path.to_owned() });
    }
    if about.len() > MAX_BYTES {
        return Err(ImportError::TooLarge { file: path.to_owned(), bytes: about.len() });
    }
    std::fs::read(path).map_err(io)
}

fn malformed(file: &Path, message: &str) -> ImportError {
    ImportError::Malformed { file: file.to_owned(), line: 1, message: message.to_owned() }
}

/// The value of the first XML attribute of a name.
fn attribute<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = text.split_once(&format!(" {name}=\""))?;
    rest.split('"').next()
}

/// Blocks of a file: a tag, a size, data padded to 4 or 8 bytes.
struct Reader<'a> {
    rest: &'a [u8],
    is_wide: bool,
}

/// A tag and its content; `None` if the file ends inside.
type Block<'a, T> = Option<([u8; 4], T)>;

impl<'a> Reader<'a> {
    fn of(all: &'a [u8]) -> Option<Self> {
        match all.get(..4)? {
            b"FOR4" => Some(Self { rest: all, is_wide: false }),
            b"FOR8" => Some(Self { rest: all, is_wide: true }),
            _ => None,
        }
    }

    /// The next group with its kind; the outer `None` at the end of the file.
    fn group(&mut self) -> Option<Block<'a, Reader<'a>>> {
        let (tag, data) = match self.block()? {
            Some(block) => block,
            None => return Some(None),
        };
        if !matches!(&tag, b"FOR4" | b"FOR8") {
            return Some(None);
        }
        let kind = data.first_chunk::<4>().copied();
        Some(kind.map(|kind| (kind, Reader { rest: &data[4..], is_wide: self.is_wide })))
    }

    /// The next block; the outer `None` at the end.
    fn block(&mut self) -> Option<Block<'a, &'a [u8]>> {
        if self.rest.is_empty() {
            return None;
        }
        let block = self.take();
        if block.is_none() {
            self.rest = &[];
        }
        Some(block)
    }

    fn take(&mut self) -> Block<'a, &'a [u8]> {
        let tag = *self.rest.first_chunk::<4>()?;
        let (head, size): (usize, u64) = if self.is_wide {
            (16, u64::from_be_bytes(*self.rest.get(8..)?.first_chunk::<8>()?))
        } else {
            (8, u64::from(u32::from_be_bytes(*self.rest.get(4..)?.first_chunk::<4>()?)))
        };
        let size = usize::try_from(size).ok()?;
        let data = self.rest.get(head..head.checked_add(size)?)?;
        let is_group = matches!(&tag, b"FOR4" | b"FOR8");
        let step = if self.is_wide { 8 } else { 4 };
        // Groups are not padded.
        let padded = if is_group { size } else { size.checked_next_multiple_of(step)? };
        self.rest = self.rest.get(head + padded..).unwrap_or_default();
        Some((tag, data))
    }
}

fn whole(data: &[u8]) -> Option<i32> {
    data.first_chunk::<4>().map(|bytes| i32::from_be_bytes(*bytes))
}

fn values(tag: &[u8; 4], data: &[u8]) -> ChannelData {
    let single = || data.as_chunks::<4>().0.iter().map(|bytes| f64::from(f32::from_be_bytes(*bytes)));
    let double = || data.as_chunks::<8>().0.iter().map(|bytes| f64::from_be_bytes(*bytes));
    let vectors = |numbers: Vec<f64>| {
        ChannelData::Vectors(numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect())
    };
    match tag {
        b"FVCA" => vectors(single().collect()),
        b"DVCA" => vectors(double().collect()),
        b"FBCA" => ChannelData::Numbers(single().collect()),
        _ => ChannelData::Numbers(double().collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block as Maya writes it.
    fn block(wide: bool, tag: &[u8; 4], data: &[u8]) -> Vec<u8> {
        let mut all = tag.to_vec();
        if wide {
            // The bytes after a tag may hold anything.
            all.extend([0x45, 0x7f, 0, 0]);
            all.extend((data.len() as u64).to_be_bytes());
        } else {
            all.extend((data.len() as u32).to_be_bytes());
        }
        all.extend(data);
        let step = if wide { 8 } else { 4 };
        if tag != b"FOR4" && tag != b"FOR8" {
            all.resize(all.len().next_multiple_of(step), 0);
        }
        all
    }

    fn file(wide: bool, ticks: &[(Option<i32>, f32)], start: i32) -> Vec<u8> {
        let outer: &[u8; 4] = if wide { b"FOR8" } else { b"FOR4" };
        let head = [&b"CACH"[..], &block(wide, b"STIM", &start.to_be_bytes())].concat();
        let mut all = block(wide, outer, &head);
        for (tick, x) in ticks {
            let mut body = b"MYCH".to_vec();
            body.extend(tick.iter().flat_map(|tick| block(wide, b"TIME", &tick.to_be_bytes())));
            body.extend(block(wide, b"CHNM", b"p_count\0"));
            body.extend(block(wide, b"DBLA", &1f64.to_be_bytes()));
            body.extend(block(wide, b"CHNM", b"p_position\0"));
            body.extend(block(wide, b"SIZE", &1u32.to_be_bytes()));
            body.extend(block(wide, b"FVCA", &[*x, 2.0, 3.0].map(f32::to_be_bytes).concat()));
            all.extend(block(wide, outer, &body));
        }
        all
    }

    #[test]
    fn one_file_and_one_file_for_each_frame_hold_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let xml = |format: &str| {
            format!(
                "<Autodesk_Cache_File>\n<cacheType Type=\"OneFile\" Format=\"{format}\"/>\n<cacheTimePerFrame TimePerFrame=\"200\"/>"
            )
        };
        let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
        for (wide, format, end) in [(false, "mcc", "mc"), (true, "mcx", "mcx")] {
            write("one.xml", xml(format).as_bytes());
            write(&format!("one.{end}"), &file(wide, &[(Some(200), 1.0), (Some(400), 5.0)], 200));
            write("each.xml", xml(format).as_bytes());
            write(&format!("eachFrame1.{end}"), &file(wide, &[(None, 1.0)], 200));
            write(&format!("eachFrame2.{end}"), &file(wide, &[(None, 5.0)], 400));
            let [one, each] =
                ["one.xml", "each.xml"].map(|name| NCache::read(&folder.path().join(name)).unwrap());
            assert_eq!(one, each);
            assert_eq!(one.objects(), ["p"]);
            assert_eq!(one.positions("p", 2.0), Some(&[[5.0, 2.0, 3.0]][..]));
            assert_eq!(one.positions("p", 3.0), None);
            std::fs::remove_file(folder.path().join(format!("one.{end}"))).unwrap();
        }
    }

    #[test]
    fn a_sample_is_found_within_half_a_tick_of_its_frame() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
        let read = |ticks: &str| {
            let xml = format!(
                "<Autodesk_Cache_File>\n<cacheType Type=\"OneFile\" Format=\"mcc\"/>\n<cacheTimePerFrame TimePerFrame=\"{ticks}\"/>"
            );
            write("a.xml", xml.as_bytes());
            NCache::read(&folder.path().join("a.xml")).unwrap()
        };
        write("a.mc", &file(false, &[(Some(333), 1.0), (Some(501), 2.0), (Some(751), 3.0)], 333));
        let x = |cache: &NCache, frame: f64| cache.positions("p", frame).map(|points| points[0][0]);
        let whole = read("250");
        assert_eq!(x(&whole, 4.0 / 3.0), Some(1.0), "a third of a frame is no whole number of ticks");
        assert_eq!([x(&whole, 2.0), x(&whole, 501.0 / 250.0)], [None, Some(2.0)], "a tick off");
        let rounded = read("250.25");
        assert_eq!([x(&rounded, 2.0), x(&rounded, 3.0)], [Some(2.0), Some(3.0)]);
        assert_eq!(rounded.samples[2].frame, 3.0);
    }

    #[test]
    fn a_cache_cut_anywhere_is_an_error_or_a_shorter_cache() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mc");
        let whole = file(false, &[(Some(250), 1.0), (Some(500), 2.0)], 250);
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            if let Ok(cache) = NCache::read(&path) {
                assert!(cache.samples.len() < 2, "{length} of {} bytes", whole.len());
            }
        }
        let mut broken = whole.clone();
        broken[4..8].fill(0xff);
        std::fs::write(&path, broken).unwrap();
        assert!(NCache::read(&path).unwrap_err().to_string().contains("cut off"));
    }
}
