//! Foxglove's public schemas in an MCAP file: a mesh per object and sample, and its points as a cloud.
//!
//! In Foxglove and Lichtblick a new entity of the same id takes the place of the old one, so a mesh that
//! deforms is one entity per sample. rerun shows clouds, but no meshes of this schema; so each object is both.

mod message;
mod schema;

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::TopicFile;

use crate::clip::Clip;
use crate::error::ExportError;
use crate::output::Output;
use message::{point_cloud, scene_update};

/// Writes one file, in metres.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    out: &Path,
    output: &mut Output,
    told: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    clip.in_metres();
    let mut file = output.file(out.to_owned())?;
    let mut topics = TopicFile::to_writer(&mut file)?;
    let types = schema::file_descriptor_set();
    let updates = topics.schema("foxglove.SceneUpdate", "protobuf", &types)?;
    let clouds = topics.schema("foxglove.PointCloud", "protobuf", &types)?;
    let mut channels = Vec::new();
    for object in clip.objects() {
        let mesh = match object.faces.is_empty() {
            true => None,
            false => Some(topics.channel(&format!("/{}/mesh", object.name), updates, "protobuf")?),
        };
        channels.push((mesh, topics.channel(&format!("/{}/points", object.name), clouds, "protobuf")?));
    }
    let begin = clip.samples()[0].at;
    for sample in 0..clip.samples().len() {
        let time = ((clip.samples()[sample].at - begin) / clip.fps() * 1e9).round() as u64;
        for (object, (mesh, cloud)) in channels.iter().enumerate() {
            let positions = clip.positions(object, sample)?;
            if let Some(mesh) = mesh {
                topics.send(*mesh, time, &scene_update(clip.object_at(object, sample)?, &positions, time))?;
            }
            topics.send(*cloud, time, &point_cloud(&positions, time))?;
        }
        topics.close_chunk()?;
        told((sample + 1) as f64 / clip.samples().len() as f64);
    }
    topics.finish()?;
    output.finish(file)
}
