//! One collision pass: every pair is kept apart once, points against faces last.

use std::sync::atomic::{AtomicU64, Ordering};

use super::collider_contact::{Outcome, Pair, Proof, Step};
use super::pairs::PairList;
use crate::math::Real;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// Pairs per task of proving.
const PROOFS_PER_TASK: usize = 1024;
/// How often the pairs of one point are gone through while they still push it about.
const ROUNDS: usize = 4;

/// What collision passes have done. Whole numbers, so that the order of adding does not matter.
#[derive(Debug, Default)]
pub struct Tally {
    /// Contacts that pushed.
    pub contacts: AtomicU64,
    /// Pairs whose motion was undone or cut short, once for each time.
    pub pairs_reverted: AtomicU64,
    /// Pairs that ended a time step without proof that they are on their sides, once for each time step.
    pub pairs_unresolved: AtomicU64,
    /// Pairs found by the broad phase.
    pub pairs: AtomicU64,
    /// Runs of the broad phase.
    pub broad_phases: AtomicU64,
}

impl Tally {
    fn count(&self, outcome: Outcome) -> bool {
        match outcome {
            Outcome::Apart | Outcome::Inseparable => return false,
            Outcome::Pushed => self.contacts.fetch_add(1, Ordering::Relaxed),
            Outcome::Reverted => self.pairs_reverted.fetch_add(1, Ordering::Relaxed),
        };
        true
    }
}

/// Keeps every active pair of the list apart once. Points go first: on a smooth surface they carry the cloth,
/// and edges and faces, which would lift one end when the other is low, find nothing left to do. Where they do
/// find something, points have the last word.
pub fn resolve<R: Real>(list: &mut PairList<R>, step: &Step<'_, R>, pool: &ThreadPool, tally: &Tally) {
    settle_points(list, step, pool, tally);
    let PairList { edge_edge, face_point, active, .. } = list;
    let mut pushed = 0;
    for &pair in &active.edge_edge {
        pushed += usize::from(tally.count(edge_edge[pair as usize].resolve(step)));
    }
    for &pair in &active.face_point {
        pushed += usize::from(tally.count(face_point[pair as usize].resolve(step)));
    }
    if pushed > 0 {
        settle_points(list, step, pool, tally);
    }
}

/// How many active pairs are open and how many inseparable at the end of the step. Pairs that motion bounds certify are skipped.
pub fn prove<R: Real>(list: &mut PairList<R>, step: &Step<'_, R>, pool: &ThreadPool) -> [u64; 2] {
    let PairList { point_face, edge_edge, face_point, active, .. } = list;
    let [points, edges, faces] = &active.uncertified;
    let of_points = prove_all(point_face, points, step, pool);
    let of_edges = prove_all(edge_edge, edges, step, pool);
    let of_faces = prove_all(face_point, faces, step, pool);
    [0, 1].map(|k| of_points[k] + of_edges[k] + of_faces[k])
}

fn prove_all<R: Real, const N: usize, const M: usize>(
    pairs: &mut [Pair<R, N, M>],
    active: &[u32],
    step: &Step<'_, R>,
    pool: &ThreadPool,
) -> [u64; 2] {
    let (pairs, counts) = (DisjointSlice::new(pairs), [AtomicU64::new(0), AtomicU64::new(0)]);
    pool.parallel_for(active.len().div_ceil(PROOFS_PER_TASK), |task| {
        let end = active.len().min((task + 1) * PROOFS_PER_TASK);
        let mut counts_here = [0; 2];
        for &index in &active[task * PROOFS_PER_TASK..end] {
            // SAFETY: a pair is active once, and proofs move no point.
            #[allow(unsafe_code)]
            let [pair] = (unsafe { pairs.run(index..index + 1) }) else { continue };
            let proof = pair.prove(step);
            counts_here[0] += u64::from(proof == Proof::Open);
            counts_here[1] += u64::from(proof == Proof::Inseparable);
        }
        // Once a task: threads that count in one place wait for each other.
        (0..2).for_each(|k| _ = counts[k].fetch_add(counts_here[k], Ordering::Relaxed));
    });
    counts.map(AtomicU64::into_inner)
}

