//! PLY files: text, or binary of either byte order. Positions, faces and texture coordinates of points are read; other
//! elements and properties are skipped.
//!
//! The reader is our own: `ply-rs` keeps a hash map for each vertex, and reserves memory for counts that a file only
//! claims.

use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::Faces;

use super::error::Fault;
use super::source::Source;
use crate::files;
use crate::memory::Size;
use crate::mesh::obj::CornerUvs;

/// A file that has been read.
#[derive(Debug, Default, PartialEq)]
pub(super) struct PlyFile {
    positions: Vec<Vector3<f64>>,
    faces: Faces,
    uvs: Vec<[f64; 2]>,
}

impl PlyFile {
    pub(super) fn open(path: &Path) -> Result<Self, Fault> {
        let bytes = files::read_all(path).map_err(Fault::Io)?;
        read(&bytes).map_err(Fault::Malformed)
    }
}

impl Source for PlyFile {
    fn size(&self) -> Size {
        Size { points: self.positions.len() as u64, corners: self.faces.corners().len() as u64 }
    }

    fn faces(&self, _frame: i64) -> Result<(Faces, Option<CornerUvs>), Fault> {
        let uvs = (!self.uvs.is_empty()).then(|| (self.uvs.clone(), self.faces.corners().to_vec()));
        Ok((self.faces.clone(), uvs))
    }

    fn positions(&self, _frame: i64) -> Result<Vec<Vector3<f64>>, Fault> {
        Ok(self.positions.clone())
    }
}

/// A number type of PLY.
#[derive(Debug, Clone, Copy)]
struct Number {
    bytes: usize,
    is_float: bool,
    is_signed: bool,
}

/// What a property means to a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meaning {
    /// x, y or z.
    Position(usize),
    /// u or v.
    Texture(usize),
    Corners,
    Other,
}

