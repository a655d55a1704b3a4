//! The links of woven cloth: their strips of cloth, and their angles to the warp.

use nalgebra::Vector3;

use crate::model::surface::Surface;
use crate::model::topology::{Link, Polygon, across, around, distance, polygon_area, slenderness};

/// The links of woven cloth, each sorted by ends.
pub struct WovenLinks {
    /// Along the edges of the mesh.
    pub edges: Vec<Link>,
    /// Between corners of faces that are not neighbours.
    pub cross: Vec<Link>,
}

/// Links closer to warp or weft than this squared sine, half a degree, count as parallel to it: a little shear stiffness
/// is so soft beside that of the threads that rounding would show.
const PARALLEL: f64 = 1e-4;

/// A link of one face: its ends, the area of its strip in m², and its squared cosine to the warp.
type Part = ([u32; 2], f64, f64);

/// The links of woven cloth; `warp` is the direction of the warp in each face.
///
/// Where links follow warp and weft, and in quads also where they are at 45° to them, the strips are chosen so that the
/// links have the stiffness of the threads along them and that of shear across: a link at an angle φ has the modulus of
/// the cloth in its direction, which is about K_shear / (cos²φ sin²φ) off the threads. Along edges parallel to the warp,
/// diagonals of half the area of a quad each resist shear with K_shear; at 45° the roles of edges and diagonals change.
/// Between these angles, links hold shear up to three times as stiff, and the threads softer.
pub fn woven_links(surface: &Surface, warp: &[Vector3<f64>]) -> WovenLinks {
    let (mut edges, mut cross) = (Vec::new(), Vec::new());
    for (face, warp) in surface.faces.iter().zip(warp) {
        let area = polygon_area(surface, face);
        let polygon = Polygon::of(surface, face);
        let along = |ends: [u32; 2]| cosine_squared(surface, ends, warp);
        // 1 where the sides are parallel to warp or weft, 0 at 45° to them.
        let aligned = |ends: [u32; 2]| (2.0 * along(ends) - 1.0).powi(2);
        let alignment = around(face).map(aligned).sum::<f64>() / face.len() as f64;
        for ends in around(face) {
            let strip = match face.len() {
                3 => area,
                4 => area * (1.0 + alignment) / 4.0,
                _ => polygon.strip(surface, ends),
            };
            edges.push((ends, strip, along(ends)));
        }
        for ends in across(face) {
            let strip = match face.len() {
                4 => area * (2.0 - alignment) / 2.0,
                _ => polygon.strip(surface, ends),
            };
            cross.push((ends, strip, along(ends)));
        }
    }
    WovenLinks { edges: merged(surface, edges), cross: merged(surface, cross) }
}

fn cosine_squared(surface: &Surface, [a, b]: [u32; 2], warp: &Vector3<f64>) -> f64 {
    let line = surface.positions[b as usize] - surface.positions[a as usize];
    let lengths = line.norm_squared() * warp.norm_squared();
    if lengths > 0.0 { (line.dot(warp).powi(2) / lengths).min(1.0) } else { 1.0 }
}

/// One link for all parts between the same two points.
fn merged(surface: &Surface, mut parts: Vec<Part>) -> Vec<Link> {
    parts.sort_by_key(|part| part.0);
    let link = |shared: &[Part]| {
        let ends = shared[0].0;
        let rest_length = distance(surface, ends);
        let strip: f64 = shared.iter().map(|part| part.1).sum();
        let along: f64 = shared.iter().map(|part| part.1 * part.2).sum();
        let warp = if strip > 0.0 { along / strip } else { shared[0].2 };
        Link { ends, rest_length, slenderness: slenderness(rest_length, strip), warp: snapped(warp) }
    };
    parts.chunk_by(|a, b| a.0 == b.0).map(link).collect()
}

fn snapped(cosine_squared: f64) -> f64 {
    match cosine_squared {
        low if low < PARALLEL => 0.0,
        high if high > 1.0 - PARALLEL => 1.0,
        other => other,
    }
}
