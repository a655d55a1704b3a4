//! Reconstructs channels and metadata from the messages, when the start of the file and all redundant copies are lost.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Seek};

use mcap::records::{Channel, MessageHeader};
use nucleus_core::Faces;

use crate::error::ReadError;
use crate::messages::points::{self, PointsMessage, Stamp};
use crate::messages::{attribute, checkpoint, metadata, topology};
use crate::read::playback::Playback;
use crate::run::{Detail, ObjectInfo, ObjectKind, RunInfo};

/// Last part of a topic, and the encoding of a message.
type Kind = (&'static str, &'static str);
const POINTS: Kind = ("points", points::ENCODING);
const TOPOLOGY: Kind = ("topology", topology::ENCODING);

impl<R: Read + Seek> Playback<R> {
    /// Reconstructs the channels from their messages. Objects are named by their order.
    pub(crate) fn infer_channels(&mut self) -> Result<(), ReadError> {
        let mut kinds: BTreeMap<u16, Kind> = BTreeMap::new();
        self.each_message(|header, data| {
            if !kinds.contains_key(&header.channel_id) {
                kinds.extend(kind(header, data).map(|kind| (header.channel_id, kind)));
            }
        })?;
        // A recorder numbers the mesh channel of an object just before its points channel, even without messages.
        let points: Vec<u16> = kinds.iter().filter(|(_, kind)| **kind == POINTS).map(|(&id, _)| id).collect();
        kinds.extend(points.iter().filter_map(|id| Some((id.checked_sub(1)?, TOPOLOGY))));
        self.unnamed_objects = (1..=points.len()).map(|place| format!("object {place}")).collect();
        for (id, (end, encoding)) in kinds {
            let topic = match encoding {
                "json" | checkpoint::ENCODING => format!("/{end}"),
                // A mesh channel precedes the points channel of its object; the other channels follow it.
                topology::ENCODING => {
                    format!("/object {}/{end}", 1 + points.partition_point(|&one| one < id))
                }
                _ => format!("/object {}/{end}", points.partition_point(|&one| one <= id).max(1)),
            };
            let (message_encoding, metadata) = (encoding.to_owned(), BTreeMap::new());
            self.file_index
                .channels
                .insert(id, Channel { id, schema_id: 0, topic, message_encoding, metadata });
        }
        Ok(())
    }

    /// Reconstructs the metadata of the run from the stamps of points messages; `None` without such messages.
    pub(crate) fn infer_run(&mut self) -> Result<Option<RunInfo>, ReadError> {
        let (mut stamps, mut velocities) = (Vec::new(), false);
        self.each_message(|header, data| {
            if kind(header, data) == Some(POINTS)
                && let Some(points) = PointsMessage::read(data)
            {
                stamps.push(points.stamp);
                velocities |= points.velocities().is_some();
            }
        })?;
        let has = |attribute: &attribute::Attribute| {
            self.file_index.channels.values().any(|channel| channel.message_encoding == attribute.encoding)
        };
        let (contacts, strain) = (has(&attribute::CONTACTS), has(&attribute::STRAIN));
        let (looks, rotation) = (has(&attribute::LOOKS), has(&attribute::ROTATION));
        let particles = has(&attribute::PARTICLES);
        let known = RunInfo {
            velocities,
            contacts,
            strain,
            looks,
            rotation,
            particles,
            version: String::new(),
            ..RunInfo::default()
        };
        Ok(of_stamps(&stamps, known).map(|run| metadata::with_cameras(run, &self.file_index.metadata)))
    }

    /// Restores lost metadata and meshes from the recorded scene: the metadata of its run, and its objects in order.
    /// Objects with lost names take the next scene object with the same number of points.
    ///
    /// # Errors
    /// With the reason, when the scene does not match the cache.
    pub fn restore_from_scene(&mut self, run: &RunInfo, objects: Vec<ObjectInfo>) -> Result<(), String> {
        let found = self.run().clone();
        if run.frames_per_second != found.frames_per_second
            || run.start != found.start && !self.corruption.run
        {
            let [scene, cache] = [run, &found].map(|run| (run.start, run.frames_per_second));
            return Err(format!(
                "the scene starts at frame {} with {} frames a second, the cache at frame {} with {}",
                scene.0, scene.1, cache.0, cache.1
            ));
        }
        let mut left = objects.into_iter();
        let unnamed_objects = self.unnamed_objects.clone();
        let lost = std::mem::take(&mut self.corruption.meshes);
        for name in lost {
            let Some(place) = self.objects().iter().position(|object| object.name == name) else { continue };
            let points = self.objects()[place].rest.len();
            let fits = |object: &ObjectInfo| {
                object.rest.len() == points && (unnamed_objects.contains(&name) || object.name == name)
            };
            let Some(object) = left.find(fits) else {
                return Err(format!("the scene has no further object like `{name}`, with {points} points"));
            };
            self.rename(&name, &object.name);
            self.objects[place] = object;
        }
        if std::mem::take(&mut self.corruption.run) {
            let RunInfo {
                start,
                end,
                frames_per_second,
                detail,
                velocities,
                contacts,
                strain,
                looks,
                rotation,
                particles,
                ..
            } = found;
            let run = RunInfo {
                start,
                end,
                frames_per_second,
                detail,
                velocities,
                contacts,
                strain,
                looks,
                rotation,
                particles,
                checkpoint: 0,
                ..run.clone()
            };
            let records = run.to_metadata().into_iter().chain(run.extras_to_metadata());
            records.for_each(|record| self.file_index.set_metadata(record));
            self.corruption.records.clear();
            self.run = run;
        }
        Ok(())
    }

