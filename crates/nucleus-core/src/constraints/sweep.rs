//! Coloured Gauss-Seidel sweeps: every row of a list once, in a fixed order that does not depend on the number of
//! threads.
//!
//! Blocks of points are swept in parallel, each by one task, which sweeps its interior rows in order. Interface rows,
//! which join several blocks, follow colour by colour: the rows of one colour share no point.

use crate::constraints::angle::{AngleGroup, AngleStrength};
use crate::constraints::hinge::{HingeGroup, RestGroup};
use crate::constraints::parallel::LinkLists;
use crate::constraints::projection::relax;
use crate::constraints::row_loops::for_interface_rows;
use crate::constraints::strength_map::{StrengthGroup, Uniform};
use crate::constraints::stretch::LinkStrength;
use crate::constraints::weave::Woven;
use crate::constraints::{angle, bend, parallel};
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::model::rows::{RowBatch, RowList};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::{Direction, Effect, Sweep};

/// Does the sweeps of one pass: writes displacements.
///
/// The interior rows of all lists come first, block by block, while the block is in the core's cache; then the
/// interface rows, list by list. Backward reverses the unmapped order, in cloths that alternate their direction.
///
/// `corrections` is scratch for links that are all corrected from the same state; empty where no cloth has such.
pub fn sweep<R: Real>(
    cloths: &[ClothModel<R>],
    [displacement, corrections]: [&mut [Row4<R>]; 2],
    sweeps: &[Sweep<R>],
    (direction, alternates): (Direction, &[bool]),
    pool: &ThreadPool,
) {
    for of_cloth in sweeps.chunk_by(|a, b| a.cloth == b.cloth) {
        let Some(index) = of_cloth.first().map(|sweep| sweep.cloth) else { continue };
        let cloth = &cloths[index];
        let backward = direction == Direction::Backward && alternates[index] && cloth.alternates_direction;
        if !cloth.valence.is_empty() {
            sweep_parallel(cloth, [displacement, corrections], of_cloth, pool);
            continue;
        }
        let sweeper = Sweeper { points: DisjointSlice::new(displacement), cloth, backward };
        if backward {
            of_cloth.iter().rev().for_each(|sweep| sweeper.interface(pool, &sweep.effect));
            pool.parallel_for(cloth.blocks.len(), |block| {
                of_cloth.iter().rev().for_each(|sweep| sweeper.interior(block, &sweep.effect));
            });
        } else {
            pool.parallel_for(cloth.blocks.len(), |block| {
                of_cloth.iter().for_each(|sweep| sweeper.interior(block, &sweep.effect));
            });
            of_cloth.iter().for_each(|sweep| sweeper.interface(pool, &sweep.effect));
        }
    }
}

/// The sweeps over a cloth whose links are all corrected from the same state.
fn sweep_parallel<R: Real>(
    cloth: &ClothModel<R>,
    [displacement, corrections]: [&mut [Row4<R>]; 2],
    sweeps: &[Sweep<R>],
    pool: &ThreadPool,
) {
    for Sweep { effect, .. } in sweeps {
        let (lists, strength) = match effect {
            Effect::Stretch(strength, weave) => (LinkLists::stretch(cloth, weave), strength),
            Effect::Shear(strength, weave) => (LinkLists::shear(cloth, weave), strength),
            Effect::Bend(..) => {
                let sweeper = Sweeper { points: DisjointSlice::new(displacement), cloth, backward: false };
                pool.parallel_for(cloth.blocks.len(), |block| sweeper.interior(block, effect));
                sweeper.interface(pool, effect);
                continue;
            }
        };
        parallel::sweep(displacement, corrections, cloth, &lists, strength, pool);
    }
}

/// Sweeps the lists of one cloth in one direction.
///
/// Safety of all its loops: interior rows of two blocks, and interface rows of one colour, share no point. [`RowList`]
/// lays rows out so, and its tests check it.
struct Sweeper<'a, R: Real> {
    points: DisjointSlice<'a, Row4<R>>,
    cloth: &'a ClothModel<R>,
    backward: bool,
}

