//! One run: followed frame by frame, and held against the reference.

use nalgebra::Vector3;
use nucleus_core::{ClothId, Real, StateView};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{Object, ObjectKind, Program};
use serde::{Deserialize, Serialize};

use super::setting::Setting;
use super::subject::Subject;
use crate::clock::{Clock, Spent};
use crate::metrics::contact::Contact;
use crate::metrics::{distance, energy};
use crate::trajectory::Trajectory;

/// What was seen at the end of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// From the reference, over the cloth's size: RMS over the points, and the largest. Nothing without a reference.
    pub apart: Option<[f64; 2]>,
    /// The strain that 99 % of the edges stay below.
    pub strain: f64,
    /// The largest strain.
    pub max_strain: f64,
    /// Kinetic energy in joules.
    pub kinetic: f64,
    /// Kinetic and potential energy in joules.
    pub energy: f64,
    /// Processor time in milliseconds.
    pub ms: f64,
}

/// A run that has ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// What was set.
    pub setting: Setting,
    /// Bits of its numbers: 32, or 64 for references.
    pub bits: u32,
    /// Frames that were asked for.
    pub asked: usize,
    /// Frame after frame, the start left out; fewer than were asked for if one was not finite.
    pub frames: Vec<Frame>,
    /// Kinetic and potential energy at the start, in joules.
    pub start_energy: f64,
    /// What contact was like.
    pub contact: Contact,
    /// Candidate pairs of the broad phase, over all frames.
    pub pairs: u64,
    /// Runs of the broad phase, over all frames.
    pub searches: u64,
    /// Fingerprint of the state at the end, in hexadecimal.
    pub hash: String,
}

impl Run {
    /// Whether every frame was finite.
    pub fn is_finite(&self) -> bool {
        self.frames.len() == self.asked
    }

    /// Milliseconds of processor time to a frame, on one core.
    pub fn ms(&self) -> f64 {
        self.frames.iter().map(|frame| frame.ms).sum::<f64>() / self.frames.len().max(1) as f64
    }

    /// What tells it from other runs of a scene.
    pub fn key(&self) -> String {
        key(&self.setting, self.bits, self.asked)
    }
}

/// What tells a run from other runs of a scene.
pub fn key(setting: &Setting, bits: u32, frames: usize) -> String {
    format!("{}-f{bits}-n{frames}", setting.key())
}

/// What is wanted of a run besides its figures.
#[derive(Debug, Clone, Default)]
pub struct Kept {
    /// Every frame, in metres.
    pub path: Option<Trajectory>,
    /// All objects at the end, in the order of the program, in scene units.
    pub end: Vec<Vec<[f32; 3]>>,
}

/// Runs a program in `R` and holds it against `wanted`. Ends early, with nothing, if `should_continue` says so.
pub fn follow<R: Real>(
    subject: &Subject,
    setting: &Setting,
    program: &Program,
    wanted: Option<&Trajectory>,
    should_continue: &dyn Fn() -> bool,
) -> Option<(Run, Kept)> {
    let mut simulation: Simulation<R> = Simulation::new(program, 1);
    let bits = 8 * size_of::<R>() as u32;
    let mut points = Vec::new();
    all_points(&simulation, &mut points);
    let height = |points: &[Vector3<f64>]| energy::potential(&subject.masses, points, subject.gravity);
    let asked = subject.frames();
    let mut run = Run {
        setting: *setting,
        bits,
        asked,
        frames: Vec::with_capacity(asked),
        start_energy: height(&points),
        contact: Contact::default(),
        pairs: 0,
        searches: 0,
        hash: String::new(),
    };
    // References are what is kept whole; whatever is held against one is not one.
    let mut path = (bits == 64).then(|| Trajectory::new(&points));
    let mut reference = Vec::new();
    for frame in 0..asked {
        if !should_continue() {
            return None;
        }
        let (spent, seen) = Spent::by(Clock::Thread, || simulation.advance(&mut ()).report);
        if !seen.finite {
            break;
        }
        all_points(&simulation, &mut points);
        let strain = subject.strain(&points);
        let apart = wanted.filter(|wanted| frame < wanted.frames()).map(|wanted| {
            wanted.frame(frame, &mut reference);
            let found = distance::distance(&points, &reference, subject.size);
            [found.rms, found.max]
        });
        run.contact.add(&seen);
        run.pairs += seen.candidate_pairs;
        run.searches += u64::from(seen.broad_phases);
        run.frames.push(Frame {
            apart,
            strain: strain.most.max(0.0),
            max_strain: strain.max.max(0.0),
            kinetic: seen.kinetic_energy,
            energy: seen.kinetic_energy + height(&points),
            ms: 1e3 * spent.processor,
        });
        if let Some(path) = &mut path {
            path.push(&points);
        }
    }
    run.hash = format!("{:016x}", simulation.solver().state_hash());
    let mut end = vec![Vec::new(); simulation.objects().len()];
    for (object, out) in simulation.objects().iter().zip(&mut end) {
        object_positions(&simulation, object, out);
    }
    Some((run, Kept { path, end }))
}

/// Replaces `out` by the positions of an object in scene units.
pub fn object_positions<R: Real>(simulation: &Simulation<R>, object: &Object, out: &mut Vec<[f32; 3]>) {
    let (state, units) = (simulation.state(), simulation.units_per_metre());
    match object.kind {
        ObjectKind::Cloth(id) => state.positions(id, units, out),
        ObjectKind::Collider(id) => state.collider_positions(id, units, out),
    }
}

/// Replaces `out` by all points of all cloth in metres.
fn all_points<R: Real>(simulation: &Simulation<R>, out: &mut Vec<Vector3<f64>>) {
    out.clear();
    let state: &dyn StateView = simulation.state();
    for object in simulation.objects() {
        if let ObjectKind::Cloth(id) = object.kind {
            out.extend((0..object.points).map(|point| state.point(ClothId(id.0), point)));
        }
    }
}
