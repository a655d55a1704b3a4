//! One run: figures per frame, and the trajectory of all cloth points.

use nalgebra::Vector3;
use nucleus_core::{ClothId, Real, StateView, StepReport};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{ObjectKind, Program};
use serde::{Deserialize, Serialize};

use super::benchmark::{Benchmark, object_positions};
use super::setting::Setting;
use crate::clock::{Clock, Timing};
use crate::metrics::conservation::potential;
use crate::metrics::deformation::{Contact, distance};
use crate::metrics::shape::Outline;

/// Figures at the end of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Distance from the reference over the cloth's size: RMS over the points, and maximum. `None` without a reference.
    #[serde(rename = "apart")]
    pub divergence: Option<[f64; 2]>,
    /// 99th percentile of the strains of all edges.
    pub strain: f64,
    /// Maximum strain.
    pub max_strain: f64,
    /// Kinetic energy in joules.
    pub kinetic: f64,
    /// Kinetic and potential energy in joules.
    pub energy: f64,
    /// Processor time in milliseconds.
    pub ms: f64,
}

/// A finished run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Its setting.
    pub setting: Setting,
    /// Floating-point width in bits: 32, or 64 for references.
    pub bits: u32,
    /// Frames that were simulated before the compared ones.
    #[serde(default)]
    pub skipped: usize,
    /// Requested frames.
    pub asked: usize,
    /// All frames without the start; fewer than requested if one was not finite.
    pub frames: Vec<Frame>,
    /// Kinetic and potential energy at the start, in joules.
    pub start_energy: f64,
    /// Contact quality.
    pub contact: Contact,
    /// Candidate pairs of the broad phase, over all frames.
    pub pairs: u64,
    /// Broad-phase queries, over all frames.
    #[serde(rename = "searches")]
    pub queries: u64,
    /// Difference of the last frame's shape from the reference's. `None` without a reference.
    #[serde(default)]
    pub outline: Option<Outline>,
    /// Hash of the last state, in hexadecimal.
    pub hash: String,
    /// Key of the reference that distances and the outline were measured against; empty without a reference.
    #[serde(default)]
    pub against: String,
}

impl Run {
    /// Whether every frame was finite.
    pub fn is_finite(&self) -> bool {
        self.frames.len() == self.asked
    }

    /// Milliseconds of processor time per frame, on one core.
    pub fn ms(&self) -> f64 {
        self.frames.iter().map(|frame| frame.ms).sum::<f64>() / self.frames.len().max(1) as f64
    }

    /// Unique name among the runs of a scene.
    pub fn key(&self) -> String {
        key(&self.setting, self.bits, [self.skipped, self.asked])
    }
}

/// Unique name of a run among the runs of a scene: by its setting, and by its skipped and its compared frames.
pub fn key(setting: &Setting, bits: u32, [skipped, frames]: [usize; 2]) -> String {
    let after = if skipped == 0 { String::new() } else { format!("-a{skipped}") };
    format!("{}-f{bits}-n{frames}{after}", setting.key())
}

/// States that are kept of a run.
#[derive(Debug, Clone, Default)]
pub struct RunStates {
    /// All frames, in metres.
    pub trajectory: Option<Trajectory>,
    /// All objects in the last frame, in the order of the program, in scene units.
    pub end: Vec<Vec<[f32; 3]>>,
}

