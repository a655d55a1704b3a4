//! The loop over frames: evaluates the animation and calls the solvers.

use std::cell::RefCell;

use nalgebra::Vector3;
use nucleus_audit::CollisionMesh;
use nucleus_core::{
    ClothId, ColliderId, ContactState, Encode, FrameInput, Particle, ParticleLook, PointId, Reader, Real,
    RestoreError, Solver, StateView, StepObserver, StepReport, SubstepIndex, add_checksum, verify_checksum,
};

use crate::audit::{Audit, AuditScope, Audited, Closeness, GroundPlanes, collision_rules};
use crate::checks::FrameReport;
use crate::compile::{Object, Program};
use crate::scene::TimeSpan;

use combined::{CombinedObserver, CombinedState, combined_report, with_evaluation};
use idle_colliders::{NONE_IDLE, WithIdle};
use nucleus_run::{NucleusRun, SolverCall};
use substep_merge::{SubstepMerge, WithoutSubsteps};

mod combined;
mod idle_colliders;
mod nucleus_run;
mod substep_merge;

/// Identifies the layout of a checkpoint; the number increases whenever the layout changes.
const CHECKPOINT_KIND: [u8; 8] = *b"nuclei 3";

/// A run of a program, at one of its frames.
///
/// It begins at the start frame with all objects in their initial state. Each [`advance`](Self::advance) solves one frame
/// (N3.1-6), or several if the scene is evaluated less often than once per frame. Nuclei are solved one after another and
/// do not influence each other.
pub struct Simulation<R: Real = f32> {
    program: Program,
    runs: Vec<NucleusRun<R>>,
    frame: i64,
    threads: usize,
    audit: Option<Audit>,
}

impl<R: Real> Simulation<R> {
    /// A run at its start frame. `threads` is the number of threads; the result is the same for any number.
    pub fn new(program: &Program, threads: usize) -> Self {
        let frame = program.time().start;
        let runs = (0..program.nuclei().len()).map(|k| NucleusRun::new(program, k, threads)).collect();
        Self { runs, frame, threads, program: program.clone(), audit: None }
    }

    /// Audits the run from the current frame on.
    pub fn begin_audit(&mut self, closeness: Closeness) {
        let scope = self.next_scope();
        let rules = |world: &CollisionMesh| collision_rules(&self.program, self.next_frame(), &scope, world);
        self.audit = Some(Audit::new(self.objects(), closeness, self.state(), rules));
    }

    /// The audit of the run, if there is one.
    pub fn audit(&self) -> Option<&Audit> {
        self.audit.as_ref()
    }

    /// What the input of the next frame says about pairs that cannot collide, by the ids of the program.
    pub(crate) fn next_scope(&self) -> AuditScope {
        let to = self.next_frame() as f64;
        let mut scope = AuditScope::default();
        for (k, run) in self.runs.iter().enumerate() {
            let position = |cloth, point: PointId| run.solver.point(cloth, point.index());
            let interval = self.program.interval(k, [run.evaluated, to], to - run.evaluated, run.was_skipped);
            let input = interval.input(&mut run.attachments.clone(), &position);
            scope.add(&self.program.nuclei()[k], input, |constraint| run.solver.welds(constraint));
        }
        scope
    }

    /// Solves the next frame and calls `watch` with the state after each substep. The last frame of the scene is no limit.
    ///
    /// If `watch` stops the frame, the report says so. [`frame`](Self::frame) is then still the frame before, but the state
    /// is not: to continue with the same bits, [`restore`](Self::restored) a checkpoint saved at that frame.
    pub fn advance(&mut self, watch: &mut dyn StepObserver) -> FrameReport {
        self.advance_with(&mut |_, _| {}, watch)
    }

