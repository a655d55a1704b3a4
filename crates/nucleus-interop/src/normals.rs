//! Normals of a mesh, for formats that store them.

use nucleus_core::Faces;

/// The unit normal of each point: the mean of its faces' normals, by area. Points of no face have +Y.
pub(crate) fn normals(faces: &Faces, positions: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut sums = vec![[0.0_f32; 3]; positions.len()];
    for triangle in faces.triangles() {
        let [a, b, c] = triangle.map(|point| positions[point as usize]);
        let [u, v] = [b, c].map(|to| [0, 1, 2].map(|axis| to[axis] - a[axis]));
        let area = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        for point in triangle {
            (0..3).for_each(|axis| sums[point as usize][axis] += area[axis]);
        }
    }
    for sum in &mut sums {
        let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
        *sum = if length > 0.0 { sum.map(|x| x / length) } else { [0.0, 1.0, 0.0] };
    }
    sums
}
