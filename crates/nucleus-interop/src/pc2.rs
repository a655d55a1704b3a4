//! PC2, the point cache of 3ds Max and of Blender's Mesh Cache: a short head, then positions.

use std::io::{Read, Seek};
use std::path::Path;

use crate::clip::Clip;
use crate::error::ExportError;
use crate::name;
use crate::obj;
use crate::output::{OutFile, Output};

/// Writes `<object>.pc2` and the mesh it belongs to, `<object>.obj`, into a folder.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    told: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let head = |clip: &Clip<R>, points: usize, file: &mut OutFile| {
        file.bytes(b"POINTCACHE2\0");
        let samples = clip.samples();
        file.bytes(&1_i32.to_le_bytes());
        file.bytes(&(points as i32).to_le_bytes());
        file.bytes(&(samples[0].at as f32).to_le_bytes());
        // Frames from one sample to the next: the format knows only an even pace.
        let frames = samples[samples.len() - 1].at - samples[0].at;
        let pace = if samples.len() > 1 { frames / (samples.len() - 1) as f64 } else { 1.0 };
        file.bytes(&(pace as f32).to_le_bytes());
        file.bytes(&(samples.len() as i32).to_le_bytes());
    };
    point_caches(clip, folder, "pc2", output, told, head, |file, positions| file.floats_le(positions))
}

/// Writes a file of all samples for each object, beside its mesh.
pub(crate) fn point_caches<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    end: &str,
    output: &mut Output,
    told: &mut dyn FnMut(f64),
    head: impl Fn(&Clip<R>, usize, &mut OutFile),
    write: impl Fn(&mut OutFile, &[[f32; 3]]),
) -> Result<(), ExportError> {
    let names = name::for_files(clip.objects().map(|object| object.name.as_str()));
    let mut files = Vec::with_capacity(names.len());
    for (object, name) in names.iter().enumerate() {
        clip.refuse_changes(object, if end == "pc2" { "PC2" } else { "MDD" })?;
        // The mesh is that of the first sample, so that it stands where the cache begins.
        let first = clip.positions(object, 0)?;
        let mut mesh = output.file(folder.join(format!("{name}.obj")))?;
        obj::write_mesh(&mut mesh, clip.object_at(object, 0)?, &first);
        output.finish(mesh)?;
        let mut file = output.file(folder.join(format!("{name}.{end}")))?;
        head(clip, first.len(), &mut file);
        files.push(file);
    }
    for sample in 0..clip.samples().len() {
        for (object, file) in files.iter_mut().enumerate() {
            write(file, &clip.positions(object, sample)?);
        }
        if files.iter().any(OutFile::has_failed) {
            break; // told by `finish`
        }
        told((sample + 1) as f64 / clip.samples().len() as f64);
    }
    files.into_iter().try_for_each(|file| output.finish(file))
}
