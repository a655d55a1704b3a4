//! The contacts of one kind with a collider.
//!
//! A search replaces the contacts of points with new bounds: their places become vacant, and what it finds goes to the end.
//! The order of contacts is that in which they were found, whenever vacant places are given up.
//! What decides whether a contact is looked at, its points and until when it is idle, is in a column of its own: a search and
//! a selection pass over all contacts, and read few of them.

use std::mem::MaybeUninit;
use std::ops::{Deref, DerefMut};
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::bytes::{Encode, Reader};
use crate::contact::collider::contact::ColliderContact;
use crate::math::{Real, Row4};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// A list of contacts, some of whose places are vacant.
#[derive(Debug)]
pub struct ContactList<R, const N: usize, const M: usize> {
    places: Vec<ColliderContact<R, N, M>>,
    /// One for each place.
    idle: Vec<IdleUntil<R, N>>,
    vacant: usize,
    /// Where what each search task has found begins.
    firsts: Vec<u32>,
}

/// Until when the contact of a place is idle.
#[derive(Debug, Clone, Copy)]
pub struct IdleUntil<R, const N: usize> {
    /// The cloth's points; [`VACANT`] in a vacant place.
    points: [u32; N],
    /// Growth of the points' window bounds in this frame up to which the contact certainly stays inactive; zero where that
    /// is not known.
    growth: [R; N],
}

/// The points of a vacant place.
const VACANT: u32 = u32::MAX;

impl<R: Real, const N: usize> IdleUntil<R, N> {
    /// Of a contact that is not known to be idle.
    fn unknown(points: [u32; N]) -> Self {
        Self { points, growth: [R::ZERO; N] }
    }

    /// Whether the place is vacant.
    #[inline(always)]
    pub fn is_vacant(&self) -> bool {
        self.points[0] == VACANT
    }

    /// Whether the contact certainly stays inactive, given the growth of each point's window bounds in this frame.
    #[inline(always)]
    pub fn is_idle(&self, growth: &[R]) -> bool {
        (0..N).all(|k| growth[self.points[k] as usize] < self.growth[k])
    }

    /// Notes that the gap exceeds the range by `slack` metres, for growth of the bounds by as much; the collider is at rest.
    #[inline(always)]
    pub fn set(&mut self, slack: R, growth: &[R]) {
        self.growth = self.points.map(|point| growth[point as usize] + slack);
    }
}

/// Places per task.
pub const PLACES_PER_TASK: usize = 1024;

impl<R, const N: usize, const M: usize> Default for ContactList<R, N, M> {
    fn default() -> Self {
        Self { places: Vec::new(), idle: Vec::new(), vacant: 0, firsts: Vec::new() }
    }
}

/// All places, the vacant ones among them.
impl<R, const N: usize, const M: usize> Deref for ContactList<R, N, M> {
    type Target = [ColliderContact<R, N, M>];
    fn deref(&self) -> &Self::Target {
        &self.places
    }
}

impl<R, const N: usize, const M: usize> DerefMut for ContactList<R, N, M> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.places
    }
}

impl<R: Real, const N: usize, const M: usize> ContactList<R, N, M> {
    /// The number of contacts.
    pub fn count(&self) -> usize {
        self.places.len() - self.vacant
    }

    /// The contact in a place; `None` if it is vacant.
    pub fn at(&self, place: usize) -> Option<&ColliderContact<R, N, M>> {
        (!self.idle[place].is_vacant()).then(|| &self.places[place])
    }

    /// All contacts.
    pub fn contacts(&self) -> impl Iterator<Item = &ColliderContact<R, N, M>> {
        let places = self.places.iter().zip(&self.idle);
        places.filter(|(_, idle)| !idle.is_vacant()).map(|(contact, _)| contact)
    }

    /// All places, and until when the contact of each is idle.
    pub fn columns_mut(&mut self) -> (&mut [ColliderContact<R, N, M>], &mut [IdleUntil<R, N>]) {
        (&mut self.places, &mut self.idle)
    }

    /// Rebases all planes on anchors that move to the points' positions; the collider is at rest.
    pub fn shift_anchors(&mut self, moved: &[Row4<R>]) {
        for (contact, idle) in
            self.places.iter_mut().zip(&mut self.idle).filter(|(_, idle)| !idle.is_vacant())
        {
            contact.shift_anchors(moved);
            *idle = IdleUntil::unknown(contact.points);
        }
    }

    /// Removes all, keeps the capacity.
    pub fn clear(&mut self) {
        self.places.clear();
        self.idle.clear();
        self.vacant = 0;
    }

