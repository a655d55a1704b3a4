//! Writes and reads a waving sheet and prints megabytes of positions per second, memory per point, and how long
//! it takes to get to any frame.
//!
//! `cargo run --release -p nucleus-cache --example throughput -- 1000 20` (points along a side, frames; then `compact`).

use std::error::Error;
use std::sync::OnceLock;
use std::time::Instant;

use nalgebra::Vector3;
use nucleus_cache::{ObjectInfo, ObjectKind, Packing, Playback, Recorder, RunInfo, Source};
use nucleus_core::{ClothId, ColliderId, Faces, Moment, StateView, StepObserver};

/// A sheet of a metre, with waves that make every float differ from frame to frame.
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
    let mut arguments =
        std::env::args().skip(1).filter(|word| word != "compact").map(|argument| argument.parse::<u32>());
    let side = arguments.next().transpose()?.unwrap_or(129);
    let frames = arguments.next().transpose()?.unwrap_or(120) as i32;
    let packing = if std::env::args().any(|word| word == "compact") { Packing::Small } else { Packing::Fast };
    let path = std::env::temp_dir().join("nucleus-throughput.mcap");
    let raw = 12.0e-6 * f64::from(side * side) * f64::from(frames);
    let before = peak_kilobytes();

    let run = RunInfo { start: 0, end: frames, packing, ..RunInfo::default() };
    let mut recorder = Recorder::replace(&path, &run, vec![(Source::Cloth(ClothId(0)), sheet(side))])?;
    recorder.record_start(&Sheet::at(side, 0.0))?;
    let mut seconds = 0.0;
    for frame in 1..=frames {
        let state = Sheet::at(side, frame as f32 / 24.0);
        let begin = clock();
        recorder.frame(frame)?.substep(Moment { substep: 1, substeps: 1 }, &state);
        recorder.end_frame(&())?;
        seconds += clock() - begin;
    }
    let recorded = recorder.finish()?;
    let peak = (peak_kilobytes() - before) * 1024.0 / f64::from(side * side);
    println!(
        "write {:.0} MB/s, {:.0} % of raw, {peak:.0} bytes per point",
        raw / seconds,
        1e-4 * recorded.bytes as f64 / raw
    );

    let begin = clock();
    let mut cache = Playback::open(&path)?;
    let opened = (clock() - begin) * 1e3;
    let begin = clock();
    for moment in 1..cache.moments().len() {
        std::hint::black_box(cache.positions(0, moment)?);
    }
    println!("read {:.0} MB/s, open {opened:.2} ms", raw / (clock() - begin));
    let (middle, worst) = seek(&mut cache)?;
    println!("seek {middle:.2} ms, at worst {worst:.2} ms, in {:.2} GB", 1e-9 * recorded.bytes as f64);
    std::fs::remove_file(path)?;
    Ok(())
}

/// Milliseconds to read the sheet at a moment anywhere in the run: the median of 101, and the longest.
fn seek(cache: &mut Playback) -> Result<(f64, f64), Box<dyn Error>> {
    let moments = cache.moments().len();
    let mut times = Vec::new();
    for k in 0..101 {
        let begin = clock();
        std::hint::black_box(cache.positions(0, 7_919 * k % moments)?);
        times.push((clock() - begin) * 1e3);
    }
    times.sort_by(f64::total_cmp);
    Ok((times[50], times[100]))
}

fn sheet(side: u32) -> ObjectInfo {
    let quads = (side - 1) as usize * (side - 1) as usize;
    let mut faces = Faces::with_capacity(quads, 4 * quads);
    for k in (0..side * (side - 1)).filter(|k| k % side + 1 < side) {
        faces.push(&[k, k + 1, k + 1 + side, k + side]);
    }
    let rest = Sheet::at(side, 0.0).0;
    ObjectInfo { name: "sheet".to_owned(), kind: ObjectKind::Cloth, faces, rest }
}

/// Seconds that this thread has been at work, so that what else runs on the machine does not count; seconds by
/// the clock where the system does not tell.
fn clock() -> f64 {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let worked = told.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    worked.map_or_else(
        || BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64(),
        |nanoseconds| 1e-9 * nanoseconds,
    )
}

/// The most memory this process has held, where the system tells.
fn peak_kilobytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0.0)
}
