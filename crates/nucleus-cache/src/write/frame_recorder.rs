//! Records one frame: its substeps, and changes of meshes.

use std::fs::File;
use std::io::{Seek, Write};

use nucleus_core::{ClothId, ContactState, Faces, StateView, StepObserver, SubstepIndex};

use crate::error::RecordError;
use crate::messages::attribute::{RestEdges, write_contacts, write_looks, write_particles};
use crate::messages::byte_shuffle::shuffle;
use crate::messages::points::{self, Stamp};
use crate::messages::topology;
use crate::run::{Detail, ObjectInfo, ObjectKind, RunInfo, Source};
use crate::write::recorder::{Recorder, Track};

/// Records the substeps of one frame. [`Recorder::end_frame`] reports errors.
pub struct FrameRecorder<'a, W: Write + Seek = File> {
    pub(crate) recorder: &'a mut Recorder<W>,
}

impl<W: Write + Seek> StepObserver for FrameRecorder<'_, W> {
    fn substep(&mut self, index: SubstepIndex, state: &dyn StateView) {
        self.recorder.is_stepped = true;
        let RunInfo { detail, start, end, .. } = self.recorder.run;
        let wanted = match detail {
            Detail::Substeps => true,
            Detail::Frames => index.ends_frame(),
            Detail::Every(_) => index.ends_frame() && detail.includes(self.recorder.last_frame, start, end),
        };
        if self.recorder.deferred_error.is_some() {
            return;
        }
        if !wanted {
            let noted = self.recorder.check_sources(state).map(|()| self.recorder.note_motion(state));
            self.recorder.deferred_error = noted.err();
            return;
        }
        self.recorder.deferred_error = self.recorder.record(self.recorder.stamp(index), state).err();
    }

    fn observes_substeps(&self) -> bool {
        self.recorder.run.detail == Detail::Substeps
    }
}

impl<W: Write + Seek> FrameRecorder<'_, W> {
    /// Replaces the mesh of an object from substep `index` of this frame on. `rest` has its points in scene units. Call
    /// it before [`substep`](nucleus_core::StepObserver::substep) for that state; [`Recorder::end_frame`] reports
    /// errors.
    pub fn change_mesh(&mut self, index: SubstepIndex, object: &str, faces: Faces, rest: Vec<[f32; 3]>) {
        if self.recorder.deferred_error.is_none() {
            self.recorder.deferred_error = self.recorder.change_mesh(index, object, faces, rest).err();
        }
    }
}

