//! Subdivision: Catmull and Clark's smooth one (1978), and the plain split into quads.
//!
//! Points keep their numbers; then come the points on edges in the order of the edges, then those in the middles of faces.

use std::collections::HashMap;

use super::budget::Budget;
use super::poly::{Components, Poly, sides};

/// Whether a list names all faces.
pub(super) fn is_whole(mesh: &Poly, picked: &Components) -> bool {
    picked.is_empty() || picked.flags("f", mesh.face_count()).iter().all(|picked| *picked)
}

/// One step of smooth subdivision. Borders become cubic B-splines.
///
/// # Errors
/// When it makes more points than are left.
pub(super) fn smooth(mesh: &Poly, budget: &mut Budget) -> Result<Poly, String> {
    let plain = split(mesh, &vec![true; mesh.face_count()], budget)?.0;
    let (points, mut edges) = (mesh.points.len(), mesh.edges());
    let mut faces_of: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
    for (face, corners) in mesh.faces().enumerate() {
        sides(corners).for_each(|(a, b)| faces_of.entry((a.min(b), a.max(b))).or_default().push(face));
    }
    // Edges of no face are not split.
    edges.retain(|[a, b]| faces_of.contains_key(&(*a.min(b), *a.max(b))));
    let middle = points + edges.len();
    let of_edge = |[a, b]: [u32; 2]| faces_of.get(&(a.min(b), a.max(b))).map_or(&[][..], Vec::as_slice);
    let mut made = plain.clone();
    // An edge point is the mean of its ends and the middles of its two faces.
    for (k, edge) in edges.iter().enumerate() {
        let faces = of_edge(*edge);
        if faces.len() == 2 {
            let around = [
                mesh.points[edge[0] as usize],
                mesh.points[edge[1] as usize],
                plain.points[middle + faces[0]],
                plain.points[middle + faces[1]],
            ];
            made.points[points + k] = mean(&around);
        }
    }
    // A point with n faces is (F + 2 R + (n - 3) P) / n, on a border (R + P) / 2 over border edges.
    let mut sums = vec![Around::default(); points];
    for (k, edge) in edges.iter().enumerate() {
        let is_border = of_edge(*edge).len() != 2;
        for point in edge {
            let around = &mut sums[*point as usize];
            let at = plain.points[points + k];
            let (sum, count) = if is_border { &mut around.border } else { &mut around.edges };
            add(sum, at);
            *count += 1;
        }
    }
    for (face, corners) in mesh.faces().enumerate() {
        for point in corners {
            let around = &mut sums[*point as usize];
            add(&mut around.faces.0, plain.points[middle + face]);
            around.faces.1 += 1;
        }
    }
    for (point, around) in sums.iter().enumerate() {
        let p = mesh.points[point];
        let share = |(sum, count): ([f64; 3], usize), k: usize| sum[k] / count.max(1) as f64;
        let n = around.faces.1 as f64;
        made.points[point] = match (around.border.1, around.edges.1) {
            (2, _) if around.faces.1 > 1 => [0, 1, 2].map(|k| 0.5 * (share(around.border, k) + p[k])),
            (0, edges) if edges >= 3 => [0, 1, 2]
                .map(|k| (share(around.faces, k) + 2.0 * share(around.edges, k) + (n - 3.0) * p[k]) / n),
            _ => p,
        };
    }
    Ok(made)
}

/// Sums and counts round a point: middles of faces, of inner edges, of border edges.
#[derive(Debug, Clone, Copy, Default)]
struct Around {
    faces: ([f64; 3], usize),
    edges: ([f64; 3], usize),
    border: ([f64; 3], usize),
}

fn add(sum: &mut [f64; 3], point: [f64; 3]) {
    (0..3).for_each(|k| sum[k] += point[k]);
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    points.iter().for_each(|point| add(&mut sum, *point));
    sum.map(|x| x / points.len() as f64)
}

