//! Triangle rasterisation: the inner loop of the camera and of all shadow maps.

/// A limit on the cells that are filled, which bounds the time for a mesh that has exploded.
pub(super) struct Budget {
    cells_left: usize,
    small: usize,
}

impl Budget {
    /// A budget for a grid of this size: each cell may be covered 200 times.
    pub fn of(size: [u32; 2]) -> Self {
        let cells = size[0] as usize * size[1] as usize;
        Self { cells_left: cells.saturating_mul(200), small: cells / 256 }
    }

    /// Subtracts the cost of a triangle. Once the budget is spent, only small triangles are drawn.
    fn allows(&mut self, cells: usize) -> bool {
        self.cells_left = self.cells_left.saturating_sub(cells);
        self.cells_left > 0 || cells <= self.small
    }
}

/// Calls `visit` for each cell whose centre is inside the triangle, with its index and the barycentric weights of the
/// centre. A triangle without area, or with a corner that is not finite, covers no cell.
///
/// The weights are computed in double precision: those of a triangle that reaches thousands of cells beyond the grid would
/// be rounded differently in each row.
pub(super) fn rasterise(
    corners: [[f32; 2]; 3],
    size: [u32; 2],
    budget: &mut Budget,
    mut visit: impl FnMut(usize, [f32; 3]),
) {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let area = cross(a, b, c);
    let (columns, rows) = (span(corners.map(|p| p[0]), size[0]), span(corners.map(|p| p[1]), size[1]));
    if !area.is_finite() || area == 0.0 || !budget.allows(columns.len() * rows.len()) {
        return;
    }
    // Two triangles round a shared edge differently; a small overlap closes the gap.
    const OVERLAP: f64 = -1e-5;
    let (step_b, step_c) = ((c[1] - a[1]) / area, (a[1] - b[1]) / area);
    let first_column = f64::from(columns.start) + 0.5;
    for row in rows {
        let start = [first_column, f64::from(row) + 0.5];
        let (at_b, at_c) = (cross(a, start, c) / area, cross(a, b, start) / area);
        for column in columns.clone() {
            let steps = f64::from(column - columns.start);
            let (wb, wc) = (at_b + steps * step_b, at_c + steps * step_c);
            let wa = 1.0 - wb - wc;
            if wa >= OVERLAP && wb >= OVERLAP && wc >= OVERLAP {
                visit(row as usize * size[0] as usize + column as usize, [wa, wb, wc].map(|w| w as f32));
            }
        }
    }
}

/// Twice the signed area of a triangle.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The range of cells of one axis that the coordinates span. Casts saturate, so any number gives a valid range.
fn span(at: [f32; 3], size: u32) -> std::ops::Range<u32> {
    let low = at[0].min(at[1]).min(at[2]).floor() as u32;
    let high = at[0].max(at[1]).max(at[2]).ceil() as u32;
    low.min(size)..high.min(size)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SIZE: [u32; 2] = [32, 24];

    fn covered(corners: [[f32; 2]; 3]) -> Vec<(usize, [f32; 3])> {
        let mut cells = Vec::new();
        rasterise(corners, SIZE, &mut Budget::of(SIZE), |cell, weights| cells.push((cell, weights)));
        cells
    }

    proptest! {
        #[test]
        fn the_weights_interpolate_the_centre_of_the_cell(
            corners in prop::array::uniform3(prop::array::uniform2(-10.0f32..40.0)),
        ) {
            let [a, b, c] = corners.map(|corner| corner.map(f64::from));
            prop_assume!(cross(a, b, c).abs() > 1.0);
            for (cell, weights) in covered(corners) {
                let centre = [(cell % 32) as f32 + 0.5, (cell / 32) as f32 + 0.5];
                for axis in 0..2 {
                    let at: f32 = (0..3).map(|k| corners[k][axis] * weights[k]).sum();
                    prop_assert!((at - centre[axis]).abs() < 0.01, "{at} for {}", centre[axis]);
                }
            }
        }

        #[test]
        fn the_two_triangles_of_a_square_leave_no_gap(
            x in 0.0f32..8.0, y in 0.0f32..8.0, side in 2.0f32..14.0,
        ) {
            let [a, b, c, d] = [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
            let mut cells: Vec<usize> =
                covered([a, b, c]).into_iter().chain(covered([a, c, d])).map(|(cell, _)| cell).collect();
            cells.sort_unstable();
            cells.dedup();
            let inside = |at: f32, low: f32| at > low && at < low + side;
            let expected = (0..32 * 24).filter(|cell| {
                inside((cell % 32) as f32 + 0.5, x) && inside((cell / 32) as f32 + 0.5, y)
            });
            for cell in expected {
                prop_assert!(cells.contains(&cell));
            }
        }
    }

    // A ground that passes below the eye reaches far beyond the picture. A small weight of its corner near the eye decides the
    // depth of a cell.
    #[test]
    fn a_small_weight_of_a_far_corner_is_as_precise_as_a_large_one() {
        // Two corners are on the line y = x - 13, and so are some centres.
        let above_line = |[x, y]: [f64; 2]| y - x + 13.0;
        let cells = covered([[-1e6, -1_000_013.0], [1e6, 999_987.0], [-1e6, 1e6]]);
        assert!(cells.len() > 32 * 24 / 2);
        for (cell, [_, _, weight]) in cells {
            let centre = [cell % 32, cell / 32].map(|at| at as f64 + 0.5);
            let exact = above_line(centre) / above_line([-1e6, 1e6]);
            let error = (f64::from(weight) - exact).abs();
            assert!(error <= 1e-6 * exact.abs().max(1e-9), "cell {cell}: {weight} for {exact}");
        }
    }

    #[test]
    fn extreme_corners_cover_no_cell_outside_the_grid() {
        for extreme in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30] {
            let cells = covered([[extreme, 3.0], [5.0, extreme], [20.0, 20.0]]);
            assert!(cells.iter().all(|(cell, _)| *cell < 32 * 24));
        }
    }
}
