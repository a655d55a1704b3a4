//! Wavefront OBJ: text, a file for each object and sample.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::ObjectInfo;

use crate::clip::{Clip, Sample};
use crate::error::ExportError;
use crate::name;
use crate::output::{OutFile, Output};

/// Writes `<object>.<frame>.obj` into a folder.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    told: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    each_file(clip, folder, "obj", output, told, |file, object, positions| {
        write_mesh(file, object, positions)
    })
}

/// Writes a file for each object and sample.
pub(crate) fn each_file<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    end: &str,
    output: &mut Output,
    told: &mut dyn FnMut(f64),
    mut write: impl FnMut(&mut OutFile, &ObjectInfo, &[[f32; 3]]),
) -> Result<(), ExportError> {
    let names = name::for_files(clip.objects().map(|object| object.name.as_str()));
    for sample in 0..clip.samples().len() {
        let place = numbered(&clip.samples()[sample]);
        for (object, name) in names.iter().enumerate() {
            let positions = clip.positions(object, sample)?;
            let mut file = output.file(folder.join(format!("{name}.{place}.{end}")))?;
            write(&mut file, clip.object_at(object, sample)?, &positions);
            output.finish(file)?;
        }
        told((sample + 1) as f64 / clip.samples().len() as f64);
    }
    Ok(())
}

/// `0012` for the end of frame 12, `0012_2of4` for a substep: both sort in order of time in a list of files.
pub(crate) fn numbered(sample: &Sample) -> String {
    match sample.is_whole() {
        true => format!("{:04}", sample.frame),
        false => format!("{:04}_{}of{}", sample.frame - 1, sample.substep, sample.substeps),
    }
}

/// Writes an object with these positions. Points that no face names are there too; Blender's import of OBJ
/// leaves those out, whatever is done, and that of PLY does not.
pub(crate) fn write_mesh(file: &mut OutFile, object: &ObjectInfo, positions: &[[f32; 3]]) {
    // A line break in a name would begin a statement.
    let name: String = object.name.chars().map(|c| if c.is_whitespace() { '_' } else { c }).collect();
    file.text(format!("o {name}\n"));
    for [x, y, z] in positions {
        file.text(format!("v {x} {y} {z}\n"));
    }
    for face in object.faces.iter() {
        let corners: Vec<String> = face.iter().map(|point| (point + 1).to_string()).collect();
        file.text(format!("f {}\n", corners.join(" ")));
    }
    if object.faces.is_empty() {
        (1..=positions.len()).for_each(|point| file.text(format!("p {point}\n")));
    }
}