impl<W: Write + Seek> Recorder<W> {
    /// The observer of frame `frame`, to which the solver shows its substeps.
    ///
    /// # Errors
    /// When the frame is not the next one that the run solves.
    pub fn frame(&mut self, frame: i32) -> Result<FrameRecorder<'_, W>, RecordError> {
        let (end, last) = (self.run.end, self.last_frame);
        let expected = self.next_frame();
        if frame > end {
            return Err(RecordError::BeyondEnd { frame, end });
        }
        if frame != expected {
            return Err(RecordError::FrameOrder { frame, last, expected });
        }
        self.is_stepped = false;
        self.before = Some((self.last_frame, self.time_samples));
        // A frame of which an earlier one is missing is no longer than the others.
        let least = i64::from(frame) - i64::from(self.run.interval);
        self.interval_start =
            i32::try_from(least).map_or(self.last_frame, |least| least.max(self.last_frame));
        self.last_frame = frame;
        self.contact_counts = None;
        Ok(FrameRecorder { recorder: self })
    }

    /// The frame after the last recorded one: the next multiple of the interval from the start, or the end.
    pub(crate) fn next_frame(&self) -> i32 {
        let RunInfo { start, end, interval, .. } = self.run;
        let interval = i64::from(interval.max(1));
        let solved = (i64::from(self.last_frame) - i64::from(start)).div_euclid(interval);
        let next = i64::from(start) + (solved + 1) * interval;
        i32::try_from(next.min(i64::from(end))).unwrap_or(end)
    }

    /// The stamp of a substep of the current frame.
    pub(crate) fn stamp(&self, index: SubstepIndex) -> Stamp {
        let (frame, SubstepIndex { substep, substeps }) = (self.last_frame, index);
        Stamp { frame, substep, substeps, time: self.run.time([self.interval_start, frame], index) }
    }

    /// Notes which colliders move in a substep that is not recorded.
    fn note_motion(&mut self, state: &dyn StateView) {
        for track in &mut self.tracks {
            if let Source::Collider(id) = track.source {
                track.has_moved |= state.collider_moved(id);
            }
        }
    }

    /// Writes one message per object that may have changed.
    pub(crate) fn record(&mut self, stamp: Stamp, state: &dyn StateView) -> Result<(), RecordError> {
        self.check_sources(state)?;
        let units = self.run.units_per_metre;
        if self.run.contacts {
            state.contacts(&mut self.contacts);
            self.contact_counts = Some(
                [ContactState::Touching, ContactState::Compressed]
                    .map(|state| self.contacts.iter().flatten().filter(|&&found| found == state).count()),
            );
        }
        for k in 0..self.tracks.len() {
            let &Track { source, channel, mesh, points, kind, has_moved, .. } = &self.tracks[k];
            match source {
                Source::Collider(id)
                    if stamp.substep > 0
                        && !has_moved
                        && !self.marks_time(k)
                        && !state.collider_moved(id) =>
                {
                    continue;
                }
                Source::Collider(id) => state.collider_positions(id, units, &mut self.values),
                Source::Cloth(id) => state.positions(id, units, &mut self.values),
            }
            // Particles come and go.
            let points = if kind == ObjectKind::Particles { self.values.len() } else { points };
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
            if let Some(replay_check) = &mut self.replay_check {
                replay_check.compare(&stamp, &self.tracks[k].name, "points", &self.message);
            }
            self.writer.send(&stamp, channel, &self.message)?;
            self.tracks[k].has_moved = false;
            if let Source::Cloth(id) = source {
                self.record_attributes(k, id, points, &stamp)?;
                let &Track { looks, rotation, particles, .. } = &self.tracks[k];
                self.record_particles(looks, &stamp, |out| state.looks(id, out), write_looks)?;
                let turn = |all: &[[f32; 4]], message: &mut Vec<u8>| shuffle(all.as_flattened(), message);
                self.record_particles(rotation, &stamp, |out| state.orientations(id, out), turn)?;
                self.record_particles(particles, &stamp, |out| state.particles(id, out), write_particles)?;
            }
        }
        self.time_samples += 1;
        Ok(())
    }

    /// Whether an object has a message at every recorded time, moved or not: the first of a run of colliders alone, so that
    /// each frame has one.
    fn marks_time(&self, track: usize) -> bool {
        track == 0 && self.tracks.iter().all(|track| track.kind == ObjectKind::Collider)
    }

    /// Refuses a state that lacks a recorded object.
    fn check_sources(&self, state: &dyn StateView) -> Result<(), RecordError> {
        let Some([cloths, colliders]) = state.object_counts() else { return Ok(()) };
        let is_there = |track: &&Track| match track.source {
            Source::Cloth(id) => id.index() < cloths,
            Source::Collider(id) => id.index() < colliders,
        };
        match self.tracks.iter().find(|track| !is_there(track)) {
            Some(track) => Err(RecordError::NoSource { object: track.name.clone() }),
            None => Ok(()),
        }
    }

    /// Writes strain and contact states of a cloth.
    fn record_attributes(
        &mut self,
        track: usize,
        cloth: ClothId,
        points: usize,
        stamp: &Stamp,
    ) -> Result<(), RecordError> {
        let Track { contacts, strain, .. } = &self.tracks[track];
        if let Some((channel, _)) = strain {
            points::write_head(stamp, points, 0, false, &mut self.message);
            shuffle(&self.strain, &mut self.message);
            self.writer.send(stamp, *channel, &self.message)?;
        }
        let states = self.contacts.get(cloth.index()).filter(|states| states.len() == points);
        // A scene without contact has no contact states.
        if let (Some(channel), Some(states)) = (contacts, states) {
            points::write_head(stamp, points, 0, false, &mut self.message);
            write_contacts(states, &mut self.message);
            self.writer.send(stamp, *channel, &self.message)?;
        }
        Ok(())
    }

    /// Writes a value for each particle of an object, where the channel is recorded: `read` replaces the values, and `write`
    /// appends their bytes to a message.
    fn record_particles<T>(
        &mut self,
        channel: Option<u16>,
        stamp: &Stamp,
        read: impl FnOnce(&mut Vec<T>),
        write: impl FnOnce(&[T], &mut Vec<u8>),
    ) -> Result<(), RecordError> {
        let Some(channel) = channel else { return Ok(()) };
        let mut values = Vec::new();
        read(&mut values);
        if values.is_empty() {
            return Ok(());
        }
        points::write_head(stamp, values.len(), 0, false, &mut self.message);
        write(&values, &mut self.message);
        self.writer.send(stamp, channel, &self.message)
    }

    fn change_mesh(
        &mut self,
        index: SubstepIndex,
        name: &str,
        faces: Faces,
        rest: Vec<[f32; 3]>,
    ) -> Result<(), RecordError> {
        let stamp = self.stamp(index);
        let track = self.tracks.iter_mut().find(|track| track.name == name);
        let track = track.ok_or_else(|| RecordError::NoObject { name: name.to_owned() })?;
        let object = ObjectInfo { name: name.to_owned(), kind: track.kind, faces, rest };
        if !object.is_valid() {
            return Err(RecordError::BadMesh { object: object.name });
        }
        track.set_mesh(&object, track.mesh + 1);
        // A change of mesh requires new positions, even of a resting collider.
        track.has_moved = true;
        topology::write(object, track.mesh, &mut self.message);
        if let Some(replay_check) = &mut self.replay_check {
            replay_check.compare(&stamp, name, "topology", &self.message);
        }
        self.writer.send(&stamp, track.mesh_channel, &self.message)
    }

    /// Copies a mesh from another cache; `true` if it is not the first mesh of its object.
    pub(crate) fn copy_mesh(&mut self, topic: &str, data: &[u8]) -> bool {
        let Some(name) = topology::object_name(topic) else { return false };
        let track = self.tracks.iter_mut().find(|track| track.name == name);
        match (track, topology::read(name, data)) {
            (Some(track), Some((object, number))) if number > 0 => {
                track.set_mesh(&object, number);
                true
            }
            _ => false,
        }
    }
}

impl Track {
    fn set_mesh(&mut self, object: &ObjectInfo, number: u32) {
        self.mesh = number;
        self.points = object.rest.len();
        if let Some((_, edges)) = &mut self.strain {
            *edges = RestEdges::new(object);
        }
    }
}
