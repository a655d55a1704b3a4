//! The ground under four points at a time, where no attribute of the contact differs by point.
//!
//! Each lane has the bits of [`GroundContact::push`] for its point.

use std::ops::Range;

use super::GroundContact;
use crate::contact::response::DEPENETRATION_SPEED;
use crate::math::{Lanes, Real, Row4};

/// A vector per lane.
type Three<R> = [<R as Real>::Lanes; 3];

/// What is the same for all points.
struct Common<R: Real> {
    thickness: R::Lanes,
    friction: R::Lanes,
    travel: Three<R>,
    /// Normal at the start and at the end of the step.
    normals: [Three<R>; 2],
    max_depenetration: R::Lanes,
}

impl<R: Real> GroundContact<'_, R> {
    /// Whether no attribute differs by point.
    pub(super) fn is_uniform(&self) -> bool {
        let maps = self.material_maps;
        let has_maps = !maps.thickness.is_empty() || !maps.clearance.is_full() || !maps.friction.is_empty();
        !has_maps && !self.material.grips && !self.material.is_partial(maps)
    }

    /// Pushes points, whose number is a multiple of four, to the thickness. Returns the number of pushes.
    pub(super) fn resolve_fours(&self, points: Range<u32>) -> u64 {
        if points.is_empty() {
            return 0;
        }
        let splat = |x: [R; 3]| [R::Lanes::splat(x[0]), R::Lanes::splat(x[1]), R::Lanes::splat(x[2])];
        let first = points.start;
        let common = Common {
            thickness: R::Lanes::splat(self.thickness(first)),
            friction: R::Lanes::splat(
                self.material.friction_at(self.material_maps, ([first], [], &([R::ONE], []))),
            ),
            travel: splat(self.plane.travel),
            normals: [splat(self.plane.ends[0].normal), splat(self.plane.ends[1].normal)],
            max_depenetration: R::Lanes::splat(self.h * R::from_f64(DEPENETRATION_SPEED)),
        };
        points.step_by(4).map(|first| self.resolve_four(first, &common)).sum()
    }

    #[inline(always)]
    fn resolve_four(&self, first: u32, common: &Common<R>) -> u64 {
        let row = |k: u32| self.writer.row(first + k).lanes();
        let [x, y, z, inverse_mass] = R::Lanes::transpose([row(0), row(1), row(2), row(3)]);
        let gap = self.heights_of_four(1, first, common, [x, y, z]);
        let pushed = (common.thickness - gap).above_zero() & inverse_mass.above_zero();
        if pushed == 0 {
            return 0;
        }
        let (moved, depenetration) = self.pushes(first, common, [x, y, z], gap);
        let rows = R::Lanes::transpose([x + moved[0], y + moved[1], z + moved[2], inverse_mass]);
        let [a, b, c] = depenetration;
        let parts = R::Lanes::transpose([a, b, c, R::Lanes::splat(R::ZERO)]);
        for lane in (0..4).filter(|lane| pushed >> lane & 1 == 1) {
            let (row, part) = (Row4(rows[lane].to_array()), Row4::<R>(parts[lane].to_array()));
            self.writer.push(first + lane as u32, row, part.xyz());
        }
        u64::from(pushed.count_ones())
    }

    /// Heights above the plane at an end of the step, given displacements then.
    #[inline(always)]
    fn heights_of_four(
        &self,
        end: usize,
        first: u32,
        common: &Common<R>,
        displacement: Three<R>,
    ) -> R::Lanes {
        let at = (first - self.plane.first) as usize;
        let four = |column: &[R]| {
            let four = &column[at..at + 4];
            R::Lanes::from_array([four[0], four[1], four[2], four[3]])
        };
        let [from, to] = [four(self.plane.heights[0]), four(self.plane.heights[1])];
        let share = self.plane.ends[end].share;
        from * R::Lanes::splat(share[0])
            + to * R::Lanes::splat(share[1])
            + dot::<R>(common.normals[end], displacement)
    }

    /// The motion by the pushes of four points at these displacements and heights, and its part without velocity.
    #[inline(always)]
    fn pushes(&self, first: u32, common: &Common<R>, now: Three<R>, gap: R::Lanes) -> (Three<R>, Three<R>) {
        let (zero, one) = (R::Lanes::splat(R::ZERO), R::Lanes::splat(R::ONE));
        let normal = common.normals[1];
        let start = gather(first, |point| self.start[self.writer.place_of(point)].xyz());
        let so_far = gather(first, |point| self.writer.depenetration(point));
        // As `Push::new`.
        let separated = dot::<R>(normal, so_far);
        let depth = common.thickness - gap;
        let before = self.heights_of_four(0, first, common, start);
        let prior_depth = clamp::<R>(common.thickness - before - separated, depth);
        let most = common.max_depenetration;
        let together = zero - separated;
        let reversed = (together - most).choose_by_sign(together, most);
        let slowly = together.choose_by_sign(reversed, most - separated);
        let depenetration = clamp::<R>(slowly, prior_depth);
        let length = depth - prior_depth + depenetration;
        // As `coulomb_correction`.
        let motion = sub::<R>(sub::<R>(now, start), common.travel);
        let sliding = along::<R>(motion, normal);
        let (slid, limit) = (dot::<R>(sliding, sliding).sqrt(), common.friction * length);
        let share = (slid - limit).choose_by_sign(limit / slid, one) * R::Lanes::splat(-R::ONE);
        let given_back = along::<R>(so_far, normal);
        let part = |of: R::Lanes, other: Three<R>, axis: usize| normal[axis] * of + other[axis] * share;
        let moved = [part(length, sliding, 0), part(length, sliding, 1), part(length, sliding, 2)];
        let without_velocity = [
            part(depenetration, given_back, 0),
            part(depenetration, given_back, 1),
            part(depenetration, given_back, 2),
        ];
        (moved, without_velocity)
    }
}

