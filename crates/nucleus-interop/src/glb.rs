//! Binary glTF 2.0: a mesh per object, a morph target per sample, and an animation of the target weights.
//!
//! The weight of target k is 1 at sample k, and all weights are 0 at sample 0. Between samples the weights are linear,
//! so points move along straight lines, as in a point cache.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::ObjectInfo;
use serde_json::{Value, json};

use crate::clip::{Clip, extent};
use crate::error::ExportError;
use crate::output::{OutFile, Output};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const POINTS: u32 = 0;
const TRIANGLES: u32 = 4;

/// Writes one file in metres, as glTF requires.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    out: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    clip.in_metres();
    let (text, length, moving) = describe(clip, &mut |share| progress(0.5 * share))?;
    let mut file = output.file(out.to_owned())?;
    let text = padded(text.to_string().into_bytes(), b' ');
    let total = 12 + 8 + text.len() as u64 + 8 + length;
    let total = u32::try_from(total)
        .map_err(|_| ExportError::TooLarge { format: "glb", quantity: format!("{total} bytes") })?;
    file.bytes(b"glTF");
    [2, total, text.len() as u32].iter().for_each(|word: &u32| file.bytes(&word.to_le_bytes()));
    file.bytes(b"JSON");
    file.bytes(&text);
    file.bytes(&(length as u32).to_le_bytes());
    file.bytes(b"BIN\0");
    write_times(clip, &mut file);
    for (object, moves) in moving.iter().enumerate() {
        write_object(clip, object, *moves, &mut file)?;
        progress(0.5 + 0.5 * (object + 1) as f64 / moving.len() as f64);
    }
    output.finish(file)
}

/// The JSON part under construction, and the length of the binary part in bytes.
struct Document {
    accessors: Vec<Value>,
    views: Vec<Value>,
    length: u64,
}

impl Document {
    /// Adds an array of values; returns the index of its accessor.
    fn add(&mut self, kind: &str, component: u32, count: usize, target: Option<u32>, bounds: Value) -> usize {
        let components = if kind == "VEC3" { 3 } else { 1 };
        let bytes = 4 * (components * count) as u64;
        let mut view = json!({ "buffer": 0, "byteOffset": self.length, "byteLength": bytes });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        let mut accessor = json!({ "bufferView": self.views.len(), "componentType": component, "count": count, "type": kind });
        if let Some([low, high]) = bounds.as_array().map(Vec::as_slice) {
            accessor["min"] = low.clone();
            accessor["max"] = high.clone();
        }
        self.views.push(view);
        self.accessors.push(accessor);
        self.length += bytes;
        self.accessors.len() - 1
    }

    fn add_points(&mut self, points: &[[f32; 3]]) -> usize {
        let bounds = extent(points).map(|corner| corner.map(f64::from));
        self.add("VEC3", FLOAT, points.len(), Some(ARRAY_BUFFER), json!(bounds))
    }
}