struct Property {
    meaning: Meaning,
    /// For a list, the type of its length.
    count: Option<Number>,
    number: Number,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

impl Element {
    fn has(&self, meaning: Meaning) -> bool {
        self.properties.iter().any(|property| property.meaning == meaning)
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Text,
    Little,
    Big,
}

fn read(bytes: &[u8]) -> Result<PlyFile, String> {
    let (encoding, elements, body) = header(bytes)?;
    let mut values = Values { encoding, bytes: body };
    let mut file = PlyFile::default();
    let mut corners = Vec::new();
    for element in elements.iter().filter(|element| !element.properties.is_empty()) {
        let (is_vertex, is_face) = (element.name == "vertex", element.name == "face");
        if is_vertex && !(0..3).all(|axis| element.has(Meaning::Position(axis))) {
            return Err("its vertices have no `x`, `y` and `z`".to_owned());
        }
        let has_uvs = is_vertex && (0..2).all(|axis| element.has(Meaning::Texture(axis)));
        for row in 0..element.count {
            let (mut position, mut uv) = (Vector3::zeros(), [0.0; 2]);
            corners.clear();
            for property in &element.properties {
                values
                    .each(property, |value| match property.meaning {
                        Meaning::Position(axis) => position[axis] = value,
                        Meaning::Texture(axis) => uv[axis] = value,
                        Meaning::Corners => corners.push(value),
                        Meaning::Other => {}
                    })
                    .map_err(|Ended| {
                        format!("it ends, or has no number, in row {row} of {} of an element", element.count)
                    })?;
            }
            if is_vertex {
                if !position.iter().all(|x| x.is_finite()) {
                    return Err(format!("vertex {row} is not a finite number"));
                }
                file.positions.push(position);
                file.uvs.extend(has_uvs.then_some(uv));
            } else if is_face {
                file.faces.push(&face(&corners, row)?);
            }
        }
    }
    if file.positions.len() >= u32::MAX as usize {
        return Err("it has too many vertices".to_owned());
    }
    Ok(file)
}

/// The corners of a face, of which at least three are needed.
fn face(corners: &[f64], row: u64) -> Result<Vec<u32>, String> {
    if corners.len() < 3 {
        return Err(format!("face {row} has {} corners; it takes at least three", corners.len()));
    }
    let corner = |value: &f64| {
        let is_index = *value >= 0.0 && *value < f64::from(u32::MAX) && value.fract() == 0.0;
        is_index
            .then_some(*value as u32)
            .ok_or_else(|| format!("a corner of face {row} is no number of a vertex"))
    };
    corners.iter().map(corner).collect()
}

fn header(bytes: &[u8]) -> Result<(Encoding, Vec<Element>, &[u8]), String> {
    let mut rest = bytes;
    let mut line = || {
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        let (line, after) = rest.split_at(end);
        rest = &after[1..];
        std::str::from_utf8(line).ok().map(str::trim)
    };
    if line() != Some("ply") {
        return Err("it is no PLY file".to_owned());
    }
    let (mut encoding, mut elements) = (None, Vec::<Element>::new());
    loop {
        let words: Vec<&str> = line().ok_or("its header has no end")?.split_whitespace().collect();
        match words.as_slice() {
            ["end_header"] => break,
            ["format", name, _] => {
                encoding = Some(match *name {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => return Err("its format is none of PLY's three".to_owned()),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| "an element of its header has no count")?;
                elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
            }
            ["property", rest @ ..] => {
                let element = elements.last_mut().ok_or("a property comes before any element")?;
                element.properties.push(property(rest).ok_or("a property of its header has no known type")?);
            }
            _ => {} // comments
        }
    }
    Ok((encoding.ok_or("its header names no format")?, elements, rest))
}

fn property(words: &[&str]) -> Option<Property> {
    match words {
        ["list", count, item, name] => {
            let is_face = matches!(*name, "vertex_indices" | "vertex_index");
            let meaning = if is_face { Meaning::Corners } else { Meaning::Other };
            Some(Property { meaning, count: Some(number(count)?), number: number(item)? })
        }
        [kind, name] => {
            let meaning = match *name {
                "x" => Meaning::Position(0),
                "y" => Meaning::Position(1),
                "z" => Meaning::Position(2),
                "u" | "s" | "texture_u" => Meaning::Texture(0),
                "v" | "t" | "texture_v" => Meaning::Texture(1),
                _ => Meaning::Other,
            };
            Some(Property { meaning, count: None, number: number(kind)? })
        }
        _ => None,
    }
}

fn number(word: &str) -> Option<Number> {
    let (bytes, is_float, is_signed) = match word {
        "char" | "int8" => (1, false, true),
        "uchar" | "uint8" => (1, false, false),
        "short" | "int16" => (2, false, true),
        "ushort" | "uint16" => (2, false, false),
        "int" | "int32" => (4, false, true),
        "uint" | "uint32" => (4, false, false),
        "float" | "float32" => (4, true, true),
        "double" | "float64" => (8, true, true),
        _ => return None,
    };
    Some(Number { bytes, is_float, is_signed })
}

/// The numbers of the body, one after the other.
struct Values<'a> {
    encoding: Encoding,
    bytes: &'a [u8],
}

/// The file ends before a value, or a value is no number.
struct Ended;

impl Values<'_> {
    /// Passes the value of a property, or the values of a list.
    fn each(&mut self, property: &Property, mut take: impl FnMut(f64)) -> Result<(), Ended> {
        let count = match property.count {
            None => 1.0,
            Some(count) => self.next(count)?,
        };
        // A count beyond the file ends it before it takes memory.
        if !(0.0..=self.bytes.len() as f64).contains(&count) {
            return Err(Ended);
        }
        for _ in 0..count as usize {
            take(self.next(property.number)?);
        }
        Ok(())
    }