/// A vector of each of four points.
#[inline(always)]
fn gather<R: Real>(first: u32, of: impl Fn(u32) -> [R; 3]) -> Three<R> {
    let row = |k: u32| {
        let [x, y, z] = of(first + k);
        R::Lanes::from_array([x, y, z, R::ZERO])
    };
    let [x, y, z, _] = R::Lanes::transpose([row(0), row(1), row(2), row(3)]);
    [x, y, z]
}

/// The dot product, summed left to right.
#[inline(always)]
fn dot<R: Real>(a: Three<R>, b: Three<R>) -> R::Lanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn sub<R: Real>(a: Three<R>, b: Three<R>) -> Three<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The part of a vector across the normal.
#[inline(always)]
fn along<R: Real>(x: Three<R>, normal: Three<R>) -> Three<R> {
    let height = dot::<R>(x, normal);
    sub::<R>(x, [normal[0] * height, normal[1] * height, normal[2] * height])
}

/// `x` between zero and `most`, which is not negative.
#[inline(always)]
fn clamp<R: Real>(x: R::Lanes, most: R::Lanes) -> R::Lanes {
    let zero = R::Lanes::splat(R::ZERO);
    let positive = (zero - x).choose_by_sign(zero, x);
    (positive - most).choose_by_sign(most, positive)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use proptest::prelude::*;

    use super::*;
    use crate::contact::ground::{Ground, GroundContact};
    use crate::contact::material::{ContactMaterial, MaterialMaps};
    use crate::contact::pair_filter::PairFilter;
    use crate::contact::time_step::PositionWriter;
    use crate::input::frame::{ClothFrame, GroundPlane};
    use crate::parallel::disjoint::DisjointSlice;
    use crate::schedule::StepInterval;

    fn rows() -> impl Strategy<Value = Vec<[f32; 3]>> {
        proptest::collection::vec(proptest::array::uniform3(-0.02..0.02f32), 8)
    }

    fn plane(height: f64, tilt: f64) -> GroundPlane {
        let normal = nalgebra::Vector3::new(tilt, 1.0, 0.0);
        let origin = nalgebra::Vector3::new(0.0, height, 0.0);
        GroundPlane { friction: 0.3, ..GroundPlane::new(origin, normal) }
    }

    proptest! {
        #[test]
        fn four_points_at_a_time_have_the_bits_of_one_at_a_time(
            start in rows(), now in rows(), so_far in rows(), friction in 0.0..0.5f64,
            rise in -0.01..0.01f64, tilt in -0.3..0.3f64, pinned in 0usize..16,
        ) {
            let cloth = ClothFrame { thickness: 0.01, friction, ..ClothFrame::default() };
            let mut ground = Ground::<f32>::default();
            let anchors = [[0.5, 0.003, 0.1]; 8];
            for ground_plane in [plane(0.0, 0.0), plane(rise, tilt)] {
                ground.begin_frame(Some(&ground_plane), &anchors, &PairFilter::default());
            }
            let material = ContactMaterial::for_ground(&cloth, &plane(rise, tilt), 1.0).expect("they collide");
            let run = |runs: &[Range<u32>]| {
                let row = |[x, y, z]: [f32; 3], at: usize| Row4([x, y, z, if at == pinned { 0.0 } else { 1.0 }]);
                let column = |rows: &[[f32; 3]]| rows.iter().enumerate().map(|(at, &x)| row(x, at)).collect::<Vec<_>>();
                let (mut moved, start, predicted) = (column(&now), column(&start), column(&now));
                let mut depenetration: Vec<_> = so_far.iter().map(|&[x, y, z]| Row4([0.1 * x, 0.1 * y, 0.1 * z, 0.0])).collect();
                let mut bearing = [Row4::ZERO; 8];
                let columns = [&mut depenetration[..], &mut bearing[..]];
                let contact = GroundContact {
                    writer: PositionWriter::of_run(DisjointSlice::new(&mut moved), columns, &predicted, 0),
                    start: &start,
                    plane: ground.in_step(StepInterval { from: 0.25, to: 0.5, end_of_substep: 1.0 }).expect("a plane"),
                    thickness_scale: 1.0,
                    material,
                    material_maps: &MaterialMaps::default(),
                    h: 0.01,
                    has_touched: &AtomicBool::new(false),
                };
                let pushes: u64 = runs.iter().map(|run| contact.resolve(run.clone())).sum();
                let bits = |rows: &[Row4<f32>]| rows.iter().flat_map(|row| row.0).map(f32::to_bits).collect::<Vec<_>>();
                (pushes, bits(&moved), bits(&depenetration))
            };
            let alone: Vec<_> = (0..8).map(|at| at..at + 1).collect();
            prop_assert_eq!(run(&[0..4, 4..8]), run(&alone));
        }
    }
}
