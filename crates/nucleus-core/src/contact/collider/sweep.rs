//! One Gauss-Seidel sweep over the active contacts of a cloth and a collider.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::collider::active_set::ActiveContacts;
use crate::contact::collider::contact::{ColliderContact, Outcome};
use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::collider::plane_columns::FourPlanes;
use crate::contact::time_step::{ColliderStep, ContactCounters};
use crate::math::Real;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// Rounds over the contacts of one point while they still push.
const MAX_ROUNDS: usize = 4;

/// One sweep over the active contacts. Points go first: on a smooth surface they carry the cloth, and edges and
/// faces, which would lift one end when the other is low, then have nothing to push. Where edges or faces push,
/// points are swept again.
pub fn resolve<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
    counters: &ContactCounters,
) {
    resolve_points(list, step, pool, counters);
    let ColliderContacts { edge_edge, face_point, active, .. } = list;
    let of_edges = resolve_elements(edge_edge, &mut active.edges, step, pool, counters);
    let of_faces = resolve_elements(face_point, &mut active.faces, step, pool, counters);
    if of_edges || of_faces {
        resolve_points(list, step, pool, counters);
    }
}

/// Sweeps contacts of edges or faces, task by task. Returns whether any moved anything.
fn resolve_elements<R: Real, const N: usize, const M: usize>(
    contacts: &mut [ColliderContact<R, N, M>],
    active: &mut ActiveContacts<R, N>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
    counters: &ContactCounters,
) -> bool {
    let any = AtomicBool::new(false);
    active.for_tasks(contacts, pool, |contacts, run, planes| {
        let mut any_here = false;
        for (indices, planes) in run.chunks(4).zip(planes) {
            let below = planes.below(step.active_gap(), step.shares[1], |point| step.row(point));
            if below == 0 {
                continue;
            }
            // Those behind the first may come below their thickness by its push.
            for (lane, &index) in indices.iter().enumerate().skip(below.trailing_zeros() as usize) {
                // SAFETY: a contact belongs to one task.
                #[allow(unsafe_code)]
                let [contact] = (unsafe { contacts.run(index..index + 1) }) else { continue };
                any_here |= contact.resolve(step).count(counters);
                planes.set(lane, contact);
            }
        }
        any.fetch_or(any_here, Ordering::Relaxed);
    });
    any.into_inner()
}

/// Sweeps point-face contacts, one run of points after the other.
fn resolve_points<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
    counters: &ContactCounters,
) {
    let ColliderContacts { point_face, active, .. } = list;
    active.points.for_tasks(point_face, pool, |pairs, run, planes| {
        resolve_run(pairs, run, planes, step, counters);
    });
}

/// Resolves the contacts of a run of points. A point of which no contact is below its thickness stays where it is.
fn resolve_run<R: Real>(
    pairs: DisjointSlice<'_, ColliderContact<R, 1, 3>>,
    run: &[u32],
    planes: &mut [FourPlanes<R, 1>],
    step: &ColliderStep<'_, R>,
    counters: &ContactCounters,
) {
    // SAFETY: the contacts of a point belong to one task.
    #[allow(unsafe_code)]
    let contact = |at: usize| unsafe { pairs.get(run[at]) };
    let mut resolved = 0;
    for four in 0..planes.len() {
        let mut below = planes[four].below(step.active_gap(), step.shares[1], |point| step.row(point));
        while below != 0 {
            let at = 4 * four + below.trailing_zeros() as usize;
            below &= below - 1;
            if at < resolved {
                continue;
            }
            let points = contact(at).points;
            let first =
                (resolved..at).rev().take_while(|&k| contact(k).points == points).last().unwrap_or(at);
            let end = (at..run.len()).find(|&k| contact(k).points != points).unwrap_or(run.len());
            resolve_point(pairs, &run[first..end], step, counters);
            (first..end).for_each(|k| planes[k / 4].set(k % 4, &contact(k)));
            resolved = end;
        }
    }
}

/// Applies adhesion between every point and its nearest face.
pub fn adhere<R: Real>(list: &mut ColliderContacts<R>, step: &ColliderStep<'_, R>, pool: &ThreadPool) {
    let ColliderContacts { point_face, active, .. } = list;
    active.points.for_tasks(point_face, pool, |pairs, run, _| {
        // SAFETY: the contacts of a point belong to one task.
        #[allow(unsafe_code)]
        let contact = |index: u32| unsafe { pairs.get(index) };
        for of_point in run.chunk_by(|&a, &b| contact(a).points == contact(b).points) {
            let gaps = of_point.iter().map(|&index| (contact(index).gap(step), index));
            let nearest = gaps.reduce(|least, next| if next.0 < least.0 { next } else { least });
            nearest.into_iter().for_each(|(_, index)| contact(index).adhere(step));
        }
    });
}

/// Repeats the contacts of one point until none pushes. A point that is still reverted in the last round moves
/// with the face that it would pass: points that move with a rigid surface pass no part of it.
pub(super) fn resolve_point<R: Real>(
    pairs: DisjointSlice<'_, ColliderContact<R, 1, 3>>,
    of_point: &[u32],
    step: &ColliderStep<'_, R>,
    counters: &ContactCounters,
) {
    resolve_contacts(pairs, of_point.iter().copied(), step, counters);
}

/// The same for contacts whose indices an iterator gives.
pub fn resolve_contacts<R: Real>(
    pairs: DisjointSlice<'_, ColliderContact<R, 1, 3>>,
    of_point: impl ExactSizeIterator<Item = u32> + Clone,
    step: &ColliderStep<'_, R>,
    counters: &ContactCounters,
) {
    for round in 1..=MAX_ROUNDS {
        let (mut pushed, mut reverted) = (0, false);
        for index in of_point.clone() {
            // SAFETY: the contacts of a point belong to one task.
            #[allow(unsafe_code)]
            let [contact] = (unsafe { pairs.run(index..index + 1) }) else { continue };
            let outcome = contact.resolve(step);
            pushed += usize::from(outcome.count(counters));
            reverted |= outcome == Outcome::Reverted;
            if round == MAX_ROUNDS && outcome == Outcome::Reverted {
                return contact.move_with_surface(step);
            }
        }
        if pushed == 0 || (of_point.len() == 1 && !reverted) {
            return;
        }
    }
}
