//! Meshes that change while a run goes on: told to the recorder, and found again at a moment.
//!
//! Each mesh of an object has a number, and each message of points says which it is of. So a mesh that is lost is never
//! taken for another, even where both have as many points.

use std::collections::BTreeMap;
use std::io::{Read, Seek, Write};

use nucleus_core::{Faces, SubstepIndex};

use crate::object::ObjectInfo;
use crate::open_error::ReadError;
use crate::playback::Playback;
use crate::points::PointsMessage;
use crate::record_error::RecordError;
use crate::recorder::{FrameRecorder, Recorder, Track};
use crate::strain::RestEdges;
use crate::topology;

impl<W: Write + Seek> FrameRecorder<'_, W> {
    /// Gives an object another mesh from `moment` of this frame on, with as many points as `rest` has; those are in scene
    /// units. It is said before the substep is shown that has it. What goes wrong is told by [`Recorder::end_frame`].
    pub fn change_mesh(&mut self, moment: SubstepIndex, object: &str, faces: Faces, rest: Vec<[f32; 3]>) {
        if self.recorder.trouble.is_none() {
            self.recorder.trouble = self.recorder.change_mesh(moment, object, faces, rest).err();
        }
    }
}

impl<W: Write + Seek> Recorder<W> {
    fn change_mesh(
        &mut self,
        moment: SubstepIndex,
        name: &str,
        faces: Faces,
        rest: Vec<[f32; 3]>,
    ) -> Result<(), RecordError> {
        let stamp = self.stamp(moment);
        let track = self.tracks.iter_mut().find(|track| track.name == name);
        let track = track.ok_or_else(|| RecordError::NoObject { name: name.to_owned() })?;
        let object = ObjectInfo { name: name.to_owned(), kind: track.kind, faces, rest };
        if !object.is_sound() {
            return Err(RecordError::BadMesh { object: object.name });
        }
        track.take_mesh(&object, track.mesh + 1);
        // Its points are recorded at the next moment, even of a collider that stands still.
        track.has_moved = true;
        topology::write(object, track.mesh, &mut self.message);
        if let Some(witness) = &mut self.witness {
            witness.see(&stamp, name, "topology", &self.message);
        }
        self.stream.send(&stamp, track.mesh_channel, &self.message)
    }

    /// Takes up a mesh that is copied from another cache; says whether it is another than the object began with.
    pub(crate) fn follow_mesh(&mut self, topic: &str, data: &[u8]) -> bool {
        let Some(name) = topology::object_name(topic) else { return false };
        let track = self.tracks.iter_mut().find(|track| track.name == name);
        match (track, topology::read(name, data)) {
            (Some(track), Some((object, number))) if number > 0 => {
                track.take_mesh(&object, number);
                true
            }
            _ => false,
        }
    }
}

impl Track {
    fn take_mesh(&mut self, object: &ObjectInfo, number: u32) {
        self.mesh = number;
        self.points = object.rest.len();
        if let Some((_, edges)) = &mut self.strain {
            *edges = RestEdges::new(object);
        }
    }
}

/// The time of the meshes that objects begin with.
pub(crate) const FIRST: u64 = 0;

/// A mesh that an object has for a while, and not at first.
pub(crate) struct Mesh {
    /// When it was recorded.
    time: u64,
    number: u32,
    object: ObjectInfo,
}

impl<R: Read + Seek> Playback<R> {
    /// An object with the mesh that it has at a moment. As [`objects`](Self::objects) gives it where that never changes.
    ///
    /// # Errors
    /// When there is no such object or moment, or the mesh is lost.
    pub fn object_at(&mut self, object: usize, moment: usize) -> Result<&ObjectInfo, ReadError> {
        let moments = self.moments().len();
        let at = self.moments().get(moment).ok_or(ReadError::NoMoment { moment, moments })?.log_time;
        self.mesh_at(object, at).map(|(_, object)| object)
    }

    /// All objects with the meshes that they have at a moment.
    ///
    /// # Errors
    /// As [`object_at`](Self::object_at).
    pub fn objects_at(&mut self, moment: usize) -> Result<Vec<&ObjectInfo>, ReadError> {
        let all = 0..self.objects().len();
        let mut is_first = Vec::with_capacity(all.len());
        for object in all {
            self.object_at(object, moment)?;
            let at = self.moments()[moment].log_time;
            is_first.push(self.is_first(self.mesh_channels[object], at));
        }
        let later = self.meshes.iter().map(|mesh| mesh.as_ref().map(|mesh| &mesh.object));
        let all = self.objects().iter().zip(later).zip(is_first);
        Ok(all.map(|((first, later), is_first)| later.filter(|_| !is_first).unwrap_or(first)).collect())
    }

