//! `nucleus info`: the content of a cache, with its losses; of a scene, see [`scene_info`].

use std::fmt::Write;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use nucleus_cache::{CorruptionReport, Detail, FaceSet, ObjectInfo, ObjectKind, Playback, RunInfo, Sizes};
use serde_json::json;

use super::scene_info;
use crate::process::Outcome;
use crate::{figures, files, output};

/// Largest cache, in bytes, that is verified without `--verify`.
const MAX_VERIFIED: u64 = 500_000_000;

/// Shows the program that a scene compiles to, or the content and the losses of a cache.
#[derive(Debug, Args)]
pub struct Info {
    /// The scene (.ron) or the cache (.mcap).
    file: PathBuf,
    /// Verify every frame of the cache and count the bytes of each channel, even in a file larger than 500 MB.
    #[arg(long)]
    verify: bool,
    /// Of a scene: list the points, edges and faces that its constraints select.
    #[arg(long)]
    points: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

impl Info {
    /// Prints the information. Lost frames are a problem.
    pub fn run(self) -> Result<Outcome> {
        if files::is_cache(&self.file) { self.cache() } else { self.scene() }
    }

    fn cache(&self) -> Result<Outcome> {
        let mut cache = files::open_cache(&self.file)?;
        // Verifying unpacks every frame, which is slow in a large file.
        let is_verified = self.verify || cache.bytes() <= MAX_VERIFIED;
        let sizes = if is_verified {
            cache.verify()?;
            Some(cache.sizes()?)
        } else {
            None
        };
        let ranges = particle_ranges(&mut cache, is_verified)?;
        match self.json {
            true => output::print_json(&as_json(&cache, sizes.as_ref(), &ranges))?,
            false => {
                output::print(&as_text(&self.file.display().to_string(), &cache, sizes.as_ref(), &ranges)?)?
            }
        }
        Ok(if cache.corruption().is_intact() { Outcome::Success } else { Outcome::Problem })
    }

    fn scene(&self) -> Result<Outcome> {
        let Some((scene, program, _)) = files::open_scene(&self.file, None)?.report()? else {
            return Ok(Outcome::InvalidInput);
        };
        let info = scene_info::SceneInfo::of(&scene, &program);
        match self.json {
            true => output::print_json(&info.as_json())?,
            false => output::print(&info.as_text(&self.file.display().to_string(), self.points)?)?,
        }
        Ok(Outcome::Success)
    }
}

/// The least and the largest number of particles of an object over the recorded times.
type ParticleRange = Option<[usize; 2]>;

/// That of each object whose particles are born and die; `None` for others, and where frames are not read.
fn particle_ranges(cache: &mut Playback, is_read: bool) -> Result<Vec<ParticleRange>> {
    let varies = is_read && cache.run().particles;
    let mut ranges = Vec::new();
    for object in 0..cache.objects().len() {
        let mut range: ParticleRange = None;
        if varies && cache.objects()[object].kind == ObjectKind::Particles {
            for moment in 0..cache.time_samples().len() {
                // A damaged frame is reported as lost.
                let Ok(positions) = cache.positions(object, moment) else { continue };
                let count = positions.len();
                let [least, most] = range.unwrap_or([count; 2]);
                range = Some([least.min(count), most.max(count)]);
            }
        }
        ranges.push(range);
    }
    Ok(ranges)
}

/// `20 points`; of particles that are born and die, `0 to 479 points`.
fn points(object: &ObjectInfo, range: ParticleRange) -> String {
    match range {
        Some([least, most]) if least < most => format!("{least} to {}", figures::count(most, "point")),
        _ => figures::count(object.rest.len(), "point"),
    }
}

/// The content of a cache as text.
fn as_text(
    name: &str,
    cache: &Playback,
    sizes: Option<&Sizes>,
    ranges: &[ParticleRange],
) -> Result<String, std::fmt::Error> {
    let run = cache.run();
    let mut text = String::new();
    let scene = if run.scene_path.is_empty() { "an unnamed scene" } else { &run.scene_path };
    writeln!(text, "{name}: a run of {scene}")?;
    writeln!(text, "  written by  {}", cache.library())?;
    writeln!(text, "  frames      {}", frames(cache))?;
    writeln!(text, "  recorded    {}", detail(cache))?;
    writeln!(text, "  units       {} per metre", figures::number(run.units_per_metre))?;
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
        None => writeln!(text, "  packed      not counted in a file of this size; `--verify` counts")?,
    }
    writeln!(text, "  lost        {}", lost(cache.corruption(), sizes.is_some()))?;
    let damaged = &cache.corruption().checkpoints;
    let all = cache.checkpoints();
    let intact: Vec<i32> = all.iter().copied().filter(|frame| !damaged.contains(frame)).collect();
    if let Some(last) = intact.last() {
        let of = if intact.len() < all.len() { format!(" of {} intact", all.len()) } else { String::new() };
        let (count, size) = (intact.len(), figures::bytes(cache.checkpoint_bytes()));
        writeln!(
            text,
            "  checkpoints {count}{of}, the last of frame {last}, {size}; `nucleus resume` continues from it"
        )?;
    }
    for (key, value) in &run.extra {
        writeln!(text, "  {key:<11} {value}")?;
    }
    for camera in &run.cameras {
        let motion = if camera.views.len() > 1 { "moving" } else { "static" };
        writeln!(text, "camera {}: {motion}", camera.name)?;
    }
    for (place, object) in cache.objects().iter().enumerate() {
        let [x, y, z] = size(object, run.units_per_metre).map(figures::number);
        let points = points(object, ranges[place]);
        let faces = figures::count(object.faces.len(), "face");
        writeln!(
            text,
            "object {}: {}, {points}, {faces}, {x} x {y} x {z} m{}",
            object.name,
            kind(object.kind),
            changes(cache, place)
        )?;
        for (what, sets) in face_sets(run, object) {
            let names: Vec<String> = sets
                .iter()
                .map(|set| format!("{} ({})", set.name, figures::count(set.faces.len(), "face")))
                .collect();
            writeln!(text, "  {what:<11} {}", names.join(", "))?;
        }
    }
    for (topic, encoding, messages) in cache.channels() {
        let bytes = channel_bytes(sizes, topic).map(|bytes| format!(", {}", figures::bytes(bytes)));
        let messages = figures::count(messages, "message");
        writeln!(text, "channel {topic}: {encoding}, {messages}{}", bytes.unwrap_or_default())?;
    }
    Ok(text)
}

