//! Substeps of several nuclei, shown in the order of time.
//!
//! Nuclei are solved one after another, so their substeps are kept until the frame is solved. Then all objects are shown at
//! the time of each substep of any nucleus. Between two substeps of its nucleus a point moves on a straight line.

use std::collections::{BTreeSet, HashMap};
use std::ops::ControlFlow;

use nalgebra::Vector3;
use nucleus_core::{
    ClothId, ColliderId, ContactState, Particle, ParticleLook, Stage, StateView, StepObserver, SubstepIndex,
};

use crate::compile::{Program, least_common_multiple};

use super::nucleus_run::SolverCall;

/// Parts of an evaluation interval in which its substeps are placed, at most: of any more they are rounded.
const MAX_PARTS: u64 = 1_000_000;

/// The substeps of one frame, by nucleus.
pub(super) struct SubstepMerge {
    /// Parts of an evaluation interval, such that each substep ends at a whole number of them.
    parts: u32,
    /// Evaluation intervals of the frame.
    intervals: u32,
    /// The evaluation interval that is being solved, from 0.
    interval: u32,
    nuclei: Vec<Track>,
}

/// The states of one nucleus in a frame.
struct Track {
    start: Snapshot,
    /// In the order of their times, which are in parts.
    substeps: Vec<(u32, Snapshot)>,
}

impl SubstepMerge {
    /// `start` are the states of all nuclei at the start of the frame, and `intervals` the evaluation intervals of the frame.
    pub(super) fn new<'a>(
        program: &Program,
        start: impl Iterator<Item = &'a dyn StateView>,
        intervals: u32,
    ) -> Self {
        let track = |(state, units): (&dyn StateView, f64)| Track {
            start: Snapshot::of(state, units, 0.0),
            substeps: Vec::new(),
        };
        let units = program.nuclei().iter().map(|nucleus| nucleus.units_per_metre());
        Self { parts: 1, intervals, interval: 0, nuclei: start.zip(units).map(track).collect() }
    }

    /// Sets the calls of the frame.
    pub(super) fn schedule(&mut self, calls: &[SolverCall]) {
        let parts = calls.iter().map(|call| u64::from(call.substeps.max(1))).fold(1, least_common_multiple);
        self.parts = parts.min(MAX_PARTS) as u32;
    }

    /// Begins a call of a solver.
    pub(super) fn begin(&mut self, call: &SolverCall) {
        self.interval = call.interval;
    }

    /// Keeps the state of a nucleus after a substep. `rate` is in solver seconds per second of the scene.
    pub(super) fn capture(&mut self, nucleus: usize, moment: SubstepIndex, state: &dyn StateView, rate: f64) {
        let track = &mut self.nuclei[nucleus];
        if track.substeps.is_empty() {
            track.start.colliders_at_start(state);
        }
        let share = f64::from(moment.substep) / f64::from(moment.substeps);
        let time = self.interval * self.parts + (share * f64::from(self.parts)).round() as u32;
        track.substeps.push((time, Snapshot::of(state, track.start.units, rate)));
    }

    /// Keeps the state of a nucleus that the whole frame does not solve: its colliders move on to the end of the frame.
    pub(super) fn capture_idle(&mut self, nucleus: usize, state: &dyn StateView, rate: f64) {
        let end = self.intervals * self.parts;
        let track = &mut self.nuclei[nucleus];
        track.substeps.push((end, Snapshot::of(state, track.start.units, rate)));
    }

    /// The times of all substeps in order, each with the states of the nuclei; `None` where one is at the end of the frame.
    pub(super) fn moments(&self) -> impl Iterator<Item = (SubstepIndex, Vec<Option<Snapshot>>)> + '_ {
        let substeps = self.intervals * self.parts;
        let times = self.nuclei.iter().flat_map(|track| track.substeps.iter().map(|(time, _)| *time));
        let times: BTreeSet<u32> = times.chain([substeps]).collect();
        let states = |time| self.nuclei.iter().map(|track| track.at(time)).collect();
        times.into_iter().map(move |substep| (SubstepIndex { substep, substeps }, states(substep)))
    }
}

impl Track {
    /// The state at a time; `None` from the last substep on.
    fn at(&self, time: u32) -> Option<Snapshot> {
        let next = self.substeps.partition_point(|(substep, _)| *substep < time);
        let (to, after) = self.substeps.get(next)?;
        let (from, before) = match next.checked_sub(1) {
            Some(last) => (self.substeps[last].0, &self.substeps[last].1),
            None => (0, &self.start),
        };
        if *to == time {
            return Some(after.clone());
        }
        Some(after.moved_back(before, f64::from(time - from) / f64::from(to - from)))
    }
}

/// The state of one nucleus, in its own units. Velocities are per second of the scene.
#[derive(Clone)]
pub(super) struct Snapshot {
    units: f64,
    cloths: Vec<ClothSnapshot>,
    colliders: Vec<ColliderSnapshot>,
    contacts: Vec<Vec<ContactState>>,
}

#[derive(Clone, Default)]
struct ClothSnapshot {
    positions: Vec<[f32; 3]>,
    velocities: Vec<[f32; 3]>,
    looks: Vec<ParticleLook>,
    orientations: Vec<[f32; 4]>,
    particles: Vec<Particle>,
}

#[derive(Clone, Default)]
struct ColliderSnapshot {
    positions: Vec<[f32; 3]>,
    has_moved: bool,
}

