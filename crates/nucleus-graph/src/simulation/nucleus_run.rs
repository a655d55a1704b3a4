//! One nucleus during a run: its solver, the state of its constraints, and the time it has reached.

use nalgebra::Vector3;
use nucleus_core::{Encode, PointId, Reader, Real, RestoreError, Solver, StateView};

use crate::attributes::nucleus;
use crate::compile::{AttachmentState, EmitterState, NucleusProgram, Program};

use super::idle_colliders::{IdleColliders, WithIdle};

/// One nucleus during a run.
pub(super) struct NucleusRun<R: Real> {
    pub(super) solver: Solver<R>,
    pub(super) attachments: AttachmentState,
    /// `currentTime` of the nucleus at the last evaluation, in frames.
    now: f64,
    /// Scene frame of the last evaluation.
    pub(super) evaluated: f64,
    /// The last evaluation was not solved.
    pub(super) was_skipped: bool,
    /// Solver seconds per second of the scene in the last evaluation: 0 if it was not solved.
    pub(super) rate: f64,
    pub(super) idle: IdleColliders,
}

/// One call of the solver: an evaluation interval of one nucleus.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SolverCall {
    /// Index of the nucleus.
    pub(super) nucleus: usize,
    /// Scene frames at its start and end.
    pub(super) frames: [f64; 2],
    /// Its length in frames of the nucleus' own time.
    pub(super) elapsed: f64,
    /// The evaluation before was not solved: the solver's state is not that of the start of the interval.
    pub(super) is_discontinuous: bool,
    pub(super) substeps: u32,
    /// Index of the evaluation interval in the frame.
    pub(super) interval: u32,
    /// It is the first call at its time.
    pub(super) is_new_time: bool,
    /// The nucleus returns to its initial state first.
    pub(super) resets: bool,
}

impl<R: Real> NucleusRun<R> {
    /// A nucleus in its initial state, at its start frame.
    pub(super) fn new(program: &Program, nucleus: usize, threads: usize) -> Self {
        let index = nucleus;
        let nucleus = &program.nuclei()[nucleus];
        let start = nucleus.start() as f64;
        let now = program.graph().at(start).get(nucleus.node(), &nucleus::CURRENT_TIME);
        let first = program.time().start as f64;
        Self {
            solver: Solver::new(nucleus.model().clone(), threads),
            attachments: AttachmentState::default(),
            now,
            evaluated: start,
            was_skipped: false,
            rate: program.time_rate(index, [start, start + 1.0]),
            idle: idle_at(program, index, first < start, first),
        }
    }

    /// Its state, with colliders that are not solved where the animation has them at the end of the frame.
    pub(super) fn view(&self) -> WithIdle<'_> {
        WithIdle { state: &self.solver, idle: &self.idle, ends_frame: true }
    }

    /// Returns to the initial state of nucleus number `index`. Its time goes on.
    pub(super) fn reset(&mut self, program: &Program, index: usize, threads: usize) {
        let Self { solver, attachments, .. } = Self::new(program, index, threads);
        (self.solver, self.attachments) = (solver, attachments);
    }

    /// Evaluates the time of nucleus number `index` at a scene frame. `None` keeps its state: the nucleus is disabled, it
    /// has not started, its time does not advance, or advances by more than `frameJumpLimit`.
    pub(super) fn evaluate(&mut self, program: &Program, index: usize, frame: f64) -> Option<SolverCall> {
        let moment = program.graph().at(frame);
        let nucleus: &NucleusProgram = &program.nuclei()[index];
        let (id, start) = (nucleus.node(), nucleus.start_time());
        let now = moment.get(id, &nucleus::CURRENT_TIME);
        let (elapsed, from) = (now - self.now, self.evaluated);
        (self.now, self.evaluated) = (now, frame);
        let max_jump = (moment.get(id, &nucleus::FRAME_JUMP_LIMIT) as f64).max(program.every());
        let advances = elapsed > 0.0 && elapsed <= max_jump * (1.0 + 1e-9) && now > start;
        if !advances || !moment.get(id, &nucleus::ENABLE) {
            self.was_skipped = true;
            self.idle.follow(program, index, [from, frame]);
            if now > start {
                self.rate = 0.0;
                self.hold(program, index, [from, frame], elapsed);
            }
            return None;
        }
        self.idle.resume();
        let resets = self.was_skipped && now - elapsed <= start;
        Some(SolverCall {
            nucleus: index,
            frames: [from, frame],
            elapsed,
            is_discontinuous: std::mem::take(&mut self.was_skipped),
            substeps: moment.get(id, &nucleus::SUB_STEPS) as u32,
            interval: 0,
            is_new_time: false,
            resets,
        })
    }

    /// Lets constraints that become enabled in an interval which is not solved take hold of their points, so that they carry
    /// them by all of their motion once it goes on.
    fn hold(&mut self, program: &Program, index: usize, frames: [f64; 2], elapsed: f64) {
        let Self { solver, attachments, .. } = self;
        let position = |cloth, point: PointId| solver.point(cloth, point.index());
        program.interval(index, frames, elapsed, false).pins(attachments, &position);
    }

    /// Appends the state to a checkpoint.
    pub(super) fn save(&self, out: &mut Vec<u8>) {
        let Self { solver, attachments, now, evaluated, was_skipped, rate, idle: _ } = self;
        let AttachmentState { held, formed, emitters, .. } = attachments;
        solver.save().encode(out);
        held.encode(out);
        formed.encode(out);
        emitters.iter().map(|state| (state.emitted, state.remainder)).collect::<Vec<_>>().encode(out);
        (*now, (*evaluated, (*was_skipped, *rate))).encode(out);
    }

    /// Reads the state from a checkpoint that was saved at a frame of the scene.
    pub(super) fn restored(
        program: &Program,
        index: usize,
        frame: i64,
        threads: usize,
        from: &mut Reader<'_>,
    ) -> Result<Self, RestoreError> {
        let nucleus = &program.nuclei()[index];
        let solver = Vec::decode(from).ok_or(RestoreError::Damaged)?;
        let held: Vec<Option<Vec<Vector3<f64>>>> = Encode::decode(from).ok_or(RestoreError::Damaged)?;
        let formed: Vec<bool> = Encode::decode(from).ok_or(RestoreError::Damaged)?;
        let emitters: Vec<(u64, f64)> = Encode::decode(from).ok_or(RestoreError::Damaged)?;
        let (now, (evaluated, (was_skipped, rate))) = Encode::decode(from).ok_or(RestoreError::Damaged)?;
        let emitters: Vec<EmitterState> =
            emitters.into_iter().map(|(emitted, remainder)| EmitterState { emitted, remainder }).collect();
        if !nucleus.accepts_attachments(&held) || !nucleus.accepts_constraints(&formed) {
            return Err(RestoreError::OtherModel);
        }
        let solver = Solver::restored(nucleus.model().clone(), threads, &solver)?;
        let attachments = AttachmentState { held, formed, emitters, ..AttachmentState::default() };
        let idle = idle_at(program, index, was_skipped || frame < nucleus.start(), frame as f64);
        Ok(Self { solver, attachments, now, evaluated, was_skipped, rate, idle })
    }
}

/// The idle colliders of a nucleus at a frame, if it waits there.
fn idle_at(program: &Program, index: usize, waits: bool, frame: f64) -> IdleColliders {
    if waits { IdleColliders::waiting(program, index, frame) } else { IdleColliders::default() }
}
