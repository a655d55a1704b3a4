//! Shapes that turn about the y axis.

use nalgebra::Vector3;
use nucleus_core::{Faces, Surface};

use super::primitive::{PrimitiveError, check_length, check_size, check_subdivisions, even_step};
use crate::animation::sin_cos_degrees;

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

/// What closes the first and the last ring.
enum Ends {
    Polygons,
    Poles { bottom: f64, top: f64 },
}

/// Joins rings of `sides` points, from bottom to top, and closes the ends.
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
