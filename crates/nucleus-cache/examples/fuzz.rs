//! Fuzzes the reader: opens and reads millions of damaged caches, and stops at the first that makes the reader panic,
//! take too long or allocate too much.
//!
//! `cargo run --release -p nucleus-cache --example fuzz -- 600 tests/corpus` (seconds, and the folder of the corpus).
//!
//! Some mutations change arbitrary bytes. Others change bytes inside frames and recompute the checksum, so that the
//! damage reaches the readers of meshes and points. The corpus has one small cache for each outcome of reading; a test
//! reads them all.

use std::collections::BTreeMap;
use std::error::Error;
use std::io::Cursor;
use std::panic::catch_unwind;
use std::path::Path;
use std::time::{Duration, Instant};

use nucleus_cache::{Detail, Playback, ReadError};

#[path = "../tests/cache/falling.rs"]
#[allow(dead_code)]
mod falling;
#[path = "../tests/cache/torn.rs"]
#[allow(dead_code)]
mod torn;

/// Reading a cache of a few thousand bytes takes a millisecond.
const PATIENCE: Duration = Duration::from_secs(2);
/// A cache of a few thousand bytes takes a few megabytes.
const MOST_KILOBYTES: u64 = 1_000_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let seconds = arguments.next().map_or(Ok(10), |text| text.parse())?;
    let corpus = arguments.next();
    let all = falling::whole_run(&falling::with_all_channels()).0;
    let torn = torn::recorded(&torn::run_info(Detail::Frames), falling::END);
    let frames = falling::whole_run(&falling::run_info()).0;
    let seeds = [unpacked(&frames)?, unpacked(&all)?, all, unpacked(&torn)?, torn];
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut endings: BTreeMap<String, (u64, Vec<u8>)> = BTreeMap::new();
    let (begin, mut runs) = (Instant::now(), 0_u64);
    while begin.elapsed() < Duration::from_secs(seconds) {
        let mut bytes = seeds[random.below(seeds.len())].clone();
        for _ in 0..=random.below(3) {
            if random.below(2) == 0 {
                blindly(&mut bytes, &mut random)
            } else {
                inside(&mut bytes, &mut random)
            }
        }
        let started = Instant::now();
        let Ok(ending) = catch_unwind(|| read(&bytes)) else {
            std::fs::write("panics.bin", &bytes)?;
            return Err("the cache in `panics.bin` makes the reader panic".into());
        };
        if started.elapsed() > PATIENCE || peak_kilobytes() > MOST_KILOBYTES {
            std::fs::write("slow.bin", &bytes)?;
            return Err("the cache in `slow.bin` takes too long or too much memory".into());
        }
        let kept = endings.entry(ending).or_insert_with(|| (0, bytes.clone()));
        kept.0 += 1;
        if bytes.len() < kept.1.len() {
            kept.1 = bytes;
        }
        runs += 1;
    }
    println!("{runs} caches in {seconds} s, {} ways to end, {} kB at most", endings.len(), peak_kilobytes());
    for (ending, (count, _)) in &endings {
        println!("{count:>9}  {ending}");
    }
    if let Some(corpus) = corpus {
        std::fs::create_dir_all(&corpus)?;
        for (place, (_, bytes)) in endings.values().enumerate() {
            std::fs::write(Path::new(&corpus).join(format!("{place:02}.bin")), bytes)?;
        }
    }
    Ok(())
}

/// Reads everything and returns the outcome as text without numbers.
fn read(bytes: &[u8]) -> String {
    let mut cache = match Playback::read(Cursor::new(bytes)) {
        Ok(cache) => cache,
        Err(error) => return plain(&error.to_string()),
    };
    let mut faults = Vec::new();
    for object in 0..cache.objects().len() {
        for sample in (0..cache.time_samples().len()).take(40) {
            let all = object_is_whole(&mut cache, object, sample)
                .and(cache.velocities(object, sample).map(drop))
                .and(cache.contacts(object, sample).map(drop))
                .and(cache.strain(object, sample).map(drop));
            faults.extend(all.err().map(|error| error.to_string()));
        }
    }
    for frame in cache.checkpoints() {
        faults.extend(cache.checkpoint(frame).err().map(|error| format!("checkpoint: {error}")));
    }
    faults.extend(cache.reports().err().map(|error| error.to_string()));
    faults.extend(cache.sizes().err().map(|error| error.to_string()));
    let loss = cache.verify().map_or_else(|error| error.to_string(), ToString::to_string);
    let mut saved = Cursor::new(Vec::new());
    if cache.recover(&mut saved).is_ok() {
        // A recovered file is sound, unless it lacks the records that make it a cache.
        if let Ok(again) = Playback::read(saved) {
            assert!(!again.corruption().truncated && !again.corruption().index);
        }
    }
    faults.dedup();
    plain(&format!("opened; {loss}; {}", faults.first().cloned().unwrap_or_default()))
}

