//! Operators on meshes that move, merge, split, join or drop points and faces.

use std::collections::{BTreeMap, HashMap, HashSet, VecDeque};

use crate::animation::Matrix;
use crate::scene::{MayaScene, NodeId, Vector3};

use super::budget::Budget;
use super::poly::{Components, Poly};
use super::{bevel, embedded, extrude, subdivide};

const TRANSLATE: Vector3 = Vector3 {
    whole: &["t", "translate"],
    parts: [&["tx", "translateX"], &["ty", "translateY"], &["tz", "translateZ"]],
};

/// Operators that change only normals, texture coordinates, colours, or nothing that the simulation sees.
const PASSED_OVER: [&str; 34] = [
    "polyMapCut",
    "polyTweakUV",
    "polyPlanarProj",
    "polyPlanProj",
    "polyCylProj",
    "polySphProj",
    "polyAutoProj",
    "polyMapSew",
    "polyMapSewMove",
    "polyMapDel",
    "polyNormalizeUV",
    "polyFlipUV",
    "polyLayoutUV",
    "polyCopyUV",
    "polyMoveUV",
    "polyMoveFacetUV",
    "polyForceUV",
    "polySoftEdge",
    "polyNormalPerVertex",
    "polyColorPerVertex",
    "polyColorMod",
    "polyColorDel",
    "createColorSet",
    "deleteColorSet",
    "createUVSet",
    "deleteUVSet",
    "copyColorSet",
    "groupParts",
    "polyCrease",
    "polyPinUV",
    "polyOptUvs",
    "polyUVRectangle",
    "polyContourProj",
    "polyHoleFace",
];

/// The result of an operator.
pub(crate) enum Operation {
    /// Done.
    Done(Poly),
    /// The type of the node is not carried out; its input is passed on.
    Unknown(Poly),
}

/// Whether an operator moves no point.
pub(crate) fn is_passed_over(kind: &str) -> bool {
    PASSED_OVER.contains(&kind)
}

/// Applies the operator of a history node to its input.
///
/// # Errors
/// When it makes more points than are left.
pub(crate) fn apply(
    scene: &MayaScene,
    id: NodeId,
    mut mesh: Poly,
    budget: &mut Budget,
) -> Result<Operation, String> {
    let kind = scene.kind(id);
    let picked = || {
        scene.value(id, &["ics", "inputComponents"]).map(|values| Components::of(&values)).unwrap_or_default()
    };
    let divisions = || scene.count_or(id, &["dv", "divisions"], 1).min(6);
    match kind {
        _ if PASSED_OVER.contains(&kind) => {}
        "polyTweak" => tweak(scene, id, &mut mesh),
        "transformGeometry" => transform(scene, id, &mut mesh),
        "polyMoveVertex" => move_points(scene, id, &mut mesh, &picked()),
        "polyNormal" => mesh = reversed(&mesh, &picked()),
        "polyTriangulate" => mesh = triangulated(&mesh, &picked()),
        "polySmoothFace" if !subdivide::is_whole(&mesh, &picked()) => return Ok(Operation::Unknown(mesh)),
        "polySmoothFace" => {
            for _ in 0..divisions() {
                mesh = subdivide::smooth(&mesh, budget)?;
            }
        }
        "polySubdFace" => {
            let mut picked = picked().flags("f", mesh.face_count());
            for _ in 0..divisions() {
                (mesh, picked) = subdivide::split(&mesh, &picked, budget)?;
            }
        }
        "polyExtrudeFace" => match extrude::extrude(scene, id, &mesh, &picked(), budget)? {
            Some(extruded) => mesh = extruded,
            None => return Ok(Operation::Unknown(mesh)),
        },
        "polyBevel" | "polyBevel2" | "polyBevel3" => {
            match bevel::bevel(scene, id, &mesh, &picked(), budget)? {
                Some(beveled) => mesh = beveled,
                None => return Ok(Operation::Unknown(mesh)),
            }
        }
        "polySplitVert" => {
            // At most a point for each corner of a face.
            let split = split_points(&mesh, &picked());
            budget.take((split.points.len() - mesh.points.len()) as u64)?;
            mesh = split;
        }
        "polyMergeVert" => {
            let distance = scene.stored_or(id, &["d", "distance"], 1e-4) * scene.units_of(id).centimetres;
            mesh = merged(&mesh, &picked(), distance);
        }
        "deleteComponent" => match without_deleted(scene, id, &mesh) {
            Some(left) => mesh = left,
            None => return Ok(Operation::Unknown(mesh)),
        },
        "polyCloseBorder" => mesh = closed(&mesh),
        _ => return Ok(Operation::Unknown(mesh)),
    }
    Ok(Operation::Done(mesh))
}