/// Takes every element of the cloth that is not proven back to where it was at the start of the step, along with
/// the surface that it would pass.
pub fn hold_back<R: Real>(
    list: &mut PairList<R>,
    step: &Step<'_, R>,
    tally: &Tally,
    hold: &mut impl FnMut(u32),
) {
    let PairList { point_face, edge_edge, face_point, active, .. } = list;
    hold_all(point_face, &active.point_face, step, tally, hold);
    hold_all(edge_edge, &active.edge_edge, step, tally, hold);
    hold_all(face_point, &active.face_point, step, tally, hold);
}

/// Tells the points of all active pairs that are not proven.
pub fn release<R: Real>(list: &mut PairList<R>, step: &Step<'_, R>, tell: &mut impl FnMut(u32)) {
    let PairList { point_face, edge_edge, face_point, active, .. } = list;
    release_all(point_face, &active.point_face, step, tell);
    release_all(edge_edge, &active.edge_edge, step, tell);
    release_all(face_point, &active.face_point, step, tell);
}

fn release_all<R: Real, const N: usize, const M: usize>(
    pairs: &mut [Pair<R, N, M>],
    active: &[u32],
    step: &Step<'_, R>,
    tell: &mut impl FnMut(u32),
) {
    for &index in active {
        let pair = &mut pairs[index as usize];
        if pair.prove(step) == Proof::Open {
            pair.points.into_iter().for_each(&mut *tell);
        }
    }
}

fn hold_all<R: Real, const N: usize, const M: usize>(
    pairs: &mut [Pair<R, N, M>],
    active: &[u32],
    step: &Step<'_, R>,
    tally: &Tally,
    hold: &mut impl FnMut(u32),
) {
    for &index in active {
        let pair = &mut pairs[index as usize];
        if pair.prove(step) == Proof::Open {
            pair.ride(step);
            pair.points.into_iter().for_each(&mut *hold);
            tally.count(Outcome::Reverted);
        }
    }
}

/// Goes through points against faces, block by block.
fn settle_points<R: Real>(list: &mut PairList<R>, step: &Step<'_, R>, pool: &ThreadPool, tally: &Tally) {
    let PairList { point_face, active, .. } = list;
    let pairs = DisjointSlice::new(point_face);
    pool.parallel_for(active.runs.len(), |block| {
        let run = &active.point_face[active.runs[block].start as usize..active.runs[block].end as usize];
        // SAFETY: the runs of two blocks share no pair, and no point.
        #[allow(unsafe_code)]
        let point = |pair: u32| unsafe { pairs.get(pair).points };
        for of_point in run.chunk_by(|&a, &b| point(a) == point(b)) {
            settle_point(pairs, of_point, step, tally);
        }
    });
}

/// Holds every point to the nearest face of the collider by what sticks.
pub fn stick<R: Real>(list: &mut PairList<R>, step: &Step<'_, R>, pool: &ThreadPool) {
    let PairList { point_face, active, .. } = list;
    let pairs = &*point_face;
    pool.parallel_for(active.runs.len(), |block| {
        let run = &active.point_face[active.runs[block].start as usize..active.runs[block].end as usize];
        for of_point in run.chunk_by(|&a, &b| pairs[a as usize].points == pairs[b as usize].points) {
            let gaps = of_point.iter().map(|&pair| (pairs[pair as usize].gap(step), pair));
            let nearest = gaps.reduce(|least, next| if next.0 < least.0 { next } else { least });
            nearest.into_iter().for_each(|(_, pair)| pairs[pair as usize].stick(step));
        }
    });
}

/// Goes through the pairs of one point until none pushes it any more. A point that is still being reverted
/// then rides along with the face that it would pass: what moves with a rigid surface passes no part of it.
fn settle_point<R: Real>(
    pairs: DisjointSlice<'_, Pair<R, 1, 3>>,
    of_point: &[u32],
    step: &Step<'_, R>,
    tally: &Tally,
) {
    for round in 1..=ROUNDS {
        let (mut pushed, mut reverted) = (0, false);
        for &index in of_point {
            // SAFETY: the pairs of a point belong to the task of its block.
            #[allow(unsafe_code)]
            let [pair] = (unsafe { pairs.run(index..index + 1) }) else { continue };
            let outcome = pair.resolve(step);
            pushed += usize::from(tally.count(outcome));
            reverted |= outcome == Outcome::Reverted;
            if round == ROUNDS && outcome == Outcome::Reverted {
                return pair.ride(step);
            }
        }
        if pushed == 0 || (of_point.len() == 1 && !reverted) {
            return;
        }
    }
}
