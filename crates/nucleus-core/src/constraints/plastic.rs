//! Plasticity: links pulled beyond `restitutionTension` lengthen, and hinges bent beyond `restitutionAngle` take a set,
//! by as much as brings them back to the limit. Once per time step, after contact.

use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::model::rows::RowList;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::angle::{AngleGroup, AngleMemory};
use super::hinge::HingeGroup;
use super::strength_map::StrengthGroup;
use super::stretch::LinkGroup;

/// Groups of rows per task.
const TASK: u32 = 256;

impl<R: Real> LinkGroup<R> {
    /// Lengthens links whose strain is above `limit`, so that it is at the limit.
    fn creep(&mut self, points: &[Row4<R>], rest_scale: R, limit: R) {
        let strain = self.strain(points, rest_scale);
        for lane in 0..4 {
            if strain[lane] > limit {
                self.rest_length[lane] = self.rest_length[lane] * (R::ONE + strain[lane]) / (R::ONE + limit);
            }
        }
    }
}

/// Lengthens the links of a cloth whose strain is above `limit`.
pub fn creep<R: Real>(
    cloth: &mut ClothModel<R>,
    points: &[Row4<R>],
    rest_scale: R,
    limit: R,
    pool: &ThreadPool,
) {
    for list in [&mut cloth.stretch, &mut cloth.shear] {
        let groups = list.groups_mut();
        for_groups(groups, pool, |_, group| group.creep(points, rest_scale, limit));
    }
}

/// Updates the rest angles and flip states of the hinges of a cloth.
pub fn remember_angles<R: Real>(
    cloth: &mut ClothModel<R>,
    points: &[Row4<R>],
    memory: &AngleMemory<R>,
    pool: &ThreadPool,
) {
    let maps = &cloth.strength_maps;
    update(&cloth.bend, &mut cloth.bend_angles, maps.angles.groups(), points, memory, pool);
    update(&cloth.bend_six, &mut cloth.bend_six_angles, maps.angles_six.groups(), points, memory, pool);
}

fn update<R: Real, const N: usize>(
    hinges: &RowList<HingeGroup<R, N>>,
    angles: &mut RowList<AngleGroup<R>>,
    maps: &[StrengthGroup<R>],
    points: &[Row4<R>],
    memory: &AngleMemory<R>,
    pool: &ThreadPool,
) {
    let hinges = hinges.groups();
    for_groups(angles.groups_mut(), pool, |at, angle| {
        memory.update(&hinges[at], angle, maps.get(at), points)
    });
}

/// Does `work` on every group, in tasks of a fixed size.
fn for_groups<G: Copy + Send>(groups: &mut [G], pool: &ThreadPool, work: impl Fn(usize, &mut G) + Sync) {
    let count = groups.len() as u32;
    let groups = DisjointSlice::new(groups);
    pool.parallel_for(count.div_ceil(TASK) as usize, |task| {
        let from = task as u32 * TASK;
        // SAFETY: tasks have groups of their own.
        #[allow(unsafe_code)]
        let run = unsafe { groups.run(from..count.min(from + TASK)) };
        (from as usize..).zip(run).for_each(|(at, group)| work(at, group));
    });
}