/// Adds the offsets of single points.
fn tweak(scene: &MayaScene, id: NodeId, mesh: &mut Poly) {
    let parts: [&[&str]; 3] = [&["tx", "tweakX"], &["ty", "tweakY"], &["tz", "tweakZ"]];
    let offsets = scene.array(id, &["tk", "tweak"], 3, &parts).unwrap_or_default();
    embedded::add(&mut mesh.points, &offsets, scene.units_of(id).centimetres);
}

/// Moves all points by a matrix.
fn transform(scene: &MayaScene, id: NodeId, mesh: &mut Poly) {
    if let Some(matrix) = scene.matrix(id, &["txf", "transform"], None) {
        let matrix = Matrix::of_rows(matrix);
        mesh.points.iter_mut().for_each(|point| *point = matrix.point(*point));
    }
}

/// Moves the picked points alike.
fn move_points(scene: &MayaScene, id: NodeId, mesh: &mut Poly, picked: &Components) {
    let unit = scene.units_of(id).centimetres;
    let by = scene.stored_vector(id, TRANSLATE, [0.0; 3]).map(|x| x * unit);
    let flags = picked.flags("vtx", mesh.points.len());
    for (point, _) in mesh.points.iter_mut().zip(flags).filter(|(_, picked)| *picked) {
        (0..3).for_each(|k| point[k] += by[k]);
    }
}

/// The mesh without the faces that are deleted; `None` if anything else is.
fn without_deleted(scene: &MayaScene, id: NodeId, mesh: &Poly) -> Option<Poly> {
    let values = scene.value(id, &["dc", "deleteComponents"]);
    let list = values.map(|values| Components::of(&values)).unwrap_or_default();
    (!list.has_other_than("f")).then(|| without_faces(mesh, &list.flags("f", mesh.face_count())))
}

fn reversed(mesh: &Poly, picked: &Components) -> Poly {
    let flags = picked.flags("f", mesh.face_count());
    let all = picked.is_empty();
    let mut turned = Poly { stored_edges: mesh.stored_edges.clone(), ..Poly::reshaped(mesh.points.clone()) };
    for (face, picked) in mesh.faces().zip(flags) {
        let mut face = face.to_vec();
        if picked || all {
            face.reverse();
        }
        turned.face(&face);
    }
    turned
}

/// A fan of triangles for each picked face, from its first corner.
fn triangulated(mesh: &Poly, picked: &Components) -> Poly {
    let flags = picked.flags("f", mesh.face_count());
    let all = picked.is_empty();
    let mut made = Poly::reshaped(mesh.points.clone());
    for (face, picked) in mesh.faces().zip(flags) {
        if !(picked || all) || face.len() < 4 {
            made.face(face);
            continue;
        }
        (1..face.len() - 1).for_each(|k| made.face(&[face[0], face[k], face[k + 1]]));
    }
    made
}

/// Each face gets its own copy of the picked points; the first face keeps the point.
fn split_points(mesh: &Poly, picked: &Components) -> Poly {
    let flags = picked.flags("vtx", mesh.points.len());
    let mut seen = vec![false; mesh.points.len()];
    let mut made = Poly::reshaped(mesh.points.clone());
    for face in mesh.faces() {
        let mut own = Vec::with_capacity(face.len());
        for &point in face {
            let index = point as usize;
            if !flags[index] || !seen[index] {
                seen[index] = true;
                own.push(point);
            } else {
                own.push(made.points.len() as u32);
                made.points.push(mesh.points[index]);
            }
        }
        made.face(&own);
    }
    made
}

