//! Meshes that change during a run, read back at a time sample.
//!
//! Each mesh of an object has a number, and each points message states the number of its mesh. A lost mesh is therefore
//! never confused with another one, even with the same number of points.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use crate::error::ReadError;
use crate::messages::points::PointsMessage;
use crate::messages::topology;
use crate::read::playback::{FIRST, Mesh, Playback};
use crate::run::ObjectInfo;

impl<R: Read + Seek> Playback<R> {
    /// An object with its mesh at a time sample; the same as in [`objects`](Self::objects) if the mesh never changes.
    ///
    /// # Errors
    /// When the object or the sample does not exist, or the mesh is lost.
    pub fn object_at(&mut self, object: usize, sample: usize) -> Result<&ObjectInfo, ReadError> {
        let time_samples = self.time_samples().len();
        let at =
            self.time_samples().get(sample).ok_or(ReadError::NoTimeSample { sample, time_samples })?.log_time;
        self.mesh_at(object, at).map(|(_, object)| object)
    }

    /// All objects with their meshes at a time sample.
    ///
    /// # Errors
    /// As [`object_at`](Self::object_at).
    pub fn objects_at(&mut self, sample: usize) -> Result<Vec<&ObjectInfo>, ReadError> {
        let all = 0..self.objects().len();
        let mut is_first = Vec::with_capacity(all.len());
        for object in all {
            self.object_at(object, sample)?;
            let at = self.time_samples()[sample].log_time;
            is_first.push(self.is_first(self.mesh_channels[object], at));
        }
        let later = self.meshes.iter().map(|mesh| mesh.as_ref().map(|mesh| &mesh.object));
        let all = self.objects().iter().zip(later).zip(is_first);
        Ok(all.map(|((first, later), is_first)| later.filter(|_| !is_first).unwrap_or(first)).collect())
    }

    /// The time samples at which an object's mesh differs from that at the sample before, in order.
    pub fn mesh_changes(&self, object: usize) -> Vec<usize> {
        let Some(&channel) = self.mesh_channels.get(object) else { return Vec::new() };
        let times = self.file_index.message_times(channel).into_iter().filter(|&time| time > FIRST);
        let sample = |time: u64| {
            let before = self.time_samples().partition_point(|sample| sample.log_time < time);
            Some(before).filter(|&sample| sample < self.time_samples().len())
        };
        let mut changes: Vec<usize> = times.filter_map(sample).collect();
        changes.dedup();
        changes
    }

    /// The mesh of an object at a time, and its number. The last one is cached.
    pub(crate) fn mesh_at(&mut self, object: usize, log_time: u64) -> Result<(u32, &ObjectInfo), ReadError> {
        let objects = self.objects().len();
        let channel = *self.mesh_channels.get(object).ok_or(ReadError::NoObject { object, objects })?;
        let name = &self.objects()[object].name;
        let lost = ReadError::MeshLost { object: name.clone(), frame: self.run().frame_at(log_time) };
        // An object whose mesh is lost has no mesh time; it is shown as points.
        let time = self.mesh_time(channel, log_time).unwrap_or(FIRST);
        if time == FIRST {
            return Ok((0, &self.objects()[object]));
        }
        if self.meshes[object].as_ref().is_none_or(|mesh| mesh.time != time) {
            let name = name.clone();
            let latest = match self.load_latest(channel, log_time) {
                Ok(Some(latest)) => latest,
                Ok(None) | Err(ReadError::Damaged { .. }) => return Err(lost),
                Err(error) => return Err(error),
            };
            let message = self.latest_message(channel, latest);
            let Some((found, number)) = message.and_then(|data| topology::read(&name, data)) else {
                return Err(lost);
            };
            self.meshes[object] = Some(Mesh { time, number, object: found });
        }
        self.meshes[object].as_ref().map(|mesh| (mesh.number, &mesh.object)).ok_or(lost)
    }

    /// When the mesh that holds at a time was recorded.
    fn mesh_time(&self, channel: u16, log_time: u64) -> Option<u64> {
        let original = self.file_index.latest(channel, log_time);
        let copied = self.file_index.copies.latest(channel, log_time);
        original.max(copied).map(|(time, _)| time)
    }

    /// Whether the mesh at a time is the first on its channel.
    fn is_first(&self, channel: u16, log_time: u64) -> bool {
        self.mesh_time(channel, log_time).is_none_or(|time| time == FIRST)
    }

    /// Adds to `missed` the object, time and mesh number of all points in the loaded chunk whose mesh was in no chunk
    /// before. `numbers` has the last mesh number of each mesh channel.
    pub(crate) fn find_missing_meshes(
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

    /// Reports the frames of missing meshes that have no redundant copy either.
    pub(crate) fn report_lost_meshes(&mut self, missed: Vec<(usize, u64, u32)>) -> Result<(), ReadError> {
        for (object, log_time, number) in missed {
            match self.mesh_at(object, log_time) {
                Ok((found, _)) if found == number => {}
                Ok(_) | Err(ReadError::MeshLost { .. }) => {
                    self.corruption.frames.push(self.run().frame_at(log_time));
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}
