//! The active set: the contacts of a cloth and a collider that can touch within the next few time steps.

use std::ops::Range;

use crate::contact::collider::contact::ColliderContact;
use crate::contact::collider::motion_bounds::MotionBounds;
use crate::contact::collider::plane_columns::PlaneColumns;
use crate::contact::depenetration::Depenetration;
use crate::math::Real;

/// Indices into the columns of a [`ColliderContacts`], and the planes of these contacts in the same order.
#[derive(Debug, Clone)]
pub struct ActiveSet<R> {
    /// Of `point_face`, sorted by point.
    pub point_face: Vec<u32>,
    /// The run of `point_face` that belongs to each block of the cloth.
    pub runs: Vec<Range<u32>>,
    /// Of `edge_edge`.
    pub edge_edge: Vec<u32>,
    /// Of `face_point`.
    pub face_point: Vec<u32>,
    /// The planes of all three; those of `point_face` in runs, the first four of each in `first_fours`.
    pub(super) point_planes: PlaneColumns<R, 1>,
    pub(super) first_fours: Vec<u32>,
    pub(super) edge_planes: PlaneColumns<R, 2>,
    pub(super) face_planes: PlaneColumns<R, 3>,
    /// Indices of `point_face`, `edge_edge` and `face_point` that motion bounds do not certify over the window:
    /// they need a certificate at the end of each time step.
    pub uncertified: [Vec<u32>; 3],
}

impl<R> Default for ActiveSet<R> {
    fn default() -> Self {
        Self {
            point_face: Vec::new(),
            runs: Vec::new(),
            edge_edge: Vec::new(),
            face_point: Vec::new(),
            point_planes: PlaneColumns::default(),
            first_fours: Vec::new(),
            edge_planes: PlaneColumns::default(),
            face_planes: PlaneColumns::default(),
            uncertified: Default::default(),
        }
    }
}

impl<R: Real> ActiveSet<R> {
    pub(super) fn clear(&mut self) {
        self.point_face.clear();
        self.runs.clear();
        self.edge_edge.clear();
        self.face_point.clear();
        self.point_planes.clear();
        self.first_fours.clear();
        self.edge_planes.clear();
        self.face_planes.clear();
        self.uncertified.iter_mut().for_each(Vec::clear);
    }
}

/// Share of the interaction range by which the gap of an idle contact must exceed it.
const IDLE_MARGIN: f64 = 1e-3;
/// Share of the thickness above which a gap over the whole window is a certificate: far above rounding error.
pub(super) const CERTIFIED_GAP: f64 = 0.02;

/// How contacts are selected for the active set.
pub(super) struct Selection<'a, R> {
    pub(super) bounds: &'a MotionBounds<'a, R>,
    pub(super) window: [(R, [R; 3]); 2],
    /// Gaps in metres below which a contact is active, and up to which it is uncertified.
    pub(super) range: [R; 2],
    pub(super) growth: Option<&'a [R]>,
    pub(super) depenetration: &'a Depenetration,
}

impl<R: Real> Selection<'_, R> {
    pub(super) fn select<const N: usize, const M: usize>(
        &self,
        contacts: &mut [ColliderContact<R, N, M>],
        order: impl Iterator<Item = u32>,
        [active, uncertified]: &mut [&mut Vec<u32>; 2],
    ) {
        active.clear();
        uncertified.clear();
        let [range, certified] = self.range;
        for index in order {
            let contact = &mut contacts[index as usize];
            if self.growth.is_some_and(|growth| contact.is_idle(growth)) {
                continue;
            }
            let gap = self.min_gap(contact);
            if gap < range && self.is_acting(contact) {
                active.push(index);
                if gap <= certified {
                    uncertified.push(index);
                }
            }
        }
    }

    /// The smallest gap of a contact over the window; notes until when the contact is idle.
    #[inline(always)]
    fn min_gap<const N: usize, const M: usize>(&self, contact: &mut ColliderContact<R, N, M>) -> R {
        let Some(growth) = self.growth else { return contact.min_gap(self.window, self.bounds) };
        // Around a collider at rest the gap is the same at both ends of the window.
        let gap = contact.min_gap([self.window[0]], self.bounds);
        let rounding = R::EPSILON * R::from_f64(16.0) * (gap + R::ONE);
        contact.set_idle(gap - self.range[0] * R::from_f64(1.0 + IDLE_MARGIN) - rounding, growth);
        gap
    }

    fn is_acting<const N: usize, const M: usize>(&self, contact: &ColliderContact<R, N, M>) -> bool {
        let Depenetration { points, .. } = self.depenetration;
        points.is_empty() || !contact.points.iter().any(|&point| self.depenetration.contains(point))
    }
}
