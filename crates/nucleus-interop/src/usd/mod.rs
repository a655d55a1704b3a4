//! USD with time samples, as text (`.usda`) or binary (`.usdc`): per object a Mesh or Points with its material, and the
//! cameras of the run.

use std::io::{Read, Seek};
use std::iter;
use std::path::Path;

use nucleus_cache::{ObjectInfo, ObjectKind};

use crate::clip::{Clip, Extent, extent};
use crate::error::ExportError;
use crate::materials::{self, Material, Materials};
use crate::output::{Output, node_names};
use crate::vertices::Vertices;

use binary::BinaryStage;
use camera::write_camera;
use particles::{
    extent_of_particles, have_looks, write_looks, write_orientations, write_particles, write_widths,
};
use stage::{Attribute, Head, Prim, Stage, Value};
use text::TextStage;

mod binary;
mod camera;
mod particles;
mod stage;
mod subsets;
mod text;

/// The scope of the materials beside the objects, and its path.
const SCOPE: &str = "materials";
const MATERIALS: &str = "/run/materials";

/// Writes one scene as text.
pub(crate) fn write_text<R: Read + Seek>(
    clip: &mut Clip<R>,
    out: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let mut stage = TextStage::new(output.file(out.to_owned())?);
    write(clip, &mut stage, progress)?;
    output.finish(stage.finish())
}

/// Writes one scene as binary.
pub(crate) fn write_binary<R: Read + Seek>(
    clip: &mut Clip<R>,
    out: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let mut stage = BinaryStage::new(output.file(out.to_owned())?);
    write(clip, &mut stage, progress)?;
    output.finish(stage.finish())
}

fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    stage: &mut impl Stage,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    // The scope comes first, so that an object of its name gets another one.
    let objects = clip.objects().map(|object| object.name.as_str());
    let cameras = clip.cameras().iter().map(|camera| camera.name.as_str());
    let materials = Materials::of(clip);
    let of_faces = materials.of_all_faces().iter().map(|material| material.name.as_str());
    let names = node_names(iter::once(SCOPE).chain(objects).chain(cameras).chain(of_faces));
    let (objects, names) = names[1..].split_at(clip.objects().len());
    let (cameras, of_faces) = names.split_at(clip.cameras().len());
    let material_names = [objects, of_faces].concat();
    let samples = clip.samples();
    stage.head(&Head {
        title: clip.title(),
        metres_per_unit: clip.metres_per_unit(),
        times: [samples[0].frame_time, samples[samples.len() - 1].frame_time],
        fps: clip.fps(),
    });
    stage.begin(&Prim { kind: Some("component"), ..Prim::of("Xform", "run") });
    let mut extents = Vec::new();
    for (object, name) in objects.iter().enumerate() {
        let done = object as f64 / objects.len() as f64;
        let mut progress = |share: f64| progress(done + share / objects.len() as f64);
        let places = (&materials, material_names.as_slice());
        extents.extend(write_object(clip, object, name, places, stage, &mut progress)?);
        if stage.has_failed() {
            break; // `finish` reports the error
        }
    }
    for (camera, name) in cameras.iter().enumerate() {
        write_camera(clip, camera, name, &extent(extents.as_flattened()), stage);
    }
    write_materials(&materials, &material_names, stage);
    stage.end();
    Ok(())
}

