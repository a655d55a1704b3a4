//! Meshes from Wavefront OBJ files, points in the order of the file.
//!
//! Read are `v` (position; weight and colour are passed over) and `f` (polygons of any size, as `7`, `7/2`,
//! `7//5`, `7/2/5` or counted backwards from `-1`). Everything else is passed over: texture coordinates,
//! normals, groups, materials. Names need not be UTF-8.

use std::io::{self, BufRead, BufReader};
use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::Surface;

use crate::files::{self, Piece};

pub use error::{ObjError, ObjFault};
use lines::Lines;
pub use uvs::read_obj_uvs;

mod error;
mod lines;
#[cfg(test)]
mod tests;
mod uvs;

/// As many as the cap of a cylinder may have. Neighbours at a point are compared in pairs, and in a fan of triangles one
/// point has all others as neighbours.
const MOST_CORNERS: usize = 4096;

/// Reads a mesh. Its points are all vertices of the file, used or not, in their order there; its faces are
/// as written, degenerate ones too (see [`drop_degenerate_faces`](super::drop_degenerate_faces)). Lengths
/// are as in the file.
///
/// # Errors
/// When the file cannot be read, has no vertices, or a line of it is not as it should be; see [`ObjError`].
pub fn read_obj(path: impl AsRef<Path>) -> Result<Surface, ObjError> {
    let path = path.as_ref();
    let surface = files::open(path)
        .map_err(Trouble::from)
        .and_then(|(file, _)| read(BufReader::with_capacity(1 << 18, file)));
    surface.map_err(|trouble| trouble.in_file(path))
}

/// What can go wrong, before the file's name is added.
#[derive(Debug)]
enum Trouble {
    Io(io::Error),
    Line(u64, ObjFault),
    NoVertices,
}

impl From<io::Error> for Trouble {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl Trouble {
    fn in_file(self, path: &Path) -> ObjError {
        let path = path.to_owned();
        match self {
            Self::Io(source) => ObjError::Unreadable { path, source },
            Self::Line(line, fault) => ObjError::Malformed { path, line, fault },
            Self::NoVertices => ObjError::NoVertices { path },
        }
    }
}

fn read(input: impl BufRead) -> Result<Surface, Trouble> {
    let mut mesh = Mesh::default();
    let mut lines = Lines::new(input);
    while let Some((line, statement)) = lines.next()? {
        let mut words = words(statement);
        let result = match words.next().map(|word| word.bytes) {
            Some(b"v") => mesh.vertex(words),
            Some(b"f") => mesh.face(words, line),
            _ => Ok(()),
        };
        result.map_err(|fault| Trouble::Line(line, fault))?;
    }
    mesh.finish()
}

/// A word of a statement.
#[derive(Clone, Copy)]
struct Word<'a> {
    bytes: &'a [u8],
    statement: &'a [u8],
}

impl Word<'_> {
    fn piece(self) -> Piece {
        Piece::of(self.bytes, self.statement)
    }
}

/// The words of a statement up to a comment.
fn words(statement: &[u8]) -> impl Iterator<Item = Word<'_>> {
    let code = statement.split(|&byte| byte == b'#').next().unwrap_or_default();
    let words = code.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    words.map(move |bytes| Word { bytes, statement })
}

/// What has been read so far.
#[derive(Default)]
struct Mesh {
    surface: Surface,
    /// Corners of the face at hand.
    corners: Vec<u32>,
    /// The highest point that a face has named, and the line where. It may still follow.
    highest: Option<(u32, u64)>,
}

impl Mesh {
    fn vertex<'a>(&mut self, mut words: impl Iterator<Item = Word<'a>>) -> Result<(), ObjFault> {
        let mut position = Vector3::zeros();
        for (found, coordinate) in position.iter_mut().enumerate() {
            *coordinate = number(words.next().ok_or(ObjFault::WrongNumberCount { found })?)?;
        }
        match words.count() {
            // Nothing, a weight, a colour, or both.
            0 | 1 | 3 | 4 => {}
            more => return Err(ObjFault::WrongNumberCount { found: 3 + more }),
        }
        if self.surface.positions.len() >= u32::MAX as usize {
            return Err(ObjFault::TooLarge { most: u32::MAX });
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
        if self.corners.len() > MOST_CORNERS {
            return Err(ObjFault::TooManyCorners { found: self.corners.len(), most: MOST_CORNERS });
        }
        if self.surface.faces.corners().len() + self.corners.len() > u32::MAX as usize {
            return Err(ObjFault::TooLarge { most: u32::MAX });
        }
        self.surface.faces.push(&self.corners);
        Ok(())
    }

    /// The point that a corner names, counted from 0. It may come later in the file.
    fn corner(&self, word: Word<'_>) -> Result<u32, ObjFault> {
        let digits = word.bytes.split(|&byte| byte == b'/').next().unwrap_or_default();
        let number = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse::<i64>().ok());
        let vertex = number.ok_or_else(|| ObjFault::NotACorner { piece: word.piece() })?;
        let vertices = self.surface.positions.len();
        let point = match vertex {
            0 => return Err(ObjFault::VertexZero),
            1.. => u32::try_from(vertex - 1).ok(),
            _ => vertex.checked_add(vertices as i64).and_then(|point| u32::try_from(point).ok()),
        };
        point.ok_or(ObjFault::NoSuchVertex { vertex, vertices })
    }

    fn finish(self) -> Result<Surface, Trouble> {
        let vertices = self.surface.positions.len();
        match self.highest {
            _ if vertices == 0 => Err(Trouble::NoVertices),
            Some((point, line)) if point as usize >= vertices => {
                let vertex = i64::from(point) + 1;
                Err(Trouble::Line(line, ObjFault::NoSuchVertex { vertex, vertices }))
            }
            _ => Ok(self.surface),
        }
    }
}

fn number(word: Word<'_>) -> Result<f64, ObjFault> {
    let number = std::str::from_utf8(word.bytes).ok().and_then(|text| text.parse::<f64>().ok());
    match number {
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(ObjFault::NotFinite { piece: word.piece() }),
        None => Err(ObjFault::NotANumber { piece: word.piece() }),
    }
}
