//! Vertices of a mesh for formats that store normals: a point has more than one where its faces meet in a hard edge, or
//! along a seam of texture coordinates.

use std::collections::HashMap;

use nucleus_cache::{COS_HARD_EDGE, ObjectInfo, ObjectKind};
use nucleus_core::Faces;
use nucleus_core::nalgebra::Vector3;

/// The vertices of a mesh whose faces stay.
pub(crate) struct Vertices {
    /// Point of each vertex.
    pub points: Vec<u32>,
    /// Index of the texture coordinates of each vertex; empty where they do not split points.
    pub uvs: Vec<u32>,
    /// The faces, by vertex.
    pub faces: Faces,
    /// End of the faces that make the normal of each vertex, and those faces.
    ends: Vec<u32>,
    around: Vec<u32>,
}

impl Vertices {
    /// One per point, in order: the mesh is smooth everywhere.
    pub fn smooth(faces: &Faces, points: usize) -> Self {
        let around = faces_of_points(faces, points);
        let ends = around.iter().scan(0, |end, faces| {
            *end += faces.len() as u32;
            Some(*end)
        });
        Self {
            points: (0..points as u32).collect(),
            uvs: Vec::new(),
            faces: faces.clone(),
            ends: ends.collect(),
            around: around.concat(),
        }
    }

    /// Those of an object: colliders have hard edges, as at rest, and all others are smooth. The corners of its faces may have
    /// indices of texture coordinates.
    pub fn of(object: &ObjectInfo, uvs: &[u32]) -> Self {
        let hard = (object.kind == ObjectKind::Collider).then_some(&object.rest[..]);
        let split = Self::split(&object.faces, object.rest.len(), hard, uvs);
        match uvs.is_empty() && !split.are_split() {
            true => Self::smooth(&object.faces, object.rest.len()),
            false => split,
        }
    }

    /// Splits points where faces meet in a hard edge at these positions, if any are given, and where corners of faces differ
    /// in the index of their texture coordinates, if there are any.
    fn split(faces: &Faces, points: usize, hard: Option<&[[f32; 3]]>, uvs: &[u32]) -> Self {
        let around = faces_of_points(faces, points);
        let units: Option<Vec<_>> = hard.map(|positions| areas(faces, positions).iter().map(unit).collect());
        let mut all = Self {
            points: Vec::new(),
            uvs: Vec::new(),
            faces: Faces::with_capacity(faces.len(), faces.corners().len()),
            ends: Vec::new(),
            around: Vec::new(),
        };
        let (mut known, mut corner) = (HashMap::new(), 0);
        for (own, face) in (0..).zip(faces.iter()) {
            let vertices = face.iter().map(|&point| {
                let meets_smoothly = |other: &u32| {
                    let is_smooth = |units: &Vec<Vector3<f32>>| {
                        units[own as usize].dot(&units[*other as usize]) >= COS_HARD_EDGE
                    };
                    *other == own || units.as_ref().is_none_or(is_smooth)
                };
                let group: Vec<u32> = around[point as usize].iter().copied().filter(meets_smoothly).collect();
                let uv = uvs.get(corner).copied();
                corner += 1;
                let next = known.len() as u32;
                *known.entry((point, uv, group)).or_insert_with_key(|(_, _, group)| {
                    all.points.push(point);
                    all.uvs.extend(uv);
                    all.around.extend(group);
                    all.ends.push(all.around.len() as u32);
                    next
                })
            });
            all.faces.push(&vertices.collect::<Vec<u32>>());
        }
        all
    }

    /// Whether a point has more than one.
    pub fn are_split(&self) -> bool {
        let mut points = self.points.clone();
        points.sort_unstable();
        points.windows(2).any(|pair| pair[0] == pair[1])
    }

    /// What belongs to the points, by vertex.
    pub fn gather<T: Copy>(&self, of_points: &[T]) -> Vec<T> {
        self.points.iter().map(|&point| of_points[point as usize]).collect()
    }

