//! Primitives by their creation nodes. Missing attributes have Maya's defaults.
//!
//! Plane, sphere, cube and cylinder have Maya's order of points. The order of the others is not documented; theirs runs
//! round the axis, then along it.

use std::f64::consts::TAU;

use nucleus_graph::animation::sin_cos_degrees;
use nucleus_graph::mesh::{Primitive, rotation_to_axis};

use crate::scene::{MayaScene, NodeId, Vector3};

use super::budget::Budget;
use super::poly::Poly;

const AXIS: Vector3 =
    Vector3 { whole: &["ax", "axis"], parts: [&["axx", "axisX"], &["axy", "axisY"], &["axz", "axisZ"]] };

/// A number of a creation node at some frame, by its names, or a default.
pub(crate) type Number<'a> = dyn Fn(&[&str], f64) -> f64 + 'a;

/// The Nucleus primitive that a creation node makes, if it is one.
pub(crate) fn own_primitive(scene: &MayaScene, id: NodeId, number: &Number) -> Option<Primitive> {
    let length = |names: &[&str], default| number(names, default) * scene.units_of(id).centimetres;
    let count = |names: &[&str], default| scene.count_or(id, names, default);
    let [width, height] = [&["w", "width"], &["h", "height"]];
    // Older versions have longer short names of subdivisions.
    let (across, up) = (
        &["sw", "subdivisionsWidth", "sx", "subdivisionsX"],
        &["sh", "subdivisionsHeight", "sy", "subdivisionsY"],
    );
    let (round, deep, caps) = (
        &["sa", "subdivisionsAxis", "sx"],
        &["sd", "subdivisionsDepth", "sz", "subdivisionsZ"],
        &["sc", "subdivisionsCaps", "sz"],
    );
    Some(match scene.kind(id) {
        "polyPlane" => {
            Primitive::Plane([length(width, 1.0), length(height, 1.0)], [count(across, 10), count(up, 10)])
        }
        "polyCube" => Primitive::Cube(
            [length(width, 1.0), length(height, 1.0), length(&["d", "depth"], 1.0)],
            [count(across, 1), count(up, 1), count(deep, 1)],
        ),
        "polySphere" => Primitive::Sphere(length(&["r", "radius"], 1.0), [count(round, 20), count(up, 20)]),
        "polyCylinder" => Primitive::Cylinder(
            [length(&["r", "radius"], 1.0), length(height, 2.0)],
            [count(round, 20), count(up, 1), count(caps, 0)],
        ),
        _ => return None,
    })
}

/// Whether a creation node makes a mesh of other points where this number of it changes: not a count.
pub(crate) fn is_length(name: &str) -> bool {
    const LENGTHS: [&str; 12] =
        ["w", "width", "h", "height", "d", "depth", "r", "radius", "sr", "sectionRadius", "t", "thickness"];
    LENGTHS.contains(&name)
}

/// Whether the primitive stands along y, as Nucleus primitives do.
pub(crate) fn is_upright(scene: &MayaScene, id: NodeId) -> bool {
    let [x, y, z] = scene.stored_vector(id, AXIS, [0.0, 1.0, 0.0]);
    x.abs() < 1e-9 && z.abs() < 1e-9 && y > 0.0
}

/// The mesh that a creation node makes; `None` if it is no creation node. Its counts and its axis are as stored.
///
/// # Errors
/// When its parameters make no mesh, or one of more points than are left.
pub(crate) fn primitive(
    scene: &MayaScene,
    id: NodeId,
    number: &Number,
    budget: &mut Budget,
) -> Option<Result<Poly, String>> {
    let mut made = match own_primitive(scene, id, number) {
        Some(own) => of_own(&own, budget),
        None => other(scene, id, number, budget)?,
    };
    if let (Ok(mesh), false) = (&mut made, is_upright(scene, id)) {
        turn(mesh, scene.stored_vector(id, AXIS, [0.0, 1.0, 0.0]));
    }
    Some(made)
}

fn of_own(own: &Primitive, budget: &mut Budget) -> Result<Poly, String> {
    budget.take(own.size().points)?;
    let surface = own.surface().map_err(|error| error.to_string())?;
    let mut mesh = Poly::reshaped(surface.positions.iter().map(|p| [p.x, p.y, p.z]).collect());
    surface.faces.iter().for_each(|face| mesh.face(face));
    if let Primitive::Plane(_, [x, y]) = *own {
        mesh.uvs = nucleus_graph::mesh::poly_plane_uvs((x, y));
        mesh.uv_corners = mesh.corners.clone();
    }
    Ok(mesh)
}

