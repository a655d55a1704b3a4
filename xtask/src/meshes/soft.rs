//! Meshes of soft bodies: a balloon with an open neck, and the round bed of a trampoline.

use super::mesh::{Mesh, ring};

/// Points round a balloon and a trampoline.
const AROUND: usize = 32;

/// A sphere of 12 with a neck of radius 3 that is open below; its faces face outwards.
pub fn balloon() -> Mesh {
    let neck = [(3.0, -20.0), (3.0, -17.0), (3.2, -14.0), (4.5, -11.4)];
    let sphere = (1..10).map(|k| {
        let turn = std::f64::consts::PI * (0.2 + 0.08 * f64::from(k));
        (12.0 * turn.sin(), -12.0 * turn.cos())
    });
    let outline: Vec<_> = neck.into_iter().chain(sphere).collect();
    let rows = outline.iter().map(|&(radius, height)| ring(AROUND, radius, height)).collect();
    let mut mesh = Mesh::rows(rows, true);
    let last = mesh.points.len() - AROUND;
    mesh.points.push([0.0, 12.0, 0.0]);
    let top = mesh.points.len() - 1;
    mesh.faces.extend((0..AROUND).map(|k| vec![last + k, top, last + (k + 1) % AROUND]));
    mesh
}

/// A flat disc of radius 60 that faces up: its rim first, then ring by ring to the centre.
pub fn trampoline() -> Mesh {
    const RIM: usize = 48;
    let rows = (0..14).map(|k| ring(RIM, 60.0 * (1.0 - f64::from(k) / 14.0), 0.0)).collect();
    let mut mesh = Mesh::rows(rows, true);
    mesh.faces.iter_mut().for_each(|face| face.reverse());
    let last = mesh.points.len() - RIM;
    mesh.points.push([0.0; 3]);
    let centre = mesh.points.len() - 1;
    mesh.faces.extend((0..RIM).map(|k| vec![last + k, last + (k + 1) % RIM, centre]));
    mesh
}