/// Merges picked points that are no farther apart than a distance; the lowest number stays.
pub(super) fn merged(mesh: &Poly, picked: &Components, distance: f64) -> Poly {
    let flags = picked.flags("vtx", mesh.points.len());
    let all = picked.is_empty();
    let cell = distance.max(1e-9);
    let key = |p: [f64; 3]| p.map(|x| (x / cell).floor() as i64);
    let mut grid: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut target: Vec<u32> = (0..mesh.points.len() as u32).collect();
    for (index, point) in mesh.points.iter().enumerate() {
        if !(all || flags[index]) {
            continue;
        }
        let at = key(*point);
        let mut found: Option<u32> = None;
        for k in 0..27 {
            let beside = |axis: usize, step: i64| at[axis].saturating_add(step - 1);
            let near = [beside(0, k % 3), beside(1, k / 3 % 3), beside(2, k / 9)];
            for other in grid.get(&near).into_iter().flatten() {
                let q = mesh.points[*other as usize];
                let squared: f64 = (0..3).map(|k| (q[k] - point[k]) * (q[k] - point[k])).sum();
                if squared <= distance * distance {
                    found = Some(found.map_or(*other, |old| old.min(*other)));
                }
            }
        }
        match found {
            Some(other) => target[index] = other,
            None => grid.entry(at).or_default().push(index as u32),
        }
    }
    let mut made = Poly::reshaped(mesh.points.clone());
    for face in mesh.faces() {
        let mut own: Vec<u32> = face.iter().map(|point| target[*point as usize]).collect();
        own.dedup();
        while own.len() > 1 && own.first() == own.last() {
            own.pop();
        }
        if own.len() >= 3 {
            made.face(&own);
        }
    }
    made.without_unused_points();
    made
}

fn without_faces(mesh: &Poly, dropped: &[bool]) -> Poly {
    let mut made = Poly::reshaped(mesh.points.clone());
    for (face, dropped) in mesh.faces().zip(dropped) {
        if !dropped {
            made.face(face);
        }
    }
    made.without_unused_points();
    made
}

/// A face for each closed border.
fn closed(mesh: &Poly) -> Poly {
    let mut made = mesh.clone();
    made.uv_corners.clear();
    for border in borders(mesh) {
        made.face(&border);
    }
    made
}

/// The closed borders of a mesh, each in the direction in which a face would fill it. None has a point twice: where two
/// borders touch, they are two.
fn borders(mesh: &Poly) -> Vec<Vec<u32>> {
    let sides = || mesh.faces().flat_map(super::poly::sides);
    let (all_sides, mut seen) = (sides().collect::<HashSet<_>>(), HashSet::new());
    // The ends of the border edges that leave each point, in the order of the faces.
    let mut next: BTreeMap<u32, VecDeque<u32>> = BTreeMap::new();
    for (a, b) in sides().filter(|(a, b)| !all_sides.contains(&(*b, *a))) {
        if seen.insert((a, b)) {
            next.entry(b).or_default().push_back(a);
        }
    }
    let mut all = Vec::new();
    let mut places: HashMap<u32, usize> = HashMap::new();
    for start in next.keys().copied().collect::<Vec<_>>() {
        let (mut path, mut at) = (Vec::new(), Some(start));
        while let Some(point) = at {
            if let Some(first) = places.get(&point) {
                // The path is back at a point: the points between are a border.
                let border = path.split_off(*first);
                for point in &border {
                    places.remove(point);
                }
                if border.len() >= 3 {
                    all.push(border);
                }
            }
            places.insert(point, path.len());
            path.push(point);
            at = next.get_mut(&point).and_then(VecDeque::pop_front);
        }
        places.clear();
    }
    all
}