fn other(
    scene: &MayaScene,
    id: NodeId,
    number: &Number,
    budget: &mut Budget,
) -> Option<Result<Poly, String>> {
    let length = |names: &[&str], default| number(names, default) * scene.units_of(id).centimetres;
    let count = |names: &[&str], default| scene.count_or(id, names, default);
    let radius = |default| length(&["r", "radius"], default);
    let height = length(&["h", "height"], 2.0);
    let (sa, sh) = (count(&["sa", "subdivisionsAxis"], 20).max(3), |default| {
        count(&["sh", "subdivisionsHeight"], default).max(1)
    });
    let mut take = |rings: f64, round: u32| budget.take((rings * f64::from(round)) as u64);
    let made = match scene.kind(id) {
        "polyCone" => {
            let levels = sh(1);
            take(f64::from(levels), sa).map(|()| cone(radius(1.0), height, sa, levels))
        }
        "polyTorus" => {
            let (section, rings) = (length(&["sr", "sectionRadius"], 0.5), sh(20).max(3));
            take(f64::from(rings), sa).map(|()| torus(radius(1.0), section, sa, rings))
        }
        "polyPipe" => {
            let (outer, thickness) = (radius(1.0), length(&["t", "thickness"], 0.5));
            let (inner, levels) = ((outer - thickness).max(outer * 1e-3), sh(1));
            take(2.0 * f64::from(levels) + 2.0, sa).map(|()| pipe(outer, inner, height, sa, levels))
        }
        "polyHelix" => {
            let coils = scene.stored_or(id, &["c", "coils"], 3.0).clamp(0.01, 1e4);
            let per_coil = count(&["sco", "subdivisionsCoil"], 50).max(1);
            let round = count(&["sa", "subdivisionsAxis"], 8).max(3);
            let rings = (coils * f64::from(per_coil)).round().max(1.0);
            let size = [length(&["w", "width"], 2.0), height, radius(0.4)];
            take(rings + 1.0, round).map(|()| helix(size, coils, [round, rings as u32]))
        }
        "polyPlatonicSolid" | "polyPlatonic" => {
            Ok(platonic(radius(1.0), count(&["st", "solidType", "prm", "primitive"], 0)))
        }
        "polyPrism" | "polyPyramid" => return Some(Err(format!("{} is not built", scene.kind(id)))),
        _ => return None,
    };
    Some(made)
}

/// A ring of points about y, from +x towards -z, as in Maya.
fn ring(radius: f64, y: f64, count: u32) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |k| {
        let (sin, cos) = sin_cos_degrees(360.0 * f64::from(k) / f64::from(count));
        [radius * cos, y, -radius * sin]
    })
}

/// Quads between ring `a` and ring `b`, which is above or outside of it.
fn band(mesh: &mut Poly, a: u32, b: u32, count: u32) {
    for k in 0..count {
        let next = (k + 1) % count;
        mesh.face(&[a + k, a + next, b + next, b + k]);
    }
}

fn cone(radius: f64, height: f64, sa: u32, sh: u32) -> Poly {
    let mut mesh = Poly::default();
    for level in 0..sh {
        let share = f64::from(level) / f64::from(sh);
        mesh.points.extend(ring(radius * (1.0 - share), height * (share - 0.5), sa));
    }
    mesh.points.push([0.0, 0.5 * height, 0.0]);
    mesh.face(&(0..sa).rev().collect::<Vec<_>>());
    (0..sh - 1).for_each(|level| band(&mut mesh, level * sa, (level + 1) * sa, sa));
    let (last, apex) = ((sh - 1) * sa, sh * sa);
    (0..sa).for_each(|k| mesh.face(&[last + k, last + (k + 1) % sa, apex]));
    mesh
}

fn torus(radius: f64, section: f64, sa: u32, sh: u32) -> Poly {
    let mut mesh = Poly::default();
    for level in 0..sh {
        let (sin, cos) = sin_cos_degrees(360.0 * f64::from(level) / f64::from(sh));
        mesh.points.extend(ring(radius + section * cos, section * sin, sa));
    }
    (0..sh).for_each(|level| band(&mut mesh, level * sa, (level + 1) % sh * sa, sa));
    mesh
}