    /// The same, with access to the solver and its input before each call: to measure the input, or to set values that a
    /// scene cannot express.
    pub fn advance_with(
        &mut self,
        change: &mut dyn FnMut(&Solver<R>, &mut FrameInput),
        watch: &mut dyn StepObserver,
    ) -> FrameReport {
        if self.runs.len() == 1 || !watch.observes_substeps() {
            return self.advance_merged(change, watch, None);
        }
        let start: Vec<WithIdle<'_>> = self.runs.iter().map(NucleusRun::view).collect();
        let start = start.iter().map(|view| view as &dyn StateView);
        let intervals = self.evaluation_times(self.next_frame()).len() as u32;
        let merge = RefCell::new(SubstepMerge::new(&self.program, start, intervals));
        let report = self.advance_merged(change, &mut WithoutSubsteps(watch), Some(&merge));
        if !report.report.stopped {
            self.show(&merge.borrow(), watch);
        }
        report
    }

    /// Shows the substeps of the last frame in the order of time.
    fn show(&self, merge: &SubstepMerge, watch: &mut dyn StepObserver) {
        for (index, between) in merge.moments() {
            // Snapshots have the velocities of the scene already.
            let seen = between.iter().zip(&self.runs).map(|(snapshot, run)| match snapshot {
                Some(state) => (WithIdle { state, idle: &NONE_IDLE, ends_frame: true }, 1.0),
                None => (run.view(), run.rate),
            });
            let (parts, rates) = seen.unzip();
            watch.substep(index, &CombinedState { program: &self.program, parts, rates, solving: None });
        }
    }

    /// Solves the next frame; `merge` keeps the substeps of several nuclei.
    fn advance_merged(
        &mut self,
        change: &mut dyn FnMut(&Solver<R>, &mut FrameInput),
        watch: &mut dyn StepObserver,
        merge: Option<&RefCell<SubstepMerge>>,
    ) -> FrameReport {
        let frame = self.next_frame();
        let Some(mut audit) = self.audit.take() else {
            let planes = RefCell::default();
            let report = self.solve(frame, change, Watches { watch, planes: &planes, merge });
            return FrameReport { frame, report, passed_through: None };
        };
        let scope = self.next_scope();
        audit.begin_frame(frame, |world| collision_rules(&self.program, frame, &scope, world));
        let before = audit.account().found();
        let planes = RefCell::new(audit.take_planes());
        let mut audited = Audited::new(&mut audit, &planes, watch);
        let report = self.solve(frame, change, Watches { watch: &mut audited, planes: &planes, merge });
        audit.keep_planes(planes.into_inner());
        let passed_through = Some(audit.account().found() - before);
        self.audit = Some(audit);
        FrameReport { frame, report, passed_through }
    }

    /// Solves all nuclei up to a frame.
    fn solve(
        &mut self,
        frame: i64,
        change: &mut dyn FnMut(&Solver<R>, &mut FrameInput),
        Watches { watch, planes, merge }: Watches<'_>,
    ) -> StepReport {
        let calls = self.schedule(frame);
        if let Some(merge) = merge {
            let mut merge = merge.borrow_mut();
            merge.schedule(&calls);
            for (nucleus, run) in self.runs.iter().enumerate() {
                if !calls.iter().any(|call| call.nucleus == nucleus) {
                    merge.capture_idle(nucleus, &run.view(), run.rate);
                }
            }
        }
        let total = calls.iter().map(|call| call.substeps).sum();
        let mut done = 0;
        let mut report: Option<StepReport> = None;
        for call in calls {
            let observers = &mut Observers { watch: &mut *watch, planes, merge, done, total };
            let own = self.call_solver(&call, change, observers);
            if own.stopped {
                return own;
            }
            done += call.substeps;
            report = Some(report.map_or(own, |before| combined_report(&before, &own, call.is_new_time)));
        }
        if total == 0 {
            watch.substep(SubstepIndex { substep: 1, substeps: 1 }, self.state());
        }
        self.frame = frame;
        report.unwrap_or_default()
    }

    /// The solver calls up to a frame, in the order of time, then of nuclei.
    fn schedule(&mut self, frame: i64) -> Vec<SolverCall> {
        let mut calls: Vec<SolverCall> = Vec::new();
        self.runs.iter_mut().for_each(|run| run.idle.begin_frame());
        for (interval, time) in (0..).zip(self.evaluation_times(frame)) {
            let first = calls.len();
            for (nucleus, run) in self.runs.iter_mut().enumerate() {
                let call = run.evaluate(&self.program, nucleus, time);
                let is_new_time = calls.len() == first;
                calls.extend(call.map(|call| SolverCall { is_new_time, interval, ..call }));
            }
        }
        calls
    }