impl<R: Real> Sweeper<'_, R> {
    fn interior(&self, block: usize, effect: &Effect<R>) {
        let (cloth, batch) = (self.cloth, RowBatch::Interior(block));
        match effect {
            Effect::Stretch(strength, weave) => {
                self.links(&LinkLists::stretch(cloth, weave), batch, strength);
            }
            Effect::Shear(strength, weave) => self.links(&LinkLists::shear(cloth, weave), batch, strength),
            Effect::Bend(strength, angles) => {
                self.hinges(&HingeLists::of_four(cloth), batch, (strength, angles));
                self.hinges(&HingeLists::of_six(cloth), batch, (strength, angles));
            }
        }
    }

    fn interface(&self, pool: &ThreadPool, effect: &Effect<R>) {
        let (cloth, backward) = (self.cloth, self.backward);
        match effect {
            Effect::Stretch(strength, weave) => for_interface_rows(pool, &cloth.stretch, backward, |batch| {
                self.links(&LinkLists::stretch(cloth, weave), batch, strength);
            }),
            Effect::Shear(strength, weave) => for_interface_rows(pool, &cloth.shear, backward, |batch| {
                self.links(&LinkLists::shear(cloth, weave), batch, strength);
            }),
            Effect::Bend(strength, angles) => {
                let (four, six) = (HingeLists::of_four(cloth), HingeLists::of_six(cloth));
                for_interface_rows(pool, four.rows, backward, |batch| {
                    self.hinges(&four, batch, (strength, angles));
                });
                for_interface_rows(pool, six.rows, backward, |batch| {
                    self.hinges(&six, batch, (strength, angles));
                });
            }
        }
    }

    #[allow(unsafe_code)]
    fn links(&self, lists: &LinkLists<'_, R>, batch: RowBatch, strength: &LinkStrength<R>) {
        let (rows, map, backward) = (lists.rows.batch(batch), lists.maps(batch), self.backward);
        let woven = |(weave, strength)| (RowList::batch(weave, batch), strength);
        // SAFETY: see `Sweeper`.
        unsafe {
            match (lists.weave.map(woven), map.is_empty()) {
                (None, true) => relax::<R, _, 2>(self.points, rows, Uniform, backward, strength),
                (None, false) => relax::<R, _, 2>(self.points, rows, map, backward, strength),
                (Some((groups, law)), true) => {
                    let law = Woven { groups, strength: law, map: Uniform };
                    relax::<R, _, 2>(self.points, rows, law, backward, strength);
                }
                (Some((groups, law)), false) => {
                    let law = Woven { groups, strength: law, map };
                    relax::<R, _, 2>(self.points, rows, law, backward, strength);
                }
            }
        }
    }

    #[allow(unsafe_code)]
    fn hinges<const N: usize>(
        &self,
        lists: &HingeLists<'_, R, N>,
        batch: RowBatch,
        (strength, reading): (&bend::BendStrength<R>, &AngleStrength<R>),
    ) {
        let (map, backward) = (lists.maps.batch(batch), self.backward);
        let (rows, angles) = (lists.rows.batch(batch), lists.angles.batch(batch));
        let hinges = (rows, lists.rests.batch(batch));
        let angles = (rows, angles, lists.angle_maps.batch(batch));
        let strengths = (strength, reading);
        // SAFETY: see `Sweeper`.
        unsafe {
            match (angles.1.is_empty(), map.is_empty()) {
                (true, true) => bend::relax(self.points, hinges, Uniform, backward, strength),
                (true, false) => bend::relax(self.points, hinges, map, backward, strength),
                (false, true) => angle::relax(self.points, angles, Uniform, backward, strengths),
                (false, false) => angle::relax(self.points, angles, map, backward, strengths),
            }
        }
    }
}

/// Hinges, and the columns of the same layout; each is empty where no hinge needs it.
struct HingeLists<'a, R, const N: usize> {
    rows: &'a RowList<HingeGroup<R, N>>,
    rests: &'a RowList<RestGroup<R>>,
    maps: &'a RowList<StrengthGroup<R>>,
    angles: &'a RowList<AngleGroup<R>>,
    angle_maps: &'a RowList<StrengthGroup<R>>,
}

impl<'a, R> HingeLists<'a, R, 4> {
    fn of_four(cloth: &'a ClothModel<R>) -> Self {
        let ClothModel { bend, bend_rest, bend_angles, strength_maps, .. } = cloth;
        let (maps, angle_maps) = (&strength_maps.bend, &strength_maps.angles);
        Self { rows: bend, rests: bend_rest, maps, angles: bend_angles, angle_maps }
    }
}

impl<'a, R> HingeLists<'a, R, 6> {
    fn of_six(cloth: &'a ClothModel<R>) -> Self {
        let ClothModel { bend_six, bend_six_rest, bend_six_angles, strength_maps, .. } = cloth;
        let (maps, angle_maps) = (&strength_maps.bend_six, &strength_maps.angles_six);
        Self { rows: bend_six, rests: bend_six_rest, maps, angles: bend_six_angles, angle_maps }
    }
}