/// The content of a cache as JSON.
fn as_json(cache: &Playback, sizes: Option<&Sizes>, ranges: &[ParticleRange]) -> serde_json::Value {
    let run = cache.run();
    let names = |what: &str, object: &ObjectInfo| -> Vec<&str> {
        let all = face_sets(run, object).filter(|(kind, _)| *kind == what);
        all.flat_map(|(_, sets)| sets).map(|set| set.name.as_str()).collect()
    };
    let objects: Vec<_> = cache
        .objects()
        .iter()
        .enumerate()
        .map(|(place, object)| {
            json!({
                "name": object.name,
                "kind": kind(object.kind),
                "points": object.rest.len(),
                // Of particles that are born and die, over the recorded times.
                "least_points": ranges[place].map(|[least, _]| least),
                "most_points": ranges[place].map(|[_, most]| most),
                "faces": object.faces.len(),
                "groups": names("groups", object),
                "materials": names("materials", object),
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
            // Unknown until every frame has been read.
            "none": if loss.is_intact() && sizes.is_none() { None } else { Some(loss.is_intact()) },
            "verified": sizes.is_some(),
            "cut_off": loss.truncated,
            "index": loss.index,
            "records": loss.records,
            "copies": loss.copies,
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

/// The groups and the materials of an object's faces, where it has any.
fn face_sets<'a>(
    run: &'a RunInfo,
    object: &ObjectInfo,
) -> impl Iterator<Item = (&'static str, &'a [FaceSet])> {
    let sets = run.face_sets.get(&object.name).into_iter();
    sets.flat_map(|sets| [("groups", sets.groups.as_slice()), ("materials", &sets.materials)])
        .filter(|(_, sets)| !sets.is_empty())
}

/// The losses in words. Lost frames are known only once every frame has been read.
fn lost(loss: &CorruptionReport, is_verified: bool) -> String {
    match (is_verified, loss.is_intact()) {
        (true, _) => loss.to_string(),
        (false, true) => "not verified; `--verify` reads every frame".to_owned(),
        (false, false) => format!("{loss}; frames not verified, `--verify` reads every frame"),
    }
}

/// `1 to 48 at 24 per second; the run was to end at 120`.
fn frames(cache: &Playback) -> String {
    let run = cache.run();
    let Some((first, last)) = cache.time_samples().first().zip(cache.time_samples().last()) else {
        return "none".to_owned();
    };
    let rate = figures::number(run.frames_per_second);
    let text = format!("{} to {} at {rate} per second", first.frame, last.frame);
    match last.frame < run.end {
        true => format!("{text}; the run was to end at {}", run.end),
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

/// Unpacked bytes of a channel.
fn channel_bytes(sizes: Option<&Sizes>, topic: &str) -> Option<u64> {
    sizes.map(|sizes| sizes.channels.get(topic).copied().unwrap_or_default())
}

/// `; its mesh changes 3 times, first in frame 12`, or an empty text.
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

/// Extent of the bounding box of an object at rest along each axis, in metres.
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
    fn particles_that_are_born_are_counted_as_a_range() {
        let object = ObjectInfo {
            name: "drops".to_owned(),
            kind: ObjectKind::Particles,
            faces: Default::default(),
            rest: Vec::new(),
        };
        assert_eq!(points(&object, Some([0, 479])), "0 to 479 points");
        assert_eq!(points(&object, Some([0, 0])), "0 points");
        assert_eq!(points(&object, None), "0 points");
    }

    #[test]
    fn a_cache_that_was_not_read_is_not_called_intact() {
        let none = CorruptionReport::default();
        assert_eq!(lost(&none, true), "nothing is lost");
        assert_eq!(lost(&none, false), "not verified; `--verify` reads every frame");
    }
}
