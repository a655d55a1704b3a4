//! Writes and reads a waving sheet and prints megabytes of positions per second, memory per point, and how long
//! it takes to get to any frame.
//!
//! `cargo run --release -p nucleus-cache --example throughput -- 1000 20` (points along a side, frames; then `compact`).

use std::error::Error;
use std::time::Instant;

use nalgebra::Vector3;
use nucleus_cache::{ObjectInfo, ObjectKind, Packing, Playback, Recorder, RunInfo, Source};
use nucleus_core::{ClothId, ColliderId, Faces, Moment, StateView, StepObserver};

/// A sheet of a metre, with waves that make every float differ from frame to frame.
struct Sheet {
    side: u32,
    time: f32,
}

impl StateView for Sheet {
    fn positions(&self, _: ClothId, _: f64, out: &mut Vec<[f32; 3]>) {
        out.clear();
        let step = 1.0 / self.side as f32;
        out.extend((0..self.side * self.side).map(|k| {
            let [x, z] = [k % self.side, k / self.side].map(|x| x as f32 * step);
            let y = 0.1 * (7.0 * x + self.time).sin() * (5.0 * z - self.time).cos();
            [x + 0.02 * y * y, 1.0 + y, z + 0.01 * y]
        }));
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
    recorder.record_start(&Sheet { side, time: 0.0 })?;
    let mut seconds = 0.0;
    for frame in 1..=frames {
        let begin = Instant::now();
        let state = Sheet { side, time: frame as f32 / 24.0 };
        recorder.frame(frame)?.substep(Moment { substep: 1, substeps: 1 }, &state);
        recorder.end_frame(&())?;
        seconds += begin.elapsed().as_secs_f64();
    }
    let recorded = recorder.finish()?;
    let peak = (peak_kilobytes() - before) * 1024.0 / f64::from(side * side);
    println!(
        "write {:.0} MB/s, {:.0} % of raw, {peak:.0} bytes per point",
        raw / seconds,
        1e-4 * recorded.bytes as f64 / raw
    );

    let begin = Instant::now();
    let mut cache = Playback::open(&path)?;
    let opened = begin.elapsed().as_secs_f64() * 1e3;
    let begin = Instant::now();
    for moment in 1..cache.moments().len() {
        std::hint::black_box(cache.positions(0, moment)?);
    }
    println!("read {:.0} MB/s, open {opened:.2} ms", raw / begin.elapsed().as_secs_f64());
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
        let begin = Instant::now();
        std::hint::black_box(cache.positions(0, 7_919 * k % moments)?);
        times.push(begin.elapsed().as_secs_f64() * 1e3);
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
    let mut rest = Vec::new();
    Sheet { side, time: 0.0 }.positions(ClothId(0), 1.0, &mut rest);
    ObjectInfo { name: "sheet".to_owned(), kind: ObjectKind::Cloth, faces, rest }
}

/// The most memory this process has held, where the system tells.
fn peak_kilobytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0.0)
}
