//! Stretch, compression and shear: links keep their length.
//!
//! This file has their rows; [`projection`](super::projection) has their sweeps.
//!
//! Shear rows are links too: the cross links of quads, swept with the strength of `shearResistance`.

use nalgebra::Vector3;

use crate::math::{Real, Row4};
use crate::model::rows::Row;
use crate::model::surface::Surface;
use crate::model::topology::{Link, shear_links};
use crate::model::vertex_maps::mean;
use crate::model::weave::woven_links;

use super::strength_map::Sides;

/// Four links side by side. 28 bytes a link in `f32`.
#[derive(Debug, Clone, Copy)]
pub struct LinkGroup<R> {
    /// The points a and b.
    pub ends: [[u32; 4]; 2],
    /// From anchor a to anchor b in metres: x, y, z. Written at the start of each frame.
    pub span: [[R; 4]; 3],
    /// Length at rest in metres.
    pub rest_length: [R; 4],
    /// Length over width of the strip of cloth that the link stands for.
    pub slenderness: [R; 4],
}

/// A link between rows of the solver's columns, before it is laid out.
#[derive(Debug, Clone, Copy)]
pub struct LinkRow<R> {
    /// The points a and b.
    pub ends: [u32; 2],
    /// Length at rest in metres.
    pub rest_length: R,
    /// Length over width of the strip of cloth that the link stands for.
    pub slenderness: R,
    /// Squared cosine of the angle to the warp of woven cloth; 1 in other cloth.
    pub warp: R,
}

impl<R: Real> LinkRow<R> {
    /// The row of a link; `place` maps a point of the mesh to its row in the columns, `rest` is a factor on the rest
    /// length.
    pub fn new(link: &Link, rest: f64, place: impl Fn(u32) -> u32) -> Self {
        Self {
            ends: link.ends.map(place),
            rest_length: R::from_f64(link.rest_length * rest),
            slenderness: R::from_f64(link.slenderness),
            warp: R::from_f64(link.warp),
        }
    }
}

/// The shear rows of a mesh: its cross links. `rest` is the vertex map of rest length factors, `warp` the directions of
/// the warp of woven cloth.
///
/// Two diagonals of stiffness k in every cell of a square grid resist shear with the modulus k, so a resistance means
/// the same stiffness here as along the edges.
pub fn shear_rows<R: Real>(
    surface: &Surface,
    warp: &[Vector3<f64>],
    rest: &[f64],
    place: impl Fn(u32) -> u32,
) -> Vec<LinkRow<R>> {
    let row =
        |link: &Link| LinkRow::new(link, mean(rest, link.ends.map(|end| end as usize).into_iter()), &place);
    let links = if warp.is_empty() { shear_links(surface) } else { woven_links(surface, warp).cross };
    let mut rows: Vec<LinkRow<R>> = links.iter().map(row).collect();
    rows.sort_unstable_by_key(|row| row.ends);
    rows
}

impl<R: Real> Row for LinkRow<R> {
    type Group = LinkGroup<R>;
    const POINTS: usize = 2;
    const GROUPS: usize = 2;

    fn point(&self, k: usize) -> u32 {
        self.ends[k]
    }

    fn idle(padding_point: u32) -> Self {
        Self { ends: [padding_point; 2], rest_length: R::ZERO, slenderness: R::ONE, warp: R::ONE }
    }

    fn group(rows: [Self; 4]) -> LinkGroup<R> {
        LinkGroup {
            ends: [0, 1].map(|k| rows.map(|row| row.ends[k])),
            span: [[R::ZERO; 4]; 3],
            rest_length: rows.map(|row| row.rest_length),
            slenderness: rows.map(|row| row.slenderness),
        }
    }
}

/// The strength of a sweep over links.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkStrength<R> {
    /// The share of the error that a sweep removes, 0 to 1.
    pub share: Sides<R>,
    /// 1 / (stiffness h²) in 1/kg, for a link as long as it is wide; 0 is rigid.
    pub compliance: Sides<R>,
    /// Factor on all rest lengths.
    pub rest_scale: R,
}

impl<R: Real> LinkStrength<R> {
    /// The strength of each of two sweeps in turn that together are one of this strength.
    pub fn half(&self) -> Self {
        let sides =
            |Sides { above, below }: Sides<R>, of: fn(R) -> R| Sides { above: of(above), below: of(below) };
        Self {
            share: sides(self.share, |share| R::ONE - (R::ONE - share).sqrt()),
            compliance: sides(self.compliance, |compliance| compliance + compliance),
            rest_scale: self.rest_scale,
        }
    }
}

impl<R: Real> LinkGroup<R> {
    /// Updates the spans from the anchors. Differences are in double precision, so a cloth far from the origin is as
    /// exact as one near it.
    pub fn anchor(&mut self, anchors: &[[f64; 3]]) {
        for lane in 0..4 {
            let [a, b] = self.ends.map(|end| anchors[end[lane] as usize]);
            for axis in 0..3 {
                self.span[axis][lane] = R::from_f64(b[axis] - a[axis]);
            }
        }
    }

    /// The strain of each link, length over rest length minus one; 0 for a link whose rest length is zero.
    pub fn strain(&self, points: &[Row4<R>], rest_scale: R) -> [R; 4] {
        std::array::from_fn(|lane| {
            let [a, b] = self.ends.map(|end| points[end[lane] as usize].0);
            let d: [R; 3] = std::array::from_fn(|axis| self.span[axis][lane] + (b[axis] - a[axis]));
            let rest = self.rest_length[lane] * rest_scale;
            if rest > R::ZERO { crate::math::dot(d, d).sqrt() / rest - R::ONE } else { R::ZERO }
        })
    }
}
