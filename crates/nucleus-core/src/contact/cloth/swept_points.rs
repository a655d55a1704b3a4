//! The swept positions of points over a candidate interval in single precision, and lower bounds on the distance of two
//! elements from them.

use std::ops::Range;

use crate::contact::closest_lanes::{Positions, closest, interpolate, of_lane, scaled};
use crate::contact::cloth::local_origins::{OriginShift, ROUNDING};
use crate::contact::cloth::motion_bounds::Trajectory;
use crate::math::{Lanes, Real, dot, sub};
use crate::parallel::disjoint::DisjointSlice;
use crate::particles::population::close_up;

/// The points of two elements.
pub type ElementPoints<const N: usize, const M: usize> = ([u32; N], [u32; M]);

/// The swept position of each point.
#[derive(Debug, Default)]
pub struct SweptPoints {
    /// Position at the start and at the end in metres from the origin of its cloth, and the radius around both.
    ends: Vec<[[f32; 4]; 2]>,
}

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
}

/// The swept positions of the points of two cloths, or of one, relative to one origin.
pub struct PairPoints<'a> {
    pub points: &'a SweptPoints,
    /// The cloth whose positions are relative to another origin, if there is one.
    pub shifted: Option<ShiftedCloth<'a>>,
}

/// A cloth whose positions are shifted.
pub struct ShiftedCloth<'a> {
    /// The cloth of each point.
    pub of_point: &'a [u32],
    pub cloth: u32,
    pub shift: OriginShift,
}

impl PairPoints<'_> {
    /// Lower bounds on the distances of up to eight pairs in metres, from a share of the candidate interval on.
    #[inline(always)]
    pub fn min_distances<L: Lanes<f32>, const N: usize, const M: usize>(
        &self,
        pairs: &[ElementPoints<N, M>],
        share: f32,
    ) -> L {
        let (ours, theirs) = self.swept_pairs(pairs, share);
        let starts = (starts(&ours), starts(&theirs));
        let weights = closest::<f32, L, N, M>(starts.0, starts.1);
        let line = sub(interpolate(&starts.0, &weights.0), interpolate(&starts.1, &weights.1));
        let length = dot(line, line).sqrt();
        let per_length = length.choose_by_sign(L::splat(1.0) / length, L::splat(0.0));
        let normal = scaled::<f32, L>(line, per_length);
        let radii = largest_radius(&ours) + largest_radius(&theirs);
        length.least(gap_along(normal, (&ours, &theirs), 1)) - radii
    }

    /// One bit for each of up to eight pairs that keep `enough` metres from a share of the candidate interval on, along the
    /// line between their centroids: most pairs whose boxes overlap do, and eight take as long as one.
    #[inline(always)]
    pub fn separated_centroids<L: Lanes<f32>, const N: usize, const M: usize>(
        &self,
        pairs: &[ElementPoints<N, M>],
        share: f32,
        enough: f32,
    ) -> u32 {
        let (ours, theirs) = self.swept_pairs::<L, N, M>(pairs, share);
        let line = sub(centroids(&ours), centroids(&theirs));
        let start = gap_along(line, (&ours, &theirs), 0);
        let end = gap_along(line, (&ours, &theirs), 1);
        let needed = L::splat(enough) + largest_radius(&ours) + largest_radius(&theirs);
        let length = dot(line, line).sqrt();
        !(needed * length - start.least(end)).above_zero() & length.above_zero()
    }

    /// The points of up to eight pairs by lane; the first pair fills the lanes that are left.
    #[inline(always)]
    fn swept_pairs<L: Lanes<f32>, const N: usize, const M: usize>(
        &self,
        pairs: &[ElementPoints<N, M>],
        share: f32,
    ) -> ([SweptLanes<L>; N], [SweptLanes<L>; M]) {
        let mut ours = [self.swept_lanes(|lane| of_lane(pairs, lane).0[0], share); N];
        for k in 1..N {
            ours[k] = self.swept_lanes(|lane| of_lane(pairs, lane).0[k], share);
        }
        let mut theirs = [self.swept_lanes(|lane| of_lane(pairs, lane).1[0], share); M];
        for k in 1..M {
            theirs[k] = self.swept_lanes(|lane| of_lane(pairs, lane).1[k], share);
        }
        (ours, theirs)
    }

    /// The point of each lane.
    #[inline(always)]
    fn swept_lanes<L: Lanes<f32>>(&self, point: impl Fn(usize) -> u32, share: f32) -> SweptLanes<L> {
        let mut ends = [[L::splat(0.0); 4]; 2];
        for (end, rows) in ends.iter_mut().enumerate() {
            for (k, row) in rows.iter_mut().enumerate() {
                *row = L::of_groups(|group| self.points.ends[point(4 * group + k) as usize][end]);
            }
        }
        let ([mut x, mut y, mut z, mut radius], [mut u, mut v, mut w, _]) =
            (L::transpose(ends[0]), L::transpose(ends[1]));
        if let Some(shifted) = &self.shifted {
            let [dx, dy, dz, rounding] = shifted.lanes::<L>(point);
            (x, y, z, radius) = (x + dx, y + dy, z + dz, radius + rounding);
            (u, v, w) = (u + dx, v + dy, w + dz);
        }
        let mut start = [x, y, z];
        if share > 0.0 {
            let share = L::splat(share);
            start = [x + (u - x) * share, y + (v - y) * share, z + (w - z) * share];
        }
        SweptLanes { ends: [start, [u, v, w]], radius }
    }
}

