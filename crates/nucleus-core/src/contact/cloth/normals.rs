//! The normals of new contacts, four at a time.

use crate::contact::closest_lanes::{closest, interpolate, of_lane};
use crate::contact::cloth::contact::{Candidate, positions};
use crate::contact::narrow_phase::{COINCIDENT, shortest_line};
use crate::math::{Lanes as _, Real, Row4, dot, sub};

/// Sets the normals of up to four candidates: along their shortest lines at the start of the time step, from theirs to ours.
#[inline]
pub(super) fn set_normals<R: Real, const N: usize, const M: usize>(
    four: &mut [Candidate<R, N, M>],
    anchors: &[[f64; 3]],
    start: &[Row4<R>],
) {
    let at = |candidate: &Candidate<R, N, M>| {
        let (ours, theirs) = &candidate.points;
        positions((ours, theirs), anchors, |point| start[point as usize].xyz())
    };
    let (mut ours, mut theirs) = ([[[R::ZERO; 4]; 3]; N], [[[R::ZERO; 4]; 3]; M]);
    for lane in 0..4 {
        let at = at(of_lane(four, lane));
        for axis in 0..3 {
            for k in 0..N {
                ours[k][axis][lane] = at.0[k][axis];
            }
            for k in 0..M {
                theirs[k][axis][lane] = at.1[k][axis];
            }
        }
    }
    let lanes = |position: [[R; 4]; 3]| position.map(R::Lanes::from_array);
    let (ours, theirs) = (ours.map(lanes), theirs.map(lanes));
    let weights = closest::<R, N, M>(ours, theirs);
    let line = sub(interpolate::<R, N>(&ours, &weights.0), interpolate::<R, M>(&theirs, &weights.1));
    let length = dot(line, line).sqrt();
    let are_apart = (length - R::Lanes::splat(R::from_f64(COINCIDENT))).above_zero();
    let per_length = R::Lanes::splat(R::ONE) / length;
    let normals = line.map(|axis| (axis * per_length).to_array());
    for (lane, candidate) in four.iter_mut().enumerate() {
        candidate.normal = match are_apart & (1 << lane) {
            0 => shortest_line(at(candidate)).0,
            _ => normals.map(|axis| axis[lane]),
        };
    }
}
