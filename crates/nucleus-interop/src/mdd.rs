//! MDD, the point cache of LightWave: highest byte first, with a time for each sample.

use std::io::{Read, Seek};
use std::path::Path;

use crate::clip::Clip;
use crate::error::ExportError;
use crate::output::{OutFile, Output};
use crate::pc2::point_caches;

/// Writes `<object>.mdd` and the mesh it belongs to, `<object>.obj`, into a folder.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    told: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let head = |clip: &Clip<R>, points: usize, file: &mut OutFile| {
        file.bytes(&(clip.samples().len() as i32).to_be_bytes());
        file.bytes(&(points as i32).to_be_bytes());
        for sample in clip.samples() {
            file.bytes(&((sample.at / clip.fps()) as f32).to_be_bytes());
        }
    };
    point_caches(clip, folder, "mdd", output, told, head, |file, positions| file.floats_be(positions))
}
