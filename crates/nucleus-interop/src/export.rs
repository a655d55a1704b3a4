//! One export: from a clip to files.

use std::io::{Read, Seek};
use std::path::PathBuf;

use nucleus_cache::Playback;

use crate::clip::{Clip, Selection};
use crate::error::ExportError;
use crate::format::Format;
use crate::output::Output;
use crate::{foxglove, glb, mdd, ncache, obj, pc2, ply, usda, vtu};

/// What is to be exported, and where to.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// As what.
    pub format: Format,
    /// The file, or the folder for formats of many files; it is made if it is not there.
    pub out: PathBuf,
    /// What of the cache.
    pub selection: Selection,
    /// Whether files that are there may be replaced.
    pub force: bool,
}

/// What was exported.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exported {
    /// The files, in the order in which they were finished.
    pub files: Vec<PathBuf>,
    /// Samples of time in them.
    pub samples: usize,
    /// Objects in them.
    pub objects: usize,
}

/// Writes a part of a cache as files of another tool. `told` is called with the share that is done.
///
/// A file is under its name only when it is whole.
///
/// ```no_run
/// use nucleus_interop::{Format, Request, Selection, export};
///
/// let mut cache = nucleus_cache::Playback::open("hang.mcap")?;
/// let request =
///     Request { format: Format::Usda, out: "hang.usda".into(), selection: Selection::default(), force: false };
/// export(&mut cache, &request, &mut |_| {})?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When something is in the way, cannot be read or written, or cannot be said in the format.
pub fn export<R: Read + Seek>(
    cache: &mut Playback<R>,
    request: &Request,
    told: &mut dyn FnMut(f64),
) -> Result<Exported, ExportError> {
    let mut clip = Clip::of(cache, &request.selection)?;
    let mut output = Output::new(request.force);
    let out = &request.out;
    match (request.format.is_one_file(), out.parent()) {
        (false, _) => output.folder(out)?,
        (true, Some(parent)) if !parent.as_os_str().is_empty() => output.folder(parent)?,
        (true, _) => {}
    }
    match request.format {
        Format::Obj => obj::write(&mut clip, out, &mut output, told)?,
        Format::Ply => ply::write(&mut clip, out, &mut output, told)?,
        Format::Pc2 => pc2::write(&mut clip, out, &mut output, told)?,
        Format::Mdd => mdd::write(&mut clip, out, &mut output, told)?,
        Format::Usda => usda::write(&mut clip, out, &mut output, told)?,
        Format::Glb => glb::write(&mut clip, out, &mut output, told)?,
        Format::Vtu => vtu::write(&mut clip, out, &mut output, told)?,
        Format::Mc => ncache::write(&mut clip, out, ncache::Width::Bits32, &mut output, told)?,
        Format::Mcx => ncache::write(&mut clip, out, ncache::Width::Bits64, &mut output, told)?,
        Format::Foxglove => foxglove::write(&mut clip, out, &mut output, told)?,
    }
    let (samples, objects) = (clip.samples().len(), clip.objects().len());
    Ok(Exported { files: output.written(), samples, objects })
}
