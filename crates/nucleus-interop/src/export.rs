//! One export: which format, from a clip to files.

use std::io::{Read, Seek};
use std::path::{Path, PathBuf};

use nucleus_cache::Playback;

use crate::clip::{Clip, Selection};
use crate::error::ExportError;
use crate::mesh_files::{write_obj, write_ply};
use crate::output::Output;
use crate::point_caches::{write_mdd, write_pc2};
use crate::{foxglove, glb, ncache, usd, vtu};

/// A format of another tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A Wavefront OBJ file per object and sample.
    Obj,
    /// A binary PLY file per object and sample.
    Ply,
    /// A point cache of 3ds Max and Blender per object, beside its mesh as OBJ.
    Pc2,
    /// A point cache of LightWave, Modo, Houdini and Blender per object, beside its mesh as OBJ.
    Mdd,
    /// One scene of Pixar's USD as text, with time samples.
    Usda,
    /// The same as binary, which Maya, Houdini and Blender open too.
    Usdc,
    /// One binary glTF file, with a morph target per sample.
    Glb,
    /// A VTK file per object and sample, and a ParaView collection per object.
    Vtu,
    /// A Maya nCache with 32-bit lengths per object: a description, and a file per sample.
    Mc,
    /// The same with 64-bit lengths.
    Mcx,
    /// One MCAP file in Foxglove's public schemas, for Foxglove, Lichtblick and rerun.
    Foxglove,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 11] = [
        Self::Obj,
        Self::Ply,
        Self::Pc2,
        Self::Mdd,
        Self::Usda,
        Self::Usdc,
        Self::Glb,
        Self::Vtu,
        Self::Mc,
        Self::Mcx,
        Self::Foxglove,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Pc2 => "pc2",
            Self::Mdd => "mdd",
            Self::Usda => "usda",
            Self::Usdc => "usdc",
            Self::Glb => "glb",
            Self::Vtu => "vtu",
            Self::Mc => "mc",
            Self::Mcx => "mcx",
            Self::Foxglove => "foxglove",
        }
    }

    /// Whether the export is one file; otherwise it is a folder.
    pub fn is_one_file(self) -> bool {
        matches!(self, Self::Usda | Self::Usdc | Self::Glb | Self::Foxglove)
    }

    /// The format of a file extension, if one has it.
    pub fn of_path(path: &Path) -> Option<Self> {
        let end = path.extension()?.to_str()?.to_ascii_lowercase();
        match end.as_str() {
            "mcap" => Some(Self::Foxglove),
            "usd" => Some(Self::Usdc),
            "xml" => Some(Self::Mcx),
            "pvd" => Some(Self::Vtu),
            end => Self::ALL.into_iter().find(|format| format.name() == end),
        }
    }

    /// The default name of the export, from the name of the cache without its extension.
    pub fn default_name(self, stem: &str) -> String {
        match self {
            Self::Foxglove => format!("{stem}.foxglove.mcap"),
            Self::Usda | Self::Usdc | Self::Glb => format!("{stem}.{}", self.name()),
            _ => format!("{stem}_{}", self.name()),
        }
    }
}

/// An export: the format, the destination and the part of the cache.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The format.
    pub format: Format,
    /// The file, or the folder for formats of several files; missing folders are made.
    pub out: PathBuf,
    /// The part of the cache.
    pub selection: Selection,
    /// Whether existing files may be replaced.
    pub force: bool,
}

/// The result of an export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exported {
    /// The files, in the order in which they were finished.
    pub files: Vec<PathBuf>,
    /// Time samples in them.
    pub samples: usize,
    /// Objects in them.
    pub objects: usize,
}

/// Writes a part of a cache as files of another tool. `progress` receives the finished fraction, 0 to 1.
///
/// A file has its name only when it is complete. An export that fails leaves no new files.
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
/// When a file exists, the cache cannot be read, a file cannot be written, or the format cannot express the data.
pub fn export<R: Read + Seek>(
    cache: &mut Playback<R>,
    request: &Request,
    progress: &mut dyn FnMut(f64),
) -> Result<Exported, ExportError> {
    if request.selection.surface && !matches!(request.format, Format::Obj | Format::Ply) {
        return Err(ExportError::NoSurface { format: request.format.name() });
    }
    let mut clip = Clip::of(cache, &request.selection)?;
    if matches!(request.format, Format::Mc | Format::Mcx) {
        ncache::require_times(&clip)?;
    }
    let mut output = Output::new(request.force);
    if let Err(error) = write(&mut clip, request, &mut output, progress) {
        output.remove_new();
        return Err(error);
    }
    let (samples, objects) = (clip.samples().len(), clip.objects().len());
    Ok(Exported { files: output.written(), samples, objects })
}

/// Writes all files of a format.
fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    request: &Request,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let out = &request.out;
    match (request.format.is_one_file(), out.parent()) {
        (false, _) => output.folder(out)?,
        (true, Some(parent)) if !parent.as_os_str().is_empty() => output.folder(parent)?,
        (true, _) => {}
    }
    match request.format {
        Format::Obj => write_obj(clip, out, output, progress),
        Format::Ply => write_ply(clip, out, output, progress),
        Format::Pc2 => write_pc2(clip, out, output, progress),
        Format::Mdd => write_mdd(clip, out, output, progress),
        Format::Usda => usd::write_text(clip, out, output, progress),
        Format::Usdc => usd::write_binary(clip, out, output, progress),
        Format::Glb => glb::write(clip, out, output, progress),
        Format::Vtu => vtu::write(clip, out, output, progress),
        Format::Mc => ncache::write(clip, out, ncache::Width::Bits32, output, progress),
        Format::Mcx => ncache::write(clip, out, ncache::Width::Bits64, output, progress),
        Format::Foxglove => foxglove::write(clip, out, output, progress),
    }
}