fn pipe(outer: f64, inner: f64, height: f64, sa: u32, sh: u32) -> Poly {
    let mut mesh = Poly::default();
    let level = |k: u32| height * (f64::from(k) / f64::from(sh) - 0.5);
    (0..=sh).for_each(|k| mesh.points.extend(ring(outer, level(k), sa)));
    (0..=sh).rev().for_each(|k| mesh.points.extend(ring(inner, level(k), sa)));
    let rings = 2 * (sh + 1);
    (0..rings).for_each(|k| band(&mut mesh, k * sa, (k + 1) % rings * sa, sa));
    mesh
}

fn helix([width, height, radius]: [f64; 3], coils: f64, [round, rings]: [u32; 2]) -> Poly {
    let mut mesh = Poly::default();
    let (path, rise) = ((0.5 * width - radius).max(radius * 1e-3), (height - 2.0 * radius).max(0.0));
    let slope = rise / (TAU * coils * path);
    let tilt = (1.0 + slope * slope).sqrt();
    for k in 0..=rings {
        let share = f64::from(k) / f64::from(rings);
        let (sin, cos) = sin_cos_degrees(360.0 * coils * share);
        let (out, along) = ([cos, 0.0, -sin], [-sin / tilt, slope / tilt, -cos / tilt]);
        let up = cross(along, out);
        let centre = [path * cos, rise * (share - 0.5), -path * sin];
        for j in 0..round {
            let (s, c) = sin_cos_degrees(360.0 * f64::from(j) / f64::from(round));
            mesh.points.push([0, 1, 2].map(|a| centre[a] + radius * (c * out[a] + s * up[a])));
        }
    }
    mesh.face(&(0..round).rev().collect::<Vec<_>>());
    (0..rings).for_each(|k| band(&mut mesh, k * round, (k + 1) * round, round));
    mesh.face(&(rings * round..(rings + 1) * round).collect::<Vec<_>>());
    mesh
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// 0 dodecahedron, 1 icosahedron, 2 octahedron, 3 tetrahedron.
fn platonic(radius: f64, kind: u32) -> Poly {
    let g = 0.5 * (1.0 + 5f64.sqrt());
    let mut mesh = Poly::default();
    match kind {
        3 => {
            mesh.points = vec![[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
            [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].iter().for_each(|face| mesh.face(face));
        }
        2 => {
            mesh.points = vec![
                [0.0, 1.0, 0.0],
                [1.0, 0.0, 0.0],
                [0.0, 0.0, 1.0],
                [-1.0, 0.0, 0.0],
                [0.0, 0.0, -1.0],
                [0.0, -1.0, 0.0],
            ];
            for (a, b) in [(1, 4), (2, 1), (3, 2), (4, 3)] {
                mesh.face(&[0, b, a]);
                mesh.face(&[5, a, b]);
            }
        }
        kind => {
            let icosahedron = icosahedron(g);
            mesh = if kind == 1 { icosahedron } else { dual(&icosahedron) };
        }
    }
    for point in &mut mesh.points {
        let length = point.iter().map(|x| x * x).sum::<f64>().sqrt();
        *point = point.map(|x| x * radius / length);
    }
    outward(&mut mesh);
    mesh
}

/// Turns faces that look inwards, of a convex mesh about the origin.
fn outward(mesh: &mut Poly) {
    for face in 0..mesh.face_count() {
        let (normal, first) = (mesh.normal(face), mesh.points[mesh.points_of(face)[0] as usize]);
        if normal.iter().zip(first).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
            let start = if face == 0 { 0 } else { mesh.ends[face - 1] as usize };
            let end = mesh.ends[face] as usize;
            mesh.corners[start..end].reverse();
        }
    }
}

/// The twelve corners of three golden rectangles; faces join corners at the shortest distance.
fn icosahedron(g: f64) -> Poly {
    let mut mesh = Poly::default();
    for (a, b) in [(1.0, g), (-1.0, g), (1.0, -g), (-1.0, -g)] {
        mesh.points.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
    }
    let near = |mesh: &Poly, a: u32, b: u32| {
        let [a, b] = [a, b].map(|k| mesh.points[k as usize]);
        (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>() < 4.1
    };
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(&mesh, a, b) && near(&mesh, b, c) && near(&mesh, a, c) {
                    mesh.face(&[a, b, c]);
                }
            }
        }
    }
    mesh
}

