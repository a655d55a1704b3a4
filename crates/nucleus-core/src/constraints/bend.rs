//! Bending: faces that share an edge keep the angle between them, and quads stay flat.
//!
//! C(x) = |c| - |c_rest|, where c is the bending vector of a [`hinge`](super::hinge) (Bergou et al. 2006): zero where
//! the cloth is flat, else at right angles to it, with a length that grows with the angle. The vector is linear in the
//! positions, so it needs no angle, has no singular shape, and cannot rotate or translate the cloth. A hinge that is
//! bent at rest keeps the length of its vector. Far from flat a hinge is stiffer along c, so that its moment grows with
//! the angle.

use crate::math::kernel::{self, Kernel};
use crate::math::{Lanes, Real, Row4, by_axis};
use crate::parallel::disjoint::DisjointSlice;

use super::hinge::{HingeGroup, MIN_COSINE, RestGroup, weights};
use super::side_by_side::{group_starts, load_each, store};
use super::strength_map::StrengthMap;

/// The strength of a sweep over hinges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendStrength<R> {
    /// The share of the error that a sweep removes, 0 to 1.
    pub share: R,
    /// 1 / (B h²), with the bending stiffness B in N·m and the time step h in seconds; 0 is rigid.
    pub compliance: R,
}

/// Hinges, and the lengths of their bending vectors at rest; empty where all are flat.
pub type RestingHinges<'a, R, const N: usize> = (&'a [HingeGroup<R, N>], &'a [RestGroup<R>]);

/// Sweeps hinges once, in order or backward, with their strength map.
///
/// # Safety
/// The hinges come in twos of groups whose rows share no point, and no other task of the loop touches their points.
#[allow(unsafe_code)]
#[inline]
pub unsafe fn relax<R: Real, P: StrengthMap<R>, const N: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    hinges: RestingHinges<'_, R, N>,
    map: P,
    backward: bool,
    strength: &BendStrength<R>,
) {
    // SAFETY: the caller's promise.
    unsafe { kernel::run(HingeSweep { points, hinges, map, backward, strength }) };
}

struct HingeSweep<'a, R, P, const N: usize> {
    points: DisjointSlice<'a, Row4<R>>,
    hinges: RestingHinges<'a, R, N>,
    map: P,
    backward: bool,
    strength: &'a BendStrength<R>,
}

