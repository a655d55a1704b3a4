//! Mesh files, one for each object and time sample: Wavefront OBJ as text, PLY as binary.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::{LiquidSurface, ObjectInfo, TextureCoordinates};
use nucleus_core::Faces;

use crate::clip::{Clip, Sample};
use crate::error::ExportError;
use crate::materials;
use crate::output::{OutFile, Output, file_names};

/// Writes `<object>.<frame>.obj` into a folder.
pub(crate) fn write_obj<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    write_obj_materials(clip, folder, output)?;
    each_file(clip, folder, "obj", output, progress, |file, object, positions, uvs| {
        file.text(format!("mtllib {OBJ_MATERIALS}\n"));
        write_obj_mesh(file, object, positions, uvs);
    })
}

/// The file of the materials beside the meshes.
const OBJ_MATERIALS: &str = "materials.mtl";

/// Writes a material per object, under its name.
fn write_obj_materials<R: Read + Seek>(
    clip: &Clip<R>,
    folder: &Path,
    output: &mut Output,
) -> Result<(), ExportError> {
    let mut file = output.file(folder.join(OBJ_MATERIALS))?;
    let colours = materials::colours(clip.objects().map(|object| object.kind));
    for (object, [red, green, blue]) in clip.objects().zip(colours) {
        file.text(format!("newmtl {}\nKd {red} {green} {blue}\nillum 1\n", obj_name(&object.name)));
    }
    output.finish(file)
}

/// A line break in a name would begin a statement.
fn obj_name(name: &str) -> String {
    name.chars().map(|c| if c.is_whitespace() { '_' } else { c }).collect()
}

/// Writes a file per object and sample.
fn each_file<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    end: &str,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
    mut write: impl FnMut(&mut OutFile, &ObjectInfo, &[[f32; 3]], Option<&TextureCoordinates>),
) -> Result<(), ExportError> {
    let names = file_names(clip.objects().map(|object| object.name.as_str()));
    for sample in 0..clip.samples().len() {
        let frame = numbered(&clip.samples()[sample]);
        for (object, name) in names.iter().enumerate() {
            let mut file = output.file(folder.join(format!("{name}.{frame}.{end}")))?;
            if let Some(LiquidSurface { positions, quads }) = clip.surface(object, sample)? {
                let mut faces = Faces::default();
                quads.iter().for_each(|quad| faces.push(quad));
                let object = ObjectInfo { faces, ..clip.object(object).clone() };
                write(&mut file, &object, &positions, None);
                output.finish(file)?;
                continue;
            }
            let positions = clip.positions(object, sample)?;
            let uvs = clip.texture_coordinates(object).cloned();
            let object = clip.object_at(object, sample)?;
            let uvs = uvs.filter(|uvs| uvs.fit(object.rest.len(), object.faces.corners().len()));
            write(&mut file, object, &positions, uvs.as_ref());
            output.finish(file)?;
        }
        progress((sample + 1) as f64 / clip.samples().len() as f64);
    }
    Ok(())
}

/// `0012` for the end of frame 12, `0012_02of10` for a substep after it: from frame 0 on, file names sort in order of time.
pub(crate) fn numbered(sample: &Sample) -> String {
    let Sample { frame, substep, substeps, .. } = *sample;
    let digits = substeps.to_string().len();
    match sample.ends_frame() {
        true => format!("{frame:04}"),
        false => format!("{:04}_{substep:0digits$}of{substeps}", frame - 1),
    }
}

/// Writes an object as OBJ with these positions, points without faces included. Blender keeps those when it imports PLY,
/// and drops them when it imports OBJ.
pub(crate) fn write_obj_mesh(
    file: &mut OutFile,
    object: &ObjectInfo,
    positions: &[[f32; 3]],
    uvs: Option<&TextureCoordinates>,
) {
    let name = obj_name(&object.name);
    file.text(format!("o {name}\n"));
    for [x, y, z] in positions {
        file.text(format!("v {x} {y} {z}\n"));
    }
    for [u, v] in uvs.map_or(&[][..], |uvs| &uvs.values) {
        file.text(format!("vt {u} {v}\n"));
    }
    file.text(format!("usemtl {name}\n"));
    let mut next = 0;
    for face in object.faces.iter() {
        let corner = |(k, point): (usize, &u32)| match uvs {
            None => (point + 1).to_string(),
            Some(uvs) => {
                let uv = uvs.corners.get(next + k).unwrap_or(point);
                format!("{}/{}", point + 1, uv + 1)
            }
        };
        let corners: Vec<String> = face.iter().enumerate().map(corner).collect();
        file.text(format!("f {}\n", corners.join(" ")));
        next += face.len();
    }
    if object.faces.is_empty() {
        (1..=positions.len()).for_each(|point| file.text(format!("p {point}\n")));
    }
}

/// Writes `<object>.<frame>.ply` into a folder.
pub(crate) fn write_ply<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    each_file(clip, folder, "ply", output, progress, |file, object, positions, _| {
        write_ply_mesh(file, object, positions);
    })
}

fn write_ply_mesh(file: &mut OutFile, object: &ObjectInfo, positions: &[[f32; 3]]) {
    // Nearly all readers expect the corner count of a face as one byte.
    let is_short = object.faces.iter().all(|face| face.len() <= 255);
    file.text(format!(
        "ply\nformat binary_little_endian 1.0\ncomment written by Nucleus\nelement vertex {}\n\
         property float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list {} uint vertex_indices\nend_header\n",
        positions.len(),
        object.faces.len(),
        if is_short { "uchar" } else { "uint" },
    ));
    file.floats_le(positions);
    for face in object.faces.iter() {
        match is_short {
            true => file.bytes(&[face.len() as u8]),
            false => file.bytes(&(face.len() as u32).to_le_bytes()),
        }
        face.iter().for_each(|point| file.bytes(&point.to_le_bytes()));
    }
}
