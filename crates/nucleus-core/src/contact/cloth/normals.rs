//! The normals of new contacts, eight at a time.

use crate::contact::closest_lanes::{Positions, closest, interpolate, of_lane, scaled};
use crate::contact::cloth::contact::{Candidate, positions};
use crate::contact::cloth::swept_points::ElementPoints;
use crate::contact::narrow_phase::{COINCIDENT, ElementPositions, shortest_line};
use crate::math::kernel::Kernel;
use crate::math::{Lanes, Real, Row4, dot, sub};

/// Sets the normals of candidates: along their shortest lines at the start of the time step, from theirs to ours.
pub(super) struct SetNormals<'a, R, const N: usize, const M: usize> {
    pub candidates: &'a mut [Candidate<R, N, M>],
    /// In metres, by point.
    pub anchors: &'a [[f64; 3]],
    /// Displacements at the start of the step, by point.
    pub start: &'a [Row4<R>],
    /// Whether the two cloths may overlap.
    pub may_overlap: bool,
}

impl<R: Real, const N: usize, const M: usize> Kernel<R> for SetNormals<'_, R, N, M> {
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run<L: Lanes<R>>(self) {
        let Self { candidates, anchors, start, may_overlap } = self;
        for some in candidates.chunks_mut(4 * L::GROUPS) {
            let distances = set_normals::<R, L, N, M>(some, |(ours, theirs)| {
                positions((ours, theirs), anchors, |point| start[point as usize].xyz())
            });
            if may_overlap {
                some.iter_mut()
                    .zip(distances)
                    .for_each(|(candidate, distance)| candidate.mark_overlap(distance));
            }
        }
    }
}

/// Sets the normals of no more candidates than there are lanes. Returns the distances at the start of the step in metres.
#[inline(always)]
fn set_normals<R: Real, L: Lanes<R>, const N: usize, const M: usize>(
    candidates: &mut [Candidate<R, N, M>],
    at: impl Fn(&ElementPoints<N, M>) -> ElementPositions<R, N, M>,
) -> [R; 8] {
    let (mut ours, mut theirs) = ([[[[R::ZERO; 4]; 2]; 3]; N], [[[[R::ZERO; 4]; 2]; 3]; M]);
    for lane in 0..4 * L::GROUPS {
        let at = at(&of_lane(candidates, lane).points);
        for axis in 0..3 {
            for k in 0..N {
                ours[k][axis][lane / 4][lane % 4] = at.0[k][axis];
            }
            for k in 0..M {
                theirs[k][axis][lane / 4][lane % 4] = at.1[k][axis];
            }
        }
    }
    let (ours, theirs) = (to_lanes::<R, L, N>(&ours), to_lanes::<R, L, M>(&theirs));
    let weights = closest::<R, L, N, M>(ours, theirs);
    let line = sub(interpolate(&ours, &weights.0), interpolate(&theirs, &weights.1));
    let length = dot(line, line).sqrt();
    let are_apart = (length - L::splat(R::from_f64(COINCIDENT))).above_zero();
    let normal = scaled::<R, L>(line, L::splat(R::ONE) / length);
    let mut normals = [[R::ZERO; 3]; 8];
    for axis in 0..3 {
        normal[axis]
            .for_groups(|group, four| (0..4).for_each(|lane| normals[4 * group + lane][axis] = four[lane]));
    }
    let mut distances = [R::ZERO; 8];
    length.for_groups(|group, four| distances[4 * group..4 * group + 4].copy_from_slice(&four));
    for (lane, candidate) in candidates.iter_mut().enumerate() {
        candidate.normal = match are_apart & (1 << lane) {
            0 => shortest_line(at(&candidate.points)).0,
            _ => normals[lane],
        };
    }
    distances
}

/// The lanes of positions by axis, group and lane.
#[inline(always)]
fn to_lanes<R: Real, L: Lanes<R>, const K: usize>(positions: &[[[[R; 4]; 2]; 3]; K]) -> [Positions<L>; K] {
    let mut lanes = [[L::splat(R::ZERO); 3]; K];
    for k in 0..K {
        for axis in 0..3 {
            lanes[k][axis] = L::of_groups(|group| positions[k][axis][group]);
        }
    }
    lanes
}