    /// Removes contacts of some points. Gives up vacant places where they are more than a quarter of all.
    pub fn remove(&mut self, is_removed: impl Fn(&[u32; N]) -> bool + Sync, pool: &ThreadPool) {
        let Self { places, idle, vacant, .. } = self;
        let (count, removed) = (places.len(), AtomicUsize::new(0));
        let shared = DisjointSlice::new(idle);
        pool.parallel_for(count.div_ceil(PLACES_PER_TASK), |task| {
            let own = task * PLACES_PER_TASK..count.min((task + 1) * PLACES_PER_TASK);
            // SAFETY: tasks share no contact.
            #[allow(unsafe_code)]
            let own = unsafe { shared.run(own.start as u32..own.end as u32) };
            let mut removed_here = 0;
            for idle in own.iter_mut().filter(|idle| !idle.is_vacant() && is_removed(&idle.points)) {
                idle.points = [VACANT; N];
                removed_here += 1;
            }
            removed.fetch_add(removed_here, Ordering::Relaxed);
        });
        *vacant += removed.into_inner();
        if 4 * *vacant > places.len() {
            let mut kept = idle.iter().map(|idle| !idle.is_vacant());
            places.retain(|_| kept.next() == Some(true));
            idle.retain(|idle| !idle.is_vacant());
            *vacant = 0;
        }
    }

    /// Appends what search tasks have `found`, in their order.
    pub fn append<'a>(
        &mut self,
        tasks: usize,
        found: impl Fn(usize) -> &'a [ColliderContact<R, N, M>] + Sync,
        pool: &ThreadPool,
    ) {
        let Self { places, idle, firsts, .. } = self;
        let mut count = 0;
        firsts.clear();
        for task in 0..tasks {
            firsts.push(count);
            let points = found(task).iter().map(|contact| contact.points);
            idle.extend(points.map(IdleUntil::unknown));
            count += found(task).len() as u32;
        }
        places.reserve(count as usize);
        let spare = DisjointSlice::new(places.spare_capacity_mut());
        pool.parallel_for(tasks, |task| {
            let found = found(task);
            // SAFETY: every task has places of its own.
            #[allow(unsafe_code)]
            let to = unsafe { spare.run(firsts[task]..firsts[task] + found.len() as u32) };
            to.iter_mut().zip(found).for_each(|(to, contact)| *to = MaybeUninit::new(*contact));
        });
        // SAFETY: the tasks have set all of these places.
        #[allow(unsafe_code)]
        unsafe {
            places.set_len(places.len() + count as usize);
        }
    }
}

impl<R: Real, const N: usize, const M: usize> Encode for ContactList<R, N, M> {
    const SIZE: usize = 0;
    fn encode(&self, out: &mut Vec<u8>) {
        self.contacts().copied().collect::<Vec<_>>().encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let places: Vec<ColliderContact<R, N, M>> = Encode::decode(from)?;
        let idle = places.iter().map(|contact| IdleUntil::unknown(contact.points)).collect();
        Some(Self { places, idle, ..Self::default() })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn contacts_stay_in_the_order_in_which_they_were_found(
            searches in proptest::collection::vec((proptest::collection::vec(any::<bool>(), 20), proptest::collection::vec(0u32..20, 0..3000)), 1..8),
        ) {
            let pool = ThreadPool::new(2);
            let (mut list, mut expected) = (ContactList::<f32, 1, 3>::default(), Vec::new());
            for (is_new, points) in searches {
                let found: Vec<_> = points.iter().map(|&point| ColliderContact::at([point])).collect();
                let tasks: Vec<_> = found.chunks(7).collect();
                list.remove(|&[point]| is_new[point as usize], &pool);
                list.append(tasks.len(), |task| tasks[task], &pool);
                expected.retain(|&point| !is_new[point as usize]);
                expected.extend_from_slice(&points);
                prop_assert_eq!(list.contacts().map(|contact| contact.points[0]).collect::<Vec<_>>(), &expected[..]);
                prop_assert_eq!(list.count(), expected.len());
                prop_assert!(list.len() <= 2 * expected.len().max(1) + points.len());
            }
            let mut bytes = Vec::new();
            list.encode(&mut bytes);
            let decoded = ContactList::<f32, 1, 3>::decode(&mut Reader::new(&bytes)).expect("it was encoded");
            prop_assert_eq!(decoded.contacts().map(|contact| contact.points[0]).collect::<Vec<_>>(), expected);
        }
    }
}
