//! `cargo xtask meshes`: writes the generated meshes of the gallery, deterministically. Centimetres, Y up.
//!
//! | Question                                  | Read         |
//! |-------------------------------------------|--------------|
//! | the meshes                                | [`ALL`]      |
//! | the two ribbons of a knot                 | [`knot`]     |
//! | the OBJ writer                            | [`Mesh`]     |

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::Context;

mod knot;
mod soft;

/// Points and polygons, counted from 0.
#[derive(Debug, Default)]
pub struct Mesh {
    points: Vec<[f64; 3]>,
    faces: Vec<Vec<usize>>,
}

/// A file name and its generator.
type Entry = (&'static str, fn() -> Mesh);

/// All meshes.
const ALL: [Entry; 10] = [
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
];

/// Writes all of them.
pub fn run(root: &Path) -> anyhow::Result<()> {
    for (name, make) in ALL {
        let path = root.join("scenes/meshes").join(name).with_extension("obj");
        fs::write(&path, make().obj()).with_context(|| format!("cannot write `{}`", path.display()))?;
        println!("scenes/meshes/{name}.obj");
    }
    Ok(())
}

impl Mesh {
    /// A strip of quads: rows of equal length; with `closed`, the last point of a row connects to its first.
    fn rows(rows: Vec<Vec<[f64; 3]>>, closed: bool) -> Self {
        let width = rows.first().map_or(0, Vec::len);
        let count = rows.len();
        let mut mesh = Self { points: rows.into_iter().flatten().collect(), faces: Vec::new() };
        for row in 1..count {
            for column in 0..width - usize::from(!closed) {
                let next = (column + 1) % width;
                let [above, below] = [(row - 1) * width, row * width];
                mesh.faces.push(vec![above + column, below + column, below + next, above + next]);
            }
        }
        mesh
    }

    fn add(&mut self, other: Self) {
        let first = self.points.len();
        self.points.extend(other.points);
        self.faces.extend(other.faces.into_iter().map(|face| face.iter().map(|k| k + first).collect()));
    }

    fn obj(&self) -> String {
        let mut text = String::from("# Written by `cargo xtask meshes`.\n");
        for [x, y, z] in &self.points {
            // Normalises -0.0, whose sign depends on the arithmetic.
            let [x, y, z] = [x, y, z].map(|x| (x * 1e5).round() / 1e5 + 0.0);
            writeln!(text, "v {x:.5} {y:.5} {z:.5}").expect("writing to a string does not fail");
        }
        for face in &self.faces {
            let corners: Vec<String> = face.iter().map(|k| (k + 1).to_string()).collect();
            writeln!(text, "f {}", corners.join(" ")).expect("writing to a string does not fail");
        }
        text
    }
}

/// A ring of points about the y axis.
fn ring(count: usize, radius: f64, height: f64) -> Vec<[f64; 3]> {
    let point = |k: usize| {
        let turn = TAU * k as f64 / count as f64;
        [radius * turn.cos(), height, radius * turn.sin()]
    };
    (0..count).map(point).collect()
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
        let folder = crate::root().join("scenes/meshes");
        for (name, make) in ALL {
            let there = fs::read_to_string(folder.join(name).with_extension("obj")).unwrap_or_default();
            assert!(there == make().obj(), "scenes/meshes/{name}.obj: `cargo xtask meshes` rewrites it");
        }
    }
}
