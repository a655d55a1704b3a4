//! Meshes of the workloads: square sheets of triangles or quads, and a sphere.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use nucleus_core::{Faces, Surface};
use nucleus_measure::fixture;

/// Triangulation of a sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cells {
    /// Two triangles per cell, the diagonal alternating from cell to cell so that no direction is preferred.
    Triangles,
    /// One quad per cell.
    Quads,
}

/// A sheet of `n` by `n` points from `origin` along `u` and `v`, in metres. Points come row by row along `u`.
pub fn sheet(n: u32, cells: Cells, origin: Vector3<f64>, u: Vector3<f64>, v: Vector3<f64>) -> Surface {
    let quads = fixture::sheet([n, n], origin, u, v);
    match cells {
        Cells::Quads => quads,
        Cells::Triangles => Surface { faces: triangles([n, n]), ..quads },
    }
}

/// The triangles of a sheet of `columns` by `rows` points, row by row.
pub fn triangles([columns, rows]: [u32; 2]) -> Faces {
    let quads = (columns as usize - 1) * (rows as usize - 1);
    let mut faces = Faces::with_capacity(2 * quads, 6 * quads);
    for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
        let a = row * columns + column;
        let (b, c, d) = (a + 1, a + columns, a + columns + 1);
        let halves = match (row + column).is_multiple_of(2) {
            true => [[a, c, b], [b, c, d]],
            false => [[a, c, d], [a, d, b]],
        };
        halves.iter().for_each(|face| faces.push(face));
    }
    faces
}

/// A triangulated sphere of 64 meridians and 32 parallels, with vertices on the sphere.
pub fn sphere(radius: f64, centre: Vector3<f64>) -> Surface {
    const ROUND: u32 = 64;
    const DOWN: u32 = 32;
    let mut positions = vec![centre + Vector3::y() * radius];
    for (j, i) in (1..DOWN).flat_map(|j| (0..ROUND).map(move |i| (j, i))) {
        let (polar, turn) = (PI * f64::from(j) / f64::from(DOWN), TAU * f64::from(i) / f64::from(ROUND));
        let across = Vector3::new(turn.cos(), 0.0, turn.sin()) * polar.sin();
        positions.push(centre + (across + Vector3::y() * polar.cos()) * radius);
    }
    positions.push(centre - Vector3::y() * radius);
    let last = positions.len() as u32 - 1;
    let mut faces = Faces::default();
    for i in 0..ROUND {
        let next = (i + 1) % ROUND;
        faces.push(&[0, 1 + next, 1 + i]);
        for a in (0..DOWN - 2).map(|j| 1 + j * ROUND) {
            faces.push(&[a + i, a + next, a + next + ROUND]);
            faces.push(&[a + i, a + next + ROUND, a + i + ROUND]);
        }
        faces.push(&[last, last - ROUND + i, last - ROUND + next]);
    }
    Surface { positions, faces }
}

#[cfg(test)]
mod tests {
    use nucleus_measure::metrics::deformation::Edges;

    use super::*;

    #[test]
    fn a_sheet_of_triangles_has_one_diagonal_in_every_cell() {
        let n = 5;
        let sheet = sheet(n, Cells::Triangles, Vector3::zeros(), Vector3::x(), Vector3::z());
        let edges: Vec<_> = Edges::of(&sheet).iter().collect();
        assert_eq!(edges.len() as u32, 2 * n * (n - 1) + (n - 1) * (n - 1));
        let side = 1.0 / f64::from(n - 1);
        let diagonals = edges.iter().filter(|(_, length)| *length > 1.2 * side).count() as u32;
        assert_eq!(diagonals, (n - 1) * (n - 1));
    }

    #[test]
    fn a_sphere_is_closed_and_faces_outwards() {
        let ball = sphere(0.35, Vector3::zeros());
        // Euler characteristic of a sphere: points - edges + faces = 2.
        assert_eq!(ball.positions.len() + ball.faces.len() - Edges::of(&ball).iter().count(), 2);
        for corners in ball.faces.iter() {
            let [a, b, c] = [0, 1, 2].map(|k| ball.positions[corners[k] as usize]);
            assert!((b - a).cross(&(c - a)).dot(&(a + b + c)) > 0.0);
        }
    }
}
