//! The swept positions of points over a candidate interval in single precision, and lower bounds on the distance of two
//! elements from them.

use std::ops::Range;

use crate::contact::closest_lanes::{Four, closest, interpolate, of_lane};
use crate::contact::cloth::motion_bounds::Trajectory;
use crate::math::{Lanes as _, Real, dot, sub};
use crate::parallel::disjoint::DisjointSlice;
use crate::particles::population::close_up;

/// The points of two elements.
pub type ElementPoints<const N: usize, const M: usize> = ([u32; N], [u32; M]);

/// The swept position of each point.
#[derive(Debug, Default)]
pub struct SweptPoints {
    /// Position at the start and at the end in metres from a common origin, and the radius around both.
    ends: Vec<[[f32; 4]; 2]>,
}

/// Relative rounding error of a position.
pub const ROUNDING: f32 = 1e-6;

/// The positions of a point at the start and at the end, and the radius around both, from its trajectory. `anchor` is in
/// metres from the origin.
#[inline]
pub fn swept_point<R: Real>(trajectory: &Trajectory<R>, anchor: [f64; 3]) -> [[f32; 4]; 2] {
    let [start, end] = [R::ZERO, R::ONE].map(|share| {
        let moved = trajectory.at(share);
        std::array::from_fn::<f32, 3, _>(|axis| (anchor[axis] + moved[axis].to_f64()) as f32)
    });
    let size = |[x, y, z]: [f32; 3]| x.abs() + y.abs() + z.abs();
    let radius = trajectory.radius.to_f64() as f32 + (size(start) + size(end)) * ROUNDING;
    [start, end].map(|[x, y, z]| [x, y, z, radius])
}

impl SweptPoints {
    /// Resizes to `points` points.
    pub fn resize(&mut self, points: usize) {
        self.ends.resize(points, [[0.0; 4]; 2]);
    }

    /// Follows the particles of an object whose rows are closed up; `kept` are the places of those that remain.
    pub fn close_up(&mut self, rows: Range<usize>, kept: &[u32]) {
        close_up(self.ends.get_mut(rows).unwrap_or_default(), kept);
    }

