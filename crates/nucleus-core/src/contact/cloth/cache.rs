//! The contact cache: all contacts among cloths, by kind, over a candidate interval.

use std::sync::atomic::AtomicBool;

use crate::bytes::checkpoint_struct;
use crate::contact::cloth::contact::{ClothContact, ClothStep};
use crate::contact::cloth::contact_list::{Blocks, ContactList, Replaced};
use crate::contact::cloth::found_contacts::FoundContacts;
use crate::contact::cloth::frozen::Frozen;
use crate::contact::collider::affine_motion::AffineMotion;
use crate::contact::pair_table::ContactMaterials;
use crate::contact::response::Restitution;
use crate::math::{Real, Row4};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// All contacts that can touch within the candidate interval.
#[derive(Debug)]
pub struct ContactCache<R> {
    /// Points and faces.
    pub point_face: ContactList<R, 1, 3>,
    /// Edges and edges.
    pub edge_edge: ContactList<R, 2, 2>,
    /// Points and edges.
    pub point_edge: ContactList<R, 1, 2>,
    /// Points and points.
    pub point_point: ContactList<R, 1, 1>,
}

checkpoint_struct!([R: Real] ContactCache<R> {
    columns: [], values: [], parts: [point_face, edge_edge, point_edge, point_point], rebuilt: [],
});

impl<R> Default for ContactCache<R> {
    fn default() -> Self {
        Self {
            point_face: ContactList::default(),
            edge_edge: ContactList::default(),
            point_edge: ContactList::default(),
            point_point: ContactList::default(),
        }
    }
}

impl<R: Real> ContactCache<R> {
    /// Removes the contacts that a search replaces.
    pub(super) fn remove(&mut self, replaced: &Replaced<'_>, pool: &ThreadPool) {
        self.point_face.remove(replaced, pool);
        self.edge_edge.remove(replaced, pool);
        self.point_edge.remove(replaced, pool);
        self.point_point.remove(replaced, pool);
    }

    /// Adds what search tasks have found, in their order.
    pub(super) fn add(&mut self, found: &[FoundContacts<R>], pool: &ThreadPool) {
        self.point_face.add(found, |found| &found.point_face, pool);
        self.edge_edge.add(found, |found| &found.edge_edge, pool);
        self.point_edge.add(found, |found| &found.point_edge, pool);
        self.point_point.add(found, |found| &found.point_point, pool);
    }

    /// Colours the tasks, after contacts were removed or added.
    pub(super) fn finish(&mut self, blocks: u32) {
        self.point_face.finish(blocks);
        self.edge_edge.finish(blocks);
        self.point_edge.finish(blocks);
        self.point_point.finish(blocks);
    }

    /// Renumbers the rows of points; contacts of a point without a number are removed.
    pub(super) fn renumber(&mut self, number: &impl Fn(u32) -> Option<u32>, blocks: Blocks<'_>) {
        self.point_face.renumber(number, blocks);
        self.edge_edge.renumber(number, blocks);
        self.point_edge.renumber(number, blocks);
        self.point_point.renumber(number, blocks);
    }

    /// Whether every contact stands in the task of its blocks.
    pub fn is_sorted(&self, blocks: Blocks<'_>) -> bool {
        let Self { point_face, edge_edge, point_edge, point_point } = self;
        point_face.is_sorted(blocks)
            && edge_edge.is_sorted(blocks)
            && point_edge.is_sorted(blocks)
            && point_point.is_sorted(blocks)
    }

    /// The number of contacts.
    pub fn len(&self) -> u64 {
        let Self { point_face, edge_edge, point_edge, point_point } = self;
        (point_face.len() + edge_edge.len() + point_edge.len() + point_point.len()) as u64
    }

    /// The number of contacts that keep less than the cloth's thickness, because their elements are neighbours at
    /// rest.
    pub fn count_rest_limited(&self) -> u64 {
        let limited = self.point_face.iter().filter(|contact| contact.is_rest_limited()).count()
            + self.edge_edge.iter().filter(|contact| contact.is_rest_limited()).count()
            + self.point_edge.iter().filter(|contact| contact.is_rest_limited()).count();
        limited as u64
    }

    /// The smallest ratio of distance to contact thickness; infinite without contacts.
    pub fn min_gap_ratio(&self, step: &ClothStep<'_, R>, pool: &ThreadPool) -> f64 {
        let Self { point_face, edge_edge, point_edge, point_point } = self;
        point_face
            .min_gap_ratio(step, pool)
            .min(edge_edge.min_gap_ratio(step, pool))
            .min(point_edge.min_gap_ratio(step, pool))
            .min(point_point.min_gap_ratio(step, pool))
    }

    /// One sweep. Point-face contacts go last, because they carry cloth on cloth most smoothly. Returns the
    /// number of contacts that pushed; marks their cloths.
    pub fn sweep(&mut self, step: &ClothStep<'_, R>, has_touched: &[AtomicBool], pool: &ThreadPool) -> u64 {
        self.edge_edge.sweep(step, has_touched, pool)
            + self.point_point.sweep(step, has_touched, pool)
            + self.point_edge.sweep(step, has_touched, pool)
            + self.point_face.sweep(step, has_touched, pool)
    }