/// Writes an object; returns its extent at each sample. Each material has the name of its prim.
fn write_object<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    name: &str,
    (materials, names): (&Materials, &[String]),
    stage: &mut impl Stage,
    progress: &mut dyn FnMut(f64),
) -> Result<Vec<Extent>, ExportError> {
    let changes = !clip.mesh_changes(object).is_empty();
    let info = clip.object(object);
    let faces = info.faces.len();
    let is_mesh = !info.faces.is_empty() || changes && info.kind != ObjectKind::Particles;
    let prim = Prim::of(if is_mesh { "Mesh" } else { "Points" }, name);
    stage.begin(&Prim { schemas: &["MaterialBindingAPI"], ..prim });
    let title = Value::Text(&info.name);
    stage.attribute(&Attribute { is_custom: true, ..Attribute::of("string", "nucleus:name") }, &title);
    let have_looks = !is_mesh && have_looks(clip, object)?;
    // A material would hide the colours of the particles.
    if !have_looks {
        stage.relate("material:binding", &format!("{MATERIALS}/{name}"));
    }
    if is_mesh {
        write_topology(clip, object, stage)?;
        write_texture_coordinates(clip, object, changes, stage);
    } else {
        write_ids(clip, object, stage)?;
        write_widths(clip, object, have_looks, stage)?;
    }
    if have_looks {
        write_looks(clip, object, stage)?;
    }
    let extents = write_points(clip, object, is_mesh, stage, progress)?;
    if is_mesh {
        write_normals(clip, object, stage, progress)?;
    }
    write_orientations(clip, object, stage)?;
    write_velocities(clip, object, stage)?;
    if let Some(sets) = clip.face_sets(object).filter(|_| is_mesh && !changes) {
        subsets::write_subsets(sets, faces, stage, |set| {
            format!("{MATERIALS}/{}", names[materials.of_faces(set)])
        });
    }
    stage.end();
    Ok(extents)
}

/// Writes the positions and the extent of an object; returns its extent at each sample. This is half of its progress.
fn write_points<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    is_mesh: bool,
    stage: &mut impl Stage,
    progress: &mut dyn FnMut(f64),
) -> Result<Vec<Extent>, ExportError> {
    let samples = clip.samples().to_vec();
    let steps = samples.len() as f64;
    let mut extents = Vec::with_capacity(samples.len());
    stage.begin_samples(&Attribute::of("point3f[]", "points"));
    for (index, sample) in samples.iter().enumerate() {
        let positions = clip.positions(object, index)?;
        stage.sample(sample.frame_time, &Value::Vec3s(&positions));
        extents.push(match is_mesh {
            true => extent(&positions),
            false => extent_of_particles(clip, object, index, &positions)?,
        });
        progress(0.5 * (index + 1) as f64 / steps);
    }
    stage.end_samples();
    stage.begin_samples(&Attribute::of("float3[]", "extent"));
    for (sample, extent) in samples.iter().zip(&extents) {
        stage.sample(sample.frame_time, &Value::Vec3s(extent));
    }
    stage.end_samples();
    Ok(extents)
}

/// Writes the normals of a mesh: the other half of its progress.
fn write_normals<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    stage: &mut impl Stage,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let samples = clip.samples().to_vec();
    let steps = samples.len() as f64;
    let mut vertices = Vertices::of(clip.object_at(object, 0)?, &[]);
    let changes = clip.mesh_changes(object);
    let are_split = vertices.are_split();
    let each = if are_split { "faceVarying" } else { "vertex" };
    stage.begin_samples(&Attribute::of("normal3f[]", "normals").interpolated(each));
    for (index, sample) in samples.iter().enumerate() {
        let positions = clip.positions(object, index)?;
        if changes.contains(&index) {
            vertices = Vertices::smooth(&clip.object_at(object, index)?.faces, positions.len());
        }
        let mut normals = vertices.normals(&vertices.gather(&positions));
        if are_split {
            normals = vertices.faces.corners().iter().map(|&vertex| normals[vertex as usize]).collect();
        }
        stage.sample(sample.frame_time, &Value::Vec3s(&normals));
        progress(0.5 + 0.5 * (index + 1) as f64 / steps);
    }
    stage.end_samples();
    Ok(())
}

/// Writes the numbers of particles, so that other tools can identify each over time: their places, where none is born or
/// dies. Without numbers of their own particles that come and go have none.
fn write_ids<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    stage: &mut impl Stage,
) -> Result<(), ExportError> {
    let is_recorded = write_particles(clip, object, stage)?;
    if !is_recorded && clip.count_change(object)?.is_none() {
        let ids: Vec<u64> = (0..clip.object(object).rest.len() as u64).collect();
        stage.attribute(&Attribute::of("int64[]", "ids"), &Value::Int64s(&ids));
    }
    Ok(())
}