    fn next(&mut self, number: Number) -> Result<f64, Ended> {
        if self.encoding == Encoding::Text {
            return self.next_word();
        }
        let (head, rest) = self.bytes.split_at_checked(number.bytes).ok_or(Ended)?;
        self.bytes = rest;
        let mut word = [0; 8];
        word[..head.len()].copy_from_slice(head);
        if self.encoding == Encoding::Big {
            word[..head.len()].reverse();
        }
        let bits = u64::from_le_bytes(word);
        let unused = 64 - 8 * number.bytes as u32;
        Ok(match number {
            Number { is_float: true, bytes: 4, .. } => f64::from(f32::from_bits(bits as u32)),
            Number { is_float: true, .. } => f64::from_bits(bits),
            Number { is_signed: true, .. } => ((bits << unused).cast_signed() >> unused) as f64,
            _ => bits as f64,
        })
    }

    fn next_word(&mut self) -> Result<f64, Ended> {
        let begin = self.bytes.iter().position(|byte| !byte.is_ascii_whitespace()).ok_or(Ended)?;
        let rest = &self.bytes[begin..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let word = std::str::from_utf8(&rest[..end]).map_err(|_| Ended)?;
        self.bytes = &rest[end..];
        word.parse().map_err(|_| Ended)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
                          element face 1\nproperty list uchar int vertex_indices\nend_header\n";

    fn text(body: &str) -> Result<PlyFile, String> {
        read(format!("ply\nformat ascii 1.0\ncomment a triangle\n{HEADER}{body}").as_bytes())
    }

    fn binary(big: bool, cut: usize) -> Result<PlyFile, String> {
        let name = if big { "big" } else { "little" };
        let mut bytes = format!("ply\nformat binary_{name}_endian 1.0\n{HEADER}").into_bytes();
        let put4 = |bytes: &mut Vec<u8>, word: u32| {
            bytes.extend(if big { word.to_be_bytes() } else { word.to_le_bytes() });
        };
        for [x, y, z] in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.5], [0.0, -2.0, 0.0]] {
            [x, y, z].iter().for_each(|x| put4(&mut bytes, x.to_bits()));
            bytes.push(255);
        }
        bytes.push(3);
        [0, 1, 2].iter().for_each(|point| put4(&mut bytes, *point));
        read(&bytes[..bytes.len() - cut])
    }

    #[test]
    fn text_and_both_byte_orders_give_the_same_mesh() {
        let file = text("0 0 0 255\n1 0 0.5 255\n0 -2 0 255\n3 0 1 2\n").unwrap();
        assert_eq!(file.positions[1], Vector3::new(1.0, 0.0, 0.5));
        assert_eq!(file.faces.face(0), [0, 1, 2]);
        assert_eq!(binary(false, 0).as_ref(), Ok(&file));
        assert_eq!(binary(true, 0), Ok(file));
    }

    #[test]
    fn malformed_files_are_refused_with_the_place() {
        let ended = |row, rows| format!("it ends, or has no number, in row {row} of {rows} of an element");
        assert_eq!(binary(false, 3).unwrap_err(), ended(0, 1));
        assert_eq!(text("0 0 0 255\n1 0 0.5 255\n").unwrap_err(), ended(2, 3));
        let points = "0 0 0 255\n1 0 0.5 255\n0 -2 0 255\n";
        assert_eq!(
            text(&format!("{points}3 0 1 -1\n")).unwrap_err(),
            "a corner of face 0 is no number of a vertex"
        );
        assert_eq!(
            text(&format!("{points}2 0 1\n")).unwrap_err(),
            "face 0 has 2 corners; it takes at least three"
        );
        assert_eq!(
            text("nan 0 0 0\n1 0 0 0\n0 0 0 0\n3 0 1 2").unwrap_err(),
            "vertex 0 is not a finite number"
        );
        assert_eq!(read(b"solid\n").unwrap_err(), "it is no PLY file");
        let endless =
            "ply\nformat ascii 1.0\nelement a 99999999999999\nelement vertex 1\nproperty int x\nend_header\n";
        assert_eq!(read(endless.as_bytes()).unwrap_err(), "its vertices have no `x`, `y` and `z`");
    }
}
