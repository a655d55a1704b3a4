//! A box.

use nalgebra::Vector3;
use nucleus_core::{Faces, Surface};

use super::primitive::{PrimitiveError, check_length, check_size, check_subdivisions, even_step};

/// A closed box of quads round the origin: Maya's `polyCube`.
///
/// `width` is along x, `height` along y, `depth` along z, in scene units; Maya's defaults are 1, 1, 1 and
/// `(1, 1, 1)`. As in Maya, rows of points along +x form a belt, up the front (+z), back over the top, down
/// the back and forward under the bottom; then come the inner points of the right side (+x), and of the
/// left, from bottom to top and in each row from back to front. Faces follow the same order.
///
/// # Errors
/// When a length is not above zero, a number of subdivisions is zero, or there would be too many points.
pub fn poly_cube(
    width: f64,
    height: f64,
    depth: f64,
    (sx, sy, sz): (u32, u32, u32),
) -> Result<Surface, PrimitiveError> {
    for (name, length, subdivisions) in [("width", width, sx), ("height", height, sy), ("depth", depth, sz)] {
        check_length(name, length)?;
        check_subdivisions(name, subdivisions, 1)?;
    }
    let [x, y, z] = [sx, sy, sz].map(u64::from);
    check_size(2 * (y + z), x + 1)?;
    check_size(2 * y, z)?;
    let lattice = Lattice { sx, sy, sz };
    let size = Vector3::new(width, height, depth);
    let positions = lattice.points().map(|point| point.component_mul(&size)).collect();
    let mut faces = Faces::default();
    lattice.belt().chain(lattice.right()).chain(lattice.left()).for_each(|quad| faces.push(&quad));
    Ok(Surface { positions, faces })
}

/// The points on a box of size 1, by their numbers.
#[derive(Clone, Copy)]
struct Lattice {
    sx: u32,
    sy: u32,
    sz: u32,
}

impl Lattice {
    /// Rows in the belt; the one after the last is the first again.
    fn rows(self) -> u32 {
        2 * (self.sy + self.sz)
    }

    /// Where a row of the belt is: its y and z.
    fn row(self, row: u32) -> (f64, f64) {
        let Self { sy, sz, .. } = self;
        match row {
            _ if row <= sy => (even_step(row, sy), 0.5),
            _ if row <= sy + sz => (0.5, -even_step(row - sy, sz)),
            _ if row <= sy + sz + sy => (-even_step(row - sy - sz, sy), -0.5),
            _ => (-0.5, even_step(row - sy - sz - sy, sz)),
        }
    }

    fn points(self) -> impl Iterator<Item = Vector3<f64>> {
        let belt = (0..self.rows()).flat_map(move |row| {
            let (y, z) = self.row(row);
            (0..=self.sx).map(move |i| Vector3::new(even_step(i, self.sx), y, z))
        });
        let inside = move |x| {
            let rows = (1..self.sy).map(move |j| even_step(j, self.sy));
            rows.flat_map(move |y| (1..self.sz).map(move |k| Vector3::new(x, y, even_step(k, self.sz))))
        };
        belt.chain(inside(0.5)).chain(inside(-0.5))
    }

    /// The number of the point in a row and column of the belt.
    fn on_belt(self, row: u32, column: u32) -> u32 {
        row % self.rows() * (self.sx + 1) + column
    }

    /// The number of the point of a side, `j` from the bottom and `k` from the back. `right` is 1 or 0.
    fn on_side(self, right: u32, j: u32, k: u32) -> u32 {
        let Self { sx, sy, sz } = self;
        let row = match (j, k) {
            (0, _) => 2 * sy + sz + k,
            (_, 0) => 2 * sy + sz - j,
            _ if j == sy => sy + sz - k,
            _ if k == sz => j,
            _ => {
                let first = self.rows() * (sx + 1) + (1 - right) * (sy - 1) * (sz - 1);
                return first + (j - 1) * (sz - 1) + k - 1;
            }
        };
        self.on_belt(row, right * sx)
    }

    fn belt(self) -> impl Iterator<Item = [u32; 4]> {
        let quad = move |row, i| {
            let [a, b] = [row, row + 1].map(|row| self.on_belt(row, i));
            [a, a + 1, b + 1, b]
        };
        (0..self.rows()).flat_map(move |row| (0..self.sx).map(move |i| quad(row, i)))
    }

    fn right(self) -> impl Iterator<Item = [u32; 4]> {
        self.cells().map(move |(j, k)| {
            [(j, k + 1), (j, k), (j + 1, k), (j + 1, k + 1)].map(|(j, k)| self.on_side(1, j, k))
        })
    }

    fn left(self) -> impl Iterator<Item = [u32; 4]> {
        self.cells().map(move |(j, k)| {
            [(j, k), (j, k + 1), (j + 1, k + 1), (j + 1, k)].map(|(j, k)| self.on_side(0, j, k))
        })
    }

    /// The faces of a side, from the bottom and from the back.
    fn cells(self) -> impl Iterator<Item = (u32, u32)> {
        (0..self.sy).flat_map(move |j| (0..self.sz).map(move |k| (j, k)))
    }
}
