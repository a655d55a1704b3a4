//! Degenerate and extreme meshes of the stress tests in `scenes/extremes/`, as OBJ text.

use std::fmt::Write;

/// A path in `scenes/extremes/` without its ending, and the generator of the text.
type Entry = (&'static str, fn() -> String);

/// All meshes.
pub const ALL: [Entry; 21] = [
    ("mass/graded-1e6", || graded(40, 1e6)),
    ("mass/graded-1e2", || graded(40, 1e2)),
    ("baseline/even", || graded(40, 1.0)),
    ("baseline/grid", || grid(16)),
    ("baseline/grid32", || grid(32)),
    ("baseline/grid2", || grid(2)),
    ("meshes/flat", || grid_and_flat_faces(16)),
    ("meshes/slivers", || slivers(16)),
    ("meshes/double", || edges_of_no_length(16)),
    ("meshes/two", || doubled(16)),
    ("meshes/stray", || grid_and_stray_points(16)),
    ("meshes/twice", || faces_twice(16)),
    ("meshes/book", || book(5, 8)),
    ("meshes/fan", || fan(1000)),
    ("meshes/point", || points(1)),
    ("meshes/triangle", triangle),
    ("meshes/empty", String::new),
    ("meshes/line", || points(3) + "f 1 2 3\n"),
    ("meshes/nan", || triangle() + "v 1 nan 2\n"),
    ("meshes/short", || triangle() + "f 1 2 9\n"),
    ("meshes/far", || triangle() + "v 1e300 0 0\n"),
];

/// A square grid of quads in the plane y = 0, `cells` each way, a metre wide round the origin. The first row of
/// points is at z = 0.5.
fn grid(cells: usize) -> String {
    let mut text = grid_points(cells);
    quads(&mut text, cells, 1);
    text
}

fn grid_points(cells: usize) -> String {
    let mut text = String::new();
    for (row, column) in (0..=cells).flat_map(|row| (0..=cells).map(move |column| (row, column))) {
        let at = |k: usize| k as f64 / cells as f64 - 0.5;
        point(&mut text, [at(column), 0.0, -at(row)]);
    }
    text
}

/// A grid with two vertices of no face at a distance.
fn grid_and_stray_points(cells: usize) -> String {
    let mut text = grid(cells);
    point(&mut text, [2.0, 0.0, 0.0]);
    point(&mut text, [2.0, 0.5, 0.0]);
    text
}

/// A grid with faces that name a vertex twice, lie on a line, or have no length.
fn grid_and_flat_faces(cells: usize) -> String {
    let mut text = grid(cells);
    face(&mut text, &[1, 2, 2]);
    face(&mut text, &[1, 2, 3]);
    face(&mut text, &[5, 5, 5]);
    text
}

/// A grid in which one row of cells is a millionth as high as it is wide.
fn slivers(cells: usize) -> String {
    let middle = cells / 2;
    let mut text = String::new();
    for (row, column) in (0..=cells).flat_map(|row| (0..=cells).map(move |column| (row, column))) {
        let at = |k: usize| k as f64 / cells as f64 - 0.5;
        let z = if row == middle + 1 { -at(middle) - 1e-6 / cells as f64 } else { -at(row) };
        point(&mut text, [at(column), 0.0, z]);
    }
    quads(&mut text, cells, 1);
    text
}

/// The faces of a grid whose first point is `first`.
fn quads(text: &mut String, cells: usize, first: usize) {
    for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column))) {
        let a = first + row * (cells + 1) + column;
        face(text, &[a, a + 1, a + cells + 2, a + cells + 1]);
    }
}

/// A grid in which one row of cells has zero height: its vertices are doubled and joined by edges of zero length.
fn edges_of_no_length(cells: usize) -> String {
    let mut text = String::new();
    for (row, column) in (0..=cells).flat_map(|row| (0..=cells).map(move |column| (row, column))) {
        let lower = if row > cells / 2 { row - 1 } else { row };
        let at = |k: usize, of: usize| k as f64 / of as f64 - 0.5;
        point(&mut text, [at(column, cells), 0.0, -at(lower, cells - 1)]);
    }
    for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column))) {
        let a = row * (cells + 1) + column + 1;
        // It extends into the next row, so that its area is not zero.
        if row == cells / 2 {
            face(&mut text, &[a, a + cells + 1, a + cells + 2, a + 2 * cells + 3]);
        } else {
            face(&mut text, &[a, a + 1, a + cells + 2, a + cells + 1]);
        }
    }
    text
}