/// Reads a mesh and its positions, which must fit each other: renderers rely on it.
fn object_is_whole(
    cache: &mut Playback<Cursor<&[u8]>>,
    object: usize,
    sample: usize,
) -> Result<(), ReadError> {
    let points = cache.positions(object, sample)?.len();
    let mesh = cache.object_at(object, sample)?;
    assert!(mesh.rest.len() == points && mesh.faces.corners().iter().all(|&point| (point as usize) < points));
    Ok(())
}

/// A message without numbers and quoted words.
fn plain(message: &str) -> String {
    let mut quoted = false;
    let kept = message.chars().filter(|&c| {
        quoted ^= c == '`';
        !quoted && !c.is_ascii_digit() && c != '-'
    });
    // The number of damaged frames makes no new outcome.
    let kept = kept.collect::<String>().replace(',', " ").replace(" to ", " ").replace("frames", "frame");
    kept.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The same cache with uncompressed chunks, so that their bytes can be changed.
fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let summary = mcap::Summary::read(bytes)?.ok_or("no summary")?;
    let mut plain = Cursor::new(Vec::new());
    let options =
        mcap::WriteOptions::new().profile("nucleus").library("nucleus 0").compression(None).chunk_size(None);
    let mut writer = options.create(&mut plain)?;
    for index in &summary.metadata_indexes {
        writer.write_metadata(&mcap::read::metadata(bytes, index)?)?;
    }
    let mut last = 0;
    for message in mcap::MessageStream::new(bytes)? {
        let message = message?;
        if message.log_time != last {
            writer.flush()?;
            last = message.log_time;
        }
        writer.write(&message)?;
    }
    writer.finish()?;
    drop(writer);
    Ok(plain.into_inner())
}

/// Changes arbitrary bytes.
fn blindly(bytes: &mut Vec<u8>, random: &mut Random) {
    let (at, length) = (random.below(bytes.len()), 1 + random.below(16));
    let end = (at + length).min(bytes.len());
    match random.below(6) {
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes[at..end].iter_mut().for_each(|byte| *byte = random.byte()),
        2 => bytes.truncate(at.max(1)),
        3 => drop(bytes.drain(at..end)),
        4 => {
            let copy = bytes[at..end].to_vec();
            let place = random.below(bytes.len());
            bytes.splice(place..place, copy);
        }
        _ => bytes[at..end].fill([0, 0xff][random.below(2)]),
    }
}

/// Changes bytes inside an uncompressed chunk and recomputes its checksum.
fn inside(bytes: &mut [u8], random: &mut Random) {
    // Record header, two times, size, checksum, the empty name of the compression, length.
    const HEAD: usize = 9 + 24 + 4 + 4 + 8;
    let mut chunks = Vec::new();
    let mut at = 8;
    while let Some(head) = bytes.get(at..at + 9) {
        let length = u64::from_le_bytes(head[1..].try_into().expect("eight bytes"));
        let Some(end) = usize::try_from(length).ok().and_then(|length| (at + 9).checked_add(length)) else {
            break;
        };
        if head[0] == 6 && end <= bytes.len() && end > at + HEAD {
            chunks.push((at, end));
        }
        at = end;
    }
    let Some(&(begin, end)) = chunks.get(random.below(chunks.len().max(1))) else { return };
    for _ in 0..=random.below(4) {
        let at = begin + HEAD + random.below(end - begin - HEAD);
        bytes[at] = [random.byte(), 0, 1, 0xff, bytes[at] ^ 1][random.below(5)];
    }
    let sum = crc32fast::hash(&bytes[begin + HEAD..end]);
    bytes[begin + 33..begin + 37].copy_from_slice(&sum.to_le_bytes());
}

/// Deterministic pseudo-random numbers (xorshift).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() >> 11) as usize % end
    }

    fn byte(&mut self) -> u8 {
        (self.next() >> 32) as u8
    }
}

/// Peak memory of this process in kB, where the system reports it.
fn peak_kilobytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0)
}
