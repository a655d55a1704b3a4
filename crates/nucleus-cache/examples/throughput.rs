//! Writes and reads a waving sheet and prints as JSON: megabytes of positions per second, memory per point, and the
//! times to open the file and to seek to any frame.
//!
//! `cargo run --release -p nucleus-cache --example throughput -- 1000 20` (points along a side, frames; then `compact`,
//! and `keep=PATH` to keep the file).

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Instant;

use nalgebra::Vector3;
use nucleus_cache::{ObjectInfo, ObjectKind, Packing, Playback, Recorded, Recorder, RunInfo, Source};
use nucleus_core::{ClothId, ColliderId, Faces, StateView, StepObserver, SubstepIndex};
use serde_json::json;

/// Number of precomputed shapes of the sheet: computing them takes longer than writing them.
const SHAPES: usize = 12;

/// A sheet 1 m wide, with waves that make every float differ from shape to shape.
struct Sheet(Vec<[f32; 3]>);

impl Sheet {
    fn at(side: u32, time: f32) -> Self {
        let step = 1.0 / side as f32;
        let points = (0..side * side).map(|k| {
            let [x, z] = [k % side, k / side].map(|x| x as f32 * step);
            let y = 0.1 * (7.0 * x + time).sin() * (5.0 * z - time).cos();
            [x + 0.02 * y * y, 1.0 + y, z + 0.01 * y]
        });
        Self(points.collect())
    }
}

impl StateView for Sheet {
    fn positions(&self, _: ClothId, _: f64, out: &mut Vec<[f32; 3]>) {
        out.clone_from(&self.0);
    }
    fn velocities(&self, _: ClothId, _: f64, _: &mut Vec<[f32; 3]>) {}
    fn collider_positions(&self, _: ColliderId, _: f64, _: &mut Vec<[f32; 3]>) {}
    fn collider_moved(&self, _: ColliderId) -> bool {
        false
    }
    fn point(&self, _: ClothId, _: usize) -> Vector3<f64> {
        Vector3::zeros()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    if let Some(path) = std::env::var_os(READER) {
        let before = peak_kilobytes();
        read(&mut Playback::open(path)?)?;
        println!("{}", (peak_kilobytes() - before) / 1024.0);
        return Ok(());
    }
    let words: Vec<String> = std::env::args().skip(1).collect();
    let mut numbers = words.iter().filter_map(|word| word.parse::<u32>().ok());
    let (side, frames) = (numbers.next().unwrap_or(129), numbers.next().unwrap_or(120) as i32);
    let packing = if words.iter().any(|word| word == "compact") { Packing::Small } else { Packing::Fast };
    let kept = words.iter().find_map(|word| word.strip_prefix("keep=")).map(PathBuf::from);
    let path = kept.clone().unwrap_or_else(|| std::env::temp_dir().join("nucleus-throughput.mcap"));
    let megabytes = 12e-6 * f64::from(side * side) * f64::from(frames);
    let run = RunInfo { start: 0, end: frames, packing, ..RunInfo::default() };

    let shapes: Vec<Sheet> = (0..SHAPES).map(|k| Sheet::at(side, k as f32 / 24.0)).collect();
    let before = peak_kilobytes();
    let (recorded, write) = write(&path, &run, &shapes, sheet(side))?;
    let recorder = peak_kilobytes() - before;
    let begin = Instant::now();
    let mut cache = Playback::open(&path)?;
    let open = 1e3 * begin.elapsed().as_secs_f64();
    let read = read(&mut cache)?;
    let cold = drop_from_page_cache(&path).then(|| seek(&mut cache)).transpose()?;
    let warm = seek(&mut cache)?;
    let gigabytes = 1e-9 * recorded.bytes as f64;
    println!(
        "{}",
        json!({
            "side": side, "frames": frames, "gigabytes": gigabytes, "packed": 1e3 * gigabytes / megabytes,
            "write_mb_s": megabytes / write, "read_mb_s": megabytes / read, "open_ms": open,
            "seek_ms": warm, "cold_seek_ms": cold, "recorder_bytes_per_point": 1024.0 * recorder / f64::from(side * side),
            "reader_mb": memory(&path),
        })
    );
    if kept.is_none() {
        std::fs::remove_file(path)?;
    }
    Ok(())
}

/// Records all frames; returns the seconds of recording alone.
fn write(
    path: &Path,
    run: &RunInfo,
    shapes: &[Sheet],
    object: ObjectInfo,
) -> Result<(Recorded, f64), Box<dyn Error>> {
    let mut recorder = Recorder::replace(path, run, vec![(Source::Cloth(ClothId(0)), object)])?;
    recorder.record_start(&shapes[0])?;
    let begin = clock();
    for frame in 1..=run.end {
        let shape = &shapes[frame as usize % SHAPES];
        recorder.frame(frame)?.substep(SubstepIndex { substep: 1, substeps: 1 }, shape);
        recorder.end_frame(&())?;
    }
    let recorded = recorder.finish()?;
    Ok((recorded, clock() - begin))
}

/// Seconds to read all frames in order.
fn read(cache: &mut Playback) -> Result<f64, Box<dyn Error>> {
    let begin = clock();
    let mut positions = Vec::new();
    for sample in 1..cache.time_samples().len() {
        cache.positions_into(0, sample, &mut positions)?;
        std::hint::black_box(&positions);
    }
    Ok(clock() - begin)
}

/// Milliseconds of wall time to read the sheet at a random time sample: the median and the 99th percentile of 301.
fn seek(cache: &mut Playback) -> Result<[f64; 2], Box<dyn Error>> {
    let samples = cache.time_samples().len();
    let mut times = Vec::new();
    for k in 0..301 {
        let begin = Instant::now();
        std::hint::black_box(cache.positions(0, 7_919 * (k + 1) % samples)?);
        times.push(1e3 * begin.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    Ok([times[150], times[297]])
}

/// Drops a file from the page cache; returns whether that succeeded.
fn drop_from_page_cache(path: &Path) -> bool {
    let mut dd = Command::new("dd");
    dd.arg(format!("if={}", path.display())).args(["iflag=nocache", "count=0", "status=none"]);
    let synced = Command::new("sync").arg(path).status().is_ok_and(|status| status.success());
    synced && dd.status().is_ok_and(|status| status.success())
}

/// Peak memory in MB of a separate process that reads a file from end to end.
fn memory(path: &Path) -> Option<f64> {
    let child = Command::new(std::env::current_exe().ok()?).env(READER, path).output().ok()?;
    String::from_utf8(child.stdout).ok()?.trim().parse().ok()
}

/// If set to a path, the program reads that file and prints its peak memory.
const READER: &str = "NUCLEUS_READS";

fn sheet(side: u32) -> ObjectInfo {
    let quads = (side - 1) as usize * (side - 1) as usize;
    let mut faces = Faces::with_capacity(quads, 4 * quads);
    for k in (0..side * (side - 1)).filter(|k| k % side + 1 < side) {
        faces.push(&[k, k + 1, k + 1 + side, k + side]);
    }
    let rest = Sheet::at(side, 0.0).0;
    ObjectInfo { name: "sheet".to_owned(), kind: ObjectKind::Cloth, faces, rest }
}

/// Processor seconds of this thread, so that other processes do not count; wall time where the system does not report
/// them.
fn clock() -> f64 {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    let schedstat = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let busy = schedstat.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    busy.map_or_else(
        || BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64(),
        |nanoseconds| 1e-9 * nanoseconds,
    )
}

/// Peak memory of this process in kB, where the system reports it.
fn peak_kilobytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0.0)
}
