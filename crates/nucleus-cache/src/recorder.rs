//! Writes a run as it is simulated: one chunk per frame, safe on disk before the next begins.

use std::collections::HashSet;
use std::fs::File;
use std::io::{Seek, Write};
use std::path::Path;

use nucleus_core::{ClothId, ContactState, StateView, StepObserver, SubstepIndex};
use serde::Serialize;
use serde_json::Value;

use crate::attribute::{CONTACTS, STRAIN, write_contacts};
use crate::object::{ObjectInfo, ObjectKind, Source};
use crate::points::{self, Stamp};
use crate::record_error::RecordError;
use crate::run::{Detail, RunInfo};
use crate::shuffle::shuffle;
use crate::strain::RestEdges;
use crate::stream::{Schemas, Stream};
use crate::target::{Places, Target};
use crate::witness::Witness;
use crate::{checkpoint, target, topology};

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
/// The file grows under its name with `.part` behind it, and has its name when it is whole. A recorder that is
/// dropped before [`finish`](Self::finish) leaves a `.part` that plays to its last whole frame.
pub struct Recorder<W: Write + Seek = File> {
    pub(crate) stream: Stream<W>,
    pub(crate) run: RunInfo,
    pub(crate) tracks: Vec<Track>,
    pub(crate) report_channel: u16,
    /// Where checkpoints go, if there are to be any.
    pub(crate) checkpoint_channel: Option<u16>,
    /// The frame of the last checkpoint.
    pub(crate) checkpointed: Option<i32>,
    pub(crate) last_frame: i32,
    pub(crate) moments: u64,
    /// The frame before the one in flight, and how many moments there were at its end.
    before: Option<(i32, u64)>,
    pub(crate) places: Option<Places>,
    /// An older cache, to which what is recorded is held.
    pub(crate) witness: Option<Box<Witness>>,
    /// What went wrong inside the step, where it could not be said.
    pub(crate) trouble: Option<RecordError>,
    // Reused for every message.
    values: Vec<[f32; 3]>,
    strain: Vec<f32>,
    contacts: Vec<Vec<ContactState>>,
    /// Points that touch and that are pinched at the end of the frame, where that is known.
    rungs: Option<[usize; 2]>,
    pub(crate) message: Vec<u8>,
}

/// An object while it is recorded.
pub(crate) struct Track {
    pub name: String,
    source: Source,
    pub channel: u16,
    /// Where its meshes go, and how many it had before that which it has.
    pub mesh_channel: u16,
    pub mesh: u32,
    pub kind: ObjectKind,
    pub points: usize,
    /// The channel of contacts, if they are recorded.
    pub contacts: Option<u16>,
    /// That of strain, and what it is found from.
    pub strain: Option<(u16, RestEdges)>,
    /// Whether it has moved since it was last recorded.
    pub has_moved: bool,
}

/// What has been recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Recorded {
    /// Frames in the file, the initial state among them.
    pub frames: u32,
    /// Moments in the file: as many as frames, or more where substeps are recorded.
    pub moments: u64,
    /// Size of the file in bytes.
    pub bytes: u64,
}

impl Recorder<File> {
    /// Begins a cache at `path`, where nothing may be yet.
    ///
    /// # Errors
    /// When something is in the way, the file cannot be made, or the description contradicts itself.
    pub fn create(
        path: impl AsRef<Path>,
        run: &RunInfo,
        objects: Vec<(Source, ObjectInfo)>,
    ) -> Result<Self, RecordError> {
        Self::at(path.as_ref(), run, objects, false)
    }

    /// Begins a cache at `path` that takes the place of an older one when it is whole. Any other file there is
    /// left alone.
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
        let Target { file, places } = target::create(path, replace)?;
        let mut recorder = Self::to_writer(file, run, objects)?;
        recorder.places = Some(places);
        Ok(recorder)
    }
}

