//! Maya's primitives: plane, cube, sphere and cylinder, with points and faces in Maya's order.
//!
//! Parameters are checked first, and the size of a primitive is known before it is made.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use nucleus_core::{Faces, Surface};

use crate::animation::sin_cos_degrees;
use crate::memory::Size;

mod uvs;

/// A primitive with its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Primitive {
    /// [`poly_plane`]: width, height; subdivisions along them.
    Plane([f64; 2], [u32; 2]),
    /// [`poly_sphere`]: radius; subdivisions.
    Sphere(f64, [u32; 2]),
    /// [`poly_cube`]: width, height, depth; subdivisions along them.
    Cube([f64; 3], [u32; 3]),
    /// [`poly_cylinder`]: radius, height; subdivisions.
    Cylinder([f64; 2], [u32; 3]),
}

impl Primitive {
    /// The size of the mesh, without making it. Meaningless for invalid parameters.
    pub fn size(&self) -> Size {
        let product = |factors: &[u64]| factors.iter().fold(1, |all: u64, one| all.saturating_mul(*one));
        let sum = |terms: &[u64]| terms.iter().fold(0, |all: u64, one| all.saturating_add(*one));
        let (points, corners) = match *self {
            Self::Plane(_, [x, y]) => {
                let [x, y] = [x, y].map(u64::from);
                (product(&[x + 1, y + 1]), product(&[4, x, y]))
            }
            Self::Sphere(_, [x, y]) => {
                let [x, y] = [x, y].map(u64::from);
                (sum(&[product(&[x, y.max(1) - 1]), 2]), product(&[x, 4 * y.max(2) - 2]))
            }
            Self::Cube(_, [x, y, z]) => {
                let [x, y, z] = [x, y, z].map(u64::from);
                let sides = product(&[2, y.max(1) - 1, z.max(1) - 1]);
                let faces = sum(&[product(&[x, y]), product(&[y, z]), product(&[z, x])]);
                (sum(&[product(&[2, y + z, x + 1]), sides]), product(&[8, faces]))
            }
            Self::Cylinder(_, [x, y, 0]) => {
                let [x, y] = [x, y].map(u64::from);
                (product(&[x, y + 1]), product(&[x, 4 * y + 2]))
            }
            Self::Cylinder(_, [x, y, z]) => {
                let [x, y, z] = [x, y, z].map(u64::from);
                let rings = y + 2 * (z - 1);
                (sum(&[product(&[x, rings + 1]), 2]), product(&[x, 4 * rings + 6]))
            }
        };
        Size { points, corners }
    }

    /// The mesh.
    ///
    /// # Errors
    /// When a parameter is invalid; see [`PrimitiveError`].
    pub fn surface(&self) -> Result<Surface, PrimitiveError> {
        match *self {
            Self::Plane([width, height], [x, y]) => poly_plane(width, height, (x, y)),
            Self::Sphere(radius, [x, y]) => poly_sphere(radius, (x, y)),
            Self::Cube([width, height, depth], [x, y, z]) => poly_cube(width, height, depth, (x, y, z)),
            Self::Cylinder([radius, height], [x, y, z]) => poly_cylinder(radius, height, (x, y, z)),
        }
    }
}

/// The smallest rotation that takes the y axis to a direction of any length; `None` where nothing turns.
pub fn rotation_to_axis(axis: [f64; 3]) -> Option<Rotation3<f64>> {
    let axis = Vector3::from(axis).try_normalize(1e-12).filter(|axis| *axis != Vector3::y())?;
    if axis.y < -1.0 + 1e-12 {
        let half_turn = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        return Some(Rotation3::from_matrix_unchecked(half_turn));
    }
    // Without angles: the half-way quaternion.
    let quaternion = Quaternion::from_parts(1.0 + axis.y, Vector3::y().cross(&axis));
    Some(UnitQuaternion::new_normalize(quaternion).to_rotation_matrix())
}