    /// The scene frames, possibly fractions, at which the graph is evaluated on the way to a frame.
    fn evaluation_times(&self, frame: i64) -> Vec<f64> {
        let parts = (1.0 / self.program.every()).round().max(1.0) as i64;
        let at = |part: i64| {
            if part == parts { frame as f64 } else { frame as f64 - 1.0 + part as f64 / parts as f64 }
        };
        (1..=parts).map(at).collect()
    }

    /// Solves one evaluation interval of one nucleus.
    fn call_solver(
        &mut self,
        call: &SolverCall,
        change: &mut dyn FnMut(&Solver<R>, &mut FrameInput),
        observers: &mut Observers,
    ) -> StepReport {
        if call.resets {
            self.runs[call.nucleus].reset(&self.program, call.nucleus, self.threads);
            observers.planes.borrow_mut().reset(call.nucleus);
        }
        let (before, rest) = self.runs.split_at_mut(call.nucleus);
        let Some((run, after)) = rest.split_first_mut() else { return StepReport::default() };
        let interval = self.program.interval(call.nucleus, call.frames, call.elapsed, call.is_discontinuous);
        let solver = &run.solver;
        let position = |cloth, point: PointId| solver.point(cloth, point.index());
        let mut input = interval.input(&mut run.attachments, &position);
        let invalid_results = &mut run.attachments.invalid_results;
        input.particle_changes = interval.particle_changes(solver, invalid_results);
        let (invalid_results, births_refused) =
            (std::mem::take(invalid_results), std::mem::take(&mut run.attachments.births_refused));
        let complete = |report| {
            let mut report = with_evaluation(report, invalid_results, births_refused);
            let first = report.sanitized.first.map(|input| self.program.numbered_on(call.nucleus, input));
            report.sanitized.first = first;
            report
        };
        change(&run.solver, &mut input);
        run.rate = input.duration / ((call.frames[1] - call.frames[0]) / self.program.time().fps);
        let first_cloth = self.program.nuclei()[call.nucleus].cloths().start;
        let span = [observers.done, observers.done + call.substeps];
        let span = span.map(|substep| f64::from(substep) / f64::from(observers.total.max(1)));
        observers.planes.borrow_mut().begin_span(call.nucleus, first_cloth, &input, span);
        let is_alone = before.is_empty() && after.is_empty() && observers.total == call.substeps;
        if is_alone && run.rate == 1.0 && run.idle.is_empty() {
            return complete(run.solver.step(&input, observers.watch));
        }
        let others = before.iter().chain(after.iter()).map(NucleusRun::view).collect();
        let rates =
            before.iter().map(|run| run.rate).chain([run.rate]).chain(after.iter().map(|run| run.rate));
        if let Some(merge) = observers.merge {
            merge.borrow_mut().begin(call);
        }
        let mut combined = CombinedObserver {
            watch: &mut *observers.watch,
            done: observers.done,
            own: call.substeps,
            total: observers.total,
            nucleus: call.nucleus,
            idle: &run.idle,
            others,
            rates: rates.collect(),
            merge: observers.merge,
            program: &self.program,
        };
        complete(run.solver.step(&input, &mut combined))
    }

    /// The current frame.
    pub fn frame(&self) -> i64 {
        self.frame
    }

    /// The frame after the next [`advance`](Self::advance). Solved frames are counted from the start, also in a run that is
    /// continued beyond an earlier last frame. The last frame of the scene is always one of them.
    pub fn next_frame(&self) -> i64 {
        let (every, TimeSpan { start, end, .. }) = (self.program.whole_frames(), self.program.time());
        let next = start + ((self.frame - start).div_euclid(every) + 1) * every;
        if self.frame < end { next.min(end) } else { next }
    }

    /// Whether the last frame has been reached.
    pub fn is_done(&self) -> bool {
        self.frame >= self.program.time().end
    }

    /// All objects: cloths, then colliders, each in the order of their ids.
    pub fn objects(&self) -> &[Object] {
        self.program.objects()
    }

