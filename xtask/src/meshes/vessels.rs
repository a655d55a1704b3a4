//! Meshes that liquids run in and over: a glass and a leaf.

use super::mesh::{Mesh, ring};

/// Points round a glass.
const AROUND: usize = 32;

/// A glass: open above, 8 high, of radius 3 at its foot and 4 at its rim. Its faces face inwards.
pub fn glass() -> Mesh {
    let outline = [(4.0, 8.0), (3.75, 6.0), (3.5, 4.0), (3.25, 2.0), (3.0, 0.0), (1.5, 0.0)];
    let rows = outline.iter().map(|&(radius, height)| ring(AROUND, radius, height)).collect();
    let mut mesh = Mesh::rows(rows, true);
    let last = mesh.points.len() - AROUND;
    mesh.points.push([0.0; 3]);
    let centre = mesh.points.len() - 1;
    mesh.faces.extend((0..AROUND).map(|k| vec![last + k, centre, last + (k + 1) % AROUND]));
    mesh
}

/// A leaf of 24 by 10: hollow across, and bent down along its length.
pub fn leaf() -> Mesh {
    let row = |k: usize| {
        let along = k as f64 / 24.0;
        let half = 5.0 * (4.0 * along * (1.0 - along)).sqrt().max(0.1);
        let place = |j: usize| {
            let across = (j as f64 / 6.0 - 1.0) * half;
            [24.0 * along - 12.0, 6.0 - 7.0 * along * along + 0.04 * across * across, across]
        };
        (0..13).map(place).collect()
    };
    Mesh::rows((0..25).map(row).collect(), false)
}