    /// The unit normal of each vertex at these positions of the vertices: the mean of its faces' normals, by area; +Y
    /// without any.
    pub fn normals(&self, positions: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let areas = areas(&self.faces, positions);
        let mut first = 0;
        let of_vertex = self.ends.iter().map(|&end| {
            let around = &self.around[first..end as usize];
            first = end as usize;
            let sum: Vector3<f32> = around.iter().map(|&face| areas[face as usize]).sum();
            sum.try_normalize(0.0).unwrap_or_else(Vector3::y).into()
        });
        of_vertex.collect()
    }
}

fn faces_of_points(faces: &Faces, points: usize) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); points];
    for (index, face) in (0..).zip(faces.iter()) {
        face.iter().for_each(|&point| around[point as usize].push(index));
    }
    around
}

/// Twice the area of each face, along its normal.
fn areas(faces: &Faces, positions: &[[f32; 3]]) -> Vec<Vector3<f32>> {
    let area = |face: &[u32]| {
        let place = |k: usize| Vector3::from(positions[face[k] as usize]);
        let from_first = |k: usize| place(k) - place(0);
        (1..face.len().saturating_sub(1)).map(|k| from_first(k).cross(&from_first(k + 1))).sum()
    };
    faces.iter().map(area).collect()
}

fn unit(vector: &Vector3<f32>) -> Vector3<f32> {
    vector.try_normalize(0.0).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of two by one by one, and its faces.
    fn block() -> (Faces, Vec<[f32; 3]>) {
        let place = |k: u32| [(k & 1) as f32 * 2.0, (k >> 1 & 1) as f32, (k >> 2) as f32];
        let mut faces = Faces::default();
        for face in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            faces.push(&face);
        }
        (faces, (0..8).map(place).collect())
    }

    #[test]
    fn a_box_has_flat_sides_and_a_smooth_one_a_mean_normal_at_each_corner() {
        let (faces, places) = block();
        let split = Vertices::split(&faces, 8, Some(&places), &[]);
        assert!(split.points.len() == 24 && split.are_split());
        let normals = split.normals(&split.gather(&places));
        for (face, sides) in split.faces.iter().zip([-1.0, 1.0, -1.0, 1.0, -1.0, 1.0]).enumerate() {
            let mut expected = [0.0; 3];
            expected[face / 2] = sides.1;
            assert!(sides.0.iter().all(|&vertex| normals[vertex as usize] == expected), "{face}");
        }
        let smooth = Vertices::smooth(&faces, 8);
        assert!(smooth.points.len() == 8 && !smooth.are_split() && smooth.faces == faces);
        // Its sides have areas of 1, 2 and 2.
        let [x, y, z] = smooth.normals(&places)[7].map(f64::from);
        assert!((x - 1.0 / 3.0).abs() < 1e-6 && (y - 2.0 / 3.0).abs() < 1e-6 && (y - z).abs() < 1e-6);
    }

    #[test]
    fn a_point_is_split_along_a_seam_and_keeps_one_normal() {
        let (faces, places) = block();
        // The first face has values of its own.
        let uvs: Vec<u32> = (0..)
            .zip(faces.corners())
            .map(|(corner, &point)| if corner < 4 { 8 + point } else { point })
            .collect();
        let split = Vertices::split(&faces, 8, None, &uvs);
        assert_eq!(split.points.len(), 12);
        let normals = split.normals(&split.gather(&places));
        for (vertex, &point) in split.points.iter().enumerate() {
            let twins = (0..12).filter(|&other| split.points[other] == point);
            assert!(twins.map(|twin| normals[twin]).all(|normal| normal == normals[vertex]));
        }
        assert!(
            split.faces.corners().iter().zip(&uvs).all(|(&vertex, &uv)| split.uvs[vertex as usize] == uv)
        );
    }
}