    /// Applies adhesion between points and the elements that they touch.
    pub fn adhere(&mut self, step: &ClothStep<'_, R>, pool: &ThreadPool) {
        self.point_point.count(pool, |contact| contact.adhere(step));
        self.point_edge.count(pool, |contact| contact.adhere(step));
        self.point_face.count(pool, |contact| contact.adhere(step));
    }

    /// Applies restitution at all contacts.
    pub fn apply_restitution(
        &mut self,
        step: &ClothStep<'_, R>,
        velocities: DisjointSlice<'_, Row4<R>>,
        restitution: Restitution<R>,
        pool: &ThreadPool,
    ) {
        self.edge_edge.count(pool, |contact| contact.apply_restitution(step, velocities, restitution));
        self.point_point.count(pool, |contact| contact.apply_restitution(step, velocities, restitution));
        self.point_edge.count(pool, |contact| contact.apply_restitution(step, velocities, restitution));
        self.point_face.count(pool, |contact| contact.apply_restitution(step, velocities, restitution));
    }

    /// Carries friction anchors over into a candidate interval that begins at `start`; the last one began at
    /// `interval_start`.
    pub fn carry_anchors(
        &mut self,
        origins: &[[f64; 3]],
        start: &[Row4<R>],
        interval_start: &[Row4<R>],
        pool: &ThreadPool,
    ) {
        let Self { point_face, edge_edge, point_edge, point_point } = self;
        point_face.for_each(pool, |contact| contact.carry_anchor(origins, start, interval_start));
        edge_edge.for_each(pool, |contact| contact.carry_anchor(origins, start, interval_start));
        point_edge.for_each(pool, |contact| contact.carry_anchor(origins, start, interval_start));
        point_point.for_each(pool, |contact| contact.carry_anchor(origins, start, interval_start));
    }

    /// The number of contacts without certificate. Marks their cloths.
    pub fn certify(&mut self, step: &ClothStep<'_, R>, unproven: &[AtomicBool], pool: &ThreadPool) -> u64 {
        self.edge_edge.certify(step, unproven, pool) + self.point_face.certify(step, unproven, pool)
    }

    /// The pairs of cloths in contact, each at least once.
    pub fn cloth_pairs(&self, materials: &ContactMaterials<R>) -> impl Iterator<Item = [usize; 2]> {
        let Self { point_face, edge_edge, point_edge, point_point } = self;
        let pairs = point_face.of_each_task().map(move |contact| contact.cloths(materials));
        let pairs = pairs.chain(edge_edge.of_each_task().map(move |contact| contact.cloths(materials)));
        let pairs = pairs.chain(point_edge.of_each_task().map(move |contact| contact.cloths(materials)));
        pairs.chain(point_point.of_each_task().map(move |contact| contact.cloths(materials)))
    }

    /// The pairs of cloths of all contacts that overlap.
    pub(super) fn overlapping_pairs(
        &self,
        materials: &ContactMaterials<R>,
    ) -> impl Iterator<Item = [usize; 2]> {
        let Self { point_face, edge_edge, point_edge, point_point } = self;
        let pairs = point_face.overlapping_pairs(materials).chain(edge_edge.overlapping_pairs(materials));
        let pairs = pairs.chain(point_edge.overlapping_pairs(materials));
        pairs.chain(point_point.overlapping_pairs(materials))
    }

    /// Truncates the motion of every contact without certificate, one after the other. Returns their number.
    pub fn truncate(&mut self, step: &ClothStep<'_, R>) -> u64 {
        self.correct_unproven(step, |contact| contact.truncate(step), |contact| contact.truncate(step))
    }

    /// Freezes the points of every contact without certificate, one after the other. Returns their number.
    pub fn freeze(
        &mut self,
        step: &ClothStep<'_, R>,
        frozen: &mut [Frozen],
        carriers: &[Option<AffineMotion>],
    ) -> u64 {
        let frozen = std::cell::RefCell::new(frozen);
        self.correct_unproven(
            step,
            |contact| contact.freeze(step, &mut frozen.borrow_mut(), carriers),
            |contact| contact.freeze(step, &mut frozen.borrow_mut(), carriers),
        )
    }

    /// Applies a fallback to every contact without certificate.
    fn correct_unproven(
        &mut self,
        step: &ClothStep<'_, R>,
        edges: impl Fn(&mut ClothContact<R, 2, 2>),
        faces: impl Fn(&mut ClothContact<R, 1, 3>),
    ) -> u64 {
        let mut corrected = 0;
        for contact in self.edge_edge.iter_mut() {
            if !contact.certify(step) {
                edges(contact);
                corrected += 1;
            }
        }
        for contact in self.point_face.iter_mut() {
            if !contact.certify(step) {
                faces(contact);
                corrected += 1;
            }
        }
        corrected
    }
}