/// A rectangle of quads in the xz plane, facing up, round the origin: Maya's `polyPlane`.
///
/// `width` is along x, `height` along z, both in scene units; Maya's defaults are 1, 1 and `(10, 10)`.
/// As in Maya, point 0 is at -x, +z; rows run along +x, one after the other towards -z. Faces likewise.
///
/// # Errors
/// When a length is not above zero, a number of subdivisions is zero, or there would be too many points.
pub fn poly_plane(width: f64, height: f64, (sx, sy): (u32, u32)) -> Result<Surface, PrimitiveError> {
    check_length("width", width)?;
    check_length("height", height)?;
    check_subdivisions("width", sx, 1)?;
    check_subdivisions("height", sy, 1)?;
    check_size(u64::from(sx) + 1, u64::from(sy) + 1)?;
    let row =
        |j| (0..=sx).map(move |i| Vector3::new(width * even_step(i, sx), 0.0, -height * even_step(j, sy)));
    let mut faces = Faces::with_capacity((sx * sy) as usize, (4 * sx * sy) as usize);
    for (j, i) in (0..sy).flat_map(|j| (0..sx).map(move |i| (j, i))) {
        let near = j * (sx + 1) + i;
        let far = near + sx + 1;
        faces.push(&[near, near + 1, far + 1, far]);
    }
    Ok(Surface { positions: (0..=sy).flat_map(row).collect(), faces })
}

/// The texture coordinates of the points of [`poly_plane`], as in Maya: u along +x, v along -z, both from 0 to 1.
pub fn poly_plane_uvs((sx, sy): (u32, u32)) -> Vec<[f64; 2]> {
    let share = |k: u32, of: u32| f64::from(k) / f64::from(of.max(1));
    (0..=sy).flat_map(|j| (0..=sx).map(move |i| [share(i, sx), share(j, sy)])).collect()
}

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
    /// The number of rows in the belt. The belt is closed: after the last row comes the first.
    fn rows(self) -> u32 {
        2 * (self.sy + self.sz)
    }

    /// The y and z of a row of the belt.
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

    /// The faces of a side, counted from the bottom and from the back.
    fn cells(self) -> impl Iterator<Item = (u32, u32)> {
        (0..self.sy).flat_map(move |j| (0..self.sz).map(move |k| (j, k)))
    }
}

/// A closed sphere round the origin, quads with triangles at the poles: Maya's `polySphere`.
///
/// `sx` is the number of subdivisions round the axis, `sy` from pole to pole; Maya's defaults are radius 1
/// (scene units) and `(20, 20)`. As in Maya, rings come from bottom to top, each running from the first
/// step after +x towards -z and ending on +x; the last two points are the bottom and the top pole. Faces
/// are the quads ring by ring, then the triangles at the bottom, then those at the top.
///
/// # Errors
/// When the radius is not above zero, there are fewer than 3 or 2 subdivisions, or too many points.
pub fn poly_sphere(radius: f64, (sx, sy): (u32, u32)) -> Result<Surface, PrimitiveError> {
    check_length("radius", radius)?;
    check_subdivisions("axis", sx, 3)?;
    check_subdivisions("height", sy, 2)?;
    check_size(u64::from(sx), u64::from(sy))?;
    let ring = |k| {
        let (sin, cos) = sin_cos_degrees(180.0 * even_step(k, sy));
        Ring { radius: radius * cos, height: radius * sin }
    };
    Ok(revolve(&(1..sy).map(ring).collect::<Vec<_>>(), sx, Ends::Poles { bottom: -radius, top: radius }))
}

/// A closed cylinder round the origin: Maya's `polyCylinder`.
///
/// Subdivisions are round the axis, along the height, and from rim to centre of the caps: 0 makes each cap
/// one polygon, 1 a fan of triangles. Maya's node starts with radius 1, height 2 (scene units) and
/// `(20, 1, 0)`; its menu sets the caps to 1. As in Maya, rings come along the outline, from the centre of
/// the bottom over the side to the centre of the top, each running as in [`poly_sphere`]; the last two
/// points are the centres of the caps, if they have one. Faces are the quads ring by ring, then the rest of
/// the bottom, then the rest of the top.
///
/// # Errors
/// When a length is not above zero, there are fewer than 3 or 1 subdivisions, or too many points.
pub fn poly_cylinder(
    radius: f64,
    height: f64,
    (sx, sy, sz): (u32, u32, u32),
) -> Result<Surface, PrimitiveError> {
    check_length("radius", radius)?;
    check_length("height", height)?;
    check_subdivisions("axis", sx, 3)?;
    check_subdivisions("height", sy, 1)?;
    check_size(u64::from(sx), u64::from(sy) + 2 * u64::from(sz) + 1)?;
    let (bottom, top) = (-0.5 * height, 0.5 * height);
    let on_cap = |j, height| Ring { radius: radius * f64::from(j) / f64::from(sz), height };
    let below = (1..sz).map(|j| on_cap(j, bottom));
    let side = (0..=sy).map(|k| Ring { radius, height: height * even_step(k, sy) });
    let above = (1..sz).rev().map(|j| on_cap(j, top));
    let rings: Vec<_> = below.chain(side).chain(above).collect();
    Ok(revolve(&rings, sx, if sz == 0 { Ends::Polygons } else { Ends::Poles { bottom, top } }))
}