/// Splits each picked face into a quad for each of its corners. Neighbours get the new points on their sides. Also
/// returns which of the new faces come from picked ones.
///
/// # Errors
/// When it makes more points than are left.
pub(super) fn split(mesh: &Poly, picked: &[bool], budget: &mut Budget) -> Result<(Poly, Vec<bool>), String> {
    let is_picked = |face: usize| picked.get(face).copied().unwrap_or(false);
    let mut wanted: HashMap<(u32, u32), u32> = HashMap::new();
    for (face, corners) in mesh.faces().enumerate().filter(|(face, _)| is_picked(*face)) {
        let _ = face;
        sides(corners).for_each(|(a, b)| {
            wanted.insert((a.min(b), a.max(b)), 0);
        });
    }
    let split_faces = (0..mesh.face_count()).filter(|face| is_picked(*face)).count();
    budget.take((wanted.len() + split_faces) as u64)?;
    let mut made = Poly::reshaped(mesh.points.clone());
    for [a, b] in mesh.edges() {
        if let Some(number) = wanted.get_mut(&(a.min(b), a.max(b))) {
            *number = made.points.len() as u32;
            made.points.push(mean(&[mesh.points[a as usize], mesh.points[b as usize]]));
        }
    }
    let mut flags = Vec::new();
    let on = |a: u32, b: u32| wanted.get(&(a.min(b), a.max(b))).copied();
    for (face, corners) in mesh.faces().enumerate() {
        if !is_picked(face) {
            let mut own = Vec::with_capacity(corners.len());
            for (a, b) in sides(corners) {
                own.push(a);
                own.extend(on(a, b));
            }
            made.face(&own);
            flags.push(false);
            continue;
        }
        let centre = made.points.len() as u32;
        made.points.push(mean(&corners.iter().map(|point| mesh.points[*point as usize]).collect::<Vec<_>>()));
        for k in 0..corners.len() {
            let [before, at, after] = [
                corners[(k + corners.len() - 1) % corners.len()],
                corners[k],
                corners[(k + 1) % corners.len()],
            ];
            if let (Some(out), Some(back)) = (on(at, after), on(before, at)) {
                made.face(&[at, out, centre, back]);
                flags.push(true);
            }
        }
    }
    Ok((made, flags))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Poly {
        let made = nucleus_graph::mesh::poly_cube(2.0, 2.0, 2.0, (1, 1, 1)).unwrap();
        let mut mesh = Poly::reshaped(made.positions.iter().map(|p| [p.x, p.y, p.z]).collect());
        made.faces.iter().for_each(|face| mesh.face(face));
        mesh
    }

    #[test]
    fn a_smooth_cube_has_catmull_and_clarks_points() {
        let smooth = smooth(&cube(), &mut Budget::default()).unwrap();
        assert_eq!((smooth.points.len(), smooth.face_count()), (26, 24));
        // Corner: F = 1/3, R = 2/3, n = 3 of a cube with corners at 1: (1/3 + 4/3) / 3 = 5/9.
        for x in smooth.points[0] {
            assert!((x.abs() - 5.0 / 9.0).abs() < 1e-12, "{x}");
        }
        // Edge: mean of two corners and two middles.
        let mut edge = smooth.points[8].map(f64::abs);
        edge.sort_by(f64::total_cmp);
        assert!(
            (edge[0]).abs() < 1e-12 && (edge[1] - 0.75).abs() < 1e-12 && (edge[2] - 0.75).abs() < 1e-12,
            "{edge:?}"
        );
    }

    #[test]
    fn a_split_face_gives_its_new_points_to_its_neighbours() {
        let mut picked = vec![false; 6];
        picked[0] = true;
        let (mesh, flags) = split(&cube(), &picked, &mut Budget::default()).unwrap();
        assert_eq!((mesh.points.len(), mesh.face_count()), (13, 9));
        assert_eq!(flags.iter().filter(|flag| **flag).count(), 4);
        let sides_of: usize = mesh.faces().map(<[u32]>::len).sum();
        assert_eq!(sides_of, 4 * 4 + 4 * 5 + 4);
    }
}