/// A list of numbers of a mesh.
type Part = fn(&ObjectInfo) -> Vec<u32>;

/// Writes the topology: once, or at each sample at which it changes. USD holds such values until the next sample.
fn write_topology<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    stage: &mut impl Stage,
) -> Result<(), ExportError> {
    stage.attribute(&Attribute::uniform("token", "subdivisionScheme"), &Value::Token("none"));
    stage.attribute(&Attribute::uniform("token", "orientation"), &Value::Token("rightHanded"));
    stage.attribute(&Attribute::uniform("bool", "doubleSided"), &Value::Bool(true));
    let mut samples = vec![0];
    samples.extend(clip.mesh_changes(object));
    let parts: [(&str, Part); 2] = [
        ("faceVertexCounts", |object| object.faces.iter().map(|face| face.len() as u32).collect()),
        ("faceVertexIndices", |object| object.faces.corners().to_vec()),
    ];
    for (name, values) in parts {
        let attribute = Attribute::of("int[]", name);
        if let [only] = samples[..] {
            stage.attribute(&attribute, &Value::Ints(&values(clip.object_at(object, only)?)));
            continue;
        }
        stage.begin_samples(&attribute);
        for &sample in &samples {
            let time = clip.samples()[sample].frame_time;
            stage.sample(time, &Value::Ints(&values(clip.object_at(object, sample)?)));
        }
        stage.end_samples();
    }
    Ok(())
}

/// Texture coordinates belong to the first mesh; a mesh that changes has none.
fn write_texture_coordinates<R: Read + Seek>(
    clip: &Clip<R>,
    object: usize,
    changes: bool,
    stage: &mut impl Stage,
) {
    let Some(uvs) = clip.texture_coordinates(object).filter(|_| !changes) else { return };
    let per_point = uvs.corners.is_empty();
    let st = Attribute::of("texCoord2f[]", "primvars:st");
    stage.attribute(
        &st.interpolated(if per_point { "vertex" } else { "faceVarying" }),
        &Value::Vec2s(&uvs.values),
    );
    if !per_point {
        stage.attribute(&Attribute::of("int[]", "primvars:st:indices"), &Value::Ints(&uvs.corners));
    }
}

fn write_velocities<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    stage: &mut impl Stage,
) -> Result<(), ExportError> {
    let samples = clip.samples().to_vec();
    let mut begun = false;
    for (index, sample) in samples.iter().enumerate() {
        let Some(velocities) = clip.velocities(object, index)? else { continue };
        if !begun {
            stage.begin_samples(&Attribute::of("vector3f[]", "velocities"));
            begun = true;
        }
        stage.sample(sample.frame_time, &Value::Vec3s(&velocities));
    }
    if begun {
        stage.end_samples();
    }
    Ok(())
}

/// A preview surface for each material. That of an object has the colour that the player gives it.
fn write_materials(materials: &Materials, names: &[String], stage: &mut impl Stage) {
    stage.begin(&Prim::of("Scope", SCOPE));
    for (name, &Material { colour, .. }) in names.iter().zip(&materials.all) {
        let shader = format!("{MATERIALS}/{name}/surface");
        stage.begin(&Prim::of("Material", name));
        stage.connect(&Attribute::of("token", "outputs:surface"), &format!("{shader}.outputs:surface"));
        stage.begin(&Prim::of("Shader", "surface"));
        stage.attribute(&Attribute::uniform("token", "info:id"), &Value::Token("UsdPreviewSurface"));
        stage.attribute(&Attribute::of("color3f", "inputs:diffuseColor"), &Value::Vec3(colour));
        stage.attribute(&Attribute::of("float", "inputs:roughness"), &Value::Float(materials::ROUGHNESS));
        stage.declare(&Attribute::of("token", "outputs:surface"));
        stage.end();
        stage.end();
    }
    stage.end();
}