    /// Renames the channels of an object.
    fn rename(&mut self, from: &str, to: &str) {
        for channel in self.file_index.channels.values_mut() {
            if let Some(end) = channel.topic.strip_prefix(&format!("/{from}/")) {
                channel.topic = format!("/{to}/{end}");
            }
        }
    }

    /// An object without its mesh: the points of its first readable message; `None` when there is none.
    pub(crate) fn points_without_mesh(
        &mut self,
        channel: u16,
        name: &str,
    ) -> Result<Option<ObjectInfo>, ReadError> {
        for (time, index) in self.file_index.messages.get(&channel).cloned().unwrap_or_default() {
            match self.load(index) {
                Ok(()) => {}
                Err(ReadError::Damaged { .. }) => continue,
                Err(error) => return Err(error),
            }
            let message = self.chunk.message(channel, time).and_then(PointsMessage::read);
            let Some(points) = message.filter(|points| points.mesh == 0) else { continue };
            let mut rest = Vec::new();
            points.positions(&mut rest);
            let (name, kind, faces) = (name.to_owned(), ObjectKind::Particles, Faces::default());
            return Ok(Some(ObjectInfo { name, kind, faces, rest }));
        }
        Ok(None)
    }

    /// Visits every message of every valid chunk.
    fn each_message(&mut self, mut visit: impl FnMut(&MessageHeader, &[u8])) -> Result<(), ReadError> {
        for index in 0..self.file_index.chunks.len() {
            match self.load(index) {
                Ok(()) => self.chunk.messages().for_each(|(header, data)| visit(header, data)),
                Err(ReadError::Damaged { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

/// The topic and encoding of a message, inferred from its length and time.
fn kind(header: &MessageHeader, data: &[u8]) -> Option<Kind> {
    if data.first() == Some(&b'{') && serde_json::from_slice::<serde_json::Value>(data).is_ok() {
        return Some(("report", "json"));
    }
    let stamped = Stamp::read(data).filter(|(stamp, _)| stamp.log_time() == header.log_time);
    if let Some((stamp, count)) = stamped {
        if PointsMessage::read(data).is_some() {
            return Some(POINTS);
        }
        let sample = (stamp.frame, header.log_time);
        let fits = |one: &&&attribute::Attribute| one.read(data, Some(count as usize), sample).is_some();
        return attribute::ALL.iter().find(fits).map(|one| (one.topic, one.encoding));
    }
    if topology::number(data).is_some() {
        return Some(TOPOLOGY);
    }
    checkpoint::read(data).map(|_| ("checkpoint", checkpoint::ENCODING))
}

/// Start, end, frame rate and sample rate of a run, from the stamps at frame ends.
fn of_stamps(stamps: &[Stamp], known: RunInfo) -> Option<RunInfo> {
    let ends = || stamps.iter().filter(|stamp| stamp.substep == stamp.substeps || stamp.substep == 0);
    let (first, last) =
        (ends().min_by(|a, b| a.time.total_cmp(&b.time))?, ends().max_by(|a, b| a.time.total_cmp(&b.time))?);
    let rate = (f64::from(last.frame) - f64::from(first.frame)) / (last.time - first.time);
    let rate = if rate.is_finite() && rate > 0.0 { rate } else { known.frames_per_second };
    // Frame rates usually have few digits; the quotient is off by rounding.
    let plain = (1e3 * rate).round() / 1e3;
    let frames_per_second = if (plain - rate).abs() < 1e-9 * rate { plain } else { rate };
    let start = first.frame.saturating_sub((first.time * frames_per_second).round() as i32);
    let frames: BTreeSet<i32> = ends().map(|stamp| stamp.frame).collect();
    let step = frames.iter().zip(frames.iter().skip(1)).map(|(one, next)| next - one).min().unwrap_or(1);
    let step = step.max(1) as u32;
    let (detail, interval) =
        match stamps.iter().any(|stamp| 0 < stamp.substep && stamp.substep < stamp.substeps) {
            true => (Detail::Substeps, step),
            false if step > 1 => (Detail::Every(step), 1),
            false => (Detail::Frames, 1),
        };
    Some(RunInfo { start, end: last.frame, frames_per_second, detail, interval, ..known })
}
