//! Errors of reading an OBJ file.

use std::io;
use std::path::PathBuf;

use crate::files::LineSpan;

/// Reasons why a file is no mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// It cannot be read: missing, a folder, no permission.
    #[error("cannot read `{}`: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A line is malformed.
    #[error("`{}`, line {line}: {fault}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: u64,
        /// The fault in that line.
        fault: ObjFault,
    },
    /// It has no vertices, so it is probably no OBJ file.
    #[error("`{}` has no vertices; is it an OBJ file?", path.display())]
    NoVertices {
        /// The file.
        path: PathBuf,
    },
}

/// Faults of a line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjFault {
    /// A coordinate is not a number.
    #[error("{span}: not a number")]
    NotANumber {
        /// Where it is written.
        span: LineSpan,
    },
    /// A coordinate is NaN, infinite, or too large for 64 bits.
    #[error("{span}: not a finite number")]
    NotFinite {
        /// Where it is written.
        span: LineSpan,
    },
    /// A vertex has another count of numbers than three, four, six or seven.
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
    /// A face has more corners than can be processed in reasonable time.
    #[error("a face may have {max} corners; this one has {found}: cut it into smaller faces")]
    TooManyCorners {
        /// How many it has.
        found: usize,
        /// How many it may have.
        max: usize,
    },
    /// A corner does not begin with a whole number.
    #[error("{span}: not a corner; it takes a vertex's number, as in `7` or `7/2/5`")]
    NotACorner {
        /// Where it is written.
        span: LineSpan,
    },
    /// A statement of texture coordinates has no number.
    #[error("texture coordinates take one to three numbers; this line has none")]
    NoTextureNumbers,
    /// A corner refers to texture coordinates that do not exist.
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
    /// A corner refers to a vertex that does not exist.
    #[error("there is no vertex {vertex}; there are {vertices}")]
    NoSuchVertex {
        /// The number as written.
        vertex: i64,
        /// How many vertices there are; for a negative number, before this line.
        vertices: usize,
    },
    /// The mesh has more vertices or corners than 32 bits can number.
    #[error("the mesh has more than {max} vertices or corners")]
    TooLarge {
        /// How many it may have.
        max: u32,
    },
}