struct Ring {
    radius: f64,
    height: f64,
}

/// The closure of the first and the last ring.
enum Ends {
    Polygons,
    Poles { bottom: f64, top: f64 },
}

/// A surface of revolution: joins rings of `sides` points, from bottom to top, and closes the ends.
fn revolve(rings: &[Ring], sides: u32, ends: Ends) -> Surface {
    let directions: Vec<_> =
        (1..=sides).map(|i| sin_cos_degrees(360.0 * f64::from(i) / f64::from(sides))).collect();
    let points = |ring: &Ring| {
        let &Ring { radius, height } = ring;
        directions.iter().map(move |&(sin, cos)| Vector3::new(radius * cos, height, -radius * sin))
    };
    let mut positions: Vec<_> = rings.iter().flat_map(points).collect();
    let last = (rings.len() as u32 - 1) * sides;
    let mut faces = Faces::default();
    for ring in (0..last).step_by(sides as usize) {
        for (a, b) in steps(sides) {
            faces.push(&[ring + a, ring + b, ring + sides + b, ring + sides + a]);
        }
    }
    match ends {
        Ends::Polygons => {
            faces.push(&(0..sides).rev().collect::<Vec<_>>());
            faces.push(&(last..last + sides).collect::<Vec<_>>());
        }
        Ends::Poles { bottom, top } => {
            let pole = positions.len() as u32;
            positions.extend([bottom, top].map(|height| Vector3::new(0.0, height, 0.0)));
            steps(sides).for_each(|(a, b)| faces.push(&[b, a, pole]));
            steps(sides).for_each(|(a, b)| faces.push(&[last + a, last + b, pole + 1]));
        }
    }
    Surface { positions, faces }
}

/// Each point of a ring with the next.
fn steps(sides: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..sides).map(move |i| (i, (i + 1) % sides))
}

/// Reasons why parameters are invalid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrimitiveError {
    /// A length is zero, negative, NaN or infinite.
    #[error("{name} must be above zero and finite, not {value}")]
    BadLength {
        /// Its name: `width`, `radius` ...
        name: &'static str,
        /// The given value.
        value: f64,
    },
    /// Too few subdivisions to close the shape.
    #[error("{name} needs at least {min} subdivisions, not {value}")]
    TooFewSubdivisions {
        /// Its name: `width`, `axis` ...
        name: &'static str,
        /// The given value.
        value: u32,
        /// The smallest valid number.
        min: u32,
    },
    /// The mesh would exceed the limit on points.
    #[error("the mesh would have {points} points, more than {max}")]
    TooManyPoints {
        /// The number of points that it would have.
        points: u64,
        /// The limit.
        max: u64,
    },
}

/// A hundred million points: 2.4 GB of positions.
const MAX_POINTS: u64 = 100_000_000;

/// Refuses a length that is not positive and finite.
fn check_length(name: &'static str, value: f64) -> Result<(), PrimitiveError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(PrimitiveError::BadLength { name, value }) }
}

/// Refuses fewer subdivisions than `min`.
fn check_subdivisions(name: &'static str, value: u32, min: u32) -> Result<(), PrimitiveError> {
    if value >= min { Ok(()) } else { Err(PrimitiveError::TooFewSubdivisions { name, value, min }) }
}

/// Refuses a mesh of about `across` times `along` points if that exceeds the limit.
fn check_size(across: u64, along: u64) -> Result<(), PrimitiveError> {
    let points = across.saturating_mul(along);
    if points <= MAX_POINTS { Ok(()) } else { Err(PrimitiveError::TooManyPoints { points, max: MAX_POINTS }) }
}

/// Step `k` of `steps` from -0.5 to 0.5, exactly antisymmetric.
fn even_step(k: u32, steps: u32) -> f64 {
    (2.0 * f64::from(k) - f64::from(steps)) / (2.0 * f64::from(steps))
}

#[cfg(test)]
mod tests;
