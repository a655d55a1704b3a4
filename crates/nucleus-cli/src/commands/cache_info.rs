//! `nucleus info` of a cache: run, objects, channels, and what is lost.

use std::fmt::Write;

use nucleus_cache::{Detail, ObjectInfo, ObjectKind, Playback};
use serde_json::json;

use crate::figures;

/// For people.
pub fn as_text(name: &str, cache: &Playback) -> Result<String, std::fmt::Error> {
    let run = cache.run();
    let mut text = String::new();
    let scene = if run.scene_path.is_empty() { "an unnamed scene" } else { &run.scene_path };
    writeln!(text, "{name}: a run of {scene}")?;
    writeln!(text, "  written by  {}", cache.library())?;
    writeln!(text, "  frames      {}", frames(cache))?;
    writeln!(text, "  recorded    {}", detail(cache))?;
    writeln!(text, "  units       {} to the metre", figures::number(run.units_per_metre))?;
    writeln!(text, "  size        {}", figures::bytes(cache.bytes()))?;
    writeln!(text, "  lost        {}", cache.loss())?;
    for (key, value) in &run.extra {
        writeln!(text, "  {key:<11} {value}")?;
    }
    for object in cache.objects() {
        let [x, y, z] = size(object, run.units_per_metre).map(figures::number);
        let points = figures::count(object.rest.len(), "point");
        let faces = figures::count(object.faces.len(), "face");
        writeln!(
            text,
            "object {}: {}, {points}, {faces}, {x} x {y} x {z} m",
            object.name,
            kind(object.kind)
        )?;
    }
    for (topic, encoding, messages) in cache.channels() {
        writeln!(text, "channel {topic}: {encoding}, {}", figures::count(messages, "message"))?;
    }
    Ok(text)
}

/// For machines.
pub fn as_json(cache: &Playback) -> serde_json::Value {
    let run = cache.run();
    let objects: Vec<_> = cache
        .objects()
        .iter()
        .map(|object| {
            json!({
                "name": object.name,
                "kind": kind(object.kind),
                "points": object.rest.len(),
                "faces": object.faces.len(),
                "size_metres": size(object, run.units_per_metre),
            })
        })
        .collect();
    let channels: Vec<_> = cache
        .channels()
        .map(|(topic, encoding, messages)| json!({ "topic": topic, "encoding": encoding, "messages": messages }))
        .collect();
    let loss = cache.loss();
    json!({
        "scene": run.scene_path,
        "written_by": cache.library(),
        "version": run.version,
        "frames": {
            "start": run.start,
            "end": run.end,
            "last": cache.moments().last().map(|moment| moment.frame),
            "per_second": run.frames_per_second,
        },
        "moments": cache.moments().len(),
        "record": detail(cache),
        "velocities": run.velocities,
        "units_per_metre": run.units_per_metre,
        "bytes": cache.bytes(),
        "loss": {
            "none": loss.is_none(),
            "cut_off": loss.cut_off,
            "index": loss.index,
            "scene": loss.scene,
            "bytes": loss.bytes,
            "frames": loss.frames,
            "text": loss.to_string(),
        },
        "extra": run.extra,
        "objects": objects,
        "channels": channels,
    })
}

/// `1 to 48 at 24 a second; 120 was asked for`.
fn frames(cache: &Playback) -> String {
    let run = cache.run();
    let Some((first, last)) = cache.moments().first().zip(cache.moments().last()) else {
        return "none".to_owned();
    };
    let rate = figures::number(run.frames_per_second);
    let text = format!("{} to {} at {rate} a second", first.frame, last.frame);
    match last.frame < run.end {
        true => format!("{text}; {} was asked for", run.end),
        false => text,
    }
}

fn detail(cache: &Playback) -> &'static str {
    match cache.run().detail {
        Detail::Frames => "frames",
        Detail::Substeps => "substeps",
    }
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