impl<W: Write + Seek> Recorder<W> {
    /// Begins a cache in an empty `target`.
    ///
    /// # Errors
    /// When `target` cannot be written to or the description contradicts itself.
    pub fn to_writer(
        target: W,
        run: &RunInfo,
        objects: Vec<(Source, ObjectInfo)>,
    ) -> Result<Self, RecordError> {
        check(run, &objects)?;
        let mut recorder = Self {
            stream: Stream::create(target, run.packing)?,
            run: run.clone(),
            tracks: Vec::with_capacity(objects.len()),
            report_channel: 0,
            checkpoint_channel: None,
            checkpointed: None,
            last_frame: run.start,
            moments: 0,
            before: None,
            places: None,
            witness: None,
            trouble: None,
            values: Vec::new(),
            strain: Vec::new(),
            contacts: Vec::new(),
            rungs: None,
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
        self.stream.close_frame()
    }

    /// The observer of frame `frame`, to be shown its substeps.
    ///
    /// # Errors
    /// When the frame does not come after the one before.
    pub fn frame(&mut self, frame: i32) -> Result<FrameRecorder<'_, W>, RecordError> {
        if frame <= self.last_frame {
            return Err(RecordError::FrameOrder { frame, last: self.last_frame });
        }
        self.before = Some((self.last_frame, self.moments));
        self.last_frame = frame;
        self.rungs = None;
        Ok(FrameRecorder { recorder: self })
    }

    /// Ends the frame with its report, a JSON object to which `frame` is added, and where contacts are recorded how many
    /// points are `touching` and `pinched`; and puts it on disk.
    ///
    /// # Errors
    /// When writing failed, now or during the step.
    pub fn end_frame(&mut self, report: &impl Serialize) -> Result<(), RecordError> {
        if let Some(trouble) = self.trouble.take() {
            return Err(trouble);
        }
        let frame = self.last_frame;
        let report =
            report_line(frame, self.rungs, report).map_err(|source| RecordError::Report { frame, source })?;
        let stamp = Stamp { frame, substep: 1, substeps: 1, time: self.run.time(frame, 1, 1) };
        self.message.clear();
        self.message.extend_from_slice(report.to_string().as_bytes());
        self.stream.send(&stamp, self.report_channel, &self.message)?;
        self.stream.close_frame()?;
        self.before = None;
        self.catch_up()
    }

    /// Drops the frame in flight, of which the solver has not come to the end. Whether nothing of it was written: if it was,
    /// because substeps are recorded, the file cannot be finished any more, and stays a `.part`.
    pub fn drop_frame(&mut self) -> bool {
        let Some((frame, moments)) = self.before.take() else { return true };
        self.last_frame = frame;
        self.moments == moments && self.trouble.is_none()
    }

    /// Whether checkpoints are recorded at all.
    pub fn makes_checkpoints(&self) -> bool {
        self.run.checkpoint > 0
    }

    /// Whether a checkpoint is due at the end of the frame that was recorded last.
    pub fn wants_checkpoint(&self) -> bool {
        let RunInfo { start, checkpoint, .. } = self.run;
        let period = |frame: i32| (i64::from(frame) - i64::from(start)) / i64::from(checkpoint.max(1));
        let due = |last: i32| period(self.last_frame) > period(last);
        checkpoint > 0 && self.checkpointed.is_none_or(due)
    }

    /// Whether the frame that was recorded last, if it is to remain the last, is without a checkpoint.
    pub fn wants_last_checkpoint(&self) -> bool {
        self.run.checkpoint > 0 && self.witness.is_none() && self.checkpointed != Some(self.last_frame)
    }

    /// Records what the run can be gone on with from the end of the frame that was recorded last, and puts it on disk.
    ///
    /// # Errors
    /// When writing fails.
    pub fn record_checkpoint(&mut self, bytes: &[u8]) -> Result<(), RecordError> {
        let Some(channel) = self.checkpoint_channel else { return Ok(()) };
        let (frame, is_last) = (self.last_frame, !self.wants_checkpoint());
        let has_moved = self.tracks.iter().map(|track| track.has_moved);
        checkpoint::write(frame, is_last, has_moved, bytes, &mut self.message);
        let stamp = match frame == self.run.start {
            true => Stamp::start(frame),
            false => Stamp { frame, substep: 1, substeps: 1, time: self.run.time(frame, 1, 1) },
        };
        self.stream.send(&stamp, channel, &self.message)?;
        self.checkpointed = Some(frame);
        self.stream.close_chunk()
    }

