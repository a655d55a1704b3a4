//! A mesh as it is generated, and its OBJ file.

use std::f64::consts::TAU;
use std::fmt::Write;

/// Points and polygons, counted from 0.
#[derive(Debug, Default)]
pub struct Mesh {
    /// In centimetres.
    pub points: Vec<[f64; 3]>,
    /// The corners of each polygon.
    pub faces: Vec<Vec<usize>>,
}

impl Mesh {
    /// A strip of quads: rows of equal length; with `closed`, the last point of a row connects to its first.
    pub fn rows(rows: Vec<Vec<[f64; 3]>>, closed: bool) -> Self {
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

    /// Adds another mesh.
    pub fn add(&mut self, other: Self) {
        let first = self.points.len();
        self.points.extend(other.points);
        self.faces.extend(other.faces.into_iter().map(|face| face.iter().map(|k| k + first).collect()));
    }

    /// The text of its OBJ file.
    pub fn obj(&self) -> String {
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
pub fn ring(count: usize, radius: f64, height: f64) -> Vec<[f64; 3]> {
    let point = |k: usize| {
        let turn = TAU * k as f64 / count as f64;
        [radius * turn.cos(), height, radius * turn.sin()]
    };
    (0..count).map(point).collect()
}
