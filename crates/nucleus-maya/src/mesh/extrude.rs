//! Extrusion of faces, together or each for itself.

use std::collections::{HashMap, HashSet};

use crate::scene::{MayaScene, NodeId, Vector3};

use super::budget::Budget;
use super::poly::{Components, Poly, sides};

const TRANSLATE: Vector3 = Vector3 {
    whole: &["t", "translate"],
    parts: [&["tx", "translateX"], &["ty", "translateY"], &["tz", "translateZ"]],
};
const LOCAL_TRANSLATE: Vector3 = Vector3 {
    whole: &["lt", "localTranslate"],
    parts: [&["ltx", "localTranslateX"], &["lty", "localTranslateY"], &["ltz", "localTranslateZ"]],
};
const LOCAL_SCALE: Vector3 = Vector3 {
    whole: &["ls", "localScale"],
    parts: [&["lsx", "localScaleX"], &["lsy", "localScaleY"], &["lsz", "localScaleZ"]],
};
const ROTATE: Vector3 =
    Vector3 { whole: &["ro", "rotate"], parts: [&["rx", "rotateX"], &["ry", "rotateY"], &["rz", "rotateZ"]] };
const SCALE: Vector3 =
    Vector3 { whole: &["s", "scale"], parts: [&["sx", "scaleX"], &["sy", "scaleY"], &["sz", "scaleZ"]] };
const PIVOT: Vector3 =
    Vector3 { whole: &["pvt", "pivot"], parts: [&["pvx", "pivotX"], &["pvy", "pivotY"], &["pvz", "pivotZ"]] };

/// Extrudes the picked faces. `None` if the node turns them, which is not carried out.
///
/// # Errors
/// When it makes more points than are left.
pub(super) fn extrude(
    scene: &MayaScene,
    id: NodeId,
    mesh: &Poly,
    picked: &Components,
    budget: &mut Budget,
) -> Result<Option<Poly>, String> {
    let unit = scene.units_of(id).centimetres;
    let length = |vector| scene.stored_vector(id, vector, [0.0; 3]).map(|x| x * unit);
    if scene.stored_vector(id, ROTATE, [0.0; 3]).iter().any(|x| x.abs() > 1e-9) {
        return Ok(None);
    }
    let thickness = scene.stored_or(id, &["tk", "thickness"], 0.0) * unit;
    let local = length(LOCAL_TRANSLATE);
    if local[0].abs() + local[1].abs() > 1e-9 {
        return Ok(None);
    }
    let extrusion = Extrusion {
        along_normal: local[2] + thickness,
        by: length(TRANSLATE),
        scale: scene.stored_vector(id, SCALE, [1.0; 3]),
        pivot: length(PIVOT),
        shrink: scene.stored_vector(id, LOCAL_SCALE, [1.0; 3]),
        inset: scene.stored_or(id, &["off", "offset"], 0.0) * unit,
    };
    let divisions = scene.count_or(id, &["d", "divisions"], 1).clamp(1, 100);
    let flags = picked.flags("f", mesh.face_count());
    let faces: Vec<usize> = (0..flags.len()).filter(|face| flags[*face]).collect();
    let groups: Vec<&[usize]> = match scene.switch_or(id, &["kft", "keepFacesTogether"], true) {
        true => vec![&faces],
        false => faces.chunks(1).collect(),
    };
    extrusion.apply(mesh, &groups, divisions, budget).map(Some)
}

/// How far the picked faces move. Lengths in centimetres.
struct Extrusion {
    along_normal: f64,
    by: [f64; 3],
    scale: [f64; 3],
    pivot: [f64; 3],
    shrink: [f64; 3],
    inset: f64,
}

impl Extrusion {
    /// Extrudes groups of faces. The faces of a group stay together, and no face is in two groups.
    fn apply(
        &self,
        mesh: &Poly,
        groups: &[&[usize]],
        divisions: u32,
        budget: &mut Budget,
    ) -> Result<Poly, String> {
        let mut made = Poly {
            ends: mesh.ends.clone(),
            corners: mesh.corners.clone(),
            ..Poly::reshaped(mesh.points.clone())
        };
        let sizes = groups.iter().map(|faces| {
            let points: HashSet<u32> = faces.iter().flat_map(|face| mesh.points_of(*face)).copied().collect();
            points.len().max(border(mesh, faces).len()) as u64
        });
        budget.take(sizes.sum::<u64>() * u64::from(divisions))?;
        for faces in groups {
            self.extrude(mesh, faces, divisions, &mut made);
        }
        // Points inside the picked faces are on no face any more.
        made.without_unused_points();
        Ok(made)
    }