    /// A view through which tasks set points of their own, each to what [`swept_point`] gives.
    pub fn shared(&mut self) -> DisjointSlice<'_, [[f32; 4]; 2]> {
        DisjointSlice::new(&mut self.ends)
    }

    /// Lower bounds on the distances of up to four pairs in metres, from a share of the candidate interval on.
    #[inline(always)]
    pub fn min_distances<const N: usize, const M: usize>(
        &self,
        pairs: &[ElementPoints<N, M>],
        share: f32,
    ) -> [f32; 4] {
        let (ours, theirs) = self.four_pairs(pairs, share);
        let starts = (ours.map(|point| point.ends[0]), theirs.map(|point| point.ends[0]));
        let weights = closest::<f32, N, M>(starts.0, starts.1);
        let line =
            sub(interpolate::<f32, N>(&starts.0, &weights.0), interpolate::<f32, M>(&starts.1, &weights.1));
        let length = dot(line, line).sqrt();
        let (zero, one) = (FourLanes::splat(0.0), FourLanes::splat(1.0));
        let per_length = length.choose_by_sign(one / length, zero);
        let normal = line.map(|axis| axis * per_length);
        let radii = largest_radius(&ours) + largest_radius(&theirs);
        let least = length.least(gap_along(normal, (&ours, &theirs), 1)) - radii;
        least.to_array()
    }

    /// One bit for each of up to four pairs that keep `enough` metres from a share of the candidate interval on, along the
    /// line between their centroids: most pairs whose boxes overlap do, and four take as long as one.
    #[inline(always)]
    pub fn separated_centroids<const N: usize, const M: usize>(
        &self,
        pairs: &[ElementPoints<N, M>],
        share: f32,
        enough: f32,
    ) -> u32 {
        let (ours, theirs) = self.four_pairs(pairs, share);
        let line = sub(centroids(&ours), centroids(&theirs));
        let [start, end] = [0, 1].map(|end| gap_along(line, (&ours, &theirs), end));
        let needed = FourLanes::splat(enough) + largest_radius(&ours) + largest_radius(&theirs);
        let length = dot(line, line).sqrt();
        !(needed * length - start.least(end)).above_zero() & length.above_zero()
    }

    /// The points of up to four pairs by lane; the first pair fills the lanes that are left.
    #[inline(always)]
    fn four_pairs<const N: usize, const M: usize>(
        &self,
        pairs: &[ElementPoints<N, M>],
        share: f32,
    ) -> ([FourPoints; N], [FourPoints; M]) {
        let [a, b, c, d] = [0, 1, 2, 3].map(|lane| of_lane(pairs, lane));
        let mut ours = [self.four([a.0[0], b.0[0], c.0[0], d.0[0]], share); N];
        for k in 1..N {
            ours[k] = self.four([a.0[k], b.0[k], c.0[k], d.0[k]], share);
        }
        let mut theirs = [self.four([a.1[0], b.1[0], c.1[0], d.1[0]], share); M];
        for k in 1..M {
            theirs[k] = self.four([a.1[k], b.1[k], c.1[k], d.1[k]], share);
        }
        (ours, theirs)
    }

    /// Four points by lane.
    #[inline(always)]
    fn four(&self, points: [u32; 4], share: f32) -> FourPoints {
        let [a, b, c, d] = points.map(|point| self.ends[point as usize].map(FourLanes::from_array));
        let [x, y, z, radius] = FourLanes::transpose([a[0], b[0], c[0], d[0]]);
        let [u, v, w, _] = FourLanes::transpose([a[1], b[1], c[1], d[1]]);
        let mut start = [x, y, z];
        if share > 0.0 {
            let share = FourLanes::splat(share);
            start = [x + (u - x) * share, y + (v - y) * share, z + (w - z) * share];
        }
        FourPoints { ends: [start, [u, v, w]], radius }
    }
}

type FourLanes = Four<f32>;

/// The swept positions of four points, by lane.
#[derive(Clone, Copy)]
struct FourPoints {
    ends: [[FourLanes; 3]; 2],
    radius: FourLanes,
}

/// The smallest gaps of four pairs along a direction each, at the start or at the end.
#[inline(always)]
fn gap_along<const N: usize, const M: usize>(
    direction: [FourLanes; 3],
    (ours, theirs): (&[FourPoints; N], &[FourPoints; M]),
    end: usize,
) -> FourLanes {
    let (mut low, mut high) = (dot(direction, ours[0].ends[end]), dot(direction, theirs[0].ends[end]));
    for point in &ours[1..] {
        low = low.least(dot(direction, point.ends[end]));
    }
    for point in &theirs[1..] {
        high = high.most(dot(direction, point.ends[end]));
    }
    low - high
}

/// The centroids of four elements at the start.
#[inline(always)]
fn centroids<const K: usize>(points: &[FourPoints; K]) -> [FourLanes; 3] {
    let mut sum = points[0].ends[0];
    for point in &points[1..] {
        for axis in 0..3 {
            sum[axis] = sum[axis] + point.ends[0][axis];
        }
    }
    let share = FourLanes::splat(1.0 / K as f32);
    [sum[0] * share, sum[1] * share, sum[2] * share]
}

