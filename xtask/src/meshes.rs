//! `cargo xtask meshes`: writes the generated meshes of the gallery, deterministically. Centimetres, Y up.
//!
//! | Question                                  | Read         |
//! |-------------------------------------------|--------------|
//! | the meshes                                | [`ALL`]      |
//! | the meshes of stress tests                | [`extremes`] |
//! | the two ribbons of a knot                 | [`knot`]     |
//! | the OBJ writer                            | [`Mesh`]     |

use std::fs;
use std::path::Path;

use anyhow::Context;

mod extremes;
mod knot;
mod mesh;
mod soft;
mod vessels;

use mesh::{Mesh, ring};

/// A file name and its generator.
type Entry = (&'static str, fn() -> Mesh);

/// All meshes.
const ALL: [Entry; 18] = [
    ("beads", beads),
    ("tube", tube),
    ("reef_knot_left", knot::left),
    ("reef_knot_right", knot::right),
    ("funnel", funnel),
    ("plunger", plunger),
    ("needles", needles),
    ("fifty_layers", fifty_layers),
    ("balloon", soft::balloon),
    ("trampoline", soft::trampoline),
    ("slinky", soft::slinky),
    ("slinky_standing", soft::slinky_standing),
    ("aeroplane", soft::aeroplane),
    ("bridge", soft::bridge),
    ("chain_link", soft::chain_link),
    ("disc", soft::disc),
    ("glass", vessels::glass),
    ("leaf", vessels::leaf),
];

/// Writes all of them.
pub fn run(root: &Path) -> anyhow::Result<()> {
    for (name, text) in files() {
        let path = root.join(&name);
        fs::write(&path, text).with_context(|| format!("cannot write `{}`", path.display()))?;
        println!("{name}");
    }
    Ok(())
}

/// The path of each generated file from the root, and its text.
fn files() -> impl Iterator<Item = (String, String)> {
    let gallery = ALL.iter().map(|(name, make)| (format!("scenes/meshes/{name}.obj"), make().obj()));
    let extremes = extremes::ALL.iter().map(|(name, text)| (format!("scenes/extremes/{name}.obj"), text()));
    gallery.chain(extremes)
}

/// An open tube along x, 100 long and 25 in diameter, 40 points around and 61 along.
fn tube() -> Mesh {
    let row = |k: usize| {
        let along = 100.0 * (k as f64 / 60.0 - 0.5);
        ring(40, 12.5, 0.0).into_iter().map(|[x, _, z]| [along, x, z]).collect()
    };
    Mesh::rows((0..61).map(row).collect(), true)
}

/// An open cone with a spout: 80 in diameter at the top, 20 at the bottom.
fn funnel() -> Mesh {
    let outline = [(40.0, 60.0), (28.0, 45.0), (16.0, 30.0), (10.0, 22.5), (10.0, 12.0), (10.0, 0.0)];
    Mesh::rows(outline.iter().map(|&(radius, height)| ring(48, radius, height)).collect(), true)
}

/// A tetrahedron with a vertex at the origin, pointing down.
fn plunger() -> Mesh {
    let mut mesh = Mesh { points: ring(3, 4.5, 14.0), faces: Vec::new() };
    mesh.points.push([0.0, 0.0, 0.0]);
    mesh.faces = vec![vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3], vec![2, 0, 3]];
    mesh
}

/// Ten by ten needles, 6 apart and 12 high: pyramids on a triangle.
fn needles() -> Mesh {
    let mut mesh = Mesh::default();
    for (row, column) in (0..10).flat_map(|row| (0..10).map(move |column| (row, column))) {
        let [x, z] = [column, row].map(|k| 6.0 * (f64::from(k) - 4.5));
        let mut points: Vec<[f64; 3]> =
            ring(3, 0.5, 0.0).into_iter().map(|[dx, y, dz]| [x + dx, y, z + dz]).collect();
        points.push([x, 12.0, z]);
        let faces = vec![vec![0, 1, 2], vec![1, 0, 3], vec![2, 1, 3], vec![0, 2, 3]];
        mesh.add(Mesh { points, faces });
    }
    mesh
}

/// Eight layers of 6 by 6 points, 2.6 apart, alternately offset: beads for pouring.
fn beads() -> Mesh {
    let point = |k: usize| {
        let [column, row, layer] = [k % 6, k / 6 % 6, k / 36];
        let aside = if layer % 2 == 0 { -0.25 } else { 0.25 };
        let turn = k as f64;
        let x = column as f64 - 2.5 + aside + 0.03 * turn.sin();
        let z = row as f64 - 2.5 + aside + 0.03 * (1.7 * turn).cos();
        [2.6 * x, 2.6 * layer as f64, 2.6 * z]
    };
    Mesh { points: (0..288).map(point).collect(), faces: Vec::new() }
}

/// Fifty horizontal squares of 20 with 7 by 7 points, 0.5 apart, each rotated slightly relative to the one below.
fn fifty_layers() -> Mesh {
    let mut mesh = Mesh::default();
    for layer in 0..50 {
        let (sin, cos) = (0.05 * f64::from(layer)).sin_cos();
        let point = |row: usize, column: usize| {
            let [x, z] = [column, row].map(|k| (k as f64 - 3.0) * 10.0 / 3.0);
            [x * cos - z * sin, 0.5 * f64::from(layer), x * sin + z * cos]
        };
        let row = |row: usize| (0..7).map(|column| point(row, column)).collect();
        mesh.add(Mesh::rows((0..7).map(row).collect(), false));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_of_the_gallery_match_their_generators() {
        let root = crate::files::root();
        for (name, text) in files() {
            let there = fs::read_to_string(root.join(&name)).unwrap_or_default();
            assert!(there == text, "{name}: `cargo xtask meshes` rewrites it");
        }
    }
}
