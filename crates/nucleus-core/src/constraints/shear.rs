//! Shear: the cross links of quads keep their length, so that squares stay square.
//!
//! Shear rows are links like any other, swept by [`stretch::relax`](super::stretch::relax) with the strength
//! of `shearResistance`; what makes them shear is which points they join.

use super::stretch::LinkRow;
use crate::math::Real;
use crate::model::surface::Surface;
use crate::model::vertex_maps::mean;
use crate::model::{Link, shear_links};

/// The cross links of a mesh, between the solver's places of its points.
///
/// Two diagonals of stiffness k in every cell of a square grid resist shear with the modulus k, so a
/// resistance means the same stiffness here as along the edges.
///
/// `rest` are factors on their lengths at rest, point by point.
pub fn rows<R: Real>(surface: &Surface, rest: &[f64], place: impl Fn(u32) -> u32) -> Vec<LinkRow<R>> {
    let row =
        |link: &Link| LinkRow::new(link, mean(rest, link.ends.map(|end| end as usize).into_iter()), &place);
    let mut rows: Vec<LinkRow<R>> = shear_links(surface).iter().map(row).collect();
    rows.sort_unstable_by_key(|row| row.ends);
    rows
}