    /// New points for all points of the faces, ring by ring; sides along the border of the faces.
    fn extrude(&self, mesh: &Poly, faces: &[usize], divisions: u32, made: &mut Poly) {
        let mut order: Vec<u32> = Vec::new();
        let mut index: HashMap<u32, u32> = HashMap::new();
        let mut normals: Vec<[f64; 3]> = Vec::new();
        for face in faces {
            let normal = unit(mesh.normal(*face));
            for &point in mesh.points_of(*face) {
                let k = *index.entry(point).or_insert_with(|| {
                    order.push(point);
                    normals.push([0.0; 3]);
                    order.len() as u32 - 1
                });
                (0..3).for_each(|a| normals[k as usize][a] += normal[a]);
            }
        }
        let centre = self.centre(mesh, &order);
        let ends: Vec<[f64; 3]> = order
            .iter()
            .zip(&normals)
            .map(|(point, n)| self.moved(mesh.points[*point as usize], unit(*n), centre))
            .collect();
        let first = made.points.len() as u32;
        let count = order.len() as u32;
        for ring in 1..=divisions {
            let share = f64::from(ring) / f64::from(divisions);
            for (point, end) in order.iter().zip(&ends) {
                let start = mesh.points[*point as usize];
                made.points.push([0, 1, 2].map(|k| start[k] + share * (end[k] - start[k])));
            }
        }
        let at = |point: u32, ring: u32| match ring {
            0 => point,
            ring => first + (ring - 1) * count + index[&point],
        };
        for face in faces {
            let end = mesh.ends[*face] as usize;
            let start = end - mesh.points_of(*face).len();
            made.corners[start..end].iter_mut().for_each(|point| *point = at(*point, divisions));
        }
        for (a, b) in border(mesh, faces) {
            (0..divisions)
                .for_each(|ring| made.face(&[at(a, ring), at(b, ring), at(b, ring + 1), at(a, ring + 1)]));
        }
    }

    fn centre(&self, mesh: &Poly, points: &[u32]) -> [f64; 3] {
        let count = points.len().max(1) as f64;
        [0, 1, 2].map(|k| points.iter().map(|point| mesh.points[*point as usize][k]).sum::<f64>() / count)
    }

    fn moved(&self, point: [f64; 3], normal: [f64; 3], centre: [f64; 3]) -> [f64; 3] {
        let to_centre = unit([0, 1, 2].map(|k| centre[k] - point[k]));
        [0, 1, 2].map(|k| {
            let shrunk = centre[k] + (point[k] - centre[k]) * self.shrink[k] + to_centre[k] * self.inset;
            let scaled = self.pivot[k] + (shrunk - self.pivot[k]) * self.scale[k];
            scaled + normal[k] * self.along_normal + self.by[k]
        })
    }
}

/// The sides of faces that no other of them shares.
fn border(mesh: &Poly, faces: &[usize]) -> Vec<(u32, u32)> {
    let all = || faces.iter().flat_map(|face| sides(mesh.points_of(*face)));
    let inner: HashSet<(u32, u32)> = all().collect();
    all().filter(|(a, b)| !inner.contains(&(*b, *a))).collect()
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Extrusion = Extrusion {
        along_normal: 3.0,
        by: [0.0; 3],
        scale: [1.0; 3],
        pivot: [0.0; 3],
        shrink: [1.0; 3],
        inset: 0.0,
    };

    fn plane(across: u32) -> Poly {
        let made = nucleus_graph::mesh::poly_plane(2.0, 2.0, (across, across)).unwrap();
        let mut mesh = Poly::reshaped(made.positions.iter().map(|p| [p.x, p.y, p.z]).collect());
        made.faces.iter().for_each(|face| mesh.face(face));
        mesh
    }

    #[test]
    fn faces_that_do_not_stay_together_are_numbered_as_one_after_the_other() {
        let mesh = plane(3);
        let shrinking = Extrusion { shrink: [0.5; 3], ..UP };
        let picked = [0, 1, 4, 8];
        let groups: Vec<&[usize]> = picked.chunks(1).collect();
        let apart = shrinking.apply(&mesh, &groups, 2, &mut Budget::default()).unwrap();
        let mut single = mesh;
        for face in picked {
            single = shrinking.apply(&single, &[&[face]], 2, &mut Budget::default()).unwrap();
        }
        assert_eq!(apart, single);
        assert_eq!((apart.points.len(), apart.face_count()), (16 + 4 * 8, 9 + 4 * 8));
    }

    #[test]
    fn an_extruded_plane_is_a_box_without_its_floor() {
        let whole = UP.apply(&plane(2), &[&[0, 1, 2, 3]], 2, &mut Budget::default()).unwrap();
        // Nine on top, two rings of eight below; the middle of the first ring and of the plane belong to no face.
        assert_eq!((whole.points.len(), whole.face_count()), (9 + 8 + 8, 4 + 2 * 8));
        let highest = whole.points.iter().map(|p| p[1]).fold(0.0, f64::max);
        assert!((highest - 3.0).abs() < 1e-12);
        let sides: Vec<_> = whole.faces().map(<[u32]>::len).collect();
        assert!(sides.iter().all(|count| *count == 4));
    }
}
