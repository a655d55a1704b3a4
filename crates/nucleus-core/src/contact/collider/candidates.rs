//! Candidates: contacts of the pairs of elements whose boxes overlap, four pairs at a time.
//!
//! A pair is a candidate if the gap along its shortest line at the start of the step can fall below the interaction range
//! within the candidate interval, by the motion bounds of the cloth's points. With AVX2 the lanes are wider, found at run
//! time; they give the same bits.

use crate::contact::closest_lanes::{Positions, closest, interpolate, of_lane};
use crate::contact::collider::contact::{ColliderContact, Plane, cross_direction};
use crate::contact::collider::motion_bounds::MotionBounds;
use crate::contact::narrow_phase::COINCIDENT;
use crate::contact::time_step::ColliderStep;
use crate::math::{Lanes as _, Real, dot, sub};

type Four = <f64 as Real>::Lanes;
type FourPositions = Positions<Four>;

/// Two elements whose boxes overlap.
#[derive(Debug, Clone, Copy)]
pub struct OverlappingPair<const N: usize, const M: usize> {
    /// The cloth's points.
    pub points: [u32; N],
    /// The collider's points.
    pub collider_points: [u32; M],
    /// The collider's element, by its index in the boundary.
    pub element: u32,
}

/// Calls `found` with each pair that can touch, its plane across the shortest line.
pub fn for_candidates<R: Real, const N: usize, const M: usize>(
    pairs: &[OverlappingPair<N, M>],
    step: &ColliderStep<'_, R>,
    bounds: &MotionBounds<'_, R>,
    found: impl FnMut(&OverlappingPair<N, M>, ColliderContact<R, N, M>),
) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has AVX2.
        #[allow(unsafe_code)]
        return unsafe { for_candidates_avx2(pairs, step, bounds, found) };
    }
    for_candidates_in_fours(pairs, step, bounds, found);
}

/// # Safety
///
/// Needs a processor with AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
#[allow(unsafe_code)]
unsafe fn for_candidates_avx2<R: Real, const N: usize, const M: usize>(
    pairs: &[OverlappingPair<N, M>],
    step: &ColliderStep<'_, R>,
    bounds: &MotionBounds<'_, R>,
    found: impl FnMut(&OverlappingPair<N, M>, ColliderContact<R, N, M>),
) {
    for_candidates_in_fours(pairs, step, bounds, found);
}

#[inline(always)]
fn for_candidates_in_fours<R: Real, const N: usize, const M: usize>(
    pairs: &[OverlappingPair<N, M>],
    step: &ColliderStep<'_, R>,
    bounds: &MotionBounds<'_, R>,
    mut found: impl FnMut(&OverlappingPair<N, M>, ColliderContact<R, N, M>),
) {
    let window = step.interval.ends().map(|time| bounds.travel_at(time).map(|by| Four::splat(by.to_f64())));
    let range = Four::splat(step.interaction_range().to_f64());
    for pairs in pairs.chunks(4) {
        let four = FourPairs::new(pairs, step);
        let line = four.shortest_line();
        let planes = four.planes::<R>(line.normal);
        let mut near = (range - four.min_gap(&planes, window, pairs, bounds)).above_zero();
        near &= (1 << pairs.len()) - 1;
        if near == 0 {
            continue;
        }
        let (normals, weights) = (planes.normal.map(Four::to_array), line.weights);
        let (ours, theirs) = (weights.0.map(Four::to_array), weights.1.map(Four::to_array));
        let heights = planes.heights.map(Four::to_array);
        let offsets = planes.offsets.map(|of_points| of_points.map(Four::to_array));
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            let plane = Plane {
                normal: normals.map(|axis| R::from_f64(axis[lane])),
                heights: heights.map(|height| height[lane]),
                offsets: offsets.map(|of_points| of_points.map(|of_point| R::from_f64(of_point[lane]))),
            };
            let weights = (ours.map(|weight| weight[lane]), theirs.map(|weight| weight[lane]));
            let pair = &pairs[lane];
            found(pair, ColliderContact::across(pair.points, pair.collider_points, plane, weights, step));
        }
    }
}

/// Four pairs of elements, by lane.
struct FourPairs<const N: usize, const M: usize> {
    anchors: [FourPositions; N],
    /// Positions at the start of the step.
    ours: [FourPositions; N],
    theirs: [FourPositions; M],
    /// Positions of the collider at the start and at the end of the candidate interval.
    their_ends: [[FourPositions; M]; 2],
}

/// The shortest lines of four pairs: unit directions, and the ends as weights.
struct FourLines<const N: usize, const M: usize> {
    normal: FourPositions,
    weights: ([Four; N], [Four; M]),
}

/// The planes of four contacts: normals rounded to the solver's scalar, and the height and the offset for each point at the
/// start and at the end of the candidate interval.
struct CandidatePlanes<const N: usize> {
    normal: FourPositions,
    heights: [Four; 2],
    offsets: [[Four; N]; 2],
}

