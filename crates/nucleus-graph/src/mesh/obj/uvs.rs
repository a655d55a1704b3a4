//! Texture coordinates of an OBJ file, per vertex. They are read apart from the mesh, because few scenes use them.

use std::io::{BufRead, BufReader};
use std::path::Path;

use super::error::{ObjError, ObjFault};
use super::statement::{Fault, Statements, Word, number, words};
use crate::files;

/// The texture coordinates of each vertex, `None` where no face has any. Along a seam, where faces differ, those of the
/// first face are taken.
///
/// # Errors
/// When the file cannot be read, or a line of vertices, faces or texture coordinates is malformed; see [`ObjError`].
pub fn read_obj_uvs(path: impl AsRef<Path>) -> Result<Vec<Option<[f64; 2]>>, ObjError> {
    let path = path.as_ref();
    let uvs = files::open(path)
        .map_err(Fault::from)
        .and_then(|(file, _)| read(BufReader::with_capacity(1 << 18, file)));
    uvs.map_err(|fault| fault.in_file(path))
}

/// Texture coordinates, and the index of those of each corner of a face.
pub type CornerUvs = (Vec<[f64; 2]>, Vec<u32>);

/// The texture coordinates of an OBJ file as its faces use them: the `vt` lines, and for each corner of a face the index
/// of its coordinates, in the order of the file. `None` where a corner has none.
///
/// # Errors
/// As [`read_obj_uvs`].
pub fn read_obj_corner_uvs(path: impl AsRef<Path>) -> Result<Option<CornerUvs>, ObjError> {
    let path = path.as_ref();
    let uvs = files::open(path)
        .map_err(Fault::from)
        .and_then(|(file, _)| read_all(BufReader::with_capacity(1 << 18, file)));
    uvs.map(Uvs::of_corners).map_err(|fault| fault.in_file(path))
}

/// Counts and coordinates read so far.
#[derive(Default)]
struct Uvs {
    vertices: usize,
    uvs: Vec<[f64; 2]>,
    /// For each vertex, the index of its coordinates and the line of the face.
    of_vertex: Vec<Option<(usize, u64)>>,
    /// For each corner, the index of its coordinates.
    of_corner: Vec<Option<usize>>,
}

fn read(input: impl BufRead) -> Result<Vec<Option<[f64; 2]>>, Fault> {
    read_all(input)?.finish()
}

fn read_all(input: impl BufRead) -> Result<Uvs, Fault> {
    let mut found = Uvs::default();
    let mut statements = Statements::new(input);
    while let Some((line, statement)) = statements.next()? {
        let mut words = words(statement);
        let result = match words.next().map(|word| word.bytes) {
            Some(b"v") => {
                found.vertices += 1;
                Ok(())
            }
            Some(b"vt") => found.uv(words),
            Some(b"f") => found.face(words, line),
            _ => Ok(()),
        };
        result.map_err(|fault| Fault::Line(line, fault))?;
    }
    Ok(found)
}

impl Uvs {
    /// One or two numbers; a third one, for volume textures, is ignored.
    fn uv<'a>(&mut self, mut words: impl Iterator<Item = Word<'a>>) -> Result<(), ObjFault> {
        let mut uv = [0.0; 2];
        for (found, part) in uv.iter_mut().enumerate() {
            match words.next() {
                Some(word) => *part = number(word)?,
                None if found == 0 => return Err(ObjFault::NoTextureNumbers),
                None => {}
            }
        }
        self.uvs.push(uv);
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = Word<'a>>, line: u64) -> Result<(), ObjFault> {
        for word in words {
            let mut parts = word.bytes.split(|&byte| byte == b'/');
            let (vertex, uv) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
            if uv.is_empty() {
                self.of_corner.push(None);
                continue;
            }
            let both = counted(vertex, self.vertices).zip(counted(uv, self.uvs.len()));
            let (vertex, uv) = both.ok_or_else(|| ObjFault::NotACorner { span: word.span() })?;
            if self.of_vertex.len() <= vertex {
                self.of_vertex.resize(vertex + 1, None);
            }
            self.of_vertex[vertex].get_or_insert((uv, line));
            self.of_corner.push(Some(uv));
        }
        Ok(())
    }

    fn of_corners(self) -> Option<CornerUvs> {
        let index = |uv: Option<usize>| uv.filter(|uv| *uv < self.uvs.len()).map(|uv| uv as u32);
        let corners: Option<Vec<u32>> = self.of_corner.iter().map(|uv| index(*uv)).collect();
        corners.filter(|corners| !corners.is_empty()).map(|corners| (self.uvs, corners))
    }

    fn finish(mut self) -> Result<Vec<Option<[f64; 2]>>, Fault> {
        self.of_vertex.resize(self.vertices, None);
        let uv = |known: Option<(usize, u64)>| {
            let Some((uv, line)) = known else { return Ok(None) };
            let fault = ObjFault::NoSuchTexture { texture: uv + 1, textures: self.uvs.len() };
            self.uvs.get(uv).map(|uv| Some(*uv)).ok_or(Fault::Line(line, fault))
        };
        self.of_vertex.iter().map(|known| uv(*known)).collect()
    }
}

/// The index from 0 of an OBJ number, which counts from 1 or backwards from -1. `None` if it is malformed or 0.
pub(super) fn counted(word: &[u8], count: usize) -> Option<usize> {
    let number = std::str::from_utf8(word).ok()?.parse::<i64>().ok().filter(|number| *number != 0)?;
    let from_0 = if number > 0 { number - 1 } else { number.checked_add(count as i64)? };
    u32::try_from(from_0).ok().map(|at| at as usize)
}
