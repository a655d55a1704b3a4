//! `nucleus info` of a cache: run, objects, channels, and what is lost.

use std::fmt::Write;

use nucleus_cache::{CorruptionReport, Detail, ObjectInfo, ObjectKind, Playback, Sizes};
use serde_json::json;

use crate::figures;

/// For people.
pub fn as_text(name: &str, cache: &Playback, sizes: Option<&Sizes>) -> Result<String, std::fmt::Error> {
    let run = cache.run();
    let mut text = String::new();
    let scene = if run.scene_path.is_empty() { "an unnamed scene" } else { &run.scene_path };
    writeln!(text, "{name}: a run of {scene}")?;
    writeln!(text, "  written by  {}", cache.library())?;
    writeln!(text, "  frames      {}", frames(cache))?;
    writeln!(text, "  recorded    {}", detail(cache))?;
    writeln!(text, "  units       {} to the metre", figures::number(run.units_per_metre))?;
    writeln!(text, "  size        {}", figures::bytes(cache.bytes()))?;
    match sizes {
        Some(sizes) => {
            let raw: u64 = sizes.channels.values().sum();
            let share = figures::percent((1000.0 * sizes.packed as f64 / raw.max(1) as f64).round() / 1000.0);
            writeln!(
                text,
                "  packed      {} to {}, {share}",
                figures::bytes(raw),
                figures::bytes(sizes.packed)
            )?;
        }
        None => writeln!(text, "  packed      not counted in a file of this size; --verify does")?,
    }
    writeln!(text, "  lost        {}", lost(cache.corruption(), sizes.is_some()))?;
    if let Some(last) = cache.checkpoints().last() {
        let (count, size) = (cache.checkpoints().len(), figures::bytes(cache.checkpoint_bytes()));
        writeln!(
            text,
            "  checkpoints {count}, the last of frame {last}, {size}; `nucleus resume` goes on from it"
        )?;
    }
    for (key, value) in &run.extra {
        writeln!(text, "  {key:<11} {value}")?;
    }
    for camera in &run.cameras {
        let way = if camera.views.len() > 1 { "moving" } else { "standing still" };
        writeln!(text, "camera {}: {way}", camera.name)?;
    }
    for (place, object) in cache.objects().iter().enumerate() {
        let [x, y, z] = size(object, run.units_per_metre).map(figures::number);
        let points = figures::count(object.rest.len(), "point");
        let faces = figures::count(object.faces.len(), "face");
        writeln!(
            text,
            "object {}: {}, {points}, {faces}, {x} x {y} x {z} m{}",
            object.name,
            kind(object.kind),
            changes(cache, place)
        )?;
    }
    for (topic, encoding, messages) in cache.channels() {
        let bytes = channel_bytes(sizes, topic).map(|bytes| format!(", {}", figures::bytes(bytes)));
        let messages = figures::count(messages, "message");
        writeln!(text, "channel {topic}: {encoding}, {messages}{}", bytes.unwrap_or_default())?;
    }
    Ok(text)
}

