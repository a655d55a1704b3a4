//! The cloth that growth is measured on: a sheet laid in four layers, a little apart and wavy, just above the ground. It
//! falls together within two frames and lies on itself.
//!
//! More points are more of the same cloth, never finer cloth: the cells, the thickness and the layers stay as they are, and
//! the heap becomes wider. So each point has as much to do with others, moves as far in a step, and bears as much at any
//! size, and all that grows is how many there are. A finer sheet of one size would have less of each fold on a point, and
//! further to go measured in its cells.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use nucleus_core::Surface;
use nucleus_graph::compile::Program;

use super::scene::{Draft, MeshFolder, Setting};
use crate::bench::mesh::{self, Cells};

/// Frames that a heap is run for: it falls together, and lies.
pub const FRAMES: u32 = 3;

/// Cells along a layer, and layers on one another.
const CELLS: u32 = 32;
const LAYERS: u32 = 4;

/// Points from one end of the way through all layers to the other.
const ROWS: u32 = CELLS * LAYERS + 1;

/// Length of a cell in metres: that of W3 at 129².
const CELL: f64 = 1.5 / 128.0;

/// From layer to layer in metres, and how far waves reach up and down: layers keep more than the thickness of 5 mm.
const RISE: f64 = 0.0075;
const WAVE: f64 = 0.001;

/// Lengths of the waves in metres, none a multiple of a cell.
const LENGTHS: [f64; 2] = [0.11, 0.073];

/// Height of the lowest layer in metres.
const GROUND: f64 = 0.005;

/// A heap of about `n` by `n` points.
pub fn sheet(n: u32) -> Surface {
    let columns = (f64::from(n * n) / f64::from(ROWS)).round() as u32;
    let way = way();
    let place = |row: usize, column: u32| {
        let ([along, height], across) = (way[row], f64::from(column) * CELL);
        // Waves of neighbouring layers are out of step, so that they touch here and there before they lie.
        let phase = 0.37 * f64::from(row as u32 / CELLS);
        let wave = (TAU * (across / LENGTHS[0] + phase)).sin() * (TAU * (along / LENGTHS[1] + phase)).cos();
        Vector3::new(across, height + WAVE * wave, along)
    };
    let row = |row| (0..columns).map(move |column| place(row, column));
    let positions = (0..ROWS as usize).flat_map(row).collect();
    Surface { positions, faces: mesh::faces([columns, ROWS], Cells::Triangles) }
}

/// The way through all layers, back and forth, point by point: along and up. The last cell of a layer leads to the next.
fn way() -> Vec<[f64; 2]> {
    let mut way = vec![[0.0, GROUND]];
    let mut place = way[0];
    for cell in 0..CELLS * LAYERS {
        let is_turn = cell % CELLS == CELLS - 1;
        let rise = if is_turn { RISE } else { 0.0 };
        let forth = if (cell / CELLS).is_multiple_of(2) { 1.0 } else { -1.0 };
        place = [place[0] + forth * (CELL * CELL - rise * rise).sqrt(), place[1] + rise];
        way.push(place);
    }
    way
}

/// The scene, ready to run.
///
/// # Errors
/// When a mesh cannot be written or the scene is refused.
pub fn program(n: u32, setting: Setting, place: &MeshFolder) -> anyhow::Result<Program> {
    Draft { frames: FRAMES, plane: true, sheets: vec![sheet(n)], other_nodes: String::new() }
        .program(setting, place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::timed::Timed;

    #[test]
    fn a_heap_has_the_points_that_it_is_asked_for_and_no_cell_is_drawn_out() {
        for n in [65, 100, 257] {
            let pile = sheet(n);
            let points = pile.positions.len() as f64;
            assert!((points / f64::from(n * n) - 1.0).abs() < 0.02, "{n}: {points}");
            let lengths = mesh::edges(&pile).into_iter().map(|(_, length)| length / CELL);
            let (least, most) = lengths.fold((f64::MAX, 0.0), |(a, b): (f64, f64), x| (a.min(x), b.max(x)));
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
                Timed::run(&program(n, setting, &MeshFolder::new().unwrap()).unwrap(), 1, Some(3), |_| {});
            [run.pairs / run.queries, run.contacts].map(|count| count / sheet(n).positions.len() as f64)
        };
        let [small, large] = [run(65), run(129)];
        for (small, large) in small.into_iter().zip(large) {
            assert!(small > 1.0 && (large / small - 1.0).abs() < 0.1, "{small} and {large}");
        }
    }
}
