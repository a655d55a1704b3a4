//! How much a closed surface holds.

use nalgebra::Vector3;
use nucleus_core::Faces;

/// The volume inside a closed surface in the cube of its unit, by the divergence theorem; below nought if it is
/// inside out. Of a surface that is not closed it means nothing.
pub fn volume(faces: &Faces, points: &[Vector3<f64>]) -> f64 {
    let corner = |point: u32| points[point as usize];
    faces.triangles().map(|[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_cut_off_a_cube_holds_a_sixth_of_it_wherever_it_stands() {
        let faces: Faces =
            [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].iter().map(|face| &face[..]).collect();
        let corners = [Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z()];
        for shift in [Vector3::zeros(), Vector3::new(3.0, -8.0, 5.0)] {
            let found = volume(&faces, &corners.map(|corner| corner + shift));
            assert!((found - 1.0 / 6.0).abs() < 1e-12, "{found}");
        }
    }
}
