//! A polygon mesh: positions and faces, as the builder receives them.

use std::collections::BTreeMap;

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
    /// No faces, with capacity for `faces` faces of `corners` corners in all.
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
    ///
    /// # Panics
    /// When there is no such face.
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

    /// The faces seen from behind: each begins at the same corner and goes the other way round.
    pub fn reversed(&self) -> Self {
        let mut corners = self.corners.clone();
        self.reverse(&mut corners);
        Self { starts: self.starts.clone(), corners }
    }

    /// Puts a column with an entry per corner in the order of the faces seen from behind.
    ///
    /// # Panics
    /// When it has fewer entries.
    pub fn reverse<T>(&self, column: &mut [T]) {
        for face in self.starts.windows(2) {
            let [first, end] = [face[0], face[1]].map(|corner| corner as usize);
            column[first..end].get_mut(1..).into_iter().for_each(<[T]>::reverse);
        }
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

impl Surface {
    /// A flat sheet of `across` by `along` quads, from a corner along two sides, in metres.
    ///
    /// Point `row * (across + 1) + column` is `column` quads along `u` and `row` quads along `v`. Its normal is along
    /// `v` × `u`.
    pub fn sheet(corner: Vector3<f64>, [u, v]: [Vector3<f64>; 2], [across, along]: [u32; 2]) -> Self {
        let (across, along) = (across.max(1), along.max(1));
        let mut sheet = Self::default();
        for (row, column) in (0..=along).flat_map(|row| (0..=across).map(move |column| (row, column))) {
            let (s, t) = (f64::from(column) / f64::from(across), f64::from(row) / f64::from(along));
            sheet.positions.push(corner + u * s + v * t);
        }
        for (row, column) in (0..along).flat_map(|row| (0..across).map(move |column| (row, column))) {
            let a = row * (across + 1) + column;
            sheet.faces.push(&[a, a + across + 1, a + across + 2, a + 1]);
        }
        sheet
    }

    /// A sphere whose faces are those of a cube with `quads` by `quads` on each side; normals point outwards. Metres.
    pub fn sphere(centre: Vector3<f64>, radius: f64, quads: u32) -> Self {
        let quads = quads.max(1);
        let mut sphere = Self::default();
        let mut points: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        for (axis, side) in (0..3).flat_map(|axis| [0, quads].map(|side| (axis, side))) {
            for (i, j) in (0..quads).flat_map(|i| (0..quads).map(move |j| (i, j))) {
                let mut face = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| {
                    let mut cell = [side; 3];
                    (cell[(axis + 1) % 3], cell[(axis + 2) % 3]) = (i, j);
                    *points.entry(cell).or_insert_with(|| {
                        let on_cube =
                            Vector3::from(cell.map(|x| 2.0 * f64::from(x) / f64::from(quads) - 1.0));
                        sphere.positions.push(centre + on_cube.normalize() * radius);
                        sphere.positions.len() as u32 - 1
                    })
                });
                if side == 0 {
                    face.reverse();
                }
                sphere.faces.push(&face);
            }
        }
        sphere
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The volume inside a closed mesh whose normals point outwards, in m³.
    fn volume(mesh: &Surface) -> f64 {
        let corner = |point: u32| mesh.positions[point as usize];
        let of = |[a, b, c]: [u32; 3]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0;
        mesh.faces.triangles().map(of).sum()
    }

    #[test]
    fn a_sphere_is_closed_and_its_normals_point_outwards() {
        let sphere = Surface::sphere(Vector3::new(3.0, -2.0, 1.0), 0.5, 16);
        // Euler: of a cube's 6 n² faces and 12 n² edges, 6 n² + 2 points remain.
        assert_eq!([sphere.positions.len(), sphere.faces.len()], [6 * 256 + 2, 6 * 256]);
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
        assert!((volume(&sphere) / exact - 1.0).abs() < 0.01, "{} of {exact}", volume(&sphere));
    }

    #[test]
    fn a_sheet_spans_its_two_sides() {
        let sheet = Surface::sheet(Vector3::x(), [Vector3::y() * 2.0, Vector3::z() * 3.0], [4, 6]);
        assert_eq!([sheet.positions.len(), sheet.faces.len()], [35, 24]);
        assert_eq!(sheet.positions[34], Vector3::new(1.0, 2.0, 3.0));
        let corner = |point: u32| sheet.positions[point as usize];
        let area = |[a, b, c]: [u32; 3]| (corner(b) - corner(a)).cross(&(corner(c) - corner(a))).x / -2.0;
        assert!((sheet.faces.triangles().map(area).sum::<f64>() - 6.0).abs() < 1e-12);
    }
}
