//! Meshes from Wavefront OBJ files, with points in the order of the file.
//!
//! Two statements are read: `v` (position; weight and colour are ignored) and `f` (polygons, with corners as `7`,
//! `7/2`, `7//5`, `7/2/5`, or counted backwards from `-1`). Normals are ignored; texture coordinates, groups and materials have
//! readers of their own. Names need not be UTF-8.

use std::io::{BufRead, BufReader};
use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::Surface;

use crate::files;

pub use error::{ObjError, ObjFault};
pub use face_sets::{FaceSet, FaceSets, read_obj_face_sets};
use statement::{Fault, Statements, Word, number, words};
pub use uvs::{CornerUvs, read_obj_corner_uvs, read_obj_uvs};

mod error;
mod face_sets;
mod statement;
#[cfg(test)]
mod tests;
mod uvs;

/// The most corners of a face; the cap of a cylinder has the same limit. A fan of triangles makes all points of a face
/// neighbours of one point, and the neighbours of a point are compared in pairs.
pub(super) const MAX_CORNERS: usize = 4096;

/// Reads a mesh. Its points are all vertices of the file in file order, used or not. Its faces are those of the
/// file, degenerate ones too (see [`drop_degenerate_faces`](super::drop_degenerate_faces)). Lengths are as in the
/// file.
///
/// # Errors
/// When the file cannot be read, has no vertices, or has a malformed line; see [`ObjError`].
pub fn read_obj(path: impl AsRef<Path>) -> Result<Surface, ObjError> {
    let path = path.as_ref();
    let surface = files::open(path)
        .map_err(Fault::from)
        .and_then(|(file, _)| read(BufReader::with_capacity(1 << 18, file)));
    surface.map_err(|fault| fault.in_file(path))
}

/// Reads the points of a file as [`read_obj`] does. A file that names an object without vertices has none, as an export of
/// particles has before the first of them is born.
///
/// # Errors
/// As [`read_obj`].
pub fn read_obj_points(path: impl AsRef<Path>) -> Result<Vec<Vector3<f64>>, ObjError> {
    let path = path.as_ref();
    let points = files::open(path)
        .map_err(Fault::from)
        .and_then(|(file, _)| points(BufReader::with_capacity(1 << 18, file)));
    points.map_err(|fault| fault.in_file(path))
}

fn points(input: impl BufRead) -> Result<Vec<Vector3<f64>>, Fault> {
    let mesh = statements(input)?;
    let names_object = mesh.names_object;
    match mesh.finish() {
        Err(Fault::NoVertices) if names_object => Ok(Vec::new()),
        surface => Ok(surface?.positions),
    }
}

fn read(input: impl BufRead) -> Result<Surface, Fault> {
    statements(input)?.finish()
}

fn statements(input: impl BufRead) -> Result<Mesh, Fault> {
    let mut mesh = Mesh::default();
    let mut statements = Statements::new(input);
    while let Some((line, statement)) = statements.next()? {
        let mut words = words(statement);
        let result = match words.next().map(|word| word.bytes) {
            Some(b"v") => mesh.vertex(words),
            Some(b"f") => mesh.face(words, line),
            Some(b"o") => {
                mesh.names_object = true;
                Ok(())
            }
            _ => Ok(()),
        };
        result.map_err(|fault| Fault::Line(line, fault))?;
    }
    Ok(mesh)
}

/// The mesh as read so far.
#[derive(Default)]
struct Mesh {
    surface: Surface,
    /// Corners of the current face; a reused buffer.
    corners: Vec<u32>,
    /// The highest point that a face refers to, and the line of that face. The vertex may follow later.
    highest: Option<(u32, u64)>,
    /// Whether a statement names an object.
    names_object: bool,
}

impl Mesh {
    fn vertex<'a>(&mut self, mut words: impl Iterator<Item = Word<'a>>) -> Result<(), ObjFault> {
        let mut position = Vector3::zeros();
        for (found, coordinate) in position.iter_mut().enumerate() {
            *coordinate = number(words.next().ok_or(ObjFault::WrongNumberCount { found })?)?;
        }
        match words.count() {
            // None, a weight, a colour, or both.
            0 | 1 | 3 | 4 => {}
            more => return Err(ObjFault::WrongNumberCount { found: 3 + more }),
        }
        if self.surface.positions.len() >= u32::MAX as usize {
            return Err(ObjFault::TooLarge { max: u32::MAX });
        }
        self.surface.positions.push(position);
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = Word<'a>>, line: u64) -> Result<(), ObjFault> {
        self.corners.clear();
        for word in words {
            let point = self.corner(word)?;
            self.corners.push(point);
            if self.highest.is_none_or(|(highest, _)| point > highest) {
                self.highest = Some((point, line));
            }
        }
        if self.corners.len() < 3 {
            return Err(ObjFault::TooFewCorners { found: self.corners.len() });
        }
        if self.corners.len() > MAX_CORNERS {
            return Err(ObjFault::TooManyCorners { found: self.corners.len(), max: MAX_CORNERS });
        }
        if self.surface.faces.corners().len() + self.corners.len() > u32::MAX as usize {
            return Err(ObjFault::TooLarge { max: u32::MAX });
        }
        self.surface.faces.push(&self.corners);
        Ok(())
    }

    /// The point that a corner refers to, counted from 0. Its vertex may follow later in the file.
    fn corner(&self, word: Word<'_>) -> Result<u32, ObjFault> {
        let digits = word.bytes.split(|&byte| byte == b'/').next().unwrap_or_default();
        let number = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse::<i64>().ok());
        let vertex = number.ok_or_else(|| ObjFault::NotACorner { span: word.span() })?;
        let vertices = self.surface.positions.len();
        let point = match vertex {
            0 => return Err(ObjFault::VertexZero),
            1.. => u32::try_from(vertex - 1).ok(),
            _ => vertex.checked_add(vertices as i64).and_then(|point| u32::try_from(point).ok()),
        };
        point.ok_or(ObjFault::NoSuchVertex { vertex, vertices })
    }

    fn finish(self) -> Result<Surface, Fault> {
        let vertices = self.surface.positions.len();
        match self.highest {
            _ if vertices == 0 => Err(Fault::NoVertices),
            Some((point, line)) if point as usize >= vertices => {
                let vertex = i64::from(point) + 1;
                Err(Fault::Line(line, ObjFault::NoSuchVertex { vertex, vertices }))
            }
            _ => Ok(self.surface),
        }
    }
}