    /// Writes the index and closes the file.
    ///
    /// # Errors
    /// When writing fails; the frames before are in the file all the same.
    pub fn finish(self) -> Result<Recorded, RecordError> {
        if let Some(witness) = &self.witness {
            self.places.iter().for_each(Places::give_up);
            return Err(RecordError::NotCaughtUp { frame: self.last_frame, until: witness.until() });
        }
        let (frames, bytes) = self.stream.finish()?;
        if let Some(places) = self.places {
            places.settle().map_err(|source| RecordError::Write { frames, bytes, source })?;
        }
        Ok(Recorded { frames, moments: self.moments, bytes })
    }

    /// Writes what stands before the first frame: the run, the channels, the meshes.
    fn begin(&mut self, objects: Vec<(Source, ObjectInfo)>) -> Result<(), RecordError> {
        for record in self.run.to_metadata().into_iter().chain(self.run.cameras_to_metadata()) {
            self.stream.metadata(&record)?;
        }
        let schemas = self.stream.own_schemas(|one| one.is_recorded(&self.run), self.run.checkpoint > 0)?;
        self.report_channel = self.stream.channel("/report", 0, "json")?;
        if self.run.checkpoint > 0 {
            let channel = self.stream.channel(
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
                self.stream.hold(channel); // It is recorded only when it moves.
            }
            let contacts = match is_cloth && self.run.contacts {
                true => Some(self.channel(&schemas, &name, CONTACTS.topic, CONTACTS.encoding)?),
                false => None,
            };
            let strain = match is_cloth && self.run.strain {
                true => Some((
                    self.channel(&schemas, &name, STRAIN.topic, STRAIN.encoding)?,
                    RestEdges::new(object),
                )),
                false => None,
            };
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
                has_moved: false,
            });
        }
        for (track, (_, object)) in self.tracks.iter().zip(objects) {
            topology::write(object, 0, &mut self.message);
            self.stream.send(&Stamp::start(self.run.start), track.mesh_channel, &self.message)?;
        }
        Ok(())
    }

    /// A moment of the frame that is being recorded.
    pub(crate) fn stamp(&self, SubstepIndex { substep, substeps }: SubstepIndex) -> Stamp {
        let frame = self.last_frame;
        Stamp { frame, substep, substeps, time: self.run.time(frame, substep, substeps) }
    }

    /// A channel of an object.
    fn channel(
        &mut self,
        schemas: &Schemas,
        name: &str,
        topic: &str,
        encoding: &str,
    ) -> Result<u16, RecordError> {
        self.stream.channel(&format!("/{name}/{topic}"), schemas.of(encoding), encoding)
    }

    /// Keeps in mind which colliders move while nothing is recorded.
    fn note_motion(&mut self, state: &dyn StateView) {
        for track in &mut self.tracks {
            if let Source::Collider(id) = track.source {
                track.has_moved |= state.collider_moved(id);
            }
        }
    }

    /// Writes one message per object that may have changed.
    fn record(&mut self, stamp: Stamp, state: &dyn StateView) -> Result<(), RecordError> {
        let units = self.run.units_per_metre;
        if self.run.contacts {
            state.contacts(&mut self.contacts);
            self.rungs = Some(
                [ContactState::Touching, ContactState::Compressed]
                    .map(|rung| self.contacts.iter().flatten().filter(|&&found| found == rung).count()),
            );
        }
        for k in 0..self.tracks.len() {
            let &Track { source, channel, mesh, points, has_moved, .. } = &self.tracks[k];
            match source {
                Source::Collider(id) if stamp.substep > 0 && !has_moved && !state.collider_moved(id) => {
                    continue;
                }
                Source::Collider(id) => state.collider_positions(id, units, &mut self.values),
                Source::Cloth(id) => state.positions(id, units, &mut self.values),
            }
            if self.values.len() != points {
                let (object, found) = (self.tracks[k].name.clone(), self.values.len());
                return Err(RecordError::PointCount { object, expected: points, found });
            }
            if let Some((_, edges)) = &self.tracks[k].strain {
                edges.strain(&self.values, &mut self.strain);
            }
            let cloth = match source {
                Source::Cloth(id) if self.run.velocities => Some(id),
                _ => None,
            };
            points::write_head(&stamp, points, mesh, cloth.is_some(), &mut self.message);
            shuffle(self.values.as_flattened(), &mut self.message);
            if let Some(id) = cloth {
                state.velocities(id, units, &mut self.values);
                shuffle(self.values.as_flattened(), &mut self.message);
            }
            if let Some(witness) = &mut self.witness {
                witness.see(&stamp, &self.tracks[k].name, "points", &self.message);
            }
            self.stream.send(&stamp, channel, &self.message)?;
            self.tracks[k].has_moved = false;
            if let Source::Cloth(id) = source {
                self.record_attributes(k, id, &stamp)?;
            }
        }
        self.moments += 1;
        Ok(())
    }

    /// Writes what else is recorded of a cloth.
    fn record_attributes(&mut self, track: usize, cloth: ClothId, stamp: &Stamp) -> Result<(), RecordError> {
        let Track { contacts, strain, points, .. } = &self.tracks[track];
        if let Some((channel, _)) = strain {
            points::write_head(stamp, *points, 0, false, &mut self.message);
            shuffle(&self.strain, &mut self.message);
            self.stream.send(stamp, *channel, &self.message)?;
        }
        let rungs = self.contacts.get(cloth.index()).filter(|rungs| rungs.len() == *points);
        // A scene in which nothing can touch has nothing to say.
        if let (Some(channel), Some(rungs)) = (contacts, rungs) {
            points::write_head(stamp, *points, 0, false, &mut self.message);
            write_contacts(rungs, &mut self.message);
            self.stream.send(stamp, *channel, &self.message)?;
        }
        Ok(())
    }
}