/// Runs a program with scalar `R` and measures its distance from `reference`. Returns `None` if `should_continue`
/// returns false.
pub fn run_setting<R: Real>(
    benchmark: &Benchmark,
    setting: &Setting,
    program: &Program,
    reference: Option<&Trajectory>,
    should_continue: &dyn Fn() -> bool,
) -> Option<(Run, RunStates)> {
    let mut simulation: Simulation<R> = Simulation::new(program, 1);
    let bits = 8 * size_of::<R>() as u32;
    let mut points = Vec::new();
    let potential_energy = |points: &[Vector3<f64>]| potential(&benchmark.masses, points, benchmark.gravity);
    let [skipped, asked] = benchmark.window();
    all_points(&simulation, &mut points);
    // Only references need all their frames.
    let mut trajectory = (bits == 64).then(|| Trajectory::new(&points));
    let mut contact = Contact::default();
    let before = skip(&mut simulation, skipped, &mut contact, should_continue)?;
    all_points(&simulation, &mut points);
    let start_energy = before.kinetic + potential_energy(&points);
    let mut run = Run { contact, start_energy, ..Run::empty(setting, bits, [skipped, asked]) };
    let mut expected = Vec::new();
    for frame in 0..if before.is_finite { asked } else { 0 } {
        if !should_continue() {
            return None;
        }
        let (timing, report) = Timing::measure(Clock::Thread, || simulation.advance(&mut ()).report);
        if !report.finite {
            break;
        }
        all_points(&simulation, &mut points);
        let strain = benchmark.strain(&points);
        run.count(&report);
        run.frames.push(Frame {
            divergence: divergence(benchmark, &points, reference, frame, &mut expected),
            strain: strain.p99.max(0.0),
            max_strain: strain.max.max(0.0),
            kinetic: report.kinetic_energy,
            energy: report.kinetic_energy + potential_energy(&points),
            ms: 1e3 * timing.processor,
        });
        if let Some(trajectory) = &mut trajectory {
            trajectory.push(&points);
        }
    }
    if let Some(reference) = reference.filter(|reference| run.is_finite() && reference.frames() == asked) {
        reference.frame(asked - 1, &mut expected);
        run.outline = benchmark.outline_of(&points, &expected);
    }
    run.hash = format!("{:016x}", simulation.solver().state_hash());
    Some((run, RunStates { trajectory, end: end_positions(&simulation) }))
}

impl Run {
    /// A run without frames yet, of which it skips and compares so many.
    fn empty(setting: &Setting, bits: u32, [skipped, asked]: [usize; 2]) -> Self {
        Self {
            setting: *setting,
            bits,
            skipped,
            asked,
            frames: Vec::with_capacity(asked),
            start_energy: 0.0,
            contact: Contact::default(),
            pairs: 0,
            queries: 0,
            outline: None,
            hash: String::new(),
            against: String::new(),
        }
    }

    /// Adds the counts of a frame.
    fn count(&mut self, report: &StepReport) {
        self.contact.add(report);
        self.pairs += report.candidate_pairs;
        self.queries += u64::from(report.broad_phases);
    }
}

/// Distance of points from a frame of the reference, root mean square and largest, if it has the frame.
fn divergence(
    benchmark: &Benchmark,
    points: &[Vector3<f64>],
    reference: Option<&Trajectory>,
    frame: usize,
    expected: &mut Vec<Vector3<f64>>,
) -> Option<[f64; 2]> {
    let reference = reference.filter(|reference| frame < reference.frames())?;
    reference.frame(frame, expected);
    let deviation = distance(points, expected, benchmark.size);
    Some([deviation.rms, deviation.max])
}

/// The positions of all objects, in scene units.
fn end_positions<R: Real>(simulation: &Simulation<R>) -> Vec<Vec<[f32; 3]>> {
    let mut end = vec![Vec::new(); simulation.objects().len()];
    for (object, out) in simulation.objects().iter().zip(&mut end) {
        object_positions(simulation, object, out);
    }
    end
}

/// The state before the compared frames.
struct Before {
    kinetic: f64,
    is_finite: bool,
}

/// Simulates the frames before the compared ones. Returns `None` if `should_continue` returns false.
fn skip<R: Real>(
    simulation: &mut Simulation<R>,
    frames: usize,
    contact: &mut Contact,
    should_continue: &dyn Fn() -> bool,
) -> Option<Before> {
    let mut before = Before { kinetic: 0.0, is_finite: true };
    for _ in 0..frames {
        if !should_continue() {
            return None;
        }
        let report = simulation.advance(&mut ()).report;
        contact.add(&report);
        before = Before { kinetic: report.kinetic_energy, is_finite: report.finite };
        if !report.finite {
            break;
        }
    }
    Some(before)
}

/// Replaces `out` by the points of all cloth in metres.
pub(super) fn all_points<R: Real>(simulation: &Simulation<R>, out: &mut Vec<Vector3<f64>>) {
    out.clear();
    let state: &dyn StateView = simulation.state();
    for object in simulation.objects() {
        if let ObjectKind::Cloth(id) = object.kind {
            out.extend((0..object.points).map(|point| state.point(ClothId(id.0), point)));
        }
    }
}

