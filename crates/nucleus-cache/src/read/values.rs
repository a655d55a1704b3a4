//! Values of an object at a time sample, frame reports, and checkpoints.

use std::io::{Read, Seek};

use nucleus_core::{ContactState, Particle, ParticleLook};
use serde_json::Value;

use crate::error::ReadError;
use crate::messages::attribute::{self, Attribute};
use crate::messages::byte_shuffle::unshuffle;
use crate::messages::checkpoint::{self, Checkpoint, TOPIC};
use crate::messages::points::PointsMessage;
use crate::read::playback::Playback;
use crate::read::time_index::TimeSample;
use crate::run::{ObjectInfo, ObjectKind};

impl<R: Read + Seek> Playback<R> {
    /// Positions of an object at a time sample, in scene units, one per point of its mesh at that sample. An object at
    /// rest keeps its last positions.
    ///
    /// # Errors
    /// When the object or the sample does not exist, or its frame or the frame of its mesh is damaged.
    pub fn positions(&mut self, object: usize, sample: usize) -> Result<Vec<[f32; 3]>, ReadError> {
        let mut positions = Vec::new();
        self.positions_into(object, sample, &mut positions)?;
        Ok(positions)
    }

    /// As [`positions`](Self::positions), into an existing vector; reading frame after frame is a third faster this
    /// way.
    ///
    /// # Errors
    /// As [`positions`](Self::positions); `out` is then unchanged.
    pub fn positions_into(
        &mut self,
        object: usize,
        sample: usize,
        out: &mut Vec<[f32; 3]>,
    ) -> Result<(), ReadError> {
        self.points(object, sample).map(|points| points.positions(out))
    }

