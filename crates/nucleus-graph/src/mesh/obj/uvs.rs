//! Texture coordinates of an OBJ file, point by point. A mesh is read without them, for few scenes ask.

use std::io::{BufRead, BufReader};
use std::path::Path;

use super::lines::Lines;
use super::{ObjError, ObjFault, Trouble, Word, number, words};
use crate::files;

/// The texture coordinates of each vertex; nothing for those that no face gives any. Where faces disagree, along
/// a seam, the first of them counts.
///
/// # Errors
/// When the file cannot be read, or a line that matters here is not as it should be; see [`ObjError`].
pub fn read_obj_uvs(path: impl AsRef<Path>) -> Result<Vec<Option<[f64; 2]>>, ObjError> {
    let path = path.as_ref();
    let uvs = files::open(path)
        .map_err(Trouble::from)
        .and_then(|(file, _)| read(BufReader::with_capacity(1 << 18, file)));
    uvs.map_err(|trouble| trouble.in_file(path))
}

/// What has been read so far.
#[derive(Default)]
struct Uvs {
    vertices: usize,
    uvs: Vec<[f64; 2]>,
    /// Which of them each vertex has, and the line that says so.
    of_vertex: Vec<Option<(usize, u64)>>,
}

fn read(input: impl BufRead) -> Result<Vec<Option<[f64; 2]>>, Trouble> {
    let mut found = Uvs::default();
    let mut lines = Lines::new(input);
    while let Some((line, statement)) = lines.next()? {
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
        result.map_err(|fault| Trouble::Line(line, fault))?;
    }
    found.finish()
}

impl Uvs {
    /// One number or two, and a third for textures that fill space.
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
                continue;
            }
            let both = counted(vertex, self.vertices).zip(counted(uv, self.uvs.len()));
            let (vertex, uv) = both.ok_or_else(|| ObjFault::NotACorner { piece: word.piece() })?;
            if self.of_vertex.len() <= vertex {
                self.of_vertex.resize(vertex + 1, None);
            }
            self.of_vertex[vertex].get_or_insert((uv, line));
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Vec<Option<[f64; 2]>>, Trouble> {
        self.of_vertex.resize(self.vertices, None);
        let uv = |known: Option<(usize, u64)>| {
            let Some((uv, line)) = known else { return Ok(None) };
            let fault = ObjFault::NoSuchTexture { texture: uv + 1, textures: self.uvs.len() };
            self.uvs.get(uv).map(|uv| Some(*uv)).ok_or(Trouble::Line(line, fault))
        };
        self.of_vertex.iter().map(|known| uv(*known)).collect()
    }
}

/// A number of OBJ, from 1 or backwards from -1, counted from 0; nothing where it is none that could be meant.
fn counted(word: &[u8], count: usize) -> Option<usize> {
    let number = std::str::from_utf8(word).ok()?.parse::<i64>().ok().filter(|number| *number != 0)?;
    let from_0 = if number > 0 { number - 1 } else { number.checked_add(count as i64)? };
    u32::try_from(from_0).ok().map(|at| at as usize)
}
