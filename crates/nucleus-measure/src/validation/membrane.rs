//! Sheets that hang and stretch, and chains.

use nucleus_core::{BuildError, ClothLists, Faces, Surface};

use super::case::{Case, Comparison, Fixture, Tolerance};
use crate::fixture::{DENSITY, GRAVITY, STRIP, Vec3, membrane, sheet};

pub const CASES: &[Case] = &[
    Case {
        name: "hanging-sheet",
        description: "A sheet of stiffness K that hangs from its upper edge lengthens by ρ g H² / 2K; with cross links, and of \
            equilateral triangles, its Poisson's ratio is 1/3.",
        known_failure: None,
        run: hanging,
    },
    Case {
        name: "catenary",
        description: "A chain of 100 links between two hooks: sag over length, for several spans over length.",
        known_failure: None,
        run: catenary,
    },
];

/// N/m.
const STIFFNESS: f64 = 500.0;

fn hanging() -> Result<Vec<Comparison>, BuildError> {
    let grid = || sheet([9, 33], -Vec3::x() / 8.0, Vec3::x() / 4.0, -Vec3::y());
    let alone = ClothLists { cross_links: false, ..STRIP };
    let mut comparisons = hang("squares without cross links", grid(), alone, 0.0)?;
    comparisons.extend(hang("squares with cross links", grid(), STRIP, 1.0 / 3.0)?);
    comparisons.extend(hang("equilateral triangles", triangles(), STRIP, 1.0 / 3.0)?);
    Ok(comparisons)
}

/// Rows of equilateral triangles, 0.25 m wide and 1 m high; odd rows are offset by half a side.
fn triangles() -> Surface {
    let (columns, rows) = (9u32, 37u32);
    let side = 0.25 / f64::from(columns - 1);
    let height = side * 0.75f64.sqrt();
    let mut surface = Surface::default();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let x = (f64::from(column) + if row % 2 == 1 { 0.5 } else { 0.0 }) * side - 0.125;
        surface.positions.push(Vec3::new(x, -f64::from(row) * height, 0.0));
    }
    let mut faces = Faces::default();
    for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
        let (a, c) = (row * columns + column, (row + 1) * columns + column);
        let two = if row % 2 == 0 {
            [[a, c, a + 1], [a + 1, c, c + 1]]
        } else {
            [[a, c, c + 1], [a, c + 1, a + 1]]
        };
        two.iter().for_each(|face| faces.push(face));
    }
    surface.faces = faces;
    surface
}

/// Sag, and Poisson's ratio.
fn hang(
    name: &str,
    surface: Surface,
    lists: ClothLists,
    poisson: f64,
) -> Result<Vec<Comparison>, BuildError> {
    let columns = 9;
    let rows = surface.positions.len() / columns;
    let height = -surface.positions[(rows - 1) * columns].y;
    let mut fixture = Fixture::new(surface, lists, 1000.0)?;
    fixture.cloth().stiffness = membrane(STIFFNESS);
    fixture.damp_velocity(30.0);
    fixture.pin(0..columns);
    fixture.run_to_rest(1e-6, 48);
    let moved = |row: usize, column: usize| {
        let point = row * columns + column;
        fixture.point(point) - fixture.surface.positions[point]
    };
    let down = (0..columns).map(|column| -moved(rows - 1, column).y).sum::<f64>() / columns as f64;
    let weight = DENSITY * GRAVITY;
    let sag = weight * height * height / (2.0 * STIFFNESS);
    let mut comparisons =
        vec![Comparison::new(format!("{name}: sag in m"), sag, down, Tolerance::Relative(0.01))];
    if poisson > 0.0 {
        // At two thirds of the height, far from the pinned edge, and over the inner half of the width, because free sides of
        // triangles are ragged.
        let (row, inner) = (rows * 2 / 3, [columns / 4, columns - 1 - columns / 4]);
        let wide = |column: usize| fixture.surface.positions[row * columns + column].x;
        let narrower = (moved(row, inner[0]).x - moved(row, inner[1]).x) / (wide(inner[1]) - wide(inner[0]));
        let depth = -fixture.surface.positions[row * columns].y;
        let strain = weight * (height - depth) / STIFFNESS;
        let quantity = format!("{name}: narrowing over strain");
        comparisons.push(Comparison::new(quantity, poisson, narrower / strain, Tolerance::Relative(0.05)));
    }
    Ok(comparisons)
}

/// Span over length, sag over length: of y = a cosh(x / a).
fn catenary() -> Result<Vec<Comparison>, BuildError> {
    [0.5, 0.8, 0.95, 0.99].into_iter().map(chain).collect()
}

/// Solves sinh(u) / u = length / span for u = span / 2a; then sag = a (cosh(u) - 1).
fn exact_sag(span: f64) -> f64 {
    let (mut low, mut high) = (1e-6f64, 20.0f64);
    for _ in 0..200 {
        let middle = (low + high) / 2.0;
        if middle.sinh() / middle > 1.0 / span { high = middle } else { low = middle }
    }
    span / (2.0 * low) * (low.cosh() - 1.0)
}

fn chain(span: f64) -> Result<Comparison, BuildError> {
    // A ladder folded to its span as a zigzag, which preserves all lengths.
    let mut ladder = sheet([101, 2], Vec3::zeros(), Vec3::x(), Vec3::z() * 0.01);
    let rise = (1.0 - span * span).sqrt() * 0.01;
    for (k, p) in ladder.positions.iter_mut().enumerate() {
        *p = Vec3::new(p.x * span, if k % 101 % 2 == 1 { rise } else { 0.0 }, p.z);
    }
    let lists = ClothLists { stretch: true, air: true, ..ClothLists::NONE };
    let mut fixture = Fixture::new(ladder, lists, 3000.0)?;
    fixture.cloth().stiffness = membrane(6e4);
    fixture.damp_velocity(8.0);
    fixture.pin([0, 100, 101, 201]);
    fixture.run_to_rest(1e-5, 120);
    let found = -fixture.point(50).y;
    Ok(Comparison::new(
        format!("sag at a span of {span}, over the length"),
        exact_sag(span),
        found,
        Tolerance::Absolute(1e-3),
    ))
}

#[cfg(test)]
mod tests {
    use super::exact_sag;

    #[test]
    fn the_exact_catenary_agrees_with_an_independent_table() {
        for (span, sag) in [(0.5, 0.398_194), (0.8, 0.265_438), (0.95, 0.135_898), (0.99, 0.061_145)] {
            assert!((exact_sag(span) - sag).abs() < 2e-6, "{span}: {}", exact_sag(span));
        }
    }
}