/// For machines.
pub fn as_json(cache: &Playback, sizes: Option<&Sizes>) -> serde_json::Value {
    let run = cache.run();
    let objects: Vec<_> = cache
        .objects()
        .iter()
        .enumerate()
        .map(|(place, object)| {
            json!({
                "name": object.name,
                "kind": kind(object.kind),
                "points": object.rest.len(),
                "faces": object.faces.len(),
                "size_metres": size(object, run.units_per_metre),
                "mesh_changes": cache.mesh_changes(place).iter().map(|&at| cache.time_samples()[at].frame).collect::<Vec<_>>(),
            })
        })
        .collect();
    let channels: Vec<_> = cache
        .channels()
        .map(|(topic, encoding, messages)| json!({ "topic": topic, "encoding": encoding, "messages": messages, "bytes": channel_bytes(sizes, topic) }))
        .collect();
    let loss = cache.corruption();
    json!({
        "scene": run.scene_path,
        "written_by": cache.library(),
        "version": run.version,
        "frames": {
            "start": run.start,
            "end": run.end,
            "last": cache.time_samples().last().map(|moment| moment.frame),
            "per_second": run.frames_per_second,
        },
        "moments": cache.time_samples().len(),
        "record": detail(cache),
        "velocities": run.velocities,
        "contacts": run.contacts,
        "strain": run.strain,
        "units_per_metre": run.units_per_metre,
        "bytes": cache.bytes(),
        "loss": {
            // Only who has read every frame knows.
            "none": if loss.is_intact() && sizes.is_none() { None } else { Some(loss.is_intact()) },
            "verified": sizes.is_some(),
            "cut_off": loss.truncated,
            "index": loss.index,
            "scene": loss.scene,
            "bytes": loss.bytes,
            "frames": loss.frames,
            "checkpoints": loss.checkpoints,
            "start": loss.start,
            "run": loss.run,
            "meshes": loss.meshes,
            "objects": loss.objects,
            "text": lost(loss, sizes.is_some()),
        },
        "ground": run.ground.map(|plane| json!({ "origin": plane.origin, "normal": plane.normal })),
        "cameras": run.cameras.iter().map(|camera| &camera.name).collect::<Vec<_>>(),
        "checkpoints": { "frames": cache.checkpoints(), "bytes": cache.checkpoint_bytes() },
        "packed_bytes": sizes.map(|sizes| sizes.packed),
        "extra": run.extra,
        "objects": objects,
        "channels": channels,
    })
}

/// What is lost, as far as that is known: frames are, once every one of them has been read.
fn lost(loss: &CorruptionReport, is_verified: bool) -> String {
    match (is_verified, loss.is_intact()) {
        (true, _) => loss.to_string(),
        (false, true) => "not verified; --verify reads every frame".to_owned(),
        (false, false) => format!("{loss}; frames not verified, --verify reads them all"),
    }
}

/// `1 to 48 at 24 a second; 120 was asked for`.
fn frames(cache: &Playback) -> String {
    let run = cache.run();
    let Some((first, last)) = cache.time_samples().first().zip(cache.time_samples().last()) else {
        return "none".to_owned();
    };
    let rate = figures::number(run.frames_per_second);
    let text = format!("{} to {} at {rate} a second", first.frame, last.frame);
    match last.frame < run.end {
        true => format!("{text}; {} was asked for", run.end),
        false => text,
    }
}

fn detail(cache: &Playback) -> String {
    match cache.run().detail {
        Detail::Frames => "frames".to_owned(),
        Detail::Substeps => "substeps".to_owned(),
        Detail::Every(n) => format!("every {n} frames"),
    }
}

/// Bytes of a channel before they were packed.
fn channel_bytes(sizes: Option<&Sizes>, topic: &str) -> Option<u64> {
    sizes.map(|sizes| sizes.channels.get(topic).copied().unwrap_or_default())
}

/// `; its mesh changes 3 times, first in frame 12`; nothing where it never does.
fn changes(cache: &Playback, object: usize) -> String {
    let changes = cache.mesh_changes(object);
    let Some(&first) = changes.first() else { return String::new() };
    let (times, frame) = (figures::count(changes.len(), "time"), cache.time_samples()[first].frame);
    format!("; its mesh changes {times}, first in frame {frame}")
}

fn kind(kind: ObjectKind) -> &'static str {
    match kind {
        ObjectKind::Cloth => "cloth",
        ObjectKind::Collider => "collider",
        ObjectKind::Particles => "particles",
    }
}

/// Length of the box round an object at rest along each axis, in metres.
fn size(object: &ObjectInfo, units_per_metre: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let along = object.rest.iter().map(|point| f64::from(point[axis]));
        let (low, high) = along.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        (high - low).max(0.0) / units_per_metre
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_said_to_be_whole_that_was_not_read() {
        let none = CorruptionReport::default();
        assert_eq!(lost(&none, true), "nothing is lost");
        assert_eq!(lost(&none, false), "not verified; --verify reads every frame");
    }
}