impl ShiftedCloth<'_> {
    /// The shift of the point of each lane and its rounding error, in metres; zero for points of the other cloth.
    #[inline(always)]
    fn lanes<L: Lanes<f32>>(&self, point: impl Fn(usize) -> u32) -> [L; 4] {
        let ([x, y, z], rounding) = (self.shift.metres, self.shift.rounding);
        let mut rows = [L::splat(0.0); 4];
        for (k, row) in rows.iter_mut().enumerate() {
            *row = L::of_groups(|group| {
                let is_shifted = self.of_point[point(4 * group + k) as usize] == self.cloth;
                if is_shifted { [x, y, z, rounding] } else { [0.0; 4] }
            });
        }
        L::transpose(rows)
    }
}

/// Swept positions by lane. All that follows is in loops: maps over arrays of lanes are not compiled for them.
#[derive(Clone, Copy)]
struct SweptLanes<L> {
    ends: [Positions<L>; 2],
    radius: L,
}

/// The smallest gaps of pairs along a direction each, at the start or at the end.
#[inline(always)]
fn gap_along<L: Lanes<f32>, const N: usize, const M: usize>(
    direction: Positions<L>,
    (ours, theirs): (&[SweptLanes<L>; N], &[SweptLanes<L>; M]),
    end: usize,
) -> L {
    let (mut low, mut high) = (dot(direction, ours[0].ends[end]), dot(direction, theirs[0].ends[end]));
    for point in &ours[1..] {
        low = low.least(dot(direction, point.ends[end]));
    }
    for point in &theirs[1..] {
        high = high.most(dot(direction, point.ends[end]));
    }
    low - high
}

/// The centroids of elements at the start.
#[inline(always)]
fn centroids<L: Lanes<f32>, const K: usize>(points: &[SweptLanes<L>; K]) -> Positions<L> {
    let mut sum = points[0].ends[0];
    for point in &points[1..] {
        for axis in 0..3 {
            sum[axis] = sum[axis] + point.ends[0][axis];
        }
    }
    let share = L::splat(1.0 / K as f32);
    [sum[0] * share, sum[1] * share, sum[2] * share]
}

#[inline(always)]
fn largest_radius<L: Lanes<f32>, const K: usize>(points: &[SweptLanes<L>; K]) -> L {
    let mut most = points[0].radius;
    for point in &points[1..] {
        most = most.most(point.radius);
    }
    most
}

