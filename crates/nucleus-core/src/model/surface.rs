//! A polygon mesh: positions and faces, as the builder receives them.

use nalgebra::Vector3;

/// Polygons of any size: one list of corners, with the offset of each face.
///
/// Quads stay quads, because their diagonals become cross links (shear).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Faces {
    /// First corner of each face, and one past the last corner of the last: `len() + 1` entries.
    starts: Vec<u32>,
    /// Point of each corner.
    corners: Vec<u32>,
}

impl Default for Faces {
    fn default() -> Self {
        Self { starts: vec![0], corners: Vec::new() }
    }
}

impl Faces {
    /// No faces, with room for `faces` faces of `corners` corners in all.
    pub fn with_capacity(faces: usize, corners: usize) -> Self {
        let mut starts = Vec::with_capacity(faces + 1);
        starts.push(0);
        Self { starts, corners: Vec::with_capacity(corners) }
    }

    /// Adds one face, its corners in order round the face.
    pub fn push(&mut self, corners: &[u32]) {
        self.corners.extend_from_slice(corners);
        self.starts.push(self.corners.len() as u32);
    }

    /// The number of faces.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The points round face `face`.
    pub fn face(&self, face: usize) -> &[u32] {
        &self.corners[self.starts[face] as usize..self.starts[face + 1] as usize]
    }

    /// All faces in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> + '_ {
        (0..self.len()).map(|face| self.face(face))
    }

    /// The corners of all faces in one list.
    pub fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// The triangulated faces: a fan in each polygon, a quad along its first diagonal.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.iter().flat_map(|face| (2..face.len()).map(move |k| [face[0], face[k - 1], face[k]]))
    }
}

impl<'a> FromIterator<&'a [u32]> for Faces {
    fn from_iter<I: IntoIterator<Item = &'a [u32]>>(faces: I) -> Self {
        let mut all = Self::default();
        faces.into_iter().for_each(|face| all.push(face));
        all
    }
}

/// A polygon mesh in world space, in metres.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surface {
    /// Positions of the points, in metres.
    pub positions: Vec<Vector3<f64>>,
    /// The faces; corners index `positions`.
    pub faces: Faces,
}