impl<const N: usize, const M: usize> FourPairs<N, M> {
    /// Gathers up to four pairs.
    #[inline(always)]
    fn new<R: Real>(pairs: &[OverlappingPair<N, M>], step: &ColliderStep<'_, R>) -> Self {
        let (mut anchors, mut displacements) = ([[[0.0; 4]; 3]; N], [[[0.0; 4]; 3]; N]);
        let (mut from, mut to) = ([[[0.0; 4]; 3]; M], [[[0.0; 4]; 3]; M]);
        for lane in 0..4 {
            let pair = of_lane(pairs, lane);
            for k in 0..N {
                let (anchor, moved) = (step.anchors[pair.points[k] as usize], step.start(pair.points[k]));
                for axis in 0..3 {
                    anchors[k][axis][lane] = anchor[axis];
                    displacements[k][axis][lane] = moved[axis].to_f64();
                }
            }
            for k in 0..M {
                let point = pair.collider_points[k] as usize;
                for axis in 0..3 {
                    from[k][axis][lane] = step.collider[0][point][axis];
                    to[k][axis][lane] = step.collider[1][point][axis];
                }
            }
        }
        let of = |position: [[f64; 4]; 3]| position.map(Four::from_array);
        let (anchors, displacements) = (anchors.map(of), displacements.map(of));
        let (from, to) = (from.map(of), to.map(of));
        let mut ours = anchors;
        for k in 0..N {
            for axis in 0..3 {
                ours[k][axis] = anchors[k][axis] + displacements[k][axis];
            }
        }
        let at = |time: f64| {
            let mut position = from;
            for k in 0..M {
                for axis in 0..3 {
                    let travel = to[k][axis] - from[k][axis];
                    position[k][axis] = from[k][axis] + travel * Four::splat(time);
                }
            }
            position
        };
        Self { anchors, ours, theirs: at(step.time.start), their_ends: step.interval.ends().map(at) }
    }

    #[inline(always)]
    fn shortest_line(&self) -> FourLines<N, M> {
        let weights = closest::<f64, Four, N, M>(self.ours, self.theirs);
        let line = sub(interpolate(&self.ours, &weights.0), interpolate(&self.theirs, &weights.1));
        let length = dot(line, line).sqrt();
        let mut normal = line.map(|along| along / length);
        let apart = (length - Four::splat(COINCIDENT)).above_zero();
        if apart != 0b1111 {
            self.set_touching(&mut normal, !apart);
        }
        FourLines { normal, weights }
    }

    /// Sets the normals of pairs that touch: across both elements.
    #[cold]
    fn set_touching(&self, normal: &mut FourPositions, lanes: u32) {
        let mut axes = normal.map(Four::to_array);
        for lane in (0..4).filter(|lane| lanes & (1 << lane) != 0) {
            let of = |at: &FourPositions| at.map(|axis| axis.to_array()[lane]).into();
            let across = cross_direction(self.ours.each_ref().map(of), self.theirs.each_ref().map(of));
            let across = across.try_normalize(0.0).unwrap_or_else(nalgebra::Vector3::y);
            (0..3).for_each(|axis| axes[axis][lane] = across[axis]);
        }
        *normal = axes.map(Four::from_array);
    }

    /// The planes with these normals.
    #[inline(always)]
    fn planes<R: Real>(&self, normal: FourPositions) -> CandidatePlanes<N> {
        // Rounds first, so that offset and direction belong together to the last bit.
        let normal = normal.map(|axis| Four::from_array(axis.to_array().map(|x| R::from_f64(x).to_f64())));
        let (mut heights, mut offsets) = ([Four::splat(0.0); 2], [[Four::splat(0.0); N]; 2]);
        for (end, offsets) in offsets.iter_mut().enumerate() {
            let theirs = &self.their_ends[end];
            let mut highest = dot(normal, theirs[0]);
            for position in &theirs[1..] {
                highest = highest.most(dot(normal, *position));
            }
            heights[end] = highest;
            for k in 0..N {
                offsets[k] = highest - dot(normal, self.anchors[k]);
            }
        }
        CandidatePlanes { normal, heights, offsets }
    }

    /// The smallest gap along each plane over the motion bounds, at the start and at the end of the candidate interval.
    #[inline(always)]
    fn min_gap<R: Real>(
        &self,
        planes: &CandidatePlanes<N>,
        window: [FourPositions; 2],
        pairs: &[OverlappingPair<N, M>],
        bounds: &MotionBounds<'_, R>,
    ) -> Four {
        let mut least = Four::splat(f64::MAX);
        for k in 0..N {
            let (mut low, mut high) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
            for lane in 0..4 {
                let pair = of_lane(pairs, lane);
                let bound = bounds.of(pair.points[k]);
                for axis in 0..3 {
                    low[axis][lane] = bound[0].0[axis].to_f64();
                    high[axis][lane] = bound[1].0[axis].to_f64();
                }
            }
            let (low, high) = (low.map(Four::from_array), high.map(Four::from_array));
            let mut corner = low;
            for axis in 0..3 {
                corner[axis] = planes.normal[axis].choose_by_sign(low[axis], high[axis]);
            }
            let lowest = dot(planes.normal, corner);
            for end in 0..2 {
                let motion = dot(planes.normal, window[end]);
                least = least.least(lowest + motion - planes.offsets[end][k]);
            }
        }
        least
    }
}