/// Meshes joined to one, each in its own placement.
pub(crate) fn united(parts: &[(Poly, Matrix)]) -> Poly {
    let mut made = Poly::default();
    for (part, matrix) in parts {
        let first = made.points.len() as u32;
        made.points.extend(part.points.iter().map(|point| matrix.point(*point)));
        for face in part.faces() {
            let own: Vec<u32> = face.iter().map(|point| point + first).collect();
            made.face(&own);
        }
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_quads() -> Poly {
        let points = vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [2.0, 1.0, 0.0],
        ];
        let mut mesh = Poly::reshaped(points);
        mesh.face(&[0, 1, 4, 3]);
        mesh.face(&[1, 2, 5, 4]);
        mesh
    }

    fn all(kind: &str) -> Components {
        Components::of(&crate::ascii::Values::new(None, &format!("1 \"{kind}[*]\"")))
    }

    #[test]
    fn split_points_are_merged_again() {
        let mesh = two_quads();
        let split = split_points(&mesh, &all("vtx"));
        assert_eq!(split.points.len(), 8);
        assert_eq!(split.points_of(0), [0, 1, 4, 3], "the first face keeps its points");
        let again = merged(&split, &all("vtx"), 1e-4);
        assert_eq!((again.points.len(), again.face_count()), (6, 2));
    }

    #[test]
    fn points_beyond_all_cells_of_the_grid_are_merged() {
        let mut mesh = Poly::reshaped([0.0, -1e300, -1e300, 1e300].map(|x| [x, 0.0, 0.0]).to_vec());
        mesh.face(&[0, 1, 3]);
        mesh.face(&[0, 3, 2]);
        assert_eq!(merged(&mesh, &all("vtx"), 1e-4).points.len(), 3);
    }

    #[test]
    fn a_deleted_face_takes_its_own_points_along() {
        let left = without_faces(&two_quads(), &[true, false]);
        assert_eq!((left.points.len(), left.points_of(0)), (4, &[0, 1, 3, 2][..]));
    }

    /// Quads of a checkerboard with three rows of three; those of one colour touch at four points only.
    fn checkerboard() -> Poly {
        let points = (0..16u8).map(|k| [f64::from(k % 4), f64::from(k / 4), 0.0]).collect();
        let mut mesh = Poly::reshaped(points);
        for first in [0, 2, 5, 8, 10] {
            mesh.face(&[first, first + 1, first + 5, first + 4]);
        }
        mesh
    }

    #[test]
    fn borders_that_touch_at_a_point_are_closed_apart_and_in_the_same_order_in_every_run() {
        let first = borders(&checkerboard());
        assert!(first.iter().all(|border| border.iter().collect::<HashSet<_>>().len() == border.len()));
        // Every side of the five quads is in one border, against the direction of its face.
        let sides = |border: &Vec<u32>| super::super::poly::sides(border).collect::<Vec<_>>();
        let mut found: Vec<(u32, u32)> = first.iter().flat_map(sides).map(|(a, b)| (b, a)).collect();
        let mut expected: Vec<(u32, u32)> =
            checkerboard().faces().flat_map(super::super::poly::sides).collect();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
        // Each run has another seed of its hash maps.
        assert!((0..50).all(|_| borders(&checkerboard()) == first));
        // Two triangles at one point.
        let mut bow_tie = Poly::reshaped(vec![[0.0; 3]; 5]);
        bow_tie.face(&[0, 1, 2]);
        bow_tie.face(&[2, 3, 4]);
        assert_eq!(borders(&bow_tie), [[0, 2, 1], [2, 4, 3]]);
    }

    #[test]
    fn a_border_is_closed_against_the_direction_of_its_faces() {
        let mesh = closed(&two_quads());
        assert_eq!(mesh.face_count(), 3);
        assert_eq!(mesh.points_of(2).len(), 6);
        let [a, b] = [mesh.normal(0)[2], mesh.normal(2)[2]];
        assert!(a > 0.0 && b < 0.0);
    }
}
