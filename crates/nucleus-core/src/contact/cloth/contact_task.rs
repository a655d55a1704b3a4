//! The contacts of one kind between the same blocks of points, which one task sweeps in order.

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use crate::bytes::{Encode, Reader};
use crate::contact::cloth::contact::{Candidate, ClothContact, ClothStep};
use crate::contact::colouring::task_key;
use crate::math::Real;

/// The contacts of a task.
#[derive(Debug)]
pub struct ContactTask<R, const N: usize, const M: usize> {
    /// Its blocks: see [`task_key`].
    pub blocks: [u32; 2],
    contacts: Vec<ClothContact<R, N, M>>,
    /// Those that motion bounds do not certify: they need a certificate at the end of each time step.
    uncertified: Vec<u32>,
    /// Candidates that are to be added: the search task that has found them, and their run in it.
    pub(super) incoming: Vec<(u32, Range<u32>)>,
}

/// Part of the contacts that stays spare when they grow: millions must not double.
const SPARE: usize = 16;

impl<R: Real, const N: usize, const M: usize> ContactTask<R, N, M> {
    /// No contacts yet.
    pub fn new(blocks: [u32; 2]) -> Self {
        Self { blocks, contacts: Vec::new(), uncertified: Vec::new(), incoming: Vec::new() }
    }

    /// All contacts, in their order.
    pub fn contacts(&self) -> &[ClothContact<R, N, M>] {
        &self.contacts
    }

    /// The same, to work on.
    pub fn contacts_mut(&mut self) -> &mut [ClothContact<R, N, M>] {
        &mut self.contacts
    }

    /// Whether all contacts belong to it, given the block of each point.
    pub fn is_sorted(&self, block: &[u32]) -> bool {
        self.contacts.iter().all(|contact| contact.blocks(block) == self.blocks)
    }

    /// Removes all contacts, keeps the capacity.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.uncertified.clear();
    }

    /// Appends a contact.
    pub fn push(&mut self, contact: ClothContact<R, N, M>) {
        if !contact.is_certified() {
            self.uncertified.push(self.contacts.len() as u32);
        }
        self.contacts.push(contact);
    }

    /// Keeps some contacts, in their order.
    pub fn retain(&mut self, keeps: impl Fn(&ClothContact<R, N, M>) -> bool) {
        let Self { contacts, uncertified, .. } = self;
        uncertified.clear();
        let mut kept = 0;
        for at in 0..contacts.len() {
            if !keeps(&contacts[at]) {
                continue;
            }
            if kept != at {
                contacts[kept] = contacts[at];
            }
            if !contacts[kept].is_certified() {
                uncertified.push(kept as u32);
            }
            kept += 1;
        }
        contacts.truncate(kept);
    }

    /// Appends the incoming candidates of search tasks.
    pub fn take_incoming<'a>(&mut self, candidates: impl Fn(u32) -> &'a [Candidate<R, N, M>])
    where
        R: 'a,
    {
        let count: usize = self.incoming.iter().map(|(_, run)| run.len()).sum();
        let (len, spare) = (self.contacts.len(), self.contacts.capacity() - self.contacts.len());
        if spare < count {
            self.contacts.reserve_exact(count + (len + count) / SPARE);
        }
        let mut incoming = std::mem::take(&mut self.incoming);
        for (task, run) in incoming.drain(..) {
            let run = &candidates(task)[run.start as usize..run.end as usize];
            run.iter().for_each(|candidate| self.push(ClothContact::new(candidate)));
        }
        self.incoming = incoming;
    }

    /// Sorts the contacts by their points, so that the order does not depend on that of searches.
    pub fn sort_by_points(&mut self) {
        self.contacts.sort_unstable_by_key(ClothContact::points);
        self.retain(|_| true);
    }

    /// The number of contacts without certificate. Marks their cloths.
    pub fn certify(&mut self, step: &ClothStep<'_, R>, unproven: &[AtomicBool]) -> u64 {
        let mut count = 0;
        for &at in &self.uncertified {
            let contact = &mut self.contacts[at as usize];
            if !contact.certify(step) {
                contact.mark_cloths(step.materials, unproven);
                count += 1;
            }
        }
        count
    }
}

impl<R: Real, const N: usize, const M: usize> Encode for ContactTask<R, N, M> {
    const SIZE: usize = 0;
    fn encode(&self, out: &mut Vec<u8>) {
        self.blocks.encode(out);
        self.contacts.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let mut task = Self::new(Encode::decode(from)?);
        task.contacts = Encode::decode(from)?;
        task.retain(|_| true);
        Some(task)
    }
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// The blocks of its task, given the block of each point.
    pub fn blocks(&self, block: &[u32]) -> [u32; 2] {
        task_key(self.points().map(|point| block[point as usize]))
    }
}
