//! The start of a frame: anchors move to the current positions, pins take their motion, and rows read the new anchors.
//! From here to the end of the frame no column grows.

use nalgebra::Vector3;

use crate::input::frame::{FrameInput, Pin};
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// Lane groups per task.
const GROUPS_PER_TASK: u32 = 1024;
/// Rows per task.
const ROWS_PER_TASK: usize = 1024;

impl<R: Real> State<R> {
    /// The wind carries the air, and with it the gusts.
    pub fn carry_air(&mut self, frame: &FrameInput) {
        (0..3).for_each(|axis| self.wind_travel[axis] += frame.wind[axis] * frame.duration);
    }

    /// Moves every anchor to its point's position; displacements become zero, and every point is free.
    pub fn move_anchors(&mut self) {
        for ((anchor, row), mass) in
            self.anchor.iter_mut().zip(&mut self.displacement).zip(&self.inverse_mass)
        {
            for axis in 0..3 {
                anchor[axis] += row.0[axis].to_f64();
            }
            *row = Row4([R::ZERO, R::ZERO, R::ZERO, *mass]);
        }
    }

    /// Pins a point: it has no inverse mass, and moves on a straight line in `duration` seconds. Whether the pin starts
    /// where the point is not.
    pub fn pin(&mut self, row: u32, pin: &Pin, duration: f64) -> bool {
        let row = row as usize;
        let start: [f64; 3] = pin.start.into();
        let is_moved_elsewhere = self.anchor[row] != start;
        self.anchor[row] = start;
        self.displacement[row].0[3] = R::ZERO;
        self.velocity[row] = Row4::new(((pin.end - pin.start) / duration).into(), R::ZERO);
        is_moved_elsewhere
    }

    /// Sets the velocity in m/s of a point that has no pin.
    pub fn set_free_velocity(&mut self, row: u32, velocity: Vector3<f64>) {
        let row = row as usize;
        if self.displacement[row].0[3] > R::ZERO {
            self.velocity[row] = Row4::new(velocity.into(), R::ZERO);
        }
    }

    /// Holds a point that has no pin where it is.
    pub fn hold(&mut self, row: u32) {
        let row = row as usize;
        if self.displacement[row].0[3] > R::ZERO {
            self.displacement[row].0[3] = R::ZERO;
            self.velocity[row] = Row4::ZERO;
        }
    }

    /// Stores the displacements at the start of a time step of `h` seconds, where contact is possible.
    pub fn store_step_start(&mut self, h: f64, can_touch: bool, pool: &ThreadPool) {
        let Self { start, depenetration, bearing_depenetration, displacement, displaced, .. } = self;
        displaced.clear();
        self.step_length = h;
        // Also where contact has just become impossible: a ground plane can be keyed off.
        let rows = if can_touch { displacement.len() } else { 0 };
        depenetration.resize(rows, Row4::ZERO);
        bearing_depenetration.resize(rows, Row4::ZERO);
        if can_touch {
            start.resize(rows, Row4::ZERO);
        }
        let columns = [start, depenetration, bearing_depenetration].map(|column| DisjointSlice::new(column));
        pool.parallel_for(rows.div_ceil(ROWS_PER_TASK), |task| {
            let own = task * ROWS_PER_TASK..rows.min((task + 1) * ROWS_PER_TASK);
            // SAFETY: no two tasks have a row in common.
            #[allow(unsafe_code)]
            let [start, depenetration, bearing] =
                columns.each_ref().map(|column| unsafe { column.run(own.start as u32..own.end as u32) });
            start.copy_from_slice(&displacement[own]);
            depenetration.fill(Row4::ZERO);
            bearing.fill(Row4::ZERO);
        });
    }
}

/// Updates the part of every row that depends on the anchors alone.
pub fn update_anchors<R: Real>(cloths: &mut [ClothModel<R>], anchors: &[[f64; 3]], pool: &ThreadPool) {
    for cloth in cloths {
        for_each_group(pool, cloth.stretch.groups_mut(), |group| group.anchor(anchors));
        for_each_group(pool, cloth.shear.groups_mut(), |group| group.anchor(anchors));
        for_each_group(pool, cloth.bend.groups_mut(), |group| group.anchor(anchors));
        for_each_group(pool, cloth.bend_six.groups_mut(), |group| group.anchor(anchors));
        let hinges = cloth.bend.groups().iter().zip(cloth.bend_angles.groups_mut());
        hinges.for_each(|(hinge, angle)| angle.anchor(hinge, anchors));
        let hinges = cloth.bend_six.groups().iter().zip(cloth.bend_six_angles.groups_mut());
        hinges.for_each(|(hinge, angle)| angle.anchor(hinge, anchors));
    }
}

fn for_each_group<G: Copy + Send>(pool: &ThreadPool, groups: &mut [G], work: impl Fn(&mut G) + Sync) {
    let count = groups.len() as u32;
    let groups = DisjointSlice::new(groups);
    pool.parallel_for(count.div_ceil(GROUPS_PER_TASK) as usize, |task| {
        let from = task as u32 * GROUPS_PER_TASK;
        // SAFETY: no two tasks have a group in common.
        #[allow(unsafe_code)]
        let run = unsafe { groups.run(from..count.min(from + GROUPS_PER_TASK)) };
        run.iter_mut().for_each(&work);
    });
}
