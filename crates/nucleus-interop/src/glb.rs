//! Binary glTF 2.0: a mesh per object, a morph target per sample, and an animation of the target weights.
//!
//! The weight of target k is 1 at sample k, and all weights are 0 at sample 0. Between samples the weights are linear,
//! so points move along straight lines, as in a point cache. Normals are morphed with the positions. A point has more
//! than one vertex at hard edges and along seams of texture coordinates. The faces of a material are a primitive. Each
//! camera is a node with its motion.

use std::io::{Read, Seek};
use std::path::Path;

use serde_json::{Value, json};

use crate::clip::{Clip, extent};
use crate::error::ExportError;
use crate::materials::{self, Material, Materials};
use crate::output::{OutFile, Output};
use crate::vertices::Vertices;

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
    clip.in_metres("glb")?;
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
    let materials = Materials::of(clip);
    write_times(clip, &mut file);
    write_cameras(clip, &mut file);
    for (object, moves) in moving.iter().enumerate() {
        write_object(clip, object, *moves, &materials, &mut file)?;
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
        let components = match kind {
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 1,
        };
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

    fn add_floats(&mut self, kind: &str, count: usize, target: Option<u32>) -> usize {
        self.add(kind, FLOAT, count, target, Value::Null)
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
    let materials = Materials::of(clip);
    let (mut meshes, mut nodes, mut moving) = (Vec::new(), Vec::new(), Vec::new());
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for camera in 0..clip.cameras().len() {
        for (path, kind) in CAMERA_CHANNELS {
            let output = document.add_floats(kind, times.len(), None);
            let target = json!({ "node": objects + camera, "path": path });
            channels.push(json!({ "sampler": samplers.len(), "target": target }));
            samplers.push(json!({ "input": time, "output": output, "interpolation": "LINEAR" }));
        }
    }
    for object in 0..objects {
        clip.require_constant_topology(object, "glTF")?;
        let moves = clip.moves(object)?;
        meshes.push(describe_mesh(clip, object, moves, &materials, &mut document)?);
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
    for (camera, described) in clip.cameras().iter().enumerate() {
        nodes.push(json!({ "name": described.name, "camera": camera }));
    }
    let mut text = json!({
        "asset": { "version": "2.0", "generator": concat!("nucleus ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "name": clip.title(), "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": describe_materials(&materials),
        "accessors": document.accessors,
        "bufferViews": document.views,
        "buffers": [{ "byteLength": document.length }],
    });
    if !clip.cameras().is_empty() {
        text["cameras"] = (0..clip.cameras().len()).map(|camera| describe_camera(clip, camera)).collect();
    }
    if !channels.is_empty() {
        text["animations"] = json!([{ "name": "run", "samplers": samplers, "channels": channels }]);
    }
    Ok((text, document.length, moving))
}

fn describe_mesh<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    moves: bool,
    materials: &Materials,
    document: &mut Document,
) -> Result<Value, ExportError> {
    let vertices = vertices(clip, object);
    let base = vertices.gather(&clip.positions(object, 0)?);
    let has_uvs = clip.texture_coordinates(object).is_some();
    let has_faces = !vertices.faces.is_empty();
    let mut primitive = json!({ "mode": if has_faces { TRIANGLES } else { POINTS }, "material": object });
    let parts: Vec<(usize, usize)> = triangles_by_material(clip, object, &vertices, materials)
        .iter()
        .map(|(material, corners)| {
            let target = Some(ELEMENT_ARRAY_BUFFER);
            (*material, document.add("SCALAR", UNSIGNED_INT, corners.len(), target, Value::Null))
        })
        .collect();
    primitive["attributes"] = json!({ "POSITION": document.add_points(&base) });
    if has_faces {
        primitive["attributes"]["NORMAL"] =
            document.add_floats("VEC3", base.len(), Some(ARRAY_BUFFER)).into();
    }
    if has_uvs {
        primitive["attributes"]["TEXCOORD_0"] =
            document.add_floats("VEC2", base.len(), Some(ARRAY_BUFFER)).into();
    }
    let mut mesh = json!({ "name": clip.object(object).name });
    if moves {
        let (mut targets, mut names) = (Vec::new(), Vec::new());
        for sample in 1..clip.samples().len() {
            let moved = differences(&vertices.gather(&clip.positions(object, sample)?), &base);
            let mut target = json!({ "POSITION": document.add_points(&moved) });
            if has_faces {
                target["NORMAL"] = document.add_floats("VEC3", base.len(), Some(ARRAY_BUFFER)).into();
            }
            targets.push(target);
            names.push(format!("frame {}", clip.samples()[sample].frame_time));
        }
        mesh["weights"] = vec![0; targets.len()].into();
        mesh["extras"] = json!({ "targetNames": names });
        primitive["targets"] = targets.into();
    }
    // All primitives share the vertices of the mesh.
    let part = |(material, indices): (usize, usize)| {
        let mut part = primitive.clone();
        part["indices"] = indices.into();
        part["material"] = material.into();
        part
    };
    mesh["primitives"] = match has_faces {
        true => parts.into_iter().map(part).collect(),
        false => json!([primitive]),
    };
    Ok(mesh)
}

/// The triangles of an object, by material: its place among all, and the corners.
fn triangles_by_material<R: Read + Seek>(
    clip: &Clip<R>,
    object: usize,
    vertices: &Vertices,
    materials: &Materials,
) -> Vec<(usize, Vec<u32>)> {
    let faces = &vertices.faces;
    let sets = clip.face_sets(object);
    let of_faces = sets.map_or(vec![None; faces.len()], |sets| sets.material_of_faces(faces.len()));
    let named = sets.into_iter().flat_map(|sets| sets.materials.iter().enumerate());
    let named = named.map(|(place, set)| (Some(place), materials.of_faces(set)));
    let corners = |(own, material): (Option<usize>, usize)| {
        let own = of_faces.iter().zip(faces.iter()).filter(move |(place, _)| **place == own);
        let triangles =
            own.flat_map(|(_, face)| (2..face.len()).map(move |k| [face[0], face[k - 1], face[k]]));
        (material, triangles.flatten().collect::<Vec<u32>>())
    };
    let parts = std::iter::once((None, object)).chain(named).map(corners);
    parts.filter(|(_, corners)| !corners.is_empty()).collect()
}

/// Writes the arrays that [`describe_mesh`] lists, in its order, and the weights of the animation.
fn write_object<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    moves: bool,
    materials: &Materials,
    file: &mut OutFile,
) -> Result<(), ExportError> {
    let vertices = vertices(clip, object);
    let base = vertices.gather(&clip.positions(object, 0)?);
    let has_faces = !vertices.faces.is_empty();
    for (_, corners) in triangles_by_material(clip, object, &vertices, materials) {
        corners.iter().for_each(|vertex| file.bytes(&vertex.to_le_bytes()));
    }
    file.floats_le(&base);
    let rest = vertices.normals(&base);
    if has_faces {
        file.floats_le(&rest);
    }
    // The first row of a picture is its top in glTF.
    for [u, v] in texture_coordinates(clip, object, &vertices) {
        [u, 1.0 - v].iter().for_each(|x| file.bytes(&x.to_le_bytes()));
    }
    if !moves {
        return Ok(());
    }
    let samples = clip.samples().len();
    for sample in 1..samples {
        let now = vertices.gather(&clip.positions(object, sample)?);
        file.floats_le(&differences(&now, &base));
        if has_faces {
            file.floats_le(&differences(&vertices.normals(&now), &rest));
        }
    }
    for sample in 0..samples {
        for target in 1..samples {
            let weight: f32 = if target == sample { 1.0 } else { 0.0 };
            file.bytes(&weight.to_le_bytes());
        }
    }
    Ok(())
}

fn write_times<R: Read + Seek>(clip: &Clip<R>, file: &mut OutFile) {
    times(clip).iter().for_each(|time| file.bytes(&time.to_le_bytes()));
}

/// Times of the samples in seconds, relative to the first.
fn times<R: Read + Seek>(clip: &Clip<R>) -> Vec<f32> {
    let begin = clip.samples()[0].frame_time;
    clip.samples().iter().map(|sample| ((sample.frame_time - begin) / clip.fps()) as f32).collect()
}

fn differences(now: &[[f32; 3]], then: &[[f32; 3]]) -> Vec<[f32; 3]> {
    now.iter().zip(then).map(|(now, then)| std::array::from_fn(|axis| now[axis] - then[axis])).collect()
}

/// The vertices of an object, whose topology is constant.
fn vertices<R: Read + Seek>(clip: &Clip<R>, object: usize) -> Vertices {
    let uvs = clip.texture_coordinates(object).map_or(&[][..], |uvs| &uvs.corners);
    Vertices::of(clip.object(object), uvs)
}

/// The texture coordinates of each vertex; empty without any.
fn texture_coordinates<R: Read + Seek>(clip: &Clip<R>, object: usize, vertices: &Vertices) -> Vec<[f32; 2]> {
    let Some(uvs) = clip.texture_coordinates(object) else { return Vec::new() };
    match uvs.corners.is_empty() {
        true => vertices.gather(&uvs.values),
        false => vertices.uvs.iter().map(|&uv| uvs.values[uv as usize]).collect(),
    }
}

fn describe_materials(materials: &Materials) -> Value {
    let material = |Material { name, colour: [red, green, blue] }: &Material| {
        let surface = json!({
            "baseColorFactor": [red, green, blue, 1.0],
            "metallicFactor": 0,
            "roughnessFactor": materials::ROUGHNESS,
        });
        json!({ "name": name, "doubleSided": true, "pbrMetallicRoughness": surface })
    };
    materials.all.iter().map(material).collect()
}

/// The channels of the motion of a camera.
const CAMERA_CHANNELS: [(&str, &str); 2] = [("translation", "VEC3"), ("rotation", "VEC4")];

/// The lens of a camera, at the first sample.
fn describe_camera<R: Read + Seek>(clip: &Clip<R>, camera: usize) -> Value {
    let view = clip.camera_view(camera, 0);
    let aspect = view.film[0] / view.film[1];
    let [_, upward] = view.tangents(clip.cameras()[camera].fit, aspect);
    let lens = json!({ "yfov": 2.0 * upward.atan(), "aspectRatio": aspect, "znear": 0.01 });
    json!({ "name": clip.cameras()[camera].name, "type": "perspective", "perspective": lens })
}

fn write_cameras<R: Read + Seek>(clip: &Clip<R>, file: &mut OutFile) {
    for camera in 0..clip.cameras().len() {
        let samples = 0..clip.samples().len();
        samples.clone().for_each(|sample| file.floats_le(&[clip.camera_view(camera, sample).eye]));
        let mut before = [0.0; 4];
        for sample in samples {
            let mut turn = quaternion(&clip.camera_view(camera, sample).matrix());
            // Of a rotation's two quaternions, the one nearer to that of the sample before.
            if turn.iter().zip(&before).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
                turn = turn.map(|x| -x);
            }
            before = turn;
            turn.iter().for_each(|x| file.bytes(&(*x as f32).to_le_bytes()));
        }
    }
}

/// The rotation of a matrix whose rows are the axes, as a quaternion x, y, z, w (Shepperd 1978).
fn quaternion(rows: &[[f64; 4]; 4]) -> [f64; 4] {
    let [x, y, z] = [rows[0], rows[1], rows[2]];
    let trace = x[0] + y[1] + z[2];
    let squares = [x[0] - y[1] - z[2], y[1] - x[0] - z[2], z[2] - x[0] - y[1], trace].map(|s| 1.0 + s);
    let largest = (0..4).max_by(|a, b| squares[*a].total_cmp(&squares[*b])).unwrap_or(3);
    let (xy, xz, yz) = (x[1] + y[0], x[2] + z[0], y[2] + z[1]);
    let (dx, dy, dz) = (y[2] - z[1], z[0] - x[2], x[1] - y[0]);
    let square = squares[largest];
    let turn = match largest {
        0 => [square, xy, xz, dx],
        1 => [xy, square, yz, dy],
        2 => [xz, yz, square, dz],
        _ => [dx, dy, dz, square],
    };
    turn.map(|part| part * 0.5 / square.sqrt())
}

/// Pads to a multiple of four bytes.
fn padded(mut bytes: Vec<u8>, with: u8) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(4), with);
    bytes
}
