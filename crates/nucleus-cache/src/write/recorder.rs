//! Records a run during simulation: one chunk per frame, handed to the system before the next frame begins.

use std::collections::HashSet;
use std::fs::File;
use std::io::{Seek, Write};
use std::path::Path;

use nucleus_core::{ContactState, StateView};
use serde::Serialize;
use serde_json::Value;

use crate::container::part_file::{self, PartFile, PartPaths};
use crate::container::writer::{CacheWriter, Schemas};
use crate::error::RecordError;
use crate::messages::attribute::{Attribute, CONTACTS, LOOKS, PARTICLES, ROTATION, RestEdges, STRAIN};
use crate::messages::points::{self, Stamp};
use crate::messages::{checkpoint, topology};
use crate::run::{ObjectInfo, ObjectKind, RunInfo, Source};
use crate::write::replay_check::ReplayCheck;

/// Records a run.
///
/// ```no_run
/// # use nucleus_cache::*; use nucleus_core::*;
/// # fn run(solver: &mut Solver, input: &FrameInput, objects: Vec<(Source, ObjectInfo)>) -> Result<(), RecordError> {
/// let run = RunInfo { start: 1, end: 24, ..RunInfo::default() };
/// let mut recorder = Recorder::create("hang.mcap", &run, objects)?;
/// recorder.record_start(solver)?;
/// for frame in 2..=24 {
///     let report = solver.step(input, &mut recorder.frame(frame)?);
///     recorder.end_frame(&report.max_strain)?;
/// }
/// recorder.finish()?;
/// # Ok(()) }
/// ```
///
/// The file grows under its name with `.part` appended and is renamed when it is whole. A recorder that is dropped
/// before [`finish`](Self::finish) leaves a `.part` that plays to its last whole frame.
pub struct Recorder<W: Write + Seek = File> {
    pub(crate) writer: CacheWriter<W>,
    pub(crate) run: RunInfo,
    pub(crate) tracks: Vec<Track>,
    pub(crate) report_channel: u16,
    /// Channel of checkpoints, if any are recorded.
    pub(crate) checkpoint_channel: Option<u16>,
    /// Frame of the last checkpoint.
    pub(crate) checkpointed: Option<i32>,
    pub(crate) last_frame: i32,
    /// The frame at which the interval of the last frame begins.
    pub(crate) interval_start: i32,
    pub(crate) time_samples: u64,
    /// Frame before the one in flight, and the number of time samples at its end.
    pub(crate) before: Option<(i32, u64)>,
    pub(crate) paths: Option<PartPaths>,
    /// Whether the frame in flight has had a step.
    pub(crate) is_stepped: bool,
    /// Compares new messages with those of an older cache, in a resumed run.
    pub(crate) replay_check: Option<Box<ReplayCheck>>,
    /// The first error during a step; [`end_frame`](Self::end_frame) returns it.
    pub(crate) deferred_error: Option<RecordError>,
    /// Buffers that are reused for every message.
    pub(crate) values: Vec<[f32; 3]>,
    pub(crate) strain: Vec<f32>,
    pub(crate) contacts: Vec<Vec<ContactState>>,
    /// Number of points in contact and of compressed points at the end of the frame, where recorded.
    pub(crate) contact_counts: Option<[usize; 2]>,
    pub(crate) message: Vec<u8>,
}

/// The channels and the state of one recorded object.
pub(crate) struct Track {
    pub name: String,
    pub source: Source,
    pub channel: u16,
    /// Channel of its meshes, and the number of its current mesh.
    pub mesh_channel: u16,
    pub mesh: u32,
    pub kind: ObjectKind,
    pub points: usize,
    /// Channel of contact states, if recorded.
    pub contacts: Option<u16>,
    /// Channel of strain and the rest edges, if recorded.
    pub strain: Option<(u16, RestEdges)>,
    /// Channel of the looks of particles, if recorded.
    pub looks: Option<u16>,
    /// Channel of the orientations of particles, if recorded.
    pub rotation: Option<u16>,
    /// Channel of the numbers and ages of particles, if recorded.
    pub particles: Option<u16>,
    /// Whether it has moved since it was last recorded.
    pub has_moved: bool,
}

/// Totals of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Recorded {
    /// Frames in the file, including the initial state.
    pub frames: u32,
    /// Time samples in the file: as many as frames, or more if substeps are recorded.
    pub time_samples: u64,
    /// Size of the file in bytes.
    pub bytes: u64,
}

impl Recorder<File> {
    /// Begins a cache at `path`, where no file may exist.
    ///
    /// # Errors
    /// When a file exists, the file cannot be created, or the description contradicts itself.
    pub fn create(
        path: impl AsRef<Path>,
        run: &RunInfo,
        objects: Vec<(Source, ObjectInfo)>,
    ) -> Result<Self, RecordError> {
        Self::at(path.as_ref(), run, objects, false)
    }

