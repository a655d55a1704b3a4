//! Which way a surface faces at its points.

use super::mesh::{drawable_faces, is_drawable_face};
use super::{Object, Vec3};

/// Faces that meet at a wider angle than 50 degrees keep a sharp edge between them.
const COS_SHARPEST: f32 = 0.643;

/// A unit normal per point, weighted by the area of the faces round it; +Y where there is none.
pub(super) fn of_points(object: &Object) -> Vec<Vec3> {
    let mut sums = vec![Vec3::zeros(); object.positions.len()];
    for face in drawable_faces(object) {
        let normal = area_vector(object, face);
        for point in face {
            sums[*point as usize] += normal;
        }
    }
    sums.iter().map(unit).collect()
}

/// A unit normal per corner, in the order of corners: only faces that meet smoothly share one.
pub(super) fn of_corners(object: &Object) -> Vec<Vec3> {
    let areas: Vec<Vec3> = object
        .faces
        .iter()
        .map(|face| if is_drawable_face(object, face) { area_vector(object, face) } else { Vec3::zeros() })
        .collect();
    let around = faces_of_points(object);
    let mut normals = Vec::with_capacity(object.faces.corners().len());
    for (face, points) in object.faces.iter().enumerate() {
        let own = unit(&areas[face]);
        for point in points {
            let neighbours = around.get(*point as usize).map_or(&[][..], Vec::as_slice);
            let smooth = neighbours.iter().map(|other| areas[*other as usize]);
            let smooth = smooth.filter(|area| area.dot(&own) >= COS_SHARPEST * area.norm());
            normals.push(unit(&smooth.fold(Vec3::zeros(), |sum, area| sum + area)));
        }
    }
    normals
}

fn faces_of_points(object: &Object) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); object.positions.len()];
    for (face, points) in object.faces.iter().enumerate() {
        for point in points {
            if let Some(faces) = around.get_mut(*point as usize) {
                faces.push(face as u32);
            }
        }
    }
    around
}

/// The normal of a polygon, as long as twice its area (Newell's sum, taken from the first point).
fn area_vector(object: &Object, face: &[u32]) -> Vec3 {
    let at = |corner: usize| Vec3::from(object.positions[face[corner] as usize]);
    (2..face.len()).fold(Vec3::zeros(), |sum, k| sum + (at(k - 1) - at(0)).cross(&(at(k) - at(0))))
}

/// The direction of a vector, +Y if it has none.
pub(super) fn unit(vector: &Vec3) -> Vec3 {
    let length = vector.norm();
    if length > 0.0 && length.is_finite() { vector / length } else { Vec3::y() }
}