#[inline(always)]
fn starts<L: Lanes<f32>, const K: usize>(points: &[SweptLanes<L>; K]) -> [Positions<L>; K] {
    let mut starts = [points[0].ends[0]; K];
    for k in 1..K {
        starts[k] = points[k].ends[0];
    }
    starts
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::contact::narrow_phase::shortest_line;
    use crate::math::{Quad, Two, add, scale};

    type Plain = Two<Quad<f32>>;

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
            let points = &SweptPoints { ends };
            let pairs = PairPoints { points, shifted: None };
            let edges: Vec<ElementPoints<2, 2>> = (0..4).map(|k| ([4 * k, 4 * k + 1], [4 * k + 2, 4 * k + 3])).collect();
            let faces: Vec<ElementPoints<1, 3>> = (0..4).map(|k| ([4 * k], [4 * k + 1, 4 * k + 2, 4 * k + 3])).collect();
            let least = |lanes: Plain| lanes.to_array().concat();
            let (of_edges, of_faces) = (least(pairs.min_distances(&edges, share)), least(pairs.min_distances(&faces, share)));
            for lane in 0..4 {
                let nearest = [points.nearest(edges[lane], share), points.nearest(faces[lane], share)];
                for (least, nearest) in [of_edges[lane], of_faces[lane]].into_iter().zip(nearest) {
                    prop_assert!(least <= nearest + 1e-5);
                    // The direction of a short line is less exact. Of two edges that are equally near within rounding
                    // either is taken: the direction is exact to the square root of the rounding, at lengths up to 2.
                    prop_assert!(moves || nearest < 0.1 || least >= nearest - 2.0 * f32::EPSILON.sqrt());
                }
                // A pair has the same bits by itself.
                prop_assert_eq!(least(pairs.min_distances(&faces[lane..=lane], share))[0], of_faces[lane]);
            }
        }

        #[test]
        fn two_cloths_with_origins_of_their_own_are_as_far_apart_as_with_one_origin(
            ends in proptest::collection::vec(proptest::array::uniform2(proptest::array::uniform4(-1.0..1.0f32)), 8),
            shift in proptest::array::uniform3(-30.0..30.0f32),
        ) {
            let ends: Vec<_> = ends.into_iter().map(|ends| ends.map(|[x, y, z, radius]| [x, y, z, 0.1 * radius.abs()])).collect();
            let common = SweptPoints { ends };
            // Points below four are in the first cloth, whose origin is elsewhere.
            let mut own = SweptPoints { ends: common.ends.clone() };
            own.ends[..4].iter_mut().flatten().for_each(|end| (0..3).for_each(|axis| end[axis] -= shift[axis]));
            let [x, y, z] = shift.map(f32::abs);
            let rounding = (x + y + z) * ROUNDING;
            let shift = OriginShift { metres: shift, rounding };
            let of_point: Vec<u32> = (0..8).map(|point| point / 4).collect();
            let shifted = ShiftedCloth { of_point: &of_point, cloth: 0, shift };
            let [own, common] = [(&own, Some(shifted)), (&common, None)].map(|(points, shifted)| PairPoints { points, shifted });
            let edges: [ElementPoints<2, 2>; 2] = [([0, 1], [4, 5]), ([6, 7], [2, 3])];
            let faces: [ElementPoints<1, 3>; 2] = [([0], [5, 6, 7]), ([4], [1, 2, 3])];
            let least = |pairs: &PairPoints<'_>| {
                let of_faces: Plain = pairs.min_distances(&faces, 0.0);
                let of_edges: Plain = pairs.min_distances(&edges, 0.0);
                let both = [of_faces, of_edges].map(|lanes| lanes.to_array().concat());
                [both[0][0], both[0][1], both[1][0], both[1][1]]
            };
            let points = common.points;
            let nearest = [
                points.nearest(faces[0], 0.0), points.nearest(faces[1], 0.0),
                points.nearest(edges[0], 0.0), points.nearest(edges[1], 0.0),
            ];
            for ((own, common), nearest) in least(&own).into_iter().zip(least(&common)).zip(nearest) {
                prop_assert!(own <= nearest + 1e-5);
                // The direction of a short line is less exact.
                prop_assert!(common < 0.1 || own > common - 3.0 * rounding - 1e-3, "{own} and {common}");
            }
        }

        #[test]
        fn pairs_with_separated_centroids_are_at_least_that_far_apart(
            ends in proptest::collection::vec(proptest::array::uniform2(proptest::array::uniform4(-1.0..1.0f32)), 20),
            share in 0.0..1.0f32,
            enough in 0.0..0.2f32,
        ) {
            let ends = ends.into_iter().map(|ends| ends.map(|[x, y, z, radius]| [x, y, z, 0.1 * radius.abs()])).collect();
            let points = &SweptPoints { ends };
            let pairs = PairPoints { points, shifted: None };
            let edges: Vec<ElementPoints<2, 2>> = (0..4).map(|k| ([4 * k, 4 * k + 1], [4 * k + 2, 4 * k + 3])).collect();
            let faces: Vec<ElementPoints<1, 3>> = (0..3).map(|k| ([4 * k], [4 * k + 1, 4 * k + 2, 4 * k + 3])).collect();
            let of_edges = pairs.separated_centroids::<Plain, 2, 2>(&edges, share, enough);
            let of_faces = pairs.separated_centroids::<Plain, 1, 3>(&faces, share, enough);
            for lane in 0..4 {
                if of_edges & (1 << lane) != 0 {
                    prop_assert!(points.nearest(edges[lane], share) >= enough - 1e-5);
                }
                if lane < 3 && of_faces & (1 << lane) != 0 {
                    prop_assert!(points.nearest(faces[lane], share) >= enough - 1e-5);
                }
                // A pair has the same bit by itself.
                prop_assert_eq!(pairs.separated_centroids::<Plain, 2, 2>(&edges[lane..=lane], share, enough) & 1, of_edges >> lane & 1);
            }
        }
    }
}
