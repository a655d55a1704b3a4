//! What a format of mesh files provides.

use nalgebra::Vector3;
use nucleus_core::Faces;

use super::error::Fault;
use crate::memory::Size;
use crate::mesh::obj::CornerUvs;

/// The frames of a scene, at which a file with motion is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frames {
    /// The first frame of the scene: second 0 of a glTF file.
    pub first: i64,
    /// Frames per second.
    pub fps: f64,
}

/// An opened file of some format.
pub(super) trait Source {
    /// Points and corners at the first frame.
    fn size(&self) -> Size;

    /// Whether points may change from frame to frame.
    fn moves(&self) -> bool {
        false
    }

    /// Metres per unit; `None` if the file does not say.
    fn metres_per_unit(&self) -> Option<f64> {
        None
    }

    /// Faces at a frame, and texture coordinates with an index for each corner.
    fn faces(&self, frame: i64) -> Result<(Faces, Option<CornerUvs>), Fault>;

    /// Positions of all points at a frame.
    fn positions(&self, frame: i64) -> Result<Vec<Vector3<f64>>, Fault>;

    /// Where points of one place are one point: the count of points of each object. Empty where no points are merged.
    fn split_objects(&self) -> Vec<usize> {
        Vec::new()
    }
}