#[inline(always)]
fn largest_radius<const K: usize>(points: &[FourPoints; K]) -> FourLanes {
    points[1..].iter().fold(points[0].radius, |most, point| most.most(point.radius))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::contact::narrow_phase::shortest_line;
    use crate::math::{add, scale};

    impl SweptPoints {
        /// The least distance of two elements without their radii, at both ends.
        fn nearest<const N: usize, const M: usize>(&self, pair: ElementPoints<N, M>, share: f32) -> f32 {
            let xyz = |[x, y, z, _]: [f32; 4]| [x, y, z];
            let ends_from = |point: u32| {
                let [start, end] = self.ends[point as usize];
                let (first, last) = (xyz(start), xyz(end));
                ([add(first, scale(sub(last, first), share)), last], start[3])
            };
            let (ours, theirs) = (pair.0.map(ends_from), pair.1.map(ends_from));
            let largest = |radius: f32, &(_, next): &([[f32; 3]; 2], f32)| radius.max(next);
            let radius = ours.iter().fold(0.0, largest) + theirs.iter().fold(0.0, largest);
            let at = |end: usize| shortest_line((ours.map(|p| p.0[end]), theirs.map(|p| p.0[end]))).2;
            at(0).min(at(1)) - radius
        }
    }

    proptest! {
        #[test]
        fn least_distances_bound_the_motion_and_are_the_distance_without_motion(
            ends in proptest::collection::vec(proptest::array::uniform2(proptest::array::uniform4(-1.0..1.0f32)), 20),
            share in 0.0..1.0f32,
            moves: bool,
        ) {
            let end = |[start, end]: [[f32; 4]; 2]| [start, if moves { end } else { start }];
            let ends = ends.into_iter().map(|ends| end(ends).map(|[x, y, z, radius]| [x, y, z, 0.1 * radius.abs()])).collect();
            let points = SweptPoints { ends };
            let edges: Vec<ElementPoints<2, 2>> = (0..4).map(|k| ([4 * k, 4 * k + 1], [4 * k + 2, 4 * k + 3])).collect();
            let faces: Vec<ElementPoints<1, 3>> = (0..4).map(|k| ([4 * k], [4 * k + 1, 4 * k + 2, 4 * k + 3])).collect();
            let (of_edges, of_faces) = (points.min_distances(&edges, share), points.min_distances(&faces, share));
            for lane in 0..4 {
                let nearest = [points.nearest(edges[lane], share), points.nearest(faces[lane], share)];
                for (least, nearest) in [of_edges[lane], of_faces[lane]].into_iter().zip(nearest) {
                    prop_assert!(least <= nearest + 1e-5);
                    // The direction of a short line is less exact. Of two edges that are equally near within rounding
                    // either is taken: the direction is exact to the square root of the rounding, at lengths up to 2.
                    prop_assert!(moves || nearest < 0.1 || least >= nearest - 2.0 * f32::EPSILON.sqrt());
                }
                // A pair has the same bits by itself.
                prop_assert_eq!(points.min_distances(&faces[lane..=lane], share)[0], of_faces[lane]);
            }
        }

        #[test]
        fn pairs_with_separated_centroids_are_at_least_that_far_apart(
            ends in proptest::collection::vec(proptest::array::uniform2(proptest::array::uniform4(-1.0..1.0f32)), 20),
            share in 0.0..1.0f32,
            enough in 0.0..0.2f32,
        ) {
            let ends = ends.into_iter().map(|ends| ends.map(|[x, y, z, radius]| [x, y, z, 0.1 * radius.abs()])).collect();
            let points = SweptPoints { ends };
            let edges: Vec<ElementPoints<2, 2>> = (0..4).map(|k| ([4 * k, 4 * k + 1], [4 * k + 2, 4 * k + 3])).collect();
            let faces: Vec<ElementPoints<1, 3>> = (0..3).map(|k| ([4 * k], [4 * k + 1, 4 * k + 2, 4 * k + 3])).collect();
            let of_edges = points.separated_centroids(&edges, share, enough);
            let of_faces = points.separated_centroids(&faces, share, enough);
            for lane in 0..4 {
                if of_edges & (1 << lane) != 0 {
                    prop_assert!(points.nearest(edges[lane], share) >= enough - 1e-5);
                }
                if lane < 3 && of_faces & (1 << lane) != 0 {
                    prop_assert!(points.nearest(faces[lane], share) >= enough - 1e-5);
                }
                // A pair has the same bit by itself.
                prop_assert_eq!(points.separated_centroids(&edges[lane..=lane], share, enough) & 1, of_edges >> lane & 1);
            }
        }
    }
}