/// A point for each face, a face round each point: the icosahedron becomes a dodecahedron.
fn dual(mesh: &Poly) -> Poly {
    let centre = |face: &[u32]| {
        [0, 1, 2].map(|k| face.iter().map(|p| mesh.points[*p as usize][k]).sum::<f64>() / face.len() as f64)
    };
    let mut dual = Poly::reshaped(mesh.faces().map(centre).collect());
    for point in 0..mesh.points.len() as u32 {
        let mut round: Vec<u32> = (0..mesh.face_count())
            .filter(|face| mesh.points_of(*face).contains(&point))
            .map(|f| f as u32)
            .collect();
        // Neighbouring faces share two points.
        for k in 1..round.len() {
            let last = mesh.points_of(round[k - 1] as usize).to_vec();
            let shares =
                |face: &u32| mesh.points_of(*face as usize).iter().filter(|p| last.contains(p)).count() == 2;
            if let Some(next) = round[k..].iter().position(shares) {
                round.swap(k, k + next);
            }
        }
        dual.face(&round);
    }
    dual
}

/// Turns a mesh by the smallest rotation that takes y to an axis.
fn turn(mesh: &mut Poly, axis: [f64; 3]) {
    let Some(rotation) = rotation_to_axis(axis) else { return };
    for point in &mut mesh.points {
        *point = (rotation * nalgebra::Vector3::from(*point)).into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume by the divergence theorem: positive if all faces look outwards.
    fn volume(mesh: &Poly) -> f64 {
        let mut sum = 0.0;
        for face in mesh.faces() {
            for k in 1..face.len() - 1 {
                let [a, b, c] = [face[0], face[k], face[k + 1]].map(|p| mesh.points[p as usize]);
                sum += a.iter().zip(cross(b, c)).map(|(x, y)| x * y).sum::<f64>() / 6.0;
            }
        }
        sum
    }

    fn is_closed(mesh: &Poly) -> bool {
        let mut sides: Vec<(u32, u32)> =
            mesh.faces().flat_map(|face| super::super::poly::sides(face).collect::<Vec<_>>()).collect();
        let mut back: Vec<(u32, u32)> = sides.iter().map(|(a, b)| (*b, *a)).collect();
        sides.sort_unstable();
        back.sort_unstable();
        sides == back && sides.windows(2).all(|pair| pair[0] != pair[1])
    }

    #[test]
    fn primitives_are_closed_and_look_outwards() {
        let near = |mesh: &Poly, expected: f64, share: f64| {
            assert!(is_closed(mesh), "not closed");
            let volume = volume(mesh);
            assert!((volume / expected - 1.0).abs() < share, "{volume} is not {expected}");
        };
        let pi = std::f64::consts::PI;
        near(&cone(1.0, 2.0, 200, 3), pi * 2.0 / 3.0, 0.01);
        near(&torus(2.0, 0.5, 100, 60), 2.0 * pi * pi * 2.0 * 0.25, 0.01);
        near(&pipe(1.0, 0.5, 2.0, 200, 2), 2.0 * pi * 0.75, 0.01);
        // A tube of section πr² along a helix.
        let helix = helix([2.0, 2.0, 0.2], 3.0, [24, 300]);
        let length = ((TAU * 3.0 * 0.8).powi(2) + 1.6f64.powi(2)).sqrt();
        near(&helix, pi * 0.04 * length, 0.03);
    }

    #[test]
    fn platonic_solids_have_their_faces_and_volumes() {
        let side = 1.0;
        let icosahedron = platonic(side / 4.0 * (10.0 + 2.0 * 5f64.sqrt()).sqrt(), 1);
        assert_eq!((icosahedron.points.len(), icosahedron.face_count()), (12, 20));
        assert!((volume(&icosahedron) - 5.0 / 12.0 * (3.0 + 5f64.sqrt())).abs() < 1e-9);
        let dodecahedron = platonic(side / 4.0 * (15f64.sqrt() + 3f64.sqrt()), 0);
        assert_eq!((dodecahedron.points.len(), dodecahedron.face_count()), (20, 12));
        assert!((volume(&dodecahedron) - (15.0 + 7.0 * 5f64.sqrt()) / 4.0).abs() < 1e-9);
        let octahedron = platonic(1.0, 2);
        assert!((volume(&octahedron) - 4.0 / 3.0).abs() < 1e-9 && is_closed(&octahedron));
        let tetrahedron = platonic(1.0, 3);
        assert!((volume(&tetrahedron) - 8.0 / 27.0 * 3f64.sqrt()).abs() < 1e-9 && is_closed(&tetrahedron));
    }
}
