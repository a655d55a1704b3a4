//! The cloth of the scaling test: a sheet folded into four wavy layers just above the ground, which falls within two
//! frames and lies on itself.
//!
//! A larger sheet has more cells of the same size, thickness and layers, and the pile becomes wider. Contacts per point,
//! motion per step and load per point are independent of size, so that only the number of points scales. A refined sheet
//! of fixed size would have fewer folds per point, and longer distances relative to its cells.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use nucleus_core::Surface;
use nucleus_graph::compile::Program;

use tempfile::TempDir;

use super::scene::{Draft, Setting};
use crate::bench::mesh;

/// Frames that a heap is run for: it falls together, and lies.
pub const FRAMES: u32 = 3;

/// Cells along a layer, and number of layers.
const CELLS: u32 = 32;
const LAYERS: u32 = 4;

/// Points along the sheet through all layers.
const ROWS: u32 = CELLS * LAYERS + 1;

/// Length of a cell in metres: that of W3 at 129².
const CELL: f64 = 1.5 / 128.0;

/// Distance of layers and amplitude of waves in metres: layers start farther apart than the thickness of 5 mm.
const RISE: f64 = 0.0075;
const WAVE: f64 = 0.001;

/// Wavelengths in metres, no multiples of a cell.
const LENGTHS: [f64; 2] = [0.11, 0.073];

/// Height of the lowest layer in metres.
const GROUND: f64 = 0.005;

/// A heap of about `n` by `n` points.
pub fn sheet(n: u32) -> Surface {
    let columns = (f64::from(n * n) / f64::from(ROWS)).round() as u32;
    let way = way();
    let position = |row: usize, column: u32| {
        let ([along, height], across) = (way[row], f64::from(column) * CELL);
        // Waves of adjacent layers are out of phase, so that they touch in spots first.
        let phase = 0.37 * f64::from(row as u32 / CELLS);
        let wave = (TAU * (across / LENGTHS[0] + phase)).sin() * (TAU * (along / LENGTHS[1] + phase)).cos();
        Vector3::new(across, height + WAVE * wave, along)
    };
    let row = |row| (0..columns).map(move |column| position(row, column));
    let positions = (0..ROWS as usize).flat_map(row).collect();
    Surface { positions, faces: mesh::triangles([columns, ROWS]) }
}

/// Path through all layers, back and forth: along and up. The last cell of a layer leads to the next.
fn way() -> Vec<[f64; 2]> {
    let mut way = vec![[0.0, GROUND]];
    let mut position = way[0];
    for cell in 0..CELLS * LAYERS {
        let is_turn = cell % CELLS == CELLS - 1;
        let rise = if is_turn { RISE } else { 0.0 };
        let forth = if (cell / CELLS).is_multiple_of(2) { 1.0 } else { -1.0 };
        position = [position[0] + forth * (CELL * CELL - rise * rise).sqrt(), position[1] + rise];
        way.push(position);
    }
    way
}

/// The compiled scene.
///
/// # Errors
/// When a mesh cannot be written or the scene is rejected.
pub fn program(n: u32, setting: Setting, folder: &TempDir) -> anyhow::Result<Program> {
    Draft { frames: FRAMES, plane: true, sheets: vec![sheet(n)], other_nodes: String::new() }
        .program(setting, folder)
}

#[cfg(test)]
mod tests {
    use nucleus_measure::metrics::deformation::Edges;

    use super::*;
    use crate::bench::timed::Timed;

    #[test]
    fn a_heap_has_the_points_that_it_is_asked_for_and_no_cell_is_drawn_out() {
        for n in [65, 100, 257] {
            let pile = sheet(n);
            let points = pile.positions.len() as f64;
            assert!((points / f64::from(n * n) - 1.0).abs() < 0.02, "{n}: {points}");
            let lengths = Edges::of(&pile).iter().map(|(_, length)| length / CELL).collect::<Vec<_>>();
            let (least, most) =
                lengths.into_iter().fold((f64::MAX, 0.0), |(a, b): (f64, f64), x| (a.min(x), b.max(x)));
            assert!(least > 0.94 && most < 1.06 * 2f64.sqrt(), "{n}: {least} to {most}");
        }
    }

    #[test]
    fn layers_begin_more_than_the_thickness_apart() {
        let pile = sheet(40);
        let columns = pile.positions.len() / ROWS as usize;
        let layer = |point: usize| point / columns / CELLS as usize;
        for (a, here) in pile.positions.iter().enumerate() {
            let other_nodes = pile.positions.iter().enumerate().filter(|(b, _)| layer(*b) > layer(a));
            let apart = other_nodes
                .filter(|(b, _)| b / columns > a / columns + 1)
                .map(|(_, there)| (there - here).norm());
            let nearest = apart.fold(f64::MAX, f64::min);
            assert!(nearest > 0.005, "{a}: {nearest}");
        }
    }

    #[test]
    fn a_point_has_as_many_pairs_and_contacts_in_a_heap_of_four_times_the_points() {
        let run = |n: u32| {
            let setting = Setting { evaluations: 12, self_collide: true };
            let run =
                Timed::run(&program(n, setting, &tempfile::tempdir().unwrap()).unwrap(), 1, Some(3), |_| {});
            [run.pairs / run.queries, run.contacts].map(|count| count / sheet(n).positions.len() as f64)
        };
        let [small, large] = [run(65), run(129)];
        for (small, large) in small.into_iter().zip(large) {
            assert!(small > 1.0 && (large / small - 1.0).abs() < 0.1, "{small} and {large}");
        }
    }
}