    /// Begins a cache at `path` that replaces an older one when it is whole. Any other file is left untouched.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn replace(
        path: impl AsRef<Path>,
        run: &RunInfo,
        objects: Vec<(Source, ObjectInfo)>,
    ) -> Result<Self, RecordError> {
        Self::at(path.as_ref(), run, objects, true)
    }

    fn at(
        path: &Path,
        run: &RunInfo,
        objects: Vec<(Source, ObjectInfo)>,
        replace: bool,
    ) -> Result<Self, RecordError> {
        check(run, &objects)?;
        let PartFile { file, paths } = part_file::create(path, replace)?;
        let mut recorder = Self::to_writer(file, run, objects)?;
        recorder.paths = Some(paths);
        Ok(recorder)
    }
}

impl<W: Write + Seek> Recorder<W> {
    /// Begins a cache in an empty `target`.
    ///
    /// # Errors
    /// When writing fails or the description contradicts itself.
    pub fn to_writer(
        target: W,
        run: &RunInfo,
        objects: Vec<(Source, ObjectInfo)>,
    ) -> Result<Self, RecordError> {
        check(run, &objects)?;
        let mut recorder = Self {
            writer: CacheWriter::create(target, run.packing)?,
            run: run.clone(),
            tracks: Vec::with_capacity(objects.len()),
            report_channel: 0,
            checkpoint_channel: None,
            checkpointed: None,
            last_frame: run.start,
            interval_start: run.start,
            time_samples: 0,
            before: None,
            paths: None,
            is_stepped: false,
            replay_check: None,
            deferred_error: None,
            values: Vec::new(),
            strain: Vec::new(),
            contacts: Vec::new(),
            contact_counts: None,
            message: Vec::new(),
        };
        recorder.begin(objects)?;
        Ok(recorder)
    }

    /// Records the initial state: substep 0 of the start frame.
    ///
    /// # Errors
    /// When writing fails or an object has another number of points than announced.
    pub fn record_start(&mut self, state: &dyn StateView) -> Result<(), RecordError> {
        self.record(Stamp::start(self.run.start), state)?;
        self.writer.close_frame()
    }

    /// Ends the frame with its report and hands it to the system. The report becomes a JSON object with the field
    /// `frame`, and with the numbers of points `touching` and `compressed` if contact states are recorded.
    ///
    /// # Errors
    /// When writing failed, now or during the step, or when the frame had no step.
    pub fn end_frame(&mut self, report: &impl Serialize) -> Result<(), RecordError> {
        if let Some(deferred_error) = self.deferred_error.take() {
            return Err(deferred_error);
        }
        if !std::mem::take(&mut self.is_stepped) {
            let expected = if self.before.is_some() { self.last_frame } else { self.next_frame() };
            return Err(RecordError::NotStepped { expected });
        }
        let frame = self.last_frame;
        let report = report_line(frame, self.contact_counts, report)
            .map_err(|source| RecordError::Report { frame, source })?;
        let stamp = Stamp { frame, substep: 1, substeps: 1, time: self.run.end_time(frame) };
        self.message.clear();
        self.message.extend_from_slice(report.to_string().as_bytes());
        self.writer.send(&stamp, self.report_channel, &self.message)?;
        self.writer.close_frame()?;
        self.before = None;
        self.finish_replay()
    }

    /// Discards the frame in flight. Returns whether nothing of it was written. If substeps were written, the file
    /// cannot be finished and stays a `.part`.
    pub fn discard_frame(&mut self) -> bool {
        let Some((frame, time_samples)) = self.before.take() else { return true };
        self.last_frame = frame;
        self.time_samples == time_samples && self.deferred_error.is_none()
    }

    /// Whether the run records checkpoints.
    pub fn records_checkpoints(&self) -> bool {
        self.run.checkpoint > 0
    }

    /// Whether a checkpoint is due at the end of the last recorded frame.
    pub fn checkpoint_due(&self) -> bool {
        let RunInfo { start, checkpoint, .. } = self.run;
        let period = |frame: i32| (i64::from(frame) - i64::from(start)) / i64::from(checkpoint.max(1));
        let due = |last: i32| period(self.last_frame) > period(last);
        checkpoint > 0 && self.checkpointed.is_none_or(due)
    }

    /// Whether the last recorded frame needs a checkpoint if the run ends there.
    pub fn final_checkpoint_due(&self) -> bool {
        self.run.checkpoint > 0 && self.replay_check.is_none() && self.checkpointed != Some(self.last_frame)
    }

    /// Records a checkpoint at the end of the last recorded frame and hands it to the system.
    ///
    /// # Errors
    /// When writing fails.
    pub fn record_checkpoint(&mut self, bytes: &[u8]) -> Result<(), RecordError> {
        let Some(channel) = self.checkpoint_channel else { return Ok(()) };
        let (frame, is_last) = (self.last_frame, !self.checkpoint_due());
        let has_moved = self.tracks.iter().map(|track| track.has_moved);
        checkpoint::write(frame, is_last, has_moved, bytes, &mut self.message);
        let stamp = match frame == self.run.start {
            true => Stamp::start(frame),
            false => Stamp { frame, substep: 1, substeps: 1, time: self.run.end_time(frame) },
        };
        self.writer.send(&stamp, channel, &self.message)?;
        self.checkpointed = Some(frame);
        self.writer.close_chunk()
    }