    /// Scene units per metre in the first nucleus.
    pub fn units_per_metre(&self) -> f64 {
        self.program.units_per_metre()
    }

    /// The current state of all objects. Velocities are per second of the scene.
    pub fn state(&self) -> &dyn StateView {
        match self.runs.as_slice() {
            [only] if only.rate == 1.0 && only.idle.is_empty() => &only.solver,
            _ => self,
        }
    }

    /// The solver of the first nucleus.
    pub fn solver(&self) -> &Solver<R> {
        &self.runs[0].solver
    }

    /// The solvers of all nuclei, in the order of the program.
    pub fn solvers(&self) -> impl Iterator<Item = &Solver<R>> {
        self.runs.iter().map(|run| &run.solver)
    }

    /// The program of the run.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The state as bytes, to continue the run later. An audit is not saved.
    pub fn save(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.frame.encode(&mut bytes);
        (self.runs.len() as u64).encode(&mut bytes);
        self.runs.iter().for_each(|run| run.save(&mut bytes));
        add_checksum(CHECKPOINT_KIND, &bytes)
    }

    /// Continues a saved run with the same bits. `threads` is the number of threads, which may differ from before.
    ///
    /// # Errors
    /// If the bytes are damaged, of another version, or of a program with other objects.
    pub fn restored(program: &Program, threads: usize, bytes: &[u8]) -> Result<Self, RestoreError> {
        let mut from = Reader::new(verify_checksum(CHECKPOINT_KIND, bytes)?);
        let (frame, count) = <(i64, u64)>::decode(&mut from).ok_or(RestoreError::Damaged)?;
        if count != program.nuclei().len() as u64 {
            return Err(RestoreError::OtherModel);
        }
        let runs =
            (0..program.nuclei().len()).map(|k| NucleusRun::restored(program, k, frame, threads, &mut from));
        let runs: Vec<NucleusRun<R>> = runs.collect::<Result<_, _>>()?;
        let is_whole = from.is_at_end();
        is_whole
            .then(|| Self { runs, frame, threads, program: program.clone(), audit: None })
            .ok_or(RestoreError::Damaged)
    }

    fn combined(&self) -> CombinedState<'_> {
        let parts = self.runs.iter().map(NucleusRun::view).collect();
        let rates = self.runs.iter().map(|run| run.rate).collect();
        CombinedState { program: &self.program, parts, rates, solving: None }
    }
}

/// What sees the states of a frame.
struct Watches<'a> {
    watch: &'a mut dyn StepObserver,
    /// The motion of the ground planes in the frame, for the audit.
    planes: &'a RefCell<GroundPlanes>,
    /// The substeps of several nuclei, where they are merged by time.
    merge: Option<&'a RefCell<SubstepMerge>>,
}

/// The observers of a frame, and its progress in substeps.
struct Observers<'a> {
    watch: &'a mut dyn StepObserver,
    planes: &'a RefCell<GroundPlanes>,
    merge: Option<&'a RefCell<SubstepMerge>>,
    done: u32,
    total: u32,
}

impl<R: Real> StateView for Simulation<R> {
    fn object_counts(&self) -> Option<[usize; 2]> {
        self.combined().object_counts()
    }

    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.combined().positions(cloth, units_per_metre, out);
    }

    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.combined().velocities(cloth, units_per_metre, out);
    }

    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        self.combined().contacts(out);
    }

    fn looks(&self, cloth: ClothId, out: &mut Vec<ParticleLook>) {
        self.combined().looks(cloth, out);
    }

    fn orientations(&self, cloth: ClothId, out: &mut Vec<[f32; 4]>) {
        self.combined().orientations(cloth, out);
    }

    fn particles(&self, cloth: ClothId, out: &mut Vec<Particle>) {
        self.combined().particles(cloth, out);
    }

    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.combined().collider_positions(collider, units_per_metre, out);
    }

    fn collider_moved(&self, collider: ColliderId) -> bool {
        self.combined().collider_moved(collider)
    }

    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        self.combined().collider_points(collider, share, out);
    }

    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        self.combined().point(cloth, point)
    }
}

#[cfg(test)]
mod tests;