impl Snapshot {
    fn of(state: &dyn StateView, units: f64, rate: f64) -> Self {
        let [cloths, colliders] = state.object_counts().unwrap_or_default();
        let cloth = |id| {
            let mut seen = ClothSnapshot::default();
            state.positions(id, units, &mut seen.positions);
            state.velocities(id, units * rate, &mut seen.velocities);
            state.looks(id, &mut seen.looks);
            state.orientations(id, &mut seen.orientations);
            state.particles(id, &mut seen.particles);
            seen
        };
        let collider = |id| {
            let mut seen = ColliderSnapshot { has_moved: state.collider_moved(id), positions: Vec::new() };
            state.collider_positions(id, units, &mut seen.positions);
            seen
        };
        let mut contacts = Vec::new();
        state.contacts(&mut contacts);
        Self {
            units,
            cloths: (0..cloths as u32).map(|id| cloth(ClothId(id))).collect(),
            colliders: (0..colliders as u32).map(|id| collider(ColliderId(id))).collect(),
            contacts,
        }
    }

    /// Takes over the positions of the colliders at the start of the interval that is being solved.
    fn colliders_at_start(&mut self, state: &dyn StateView) {
        let mut points = Vec::new();
        for (id, collider) in (0..).map(ColliderId).zip(&mut self.colliders) {
            state.collider_points(id, 0.0, &mut points);
            let scaled = points.iter().map(|point| (point * self.units).map(|x| x as f32).into());
            collider.positions = scaled.collect();
        }
    }

    /// The state when a `share` of the motion from `before` to this one has passed. All but positions are those of this one.
    fn moved_back(&self, before: &Self, share: f64) -> Self {
        let mut seen = self.clone();
        for (to, from) in seen.cloths.iter_mut().zip(&before.cloths) {
            if to.particles.is_empty() && from.particles.is_empty() {
                move_back(&mut to.positions, &from.positions, share);
            } else {
                let rows: HashMap<u64, usize> =
                    from.particles.iter().zip(0..).map(|(particle, row)| (particle.id, row)).collect();
                for (position, particle) in to.positions.iter_mut().zip(&to.particles) {
                    let start = rows.get(&particle.id).and_then(|&row| from.positions.get(row));
                    *position = start.map_or(*position, |start| between(*start, *position, share));
                }
            }
        }
        for (to, from) in seen.colliders.iter_mut().zip(&before.colliders) {
            move_back(&mut to.positions, &from.positions, share);
        }
        seen
    }
}

/// Moves points towards where they were, if they are as many.
fn move_back(positions: &mut [[f32; 3]], before: &[[f32; 3]], share: f64) {
    if positions.len() == before.len() {
        positions.iter_mut().zip(before).for_each(|(to, from)| *to = between(*from, *to, share));
    }
}

fn between(from: [f32; 3], to: [f32; 3], share: f64) -> [f32; 3] {
    let on = |a: f32, b: f32| (f64::from(a) + (f64::from(b) - f64::from(a)) * share) as f32;
    std::array::from_fn(|axis| on(from[axis], to[axis]))
}

impl Snapshot {
    /// Replaces `out` by vectors in the asked units.
    fn scaled(&self, vectors: &[[f32; 3]], units: f64, out: &mut Vec<[f32; 3]>) {
        let factor = units / self.units;
        out.clear();
        match factor == 1.0 {
            true => out.extend_from_slice(vectors),
            false => out.extend(vectors.iter().map(|v| v.map(|x| (f64::from(x) * factor) as f32))),
        }
    }
}

impl StateView for Snapshot {
    fn object_counts(&self) -> Option<[usize; 2]> {
        Some([self.cloths.len(), self.colliders.len()])
    }

    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.scaled(&self.cloths[cloth.index()].positions, units_per_metre, out);
    }

    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.scaled(&self.cloths[cloth.index()].velocities, units_per_metre, out);
    }

    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        out.clone_from(&self.contacts);
    }

    fn looks(&self, cloth: ClothId, out: &mut Vec<ParticleLook>) {
        out.clone_from(&self.cloths[cloth.index()].looks);
    }

    fn orientations(&self, cloth: ClothId, out: &mut Vec<[f32; 4]>) {
        out.clone_from(&self.cloths[cloth.index()].orientations);
    }

    fn particles(&self, cloth: ClothId, out: &mut Vec<Particle>) {
        out.clone_from(&self.cloths[cloth.index()].particles);
    }

    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.scaled(&self.colliders[collider.index()].positions, units_per_metre, out);
    }

    fn collider_moved(&self, collider: ColliderId) -> bool {
        self.colliders[collider.index()].has_moved
    }

    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        Vector3::from(self.cloths[cloth.index()].positions[point].map(f64::from)) / self.units
    }
}

/// An observer that does not see substeps, because they are merged and shown later.
pub(super) struct WithoutSubsteps<'a>(pub(super) &'a mut dyn StepObserver);

impl StepObserver for WithoutSubsteps<'_> {
    fn substep(&mut self, _: SubstepIndex, _: &dyn StateView) {}

    fn step(&mut self, share: f64, state: &dyn StateView) {
        self.0.step(share, state);
    }

    fn should_continue(&self) -> ControlFlow<()> {
        self.0.should_continue()
    }

    fn enter(&mut self, stage: Stage) {
        self.0.enter(stage);
    }
}
