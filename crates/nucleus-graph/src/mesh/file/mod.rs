//! Meshes from PLY, glTF and USD files, with their motion baked to one shape per frame.
//!
//! OBJ files have a reader of their own, [`read_obj`](super::read_obj), whose errors name a line.
//! A file is opened and measured before its points are read, so that a caller can refuse it for its memory.

use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use nucleus_core::{Faces, Surface};

use super::obj::{CornerUvs, MAX_CORNERS};
use crate::memory::Size;

use error::Fault;
pub use error::MeshFileError;
use gltf::GltfFile;
use guard::guarded;
use ply::PlyFile;
pub use source::Frames;
use source::Source;
use usd::UsdFile;

mod accessor;
mod deform;
mod error;
mod gltf;
mod guard;
mod ply;
mod source;
mod track;
mod usd;
mod weld;

/// The formats of mesh files, by extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront OBJ, and every unknown extension.
    Obj,
    /// PLY, as text or binary.
    Ply,
    /// glTF 2.0, `.gltf` or `.glb`.
    Gltf,
    /// USD, `.usda`, `.usdc`, `.usd` or `.usdz`.
    Usd,
}

impl MeshFormat {
    /// The format of a file, by its extension.
    pub fn of(path: impl AsRef<Path>) -> Self {
        let end = path.as_ref().extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match end.as_str() {
            "ply" => Self::Ply,
            "glb" | "gltf" => Self::Gltf,
            "usd" | "usda" | "usdc" | "usdz" => Self::Usd,
            _ => Self::Obj,
        }
    }

    /// Whether a file holds several objects and their motion.
    pub fn holds_a_scene(self) -> bool {
        matches!(self, Self::Gltf | Self::Usd)
    }
}

/// A PLY, glTF or USD file that is opened and measured.
pub struct MeshFile {
    path: PathBuf,
    format: MeshFormat,
    source: Box<dyn Source>,
}

/// A mesh of a file at one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FileMesh {
    /// Points and faces, in units of the file, with y up.
    pub surface: Surface,
    /// Texture coordinates, where the file has them, with an index for each corner.
    pub uvs: Option<CornerUvs>,
}

impl MeshFile {
    /// Opens a file. `object` selects the meshes at and below the nodes or prims of that name, and all if it is empty.
    ///
    /// # Errors
    /// When the file cannot be read, is malformed, or has no such object.
    pub fn open(path: impl AsRef<Path>, object: &str, frames: Frames) -> Result<Self, MeshFileError> {
        let path = path.as_ref();
        let format = MeshFormat::of(path);
        let source = guarded(|| -> Result<Box<dyn Source>, Fault> {
            Ok(match format {
                MeshFormat::Gltf => Box::new(GltfFile::open(path, object, frames)?),
                MeshFormat::Usd => Box::new(UsdFile::open(path, object, frames)?),
                MeshFormat::Ply | MeshFormat::Obj => Box::new(PlyFile::open(path)?),
            })
        });
        let source = source.map_err(|fault| fault.in_file(path))?;
        Ok(Self { path: path.to_owned(), format, source })
    }

    /// Its points and corners, at the first frame. Points that are merged later are counted each.
    pub(crate) fn size(&self) -> Size {
        self.source.size()
    }

    /// Whether its points may change from frame to frame.
    pub fn moves(&self) -> bool {
        self.source.moves()
    }

    /// Metres per unit of the file; `None` if it does not say.
    pub fn metres_per_unit(&self) -> Option<f64> {
        self.source.metres_per_unit()
    }

    /// The mesh at a frame, before points are merged.
    ///
    /// # Errors
    /// When the file is malformed.
    pub fn mesh(&self, frame: i64) -> Result<FileMesh, MeshFileError> {
        guarded(|| self.checked_mesh(frame)).map_err(|fault| fault.in_file(&self.path))
    }

    fn checked_mesh(&self, frame: i64) -> Result<FileMesh, Fault> {
        let (faces, uvs) = self.source.faces(frame)?;
        let positions = self.source.positions(frame)?;
        if self.format.holds_a_scene() && faces.is_empty() {
            return Err(Fault::Malformed("it has no faces".to_owned()));
        }
        if positions.is_empty() {
            return Err(Fault::Malformed("it has no points".to_owned()));
        }
        check_faces(&faces, positions.len())?;
        let fits = |(values, corners): &CornerUvs| {
            corners.len() == faces.corners().len()
                && corners.iter().all(|corner| (*corner as usize) < values.len())
        };
        let uvs = uvs.filter(fits);
        Ok(FileMesh { surface: Surface { positions, faces }, uvs })
    }

    /// The positions at a frame, before points are merged.
    ///
    /// # Errors
    /// When the file is malformed.
    pub fn positions(&self, frame: i64) -> Result<Vec<Vector3<f64>>, MeshFileError> {
        guarded(|| self.source.positions(frame)).map_err(|fault| fault.in_file(&self.path))
    }

    /// Merges the points that the format splits: glTF has a point for each normal and each pair of texture coordinates
    /// of a vertex. Points of one object are merged if they coincide at every frame.
    pub fn merge_split_points(&self, surface: &mut Surface, frames: &mut [Vec<Vector3<f64>>]) {
        weld::weld(surface, frames, &self.source.split_objects());
    }
}

impl FileMesh {
    /// The texture coordinates of each point; along a seam those of the first face. `None` where no face has any.
    pub fn uvs_of_points(&self) -> Option<Vec<Option<[f64; 2]>>> {
        let (values, corners) = self.uvs.as_ref()?;
        let mut found = vec![None; self.surface.positions.len()];
        for (&point, &uv) in self.surface.faces.corners().iter().zip(corners) {
            found[point as usize].get_or_insert(values[uv as usize]);
        }
        Some(found)
    }
}

fn check_faces(faces: &Faces, points: usize) -> Result<(), Fault> {
    for (face, corners) in faces.iter().enumerate() {
        let malformed = |fault: String| Err(Fault::Malformed(format!("face {face} {fault}")));
        if corners.len() > MAX_CORNERS {
            let found = corners.len();
            return malformed(format!(
                "has {found} corners; at most {MAX_CORNERS} are allowed: cut it into smaller faces"
            ));
        }
        if let Some(point) = corners.iter().find(|point| **point as usize >= points) {
            return malformed(format!("refers to point {point}, but there are {points}"));
        }
    }
    Ok(())
}