/// Two coincident grids without common vertices.
fn doubled(cells: usize) -> String {
    let mut text = grid_points(cells);
    text += &grid_points(cells);
    quads(&mut text, cells, 1);
    quads(&mut text, cells, 1 + (cells + 1) * (cells + 1));
    text
}

/// Every face twice, the second time with inverted winding.
fn faces_twice(cells: usize) -> String {
    let mut text = grid(cells);
    for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column))) {
        let a = row * (cells + 1) + column + 1;
        face(&mut text, &[a + cells + 1, a + cells + 2, a + 1, a]);
    }
    text
}

/// Sheets of `cells` by `cells` that all share one edge line, like the pages of a book.
fn book(pages: usize, cells: usize) -> String {
    let mut text = String::new();
    for row in 0..=cells {
        point(&mut text, [row as f64 / cells as f64 - 0.5, 0.0, 0.5]);
    }
    for page in 0..pages {
        let turn = std::f64::consts::PI * page as f64 / pages as f64;
        for (column, row) in (1..=cells).flat_map(|column| (0..=cells).map(move |row| (column, row))) {
            let out = column as f64 / cells as f64;
            let x = row as f64 / cells as f64 - 0.5;
            point(&mut text, [x, out * turn.sin(), 0.5 - out * turn.cos()]);
        }
    }
    let at = |page: usize, column: usize, row: usize| match column {
        0 => row + 1,
        column => cells + 2 + page * cells * (cells + 1) + (column - 1) * (cells + 1) + row,
    };
    for page in 0..pages {
        for (column, row) in (0..cells).flat_map(|column| (0..cells).map(move |row| (column, row))) {
            let corners = [(column, row), (column, row + 1), (column + 1, row + 1), (column + 1, row)];
            face(&mut text, &corners.map(|(column, row)| at(page, column, row)));
        }
    }
    text
}

/// A disc of a central vertex, the first, and `spokes` triangles around it.
fn fan(spokes: usize) -> String {
    let mut text = String::new();
    point(&mut text, [0.0, 0.0, 0.0]);
    for k in 0..spokes {
        let turn = std::f64::consts::TAU * k as f64 / spokes as f64;
        point(&mut text, [turn.cos() / 2.0, 0.0, turn.sin() / 2.0]);
    }
    for k in 0..spokes {
        face(&mut text, &[1, 2 + k, 2 + (k + 1) % spokes]);
    }
    text
}

/// A strip of quads with geometrically growing sides: the last vertex has `ratio` times the mass of the first. A metre
/// long, from z = 0.5.
fn graded(cells: usize, ratio: f64) -> String {
    let growth = ratio.powf(0.5 / cells as f64);
    let lengths: Vec<f64> = (0..cells).map(|k| growth.powi(k as i32)).collect();
    let scale = 1.0 / lengths.iter().sum::<f64>();
    let mut text = String::new();
    let mut along = 0.0;
    for row in 0..=cells {
        let width = lengths[row.min(cells - 1)] * scale;
        point(&mut text, [-width / 2.0, 0.0, 0.5 - along]);
        point(&mut text, [width / 2.0, 0.0, 0.5 - along]);
        along += width;
    }
    for row in 0..cells {
        let a = 2 * row + 1;
        face(&mut text, &[a, a + 1, a + 3, a + 2]);
    }
    text
}

/// Vertices on a line, without faces.
fn points(count: usize) -> String {
    let mut text = String::new();
    (0..count).for_each(|k| point(&mut text, [k as f64 / 10.0, 0.0, 0.0]));
    text
}

/// One triangle.
fn triangle() -> String {
    let mut text = String::new();
    [[-0.5, 0.0, 0.5], [0.5, 0.0, 0.5], [0.0, 0.0, -0.5]].iter().for_each(|p| point(&mut text, *p));
    face(&mut text, &[1, 2, 3]);
    text
}

fn point(text: &mut String, [x, y, z]: [f64; 3]) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "v {x} {y} {z}");
}

fn face(text: &mut String, corners: &[usize]) {
    text.push('f');
    for corner in corners {
        let _ = write!(text, " {corner}");
    }
    text.push('\n');
}