#[allow(unsafe_code)]
impl<R: Real, P: StrengthMap<R>, const N: usize> Kernel<R> for HingeSweep<'_, R, P, N> {
    /// # Safety
    /// See [`relax`].
    #[inline(always)]
    unsafe fn run<L: Lanes<R>>(self) {
        let Self { points, hinges: (groups, rests), map, backward, strength } = self;
        let (share, compliance) = (L::splat(strength.share), L::splat(strength.compliance));
        let (zero, one, tiny) = (L::splat(R::ZERO), L::splat(R::ONE), L::splat(R::MIN_DENOMINATOR));
        let least = L::splat(R::from_f64(MIN_COSINE * MIN_COSINE));
        for at in group_starts::<R, L>(groups.len(), backward) {
            let groups = &groups[at..at + L::GROUPS];
            let weights: [L; N] = weights(groups);
            // SAFETY: the caller's promise.
            let x: [[L; 4]; N] = unsafe { load_each(points, |k, group| groups[group].points[k]) };
            let mut c = by_axis(|axis| L::of_groups(|group| groups[group].anchored[axis]));
            let mut mobility = zero;
            for (k, [px, py, pz, w]) in x.into_iter().enumerate() {
                let weight = weights[k];
                c = [c[0] + weight * px, c[1] + weight * py, c[2] + weight * pz];
                mobility = mobility + w * weight * weight;
            }
            let square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
            let length = square.sqrt();
            // cos²(θ/2), bounded from below.
            let cosine = one - square * L::of_groups(|group| groups[group].inverse_square_max);
            let cosine = (cosine - least).choose_by_sign(cosine, least);
            let bent = match rests {
                [] => one,
                rests => one - L::of_groups(|group| rests[at + group].rest) / (length + tiny),
            };
            let (share, compliance) = map.scale(at, bent, share, compliance);
            let lambda = share * bent / (mobility + compliance * cosine.sqrt() + tiny);
            let push = [lambda * c[0], lambda * c[1], lambda * c[2]];
            for (k, [px, py, pz, w]) in x.into_iter().enumerate() {
                let [mx, my, mz] = by_axis(|axis| weights[k] * push[axis]);
                // SAFETY: the caller's promise.
                unsafe {
                    let moved = [px - w * mx, py - w * my, pz - w * mz, w];
                    store(points, |group| groups[group].points[k], moved);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints::angle::{AngleStrength, AngleSweep};
    use crate::constraints::hinge::{HingeRow, rows};
    use crate::constraints::side_by_side::tests::agrees_in_every_width;
    use crate::constraints::strength_map::{StrengthGroup, Uniform};
    use crate::model::blocks::Blocks;
    use crate::model::rows::RowList;
    use crate::model::surface::{Faces, Surface};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    const SIDE: u32 = 9;
    const COUNT: usize = (SIDE * SIDE) as usize;
    const STRENGTH: BendStrength<f32> = BendStrength { share: 0.8, compliance: 0.03 };
    const READING: AngleStrength<f32> = AngleStrength { scale: 0.7, dropoff: 0.4 };

    /// A crumpled sheet of quads, or of triangles.
    fn sheets() -> impl Strategy<Value = Surface> {
        let shift = proptest::array::uniform3(-0.3f64..0.3);
        (proptest::collection::vec(shift, COUNT), any::<bool>()).prop_map(|(shifts, of_quads)| {
            let place = |k: u32| Vector3::new(f64::from(k % SIDE), f64::from(k / SIDE), 0.0);
            let positions = (0..SIDE * SIDE).zip(shifts).map(|(k, shift)| place(k) + Vector3::from(shift));
            let cells = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| row * SIDE + column));
            let faces = cells.flat_map(|a| match of_quads {
                true => vec![vec![a, a + 1, a + SIDE + 1, a + SIDE]],
                false => vec![vec![a, a + 1, a + SIDE], vec![a + 1, a + SIDE + 1, a + SIDE]],
            });
            let faces: Vec<Vec<u32>> = faces.collect();
            Surface {
                positions: positions.collect(),
                faces: faces.iter().map(Vec::as_slice).collect::<Faces>(),
            }
        })
    }

    /// Displacements; every fifth point is pinned.
    fn displacements() -> impl Strategy<Value = Vec<Row4<f32>>> {
        proptest::collection::vec(proptest::array::uniform4(-0.5f32..0.5), COUNT).prop_map(|all| {
            let free = all.into_iter().enumerate();
            let free = free.map(|(k, [x, y, z, w])| Row4([x, y, z, if k % 5 == 0 { 0.0 } else { 1.5 + w }]));
            free.chain((SIDE * SIDE..Blocks::new(0, COUNT).row_count()).map(|_| Row4::ZERO)).collect()
        })
    }

    /// A vertex map for this many groups; every third factor is zero.
    fn map(groups: usize) -> Vec<StrengthGroup<f32>> {
        let factor = |k: usize| if k.is_multiple_of(3) { 0.0 } else { k as f32 * 0.71 % 1.0 };
        let four = |group: usize, from: usize| [0, 1, 2, 3].map(|lane| factor(from + 4 * group + lane));
        (0..groups).map(|group| StrengthGroup { above: four(group, 0), below: four(group, 1) }).collect()
    }

    fn agrees<const N: usize>(
        rows: &[HingeRow<f32, N>],
        sheet: &Surface,
        anchors: &[[f64; 3]],
        (start, backward): (&[Row4<f32>], bool),
    ) -> bool {
        let blocks = Blocks::new(0, COUNT);
        let angles: Vec<_> = rows.iter().map(|row| row.angle(sheet, |k| k as usize)).collect();
        let rests: Vec<_> = rows.iter().map(HingeRow::at_rest).collect();
        let (mut hinges, mut angles) = (RowList::new(rows, &blocks), RowList::new(&angles, &blocks));
        let rests = RowList::new(&rests, &blocks);
        hinges.groups_mut().iter_mut().for_each(|group| group.anchor(anchors));
        for (hinge, angle) in hinges.groups().iter().zip(angles.groups_mut()) {
            angle.anchor(hinge, anchors);
            angle.flipped[1] = 1.0;
        }
        let (groups, angles, strength) = (hinges.groups(), angles.groups(), &STRENGTH);
        let [flat, hinges] = [(groups, &[][..]), (groups, rests.groups())];
        let maps = map(groups.len());
        let (map, signed) = (&maps[..], (&STRENGTH, &READING));
        agrees_in_every_width!(start, points => HingeSweep { points, hinges: flat, map: Uniform, backward, strength })
            && agrees_in_every_width!(start, points => HingeSweep { points, hinges, map, backward, strength })
            && agrees_in_every_width!(start, points => {
                AngleSweep { points, lists: (groups, angles, &[]), map: Uniform, backward, strength: signed }
            })
            && agrees_in_every_width!(start, points => {
                AngleSweep { points, lists: (groups, angles, map), map, backward, strength: signed }
            })
    }

    proptest! {
        #[test]
        fn every_width_of_lanes_gives_the_same_bits(
            sheet in sheets(),
            start in displacements(),
            backward: bool,
        ) {
            let (blocks, rows) = (Blocks::new(0, COUNT), rows::<f32>(&sheet, |point| point));
            let mut anchors: Vec<[f64; 3]> = sheet.positions.iter().map(|&x| (x * 0.9).into()).collect();
            anchors.resize(blocks.row_count() as usize, [0.0; 3]);
            prop_assert!(agrees(&rows.of_four, &sheet, &anchors, (&start, backward)));
            if !rows.of_six.is_empty() {
                prop_assert!(agrees(&rows.of_six, &sheet, &anchors, (&start, backward)));
            }
        }
    }
}
