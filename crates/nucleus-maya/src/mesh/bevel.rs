//! Bevels of all edges of a closed mesh, with one segment.

use std::collections::HashMap;

use crate::scene::{MayaScene, NodeId};

use super::budget::Budget;
use super::poly::{Components, Poly, sides};

/// Sine of the smallest angle of a corner that is beveled.
const MIN_SINE: f64 = 1e-3;

/// Bevels a mesh. `None` where the node does more than bevel all edges of a closed mesh with one segment.
///
/// # Errors
/// When it makes more points than are left.
pub(super) fn bevel(
    scene: &MayaScene,
    id: NodeId,
    mesh: &Poly,
    picked: &Components,
    budget: &mut Budget,
) -> Result<Option<Poly>, String> {
    let edges = mesh.edges();
    let all = picked.flags("e", edges.len()).into_iter().all(|picked| picked)
        || picked.flags("f", mesh.face_count()).into_iter().all(|picked| picked);
    if !all || edges.is_empty() || scene.count_or(id, &["sg", "segments"], 1) != 1 {
        return Ok(None);
    }
    let offset = match scene.switch_or(id, &["oaf", "offsetAsFraction"], true) {
        true => scene.stored_or(id, &["f", "fraction"], 0.5).clamp(0.0, 1.0) * half_of_shortest(mesh, &edges),
        false => scene.stored_or(id, &["o", "offset"], 0.2) * scene.units_of(id).centimetres,
    };
    // A point for each corner of a face.
    budget.take(mesh.corners.len() as u64)?;
    Ok(beveled(mesh, offset))
}

fn half_of_shortest(mesh: &Poly, edges: &[[u32; 2]]) -> f64 {
    let length = |[a, b]: &[u32; 2]| norm(between(mesh, *a, *b));
    edges.iter().map(length).fold(f64::INFINITY, f64::min) / 2.0
}

/// Every face shrinks by `offset` centimetres from each of its edges; a quad takes the place of each edge, a polygon
/// that of each point. `None` where an edge has not two faces that run along it in opposite directions.
fn beveled(mesh: &Poly, offset: f64) -> Option<Poly> {
    let mut made = Poly::default();
    // The new point of a face at a point, by the side that starts there.
    let mut starts: HashMap<(u32, u32), u32> = HashMap::new();
    let mut ends: HashMap<(u32, u32), u32> = HashMap::new();
    // The side that starts at each new point.
    let mut leaving: Vec<(u32, u32)> = Vec::new();
    for face in mesh.faces() {
        let first = made.points.len() as u32;
        let count = face.len();
        for k in 0..count {
            let [before, point, after] = [face[(k + count - 1) % count], face[k], face[(k + 1) % count]];
            made.points.push(inset(mesh, [before, point, after], offset)?);
            let twice = starts.insert((point, after), first + k as u32).is_some();
            ends.insert((before, point), first + k as u32);
            leaving.push((point, after));
            if twice {
                return None;
            }
        }
        made.face(&(first..first + count as u32).collect::<Vec<_>>());
    }
    for (a, b) in mesh.faces().flat_map(sides).filter(|(a, b)| a < b) {
        let (near, far) = ((a, b), (b, a));
        made.face(&[ends[&near], starts[&near], *ends.get(&far)?, *starts.get(&far)?]);
    }
    let mut seen = vec![false; mesh.points.len()];
    for (point, after) in mesh.faces().flat_map(sides) {
        if std::mem::replace(&mut seen[point as usize], true) {
            continue;
        }
        // Round the point, from each face to the one beyond the side that ends there.
        let mut ring = Vec::new();
        let mut side = (point, after);
        loop {
            let corner = *starts.get(&side)?;
            if ring.first() == Some(&corner) {
                break;
            }
            ring.push(corner);
            // The face that runs along this side the other way, and its side that leaves the point.
            side = leaving[*ends.get(&(side.1, side.0))? as usize];
        }
        ring.reverse();
        if ring.len() >= 3 {
            made.face(&ring);
        }
    }
    Some(made)
}

/// The corner of a face, moved in from both of its sides.
fn inset(mesh: &Poly, [before, point, after]: [u32; 3], offset: f64) -> Option<[f64; 3]> {
    let [u, v] = [unit(between(mesh, point, before)), unit(between(mesh, point, after))];
    let cosine: f64 = (0..3).map(|k| u[k] * v[k]).sum();
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    (sine > MIN_SINE).then(|| {
        let start = mesh.points[point as usize];
        std::array::from_fn(|k| start[k] + (u[k] + v[k]) * (offset / sine))
    })
}

fn between(mesh: &Poly, from: u32, to: u32) -> [f64; 3] {
    let [a, b] = [from, to].map(|point| mesh.points[point as usize]);
    std::array::from_fn(|k| b[k] - a[k])
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = norm(v);
    if length > 0.0 { v.map(|x| x / length) } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Poly {
        let points = (0..8u8).map(|k| [k & 1, k >> 1 & 1, k >> 2 & 1].map(f64::from)).collect();
        let mut cube = Poly::reshaped(points);
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            cube.face(&face);
        }
        cube
    }

    /// Six times the volume that the faces enclose.
    fn volume(mesh: &Poly) -> f64 {
        let mut sum = 0.0;
        for (face, corners) in mesh.faces().enumerate() {
            let at = mesh.points[corners[0] as usize];
            let normal = mesh.normal(face);
            sum += (0..3).map(|k| at[k] * normal[k]).sum::<f64>();
        }
        sum
    }

    #[test]
    fn a_beveled_cube_is_closed_and_faces_outwards() {
        let mesh = beveled(&cube(), 0.25).expect("a closed mesh");
        assert_eq!((mesh.points.len(), mesh.face_count()), (24, 6 + 12 + 8));
        assert!(mesh.points.iter().flatten().all(|x| [0.0, 0.25, 0.75, 1.0].contains(x)));
        let all: std::collections::HashSet<_> = mesh.faces().flat_map(sides).collect();
        assert!(all.iter().all(|(a, b)| all.contains(&(*b, *a))), "every side has its other");
        // Less twelve prisms along the edges, and of eight corner cubes all but a pyramid of a sixth.
        let expected = 1.0 - 12.0 * (0.25 * 0.25 / 2.0 * 0.5) - 8.0 * 0.25f64.powi(3) * 5.0 / 6.0;
        assert!((volume(&mesh) / volume(&cube()) - expected).abs() < 1e-9);
    }

    #[test]
    fn an_open_mesh_is_not_beveled() {
        let mut open = cube();
        open.ends.pop();
        open.corners.truncate(20);
        assert_eq!(beveled(&open, 0.1), None);
    }
}
