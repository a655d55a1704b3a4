//! Point caches, one file of positions per object beside its mesh: PC2 of 3ds Max and Blender, MDD of LightWave.

use std::io::{Read, Seek};
use std::path::Path;

use crate::clip::Clip;
use crate::error::ExportError;
use crate::mesh_files::write_obj_mesh;
use crate::output::{OutFile, Output, file_names};

/// Writes `<object>.pc2` and its mesh `<object>.obj` into a folder. Numbers are little-endian.
pub(crate) fn write_pc2<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    if let Some(sample) = clip.uneven_sample() {
        return Err(ExportError::Uneven { frame: sample.frame, format: "PC2" });
    }
    let head = |clip: &Clip<R>, points: usize, file: &mut OutFile| {
        file.bytes(b"POINTCACHE2\0");
        let samples = clip.samples();
        file.bytes(&1_i32.to_le_bytes());
        file.bytes(&(points as i32).to_le_bytes());
        file.bytes(&(samples[0].frame_time as f32).to_le_bytes());
        // Frames per sample: the format has one constant rate.
        let frames = samples[samples.len() - 1].frame_time - samples[0].frame_time;
        let rate = if samples.len() > 1 { frames / (samples.len() - 1) as f64 } else { 1.0 };
        file.bytes(&(rate as f32).to_le_bytes());
        file.bytes(&(samples.len() as i32).to_le_bytes());
    };
    point_caches(clip, folder, "pc2", output, progress, head, |file, positions| file.floats_le(positions))
}

/// Writes a file of all samples per object, beside its mesh.
fn point_caches<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    end: &str,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
    head: impl Fn(&Clip<R>, usize, &mut OutFile),
    write: impl Fn(&mut OutFile, &[[f32; 3]]),
) -> Result<(), ExportError> {
    let names = file_names(clip.objects().map(|object| object.name.as_str()));
    let mut files = Vec::with_capacity(names.len());
    for (object, name) in names.iter().enumerate() {
        clip.require_constant_topology(object, if end == "pc2" { "PC2" } else { "MDD" })?;
        // The mesh has the positions of the first sample, so that it agrees with the start of the point cache.
        let first = clip.positions(object, 0)?;
        let mut mesh = output.file(folder.join(format!("{name}.obj")))?;
        let uvs = clip.texture_coordinates(object).cloned();
        let sets = clip.face_sets_at(object, 0)?;
        write_obj_mesh(&mut mesh, clip.object_at(object, 0)?, &first, uvs.as_ref(), sets.as_ref());
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
            break; // `finish` reports the error
        }
        progress((sample + 1) as f64 / clip.samples().len() as f64);
    }
    files.into_iter().try_for_each(|file| output.finish(file))
}

/// Writes `<object>.mdd` and its mesh `<object>.obj` into a folder. Numbers are big-endian, and each sample has a time.
pub(crate) fn write_mdd<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let head = |clip: &Clip<R>, points: usize, file: &mut OutFile| {
        file.bytes(&(clip.samples().len() as i32).to_be_bytes());
        file.bytes(&(points as i32).to_be_bytes());
        for sample in clip.samples() {
            file.bytes(&((sample.frame_time / clip.fps()) as f32).to_be_bytes());
        }
    };
    point_caches(clip, folder, "mdd", output, progress, head, |file, positions| file.floats_be(positions))
}