    /// Writes the index, closes the file and gives it its final name.
    ///
    /// # Errors
    /// When writing fails; the recorded frames remain readable.
    pub fn finish(self) -> Result<Recorded, RecordError> {
        if let Some(replay_check) = &self.replay_check {
            self.paths.iter().for_each(PartPaths::remove);
            return Err(RecordError::ReplayIncomplete {
                frame: self.last_frame,
                until: replay_check.until(),
            });
        }
        let (frames, bytes) = self.writer.finish()?;
        if let Some(paths) = self.paths {
            paths.commit().map_err(|source| RecordError::Write { frames, bytes, source })?;
        }
        Ok(Recorded { frames, time_samples: self.time_samples, bytes })
    }

    /// Writes the records before the first frame: metadata, channels, meshes.
    fn begin(&mut self, objects: Vec<(Source, ObjectInfo)>) -> Result<(), RecordError> {
        for record in self.run.to_metadata().into_iter().chain(self.run.extras_to_metadata()) {
            self.writer.metadata(&record)?;
        }
        let schemas = self.writer.own_schemas(|one| one.is_recorded(&self.run), self.run.checkpoint > 0)?;
        self.report_channel = self.writer.channel("/report", 0, "json")?;
        if self.run.checkpoint > 0 {
            let channel = self.writer.channel(
                checkpoint::TOPIC,
                schemas.of(checkpoint::ENCODING),
                checkpoint::ENCODING,
            )?;
            self.checkpoint_channel = Some(channel);
        }
        for (source, object) in &objects {
            let (name, points) = (object.name.clone(), object.rest.len());
            let is_cloth = matches!(source, Source::Cloth(_));
            let mesh_channel = self.channel(&schemas, &name, "topology", topology::ENCODING)?;
            let channel = self.channel(&schemas, &name, "points", points::ENCODING)?;
            if object.kind == ObjectKind::Collider {
                self.writer.hold(channel); // A collider is recorded only when it moves.
            }
            let are_particles = is_cloth && object.kind == ObjectKind::Particles;
            let mut attribute =
                |has: bool, attribute: &Attribute| match has && attribute.is_recorded(&self.run) {
                    true => self.channel(&schemas, &name, attribute.topic, attribute.encoding).map(Some),
                    false => Ok(None),
                };
            let contacts = attribute(is_cloth, &CONTACTS)?;
            let strain = attribute(is_cloth, &STRAIN)?.map(|channel| (channel, RestEdges::new(object)));
            let looks = attribute(are_particles, &LOOKS)?;
            let rotation = attribute(are_particles, &ROTATION)?;
            let particles = attribute(are_particles, &PARTICLES)?;
            self.tracks.push(Track {
                name,
                source: *source,
                channel,
                mesh_channel,
                mesh: 0,
                kind: object.kind,
                points,
                contacts,
                strain,
                looks,
                rotation,
                particles,
                has_moved: false,
            });
        }
        for (track, (_, object)) in self.tracks.iter().zip(objects) {
            topology::write(object, 0, &mut self.message);
            self.writer.send(&Stamp::start(self.run.start), track.mesh_channel, &self.message)?;
        }
        Ok(())
    }

    /// Adds a channel of an object.
    fn channel(
        &mut self,
        schemas: &Schemas,
        name: &str,
        topic: &str,
        encoding: &str,
    ) -> Result<u16, RecordError> {
        self.writer.channel(&format!("/{name}/{topic}"), schemas.of(encoding), encoding)
    }
}

/// Validates a run and its objects.
pub(crate) fn check(run: &RunInfo, objects: &[(Source, ObjectInfo)]) -> Result<(), RecordError> {
    if let Some(fault) = run.fault() {
        return Err(RecordError::BadRun { fault });
    }
    if let Some((_, object)) = objects.iter().find(|(_, object)| !object.is_valid()) {
        return Err(RecordError::BadMesh { object: object.name.clone() });
    }
    let mut names = HashSet::new();
    match objects.iter().find(|(_, object)| !names.insert(object.name.as_str())) {
        Some((_, object)) => Err(RecordError::DuplicateName { name: object.name.clone() }),
        None => Ok(()),
    }
}

/// The report as a JSON object with the field `frame`.
fn report_line(
    frame: i32,
    contact_counts: Option<[usize; 2]>,
    report: &impl Serialize,
) -> Result<Value, serde_json::Error> {
    let mut line = match serde_json::to_value(report)? {
        Value::Object(fields) => fields,
        other => serde_json::Map::from_iter([("report".to_owned(), other)]),
    };
    line.insert("frame".to_owned(), frame.into());
    if let Some([touching, compressed]) = contact_counts {
        line.insert("touching".to_owned(), touching.into());
        line.insert("compressed".to_owned(), compressed.into());
    }
    Ok(Value::Object(line))
}
