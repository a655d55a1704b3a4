//! PLY: binary, lowest byte first, a file for each object and sample.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::ObjectInfo;

use crate::clip::Clip;
use crate::error::ExportError;
use crate::obj;
use crate::output::{OutFile, Output};

/// Writes `<object>.<frame>.ply` into a folder.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    told: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    obj::each_file(clip, folder, "ply", output, told, write_mesh)
}

fn write_mesh(file: &mut OutFile, object: &ObjectInfo, positions: &[[f32; 3]]) {
    // One byte counts the corners of a face, as nearly all readers expect, unless a face has too many.
    let short = object.faces.iter().all(|face| face.len() <= 255);
    file.text(format!(
        "ply\nformat binary_little_endian 1.0\ncomment written by Nucleus\nelement vertex {}\n\
         property float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list {} uint vertex_indices\nend_header\n",
        positions.len(),
        object.faces.len(),
        if short { "uchar" } else { "uint" },
    ));
    file.floats_le(positions);
    for face in object.faces.iter() {
        match short {
            true => file.bytes(&[face.len() as u8]),
            false => file.bytes(&(face.len() as u32).to_le_bytes()),
        }
        face.iter().for_each(|point| file.bytes(&point.to_le_bytes()));
    }
}