    /// The moments at which an object has another mesh than at the moment before, in order.
    pub fn mesh_changes(&self, object: usize) -> Vec<usize> {
        let Some(&channel) = self.mesh_channels.get(object) else { return Vec::new() };
        let times = self.contents.message_times(channel).into_iter().filter(|&time| time > FIRST);
        let moment = |time: u64| {
            let before = self.moments().partition_point(|moment| moment.log_time < time);
            Some(before).filter(|&moment| moment < self.moments().len())
        };
        let mut changes: Vec<usize> = times.filter_map(moment).collect();
        changes.dedup();
        changes
    }

    /// The mesh of an object at a time, and its number. The one that was asked for last is kept.
    pub(crate) fn mesh_at(&mut self, object: usize, log_time: u64) -> Result<(u32, &ObjectInfo), ReadError> {
        let objects = self.objects().len();
        let channel = *self.mesh_channels.get(object).ok_or(ReadError::NoObject { object, objects })?;
        let name = &self.objects()[object].name;
        let lost = ReadError::MeshLost { object: name.clone(), frame: self.run().frame_at(log_time) };
        // What has no mesh at all is shown as points.
        let time = self.mesh_time(channel, log_time).unwrap_or(FIRST);
        if time == FIRST {
            return Ok((0, &self.objects()[object]));
        }
        if self.meshes[object].as_ref().is_none_or(|mesh| mesh.time != time) {
            let name = name.clone();
            let held = match self.held(channel, log_time) {
                Ok(Some(held)) => held,
                Ok(None) | Err(ReadError::Damaged { .. }) => return Err(lost),
                Err(error) => return Err(error),
            };
            let message = self.held_message(channel, held);
            let Some((found, number)) = message.and_then(|data| topology::read(&name, data)) else {
                return Err(lost);
            };
            self.meshes[object] = Some(Mesh { time, number, object: found });
        }
        self.meshes[object].as_ref().map(|mesh| (mesh.number, &mesh.object)).ok_or(lost)
    }

    /// When the mesh that holds at a time was recorded.
    fn mesh_time(&self, channel: u16, log_time: u64) -> Option<u64> {
        let original = self.contents.latest(channel, log_time);
        let copied = self.contents.copies.latest(channel, log_time);
        original.max(copied).map(|(time, _)| time)
    }

    /// Whether the mesh at a time is the first on its channel.
    fn is_first(&self, channel: u16, log_time: u64) -> bool {
        self.mesh_time(channel, log_time).is_none_or(|time| time == FIRST)
    }

    /// Looks through the chunk in memory for points whose mesh was not come by, and adds their objects, times and mesh
    /// numbers to `missed`. `numbers` has the number of the last mesh of each object that was come by.
    pub(crate) fn note_missed_meshes(
        &self,
        numbers: &mut BTreeMap<u16, u32>,
        missed: &mut Vec<(usize, u64, u32)>,
    ) {
        for (header, data) in self.chunk.messages() {
            if self.mesh_channels.contains(&header.channel_id) {
                numbers.insert(header.channel_id, topology::number(data).unwrap_or(0));
            } else if let Some(object) = self.points_channels.iter().position(|&one| one == header.channel_id)
            {
                let has = numbers.get(&self.mesh_channels[object]).copied().unwrap_or(0);
                let points = PointsMessage::read(data).filter(|points| points.mesh != has);
                missed.extend(points.map(|points| (object, header.log_time, points.mesh)));
            }
        }
    }

    /// Notes the frames of those that have no copy either.
    pub(crate) fn note_lost_meshes(&mut self, missed: Vec<(usize, u64, u32)>) -> Result<(), ReadError> {
        for (object, log_time, number) in missed {
            match self.mesh_at(object, log_time) {
                Ok((found, _)) if found == number => {}
                Ok(_) | Err(ReadError::MeshLost { .. }) => {
                    self.loss.frames.push(self.run().frame_at(log_time));
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}