    /// Velocities of an object at a time sample, in scene units per second; `None` when they were not recorded.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn velocities(&mut self, object: usize, sample: usize) -> Result<Option<Vec<[f32; 3]>>, ReadError> {
        self.points(object, sample).map(|points| points.velocities())
    }

    /// Contact state of each point of an object at a time sample; `None` when it was not recorded.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn contacts(&mut self, object: usize, sample: usize) -> Result<Option<Vec<ContactState>>, ReadError> {
        let frame = self.time_samples.get(sample).map_or(0, |sample| sample.frame);
        let Some(bytes) = self.attribute(object, sample, &attribute::CONTACTS)? else { return Ok(None) };
        attribute::read_contacts(bytes).map(Some).ok_or(ReadError::Damaged { frame })
    }

    /// Strain at each point of an object at a time sample, the largest of its edges; `None` when it was not recorded.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn strain(&mut self, object: usize, sample: usize) -> Result<Option<Vec<f32>>, ReadError> {
        let Some(planes) = self.attribute(object, sample, &attribute::STRAIN)? else { return Ok(None) };
        let mut strain = vec![0.0; planes.len() / 4];
        unshuffle(planes, &mut strain);
        Ok(Some(strain))
    }

    /// The looks of the particles of an object at a time sample; `None` where they all look the same.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn looks(&mut self, object: usize, sample: usize) -> Result<Option<Vec<ParticleLook>>, ReadError> {
        Ok(self.attribute(object, sample, &attribute::LOOKS)?.map(attribute::read_looks))
    }

    /// The orientations of the particles of an object at a time sample, as unit quaternions x, y, z, w; `None` where they do
    /// not rotate.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn orientations(&mut self, object: usize, sample: usize) -> Result<Option<Vec<[f32; 4]>>, ReadError> {
        let Some(planes) = self.attribute(object, sample, &attribute::ROTATION)? else { return Ok(None) };
        let mut orientations = vec![[0.0; 4]; planes.len() / 16];
        unshuffle(planes, orientations.as_flattened_mut());
        Ok(Some(orientations))
    }

    /// The particles of an object at a time sample; `None` where they have no numbers of their own, because none is born
    /// or dies.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn particles(&mut self, object: usize, sample: usize) -> Result<Option<Vec<Particle>>, ReadError> {
        Ok(self.attribute(object, sample, &attribute::PARTICLES)?.map(attribute::read_particles))
    }

    /// The bytes of an attribute of an object at a time sample.
    pub(crate) fn attribute(
        &mut self,
        object: usize,
        sample: usize,
        attribute: &Attribute,
    ) -> Result<Option<&[u8]>, ReadError> {
        let (objects, time_samples) = (self.objects.len(), self.time_samples.len());
        let ObjectInfo { name, .. } =
            self.objects.get(object).ok_or(ReadError::NoObject { object, objects })?;
        let TimeSample { frame, log_time, .. } =
            *self.time_samples.get(sample).ok_or(ReadError::NoTimeSample { sample, time_samples })?;
        let channel = self.file_index.channel(&format!("/{name}/{}", attribute.topic));
        let found = channel.and_then(|channel| Some((channel, self.file_index.latest(channel, log_time)?)));
        let Some((channel, (time, index))) = found else { return Ok(None) };
        if time != log_time {
            return Ok(None); // The last message is of an earlier sample.
        }
        let has = self.mesh_at(object, log_time)?.1;
        let count = Some(has.rest.len()).filter(|_| has.kind != ObjectKind::Particles);
        self.load(index)?;
        let message = self.chunk.message(channel, log_time);
        let values = message.and_then(|data| attribute.read(data, count, (frame, log_time)));
        values.map(Some).ok_or(ReadError::Damaged { frame })
    }

    /// The report of each frame in order: JSON objects with a field `frame`. Reads the whole file; frames that are
    /// damaged or have no report are left out.
    ///
    /// # Errors
    /// When the system fails to read.
    pub fn reports(&mut self) -> Result<Vec<Value>, ReadError> {
        let Some(channel) = self.file_index.channel("/report") else { return Ok(Vec::new()) };
        let mut reports = Vec::new();
        for (log_time, index) in self.file_index.messages.get(&channel).cloned().unwrap_or_default() {
            match self.load(index) {
                Ok(()) => {}
                Err(ReadError::Damaged { .. }) => continue,
                Err(error) => return Err(error),
            }
            let line = self.chunk.message(channel, log_time);
            reports.extend(line.and_then(|line| serde_json::from_slice(line).ok()));
        }
        Ok(reports)
    }

    /// The frames that have checkpoints, in order.
    pub fn checkpoints(&self) -> Vec<i32> {
        self.file_index.checkpoints().map(|(time, _)| self.run().frame_at(time)).collect()
    }

    /// Compressed bytes of all checkpoints.
    pub fn checkpoint_bytes(&self) -> u64 {
        let bytes = |(_, chunk): (u64, usize)| &self.file_index.chunks[chunk].bytes;
        self.file_index.checkpoints().map(bytes).map(|bytes| bytes.end - bytes.start).sum()
    }

    /// The checkpoint at the end of a frame; `None` when there is none.
    ///
    /// # Errors
    /// When it is damaged, or the system fails to read.
    pub fn checkpoint(&mut self, frame: i32) -> Result<Option<Checkpoint>, ReadError> {
        let found = self.file_index.checkpoints().find(|&(time, _)| self.run().frame_at(time) == frame);
        let Some((time, chunk)) = found else { return Ok(None) };
        self.load(chunk)?;
        let channel = self.file_index.channel(TOPIC);
        let message = channel.and_then(|channel| self.chunk.message(channel, time));
        let read = message.and_then(checkpoint::read).filter(|checkpoint| checkpoint.frame == frame);
        read.map(Some).ok_or(ReadError::Damaged { frame })
    }

    /// The points message that holds for an object at a time sample.
    fn points(&mut self, object: usize, sample: usize) -> Result<PointsMessage<'_>, ReadError> {
        let (objects, time_samples) = (self.objects.len(), self.time_samples.len());
        let channel = *self.points_channels.get(object).ok_or(ReadError::NoObject { object, objects })?;
        let TimeSample { frame, log_time, .. } =
            *self.time_samples.get(sample).ok_or(ReadError::NoTimeSample { sample, time_samples })?;
        let (mesh, has) = self.mesh_at(object, log_time)?;
        // Particles come and go.
        let count = Some(has.rest.len()).filter(|_| has.kind != ObjectKind::Particles);
        let name = has.name.clone();
        let Some(latest) = self.load_latest(channel, log_time)? else {
            return Err(ReadError::Nothing { object: name, frame });
        };
        let frame = self.run.frame_at(latest.time);
        let is_whole =
            |points: &PointsMessage| (points.stamp.frame, points.stamp.log_time()) == (frame, latest.time);
        let message = self.latest_message(channel, latest).and_then(PointsMessage::read);
        let points = message.filter(is_whole).ok_or(ReadError::Damaged { frame })?;
        match points.mesh == mesh {
            true if count.is_none_or(|count| points.count() == count) => Ok(points),
            true => Err(ReadError::Damaged { frame }),
            false => Err(ReadError::MeshLost { object: name, frame }),
        }
    }
}
