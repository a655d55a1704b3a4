//! Why an OBJ file is not a mesh.

use std::io;
use std::path::PathBuf;

use crate::files::Piece;

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// It cannot be read at all: missing, a folder, no permission ...
    #[error("cannot read `{}`: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A line of it cannot be understood.
    #[error("`{}`, line {line}: {fault}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: u64,
        /// What is wrong there.
        fault: ObjFault,
    },
    /// It has no vertices: most likely it is no OBJ file.
    #[error("`{}` has no vertices; is it an OBJ file?", path.display())]
    NoVertices {
        /// The file.
        path: PathBuf,
    },
}

/// What is wrong with a line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjFault {
    /// A coordinate is not written as a number.
    #[error("{piece}: not a number")]
    NotANumber {
        /// Where it is written.
        piece: Piece,
    },
    /// A coordinate is NaN, infinite, or too large to hold.
    #[error("{piece}: not a finite number")]
    NotFinite {
        /// Where it is written.
        piece: Piece,
    },
    /// A vertex has neither three numbers nor three and a weight, a colour or both.
    #[error("a vertex takes three numbers, then may take a weight and a colour; this one has {found}")]
    WrongNumberCount {
        /// How many it has.
        found: usize,
    },
    /// A face has fewer than three corners.
    #[error("a face takes at least three corners; this one has {found}")]
    TooFewCorners {
        /// How many it has.
        found: usize,
    },
    /// A face has more corners than can be worked with in reasonable time.
    #[error("a face may have {most} corners; this one has {found}: cut it into smaller faces")]
    TooManyCorners {
        /// How many it has.
        found: usize,
        /// How many it may have.
        most: usize,
    },
    /// A corner does not begin with a whole number.
    #[error("{piece}: not a corner; it takes a vertex's number, as in `7` or `7/2/5`")]
    NotACorner {
        /// Where it is written.
        piece: Piece,
    },
    /// Texture coordinates are given without a number.
    #[error("texture coordinates take one to three numbers; here are none")]
    NoTextureNumbers,
    /// A corner names texture coordinates that are not there.
    #[error("there are no texture coordinates {texture}; there are {textures}")]
    NoSuchTexture {
        /// The number as written.
        texture: usize,
        /// How many there are.
        textures: usize,
    },
    /// Vertices are counted from 1, or backwards from -1.
    #[error("there is no vertex 0; the first is 1, the latest is -1")]
    VertexZero,
    /// A corner names a vertex that is not there.
    #[error("there is no vertex {vertex}; there are {vertices}")]
    NoSuchVertex {
        /// The number as written.
        vertex: i64,
        /// How many vertices there are; for a negative number, before this line.
        vertices: usize,
    },
    /// More vertices or corners than can be numbered.
    #[error("the mesh has more than {most} vertices or corners")]
    TooLarge {
        /// How many it may have.
        most: u32,
    },
}
