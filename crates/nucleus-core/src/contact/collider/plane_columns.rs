//! The planes of active contacts in columns of four, in the order of the sweep: which of four are below the contact
//! thickness takes as many instructions as one contact by itself, and a quarter of the memory.
//!
//! The gaps have the bits of [`ColliderContact::gaps`], so a contact that is skipped here would not have moved anything.

use crate::contact::collider::contact::ColliderContact;
use crate::math::{Lanes, Real, Row4};

/// The planes of some contacts.
#[derive(Debug, Clone)]
pub struct PlaneColumns<R, const N: usize> {
    fours: Vec<FourPlanes<R, N>>,
}

/// The planes of four contacts, by lane.
#[derive(Debug, Clone, Copy)]
pub struct FourPlanes<R, const N: usize> {
    points: [[u32; 4]; N],
    normal: [[R; 4]; 3],
    /// The plane's offset for each point at the start of the candidate interval, and its change over the interval.
    offset: [[R; 4]; N],
    change: [[R; 4]; N],
}

impl<R, const N: usize> Default for PlaneColumns<R, N> {
    fn default() -> Self {
        Self { fours: Vec::new() }
    }
}

impl<R: Real, const N: usize> PlaneColumns<R, N> {
    /// Removes all.
    pub fn clear(&mut self) {
        self.fours.clear();
    }

    /// All fours.
    pub fn fours_mut(&mut self) -> &mut [FourPlanes<R, N>] {
        &mut self.fours
    }

    /// Makes room for this number of fours, whose contents do not matter.
    pub fn resize(&mut self, fours: usize) {
        self.fours.resize(fours, FourPlanes::without_contacts([0; N]));
    }
}

impl<R: Real, const N: usize> FourPlanes<R, N> {
    /// Planes that lie infinitely deep below these points.
    fn without_contacts(points: [u32; N]) -> Self {
        Self {
            points: points.map(|point| [point; 4]),
            normal: [[R::ZERO; 4]; 3],
            offset: [[-R::ONE / R::MIN_DENOMINATOR; 4]; N],
            change: [[R::ZERO; 4]; N],
        }
    }

    /// Takes up a run of contacts, given by their indices.
    pub fn copy_run<const M: usize>(fours: &mut [Self], contacts: &[ColliderContact<R, N, M>], run: &[u32]) {
        for (four, indices) in fours.iter_mut().zip(run.chunks(4)) {
            *four = Self::without_contacts(contacts[indices[0] as usize].points);
            (0..).zip(indices).for_each(|(lane, &contact)| four.set(lane, &contacts[contact as usize]));
        }
    }

    /// Takes up a contact.
    #[inline(always)]
    pub fn set<const M: usize>(&mut self, lane: usize, contact: &ColliderContact<R, N, M>) {
        (0..3).for_each(|axis| self.normal[axis][lane] = contact.normal[axis]);
        for k in 0..N {
            let [start, end] = contact.plane_ends(k);
            self.points[k][lane] = contact.points[k];
            (self.offset[k][lane], self.change[k][lane]) = (start, end - start);
        }
    }

    /// One bit for each of the four that has a point nearer than `gap` to its plane, at a share of the candidate interval.
    /// `row` gives the displacement of a point.
    #[inline(always)]
    pub fn below(&self, gap: R, share: R, row: impl Fn(u32) -> Row4<R>) -> u32 {
        let [share, gap] = [share, gap].map(R::Lanes::splat);
        let [x, y, z] = self.normal.map(R::Lanes::from_array);
        let mut below = 0;
        for k in 0..N {
            let [a, b, c, d] = self.points[k];
            let [u, v, w, _] = R::Lanes::transpose([row(a), row(b), row(c), row(d)].map(Row4::lanes));
            let plane = R::Lanes::from_array(self.offset[k]) + R::Lanes::from_array(self.change[k]) * share;
            below |= (gap - (x * u + y * v + z * w - plane)).above_zero();
        }
        below
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn triple() -> impl Strategy<Value = [f32; 3]> {
        proptest::array::uniform3(-1.0..1.0f32)
    }

    proptest! {
        #[test]
        fn four_planes_at_once_are_as_near_as_each_alone(
            normals in proptest::collection::vec(triple(), 1..10),
            planes in proptest::collection::vec(proptest::array::uniform4(-1.0..1.0f32), 10),
            rows in proptest::collection::vec(triple(), 10),
            gap in -1.0..1.0f32,
            share in 0.0..1.0f32,
        ) {
            let contact = |at: usize| {
                let [a, b, c, d] = planes[at];
                ColliderContact::<f32, 2, 2>::of_plane([at as u32, 9 - at as u32], normals[at], [[a, b], [c, d]])
            };
            let contacts: Vec<_> = (0..normals.len()).map(contact).collect();
            let all: Vec<u32> = (0..contacts.len() as u32).collect();
            let mut columns = PlaneColumns::default();
            columns.resize(all.len().div_ceil(4));
            FourPlanes::copy_run(columns.fours_mut(), &contacts, &all);
            for (at, four) in columns.fours_mut().iter().enumerate() {
                let of_point = |point: u32| {
                    let [x, y, z] = rows[point as usize];
                    Row4([x, y, z, 1.0])
                };
                let alone = contacts[4 * at..].iter().take(4).zip(0..).map(|(contact, lane)| {
                    let (_, least) = contact.gaps(contact.points.map(|point| rows[point as usize]), share);
                    u32::from(least < gap) << lane
                });
                prop_assert_eq!(four.below(gap, share, of_point), alone.sum::<u32>());
            }
        }
    }
}