/// Records the substeps of one frame. What goes wrong is told by [`Recorder::end_frame`].
pub struct FrameRecorder<'a, W: Write + Seek = File> {
    pub(crate) recorder: &'a mut Recorder<W>,
}

impl<W: Write + Seek> StepObserver for FrameRecorder<'_, W> {
    fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView) {
        let RunInfo { detail, start, end, .. } = self.recorder.run;
        let wanted = match detail {
            Detail::Substeps => true,
            Detail::Frames => moment.ends_frame(),
            Detail::Every(_) => moment.ends_frame() && detail.takes(self.recorder.last_frame, start, end),
        };
        if self.recorder.trouble.is_some() {
            return;
        }
        if !wanted {
            self.recorder.note_motion(state);
            return;
        }
        self.recorder.trouble = self.recorder.record(self.recorder.stamp(moment), state).err();
    }
}

/// Refuses a run that could not be read back.
pub(crate) fn check(run: &RunInfo, objects: &[(Source, ObjectInfo)]) -> Result<(), RecordError> {
    if let Some(fault) = run.fault() {
        return Err(RecordError::BadRun { fault });
    }
    if let Some((_, object)) = objects.iter().find(|(_, object)| !object.is_sound()) {
        return Err(RecordError::BadMesh { object: object.name.clone() });
    }
    let mut names = HashSet::new();
    match objects.iter().find(|(_, object)| !names.insert(object.name.as_str())) {
        Some((_, object)) => Err(RecordError::DuplicateName { name: object.name.clone() }),
        None => Ok(()),
    }
}

/// The report as a JSON object that names its frame.
fn report_line(
    frame: i32,
    rungs: Option<[usize; 2]>,
    report: &impl Serialize,
) -> Result<Value, serde_json::Error> {
    let mut line = match serde_json::to_value(report)? {
        Value::Object(fields) => fields,
        other => serde_json::Map::from_iter([("report".to_owned(), other)]),
    };
    line.insert("frame".to_owned(), frame.into());
    if let Some([touching, pinched]) = rungs {
        line.insert("touching".to_owned(), touching.into());
        line.insert("pinched".to_owned(), pinched.into());
    }
    Ok(Value::Object(line))
}
