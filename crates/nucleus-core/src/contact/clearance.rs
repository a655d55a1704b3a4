//! Clearance between surfaces that face each other: where it is less than the thicknesses of a point and both surfaces, contacts
//! keep a share of them.
//!
//! Pushed to its whole thickness by each surface in turn, a point would be thrown from one to the other and through it. The
//! shares leave clearance for both pushes. They hold for the time step in which a certificate failed; other steps have none.
//! The clearance is found in [`collider::facing`](super::collider::facing).

use crate::math::{Real, dot};

/// Smallest cosine between one normal and the opposite of the other at which two surfaces face each other: at a larger
/// angle a point finds clearance beside them.
const FACING: f64 = 0.5;

/// A surface near a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearSurface<R> {
    /// The point, by its row.
    pub point: u32,
    /// Unit normal, towards the point.
    pub normal: [R; 3],
    /// Distance of the point where it started, from the surface where it ends the time step, in metres.
    pub gap: R,
    /// The distance to keep, in metres.
    pub thickness: R,
}

/// The share of its thickness that each point has clearance for.
#[derive(Debug, Clone, Default)]
pub struct Clearance<R> {
    /// By row; empty where all points have clearance.
    shares: Vec<R>,
    /// Scratch.
    surfaces: Vec<NearSurface<R>>,
}

impl<R: Real> Clearance<R> {
    /// Whether every point has clearance for its thickness.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.shares.is_empty()
    }

    /// The share of the thickness that a contact keeps, interpolated over its points.
    #[inline(always)]
    pub fn share<const N: usize>(&self, points: [u32; N], weights: [R; N]) -> R {
        if self.shares.is_empty() {
            return R::ONE;
        }
        (0..N).map(|k| weights[k] * self.shares[points[k] as usize]).sum()
    }

    /// From now on every point has clearance.
    pub fn clear(&mut self) {
        self.shares.clear();
    }

    /// Finds the clearance of each of `rows` points, given what is near them in any order: `list` adds it.
    pub fn find(&mut self, rows: usize, list: impl FnOnce(&mut Vec<NearSurface<R>>)) {
        let Self { shares, surfaces } = self;
        shares.clear();
        surfaces.clear();
        list(surfaces);
        surfaces.sort_by_key(|surface| surface.point);
        for of_point in surfaces.chunk_by(|a, b| a.point == b.point) {
            let least = least_share(of_point);
            if least < R::ONE {
                shares.resize(rows, R::ONE);
                shares[of_point[0].point as usize] = least;
            }
        }
    }
}

/// The smallest share of any two surfaces that face each other; 1 where a point has clearance.
fn least_share<R: Real>(surfaces: &[NearSurface<R>]) -> R {
    let mut least = R::ONE;
    for (at, a) in surfaces.iter().enumerate() {
        for b in &surfaces[at + 1..] {
            if dot(a.normal, b.normal) < R::from_f64(-FACING) {
                let share = (a.gap + b.gap) / (a.thickness + b.thickness);
                least = if share < least { share } else { least };
            }
        }
    }
    if least > R::ZERO { least } else { R::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(point: u32, normal: [f64; 3], gap: f64) -> NearSurface<f64> {
        NearSurface { point, normal, gap, thickness: 2.0 }
    }

    #[test]
    fn a_point_between_surfaces_keeps_the_share_of_its_thickness_that_fits() {
        let (up, down, aside) = ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]);
        let mut clearance = Clearance::default();
        let of_one_side = [near(0, up, 0.1), near(0, up, 0.2)];
        let of_both = [near(1, up, 0.5), near(2, up, 0.1), near(1, down, 1.5), near(2, aside, 0.1)];
        clearance.find(4, |near| near.extend(of_one_side.into_iter().chain(of_both)));
        assert_eq!([0, 1, 2, 3].map(|point| clearance.share([point], [1.0])), [1.0, 0.5, 1.0, 1.0]);
        assert_eq!(clearance.share([1, 3], [0.5, 0.5]), 0.75, "an edge is interpolated");
        clearance.find(4, |near| near.extend(of_one_side));
        assert!(clearance.is_full(), "one side leaves clearance");
    }

    #[test]
    fn surfaces_that_overlap_leave_no_clearance_but_none_below_zero() {
        let mut clearance = Clearance::default();
        clearance
            .find(1, |list| list.extend([near(0, [0.0, 1.0, 0.0], -3.0), near(0, [0.0, -1.0, 0.0], 1.0)]));
        assert_eq!(clearance.share([0], [1.0]), 0.0);
    }
}