/// The JSON part, the length of the binary part in bytes, and whether each object moves. Reads every frame once.
fn describe<R: Read + Seek>(
    clip: &mut Clip<R>,
    progress: &mut dyn FnMut(f64),
) -> Result<(Value, u64, Vec<bool>), ExportError> {
    let mut document = Document { accessors: Vec::new(), views: Vec::new(), length: 0 };
    let times = times(clip);
    let bounds = json!([[times[0]], [times[times.len() - 1]]]);
    let time = document.add("SCALAR", FLOAT, times.len(), None, bounds);
    let objects = clip.objects().len();
    let (mut meshes, mut nodes, mut moving) = (Vec::new(), Vec::new(), Vec::new());
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for object in 0..objects {
        clip.require_constant_topology(object, "glTF")?;
        let moves = clip.moves(object)?;
        meshes.push(describe_mesh(clip, object, moves, &mut document)?);
        nodes.push(json!({ "name": clip.object(object).name, "mesh": object }));
        if moves {
            let weights = times.len() * (times.len() - 1);
            let output = document.add("SCALAR", FLOAT, weights, None, Value::Null);
            channels
                .push(json!({ "sampler": samplers.len(), "target": { "node": object, "path": "weights" } }));
            samplers.push(json!({ "input": time, "output": output, "interpolation": "LINEAR" }));
        }
        moving.push(moves);
        progress((object + 1) as f64 / objects as f64);
    }
    let mut text = json!({
        "asset": { "version": "2.0", "generator": concat!("nucleus ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "name": clip.title(), "nodes": (0..objects).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "accessors": document.accessors,
        "bufferViews": document.views,
        "buffers": [{ "byteLength": document.length }],
    });
    if !channels.is_empty() {
        text["animations"] = json!([{ "name": "run", "samplers": samplers, "channels": channels }]);
    }
    Ok((text, document.length, moving))
}

fn describe_mesh<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    moves: bool,
    document: &mut Document,
) -> Result<Value, ExportError> {
    let base = clip.positions(object, 0)?;
    let info = clip.object_at(object, 0)?;
    let corners = 3 * info.faces.triangles().count();
    let mut primitive = json!({ "mode": if corners > 0 { TRIANGLES } else { POINTS } });
    if corners > 0 {
        primitive["indices"] =
            document.add("SCALAR", UNSIGNED_INT, corners, Some(ELEMENT_ARRAY_BUFFER), Value::Null).into();
    }
    let name = info.name.clone();
    primitive["attributes"] = json!({ "POSITION": document.add_points(&base) });
    let mut mesh = json!({ "name": name });
    if moves {
        let (mut targets, mut names) = (Vec::new(), Vec::new());
        for sample in 1..clip.samples().len() {
            let moved = displacements(clip, object, sample, &base)?;
            targets.push(json!({ "POSITION": document.add_points(&moved) }));
            names.push(format!("frame {}", clip.samples()[sample].frame_time));
        }
        mesh["weights"] = vec![0; targets.len()].into();
        mesh["extras"] = json!({ "targetNames": names });
        primitive["targets"] = targets.into();
    }
    mesh["primitives"] = json!([primitive]);
    Ok(mesh)
}

/// Writes the arrays that [`describe_mesh`] lists, in its order, and the weights of the animation.
fn write_object<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    moves: bool,
    file: &mut OutFile,
) -> Result<(), ExportError> {
    let base = clip.positions(object, 0)?;
    write_triangles(clip.object_at(object, 0)?, file);
    file.floats_le(&base);
    if !moves {
        return Ok(());
    }
    let samples = clip.samples().len();
    for sample in 1..samples {
        file.floats_le(&displacements(clip, object, sample, &base)?);
    }
    for sample in 0..samples {
        for target in 1..samples {
            let weight: f32 = if target == sample { 1.0 } else { 0.0 };
            file.bytes(&weight.to_le_bytes());
        }
    }
    Ok(())
}

fn write_triangles(object: &ObjectInfo, file: &mut OutFile) {
    object.faces.triangles().flatten().for_each(|point| file.bytes(&point.to_le_bytes()));
}

fn write_times<R: Read + Seek>(clip: &Clip<R>, file: &mut OutFile) {
    times(clip).iter().for_each(|time| file.bytes(&time.to_le_bytes()));
}

/// Times of the samples in seconds, relative to the first.
fn times<R: Read + Seek>(clip: &Clip<R>) -> Vec<f32> {
    let begin = clip.samples()[0].frame_time;
    clip.samples().iter().map(|sample| ((sample.frame_time - begin) / clip.fps()) as f32).collect()
}

/// Displacement of each point relative to the first sample.
fn displacements<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    sample: usize,
    base: &[[f32; 3]],
) -> Result<Vec<[f32; 3]>, ExportError> {
    let positions = clip.positions(object, sample)?;
    Ok(positions
        .iter()
        .zip(base)
        .map(|(now, then)| std::array::from_fn(|axis| now[axis] - then[axis]))
        .collect())
}

/// Pads to a multiple of four bytes.
fn padded(mut bytes: Vec<u8>, with: u8) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(4), with);
    bytes
}