/// Positions of all cloth points of a run, frame by frame, in metres: cloth after cloth, in mesh order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trajectory {
    /// Origin of the stored `f32` positions, so that distance from the world origin costs no precision.
    origin: [f64; 3],
    /// Points per frame.
    points: usize,
    /// Points of frame 0, points of frame 1, ...
    rows: Vec<[f32; 3]>,
}

/// First bytes of a file: format and version.
const MAGIC: &[u8; 8] = b"nucltrj1";

impl Trajectory {
    /// Without frames; the origin is the centroid of `start`.
    pub fn new(start: &[Vector3<f64>]) -> Self {
        let middle = start.iter().sum::<Vector3<f64>>() / start.len().max(1) as f64;
        Self { origin: middle.into(), points: start.len(), rows: Vec::new() }
    }

    /// Adds a frame.
    pub fn push(&mut self, points: &[Vector3<f64>]) {
        let origin = Vector3::from(self.origin);
        self.rows.extend(points.iter().map(|point| <[f64; 3]>::from(point - origin).map(|x| x as f32)));
    }

    /// The number of frames.
    pub fn frames(&self) -> usize {
        self.rows.len().checked_div(self.points).unwrap_or(0)
    }

    /// The number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Replaces `out` by the positions in a frame, counted from 0.
    pub fn frame(&self, frame: usize, out: &mut Vec<Vector3<f64>>) {
        let origin = Vector3::from(self.origin);
        let rows = &self.rows[frame * self.points..(frame + 1) * self.points];
        out.clear();
        out.extend(rows.iter().map(|row| origin + Vector3::from(row.map(f64::from))));
    }

    /// Serialises into bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let head = MAGIC.iter().copied();
        let origin = self.origin.iter().flat_map(|x| x.to_le_bytes());
        let points = (self.points as u64).to_le_bytes();
        let rows = self.rows.iter().flatten().flat_map(|x| x.to_le_bytes());
        head.chain(origin).chain(points).chain(rows).collect()
    }

    /// Deserialises; `None` if the bytes are not a complete trajectory.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let bytes = bytes.strip_prefix(MAGIC)?;
        let (origin, bytes) = bytes.split_at_checked(24)?;
        let (points, bytes) = bytes.split_at_checked(8)?;
        let mut origin = origin.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().unwrap_or_default()));
        let origin = std::array::from_fn(|_| origin.next().unwrap_or_default());
        let points = usize::try_from(u64::from_le_bytes(points.try_into().ok()?)).ok()?;
        let number = |x: &[u8]| f32::from_le_bytes(x.try_into().unwrap_or_default());
        let row = |row: &[u8]| [number(&row[0..4]), number(&row[4..8]), number(&row[8..12])];
        let is_complete = points > 0 && bytes.len() % points.checked_mul(12)? == 0;
        is_complete.then(|| Self { origin, points, rows: bytes.chunks_exact(12).map(row).collect() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_frames() -> Trajectory {
        let start = [Vector3::new(1e7, 2.0, 3.0), Vector3::new(1e7 + 1.0, 2.0, 3.0)];
        let mut path = Trajectory::new(&start);
        path.push(&start);
        path.push(&start.map(|point| point + Vector3::y() * 1e-6));
        path
    }

    #[test]
    fn a_micrometre_is_resolved_ten_thousand_kilometres_away() {
        let mut points = Vec::new();
        two_frames().frame(1, &mut points);
        assert!((points[1].y - 2.0 - 1e-6).abs() < 1e-9 && (points[1].x - 1e7 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn serialisation_round_trips() {
        let path = two_frames();
        assert_eq!(Trajectory::from_bytes(&path.to_bytes()), Some(path.clone()));
        assert_eq!((path.frames(), path.points()), (2, 2));
    }

    #[test]
    fn truncated_bytes_are_rejected() {
        let bytes = two_frames().to_bytes();
        for length in [0, 4, 8, 20, 39, bytes.len() - 1, bytes.len() - 12] {
            assert_eq!(Trajectory::from_bytes(&bytes[..length]), None, "{length}");
        }
        assert_eq!(Trajectory::from_bytes(b"something else altogether, and long enough for a head"), None);
    }
}
