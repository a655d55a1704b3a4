//! The start of a frame: anchors move to where the points are, pins and colliders take up their motion, and
//! rows take up the new anchors. From here to the end of the frame nothing is allocated that was not before.

use crate::input::frame::{FrameInput, Pin};
use crate::math::{Real, Row4};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::solver::Solver;

impl<R: Real> Solver<R> {
    /// Takes up what a frame brings.
    pub(crate) fn begin_frame(&mut self, frame: &FrameInput) {
        self.begin_collider_contact(frame);
        self.begin_contact(frame);
        self.move_anchors();
        for pin in &frame.pins {
            self.hold(pin, frame.duration);
        }
        self.anchor_rows();
        if let Some(cloth_contacts) = &mut self.cloth_contacts {
            cloth_contacts.cache.update_anchors(&self.state.anchor);
        }
        for (state, motion) in self.collider_states.iter_mut().zip(&frame.colliders) {
            state.begin_frame(&motion.start, &motion.end);
        }
        self.find_near_colliders(frame);
        self.ground.begin_frame(frame.plane.as_ref(), &self.state.anchor);
    }

    fn move_anchors(&mut self) {
        let state = &mut self.state;
        for ((anchor, row), mass) in
            state.anchor.iter_mut().zip(&mut state.displacement).zip(&state.inverse_mass)
        {
            for axis in 0..3 {
                anchor[axis] += row.0[axis].to_f64();
            }
            *row = Row4([R::ZERO, R::ZERO, R::ZERO, *mass]);
        }
    }

    /// A pinned point is one of endless mass on its way.
    fn hold(&mut self, pin: &Pin, duration: f64) {
        let row = self.cloths[pin.cloth.index()].place(pin.point.index()) as usize;
        let start: [f64; 3] = pin.start.into();
        // Put somewhere else, it is foreseen nowhere.
        if self.state.anchor[row] != start {
            self.invalidate_bounds(row);
        }
        self.state.anchor[row] = start;
        self.state.displacement[row].0[3] = R::ZERO;
        self.state.velocity[row] = Row4::new(((pin.end - pin.start) / duration).into(), R::ZERO);
    }

    /// Rows take up where the anchors are.
    pub(crate) fn anchor_rows(&mut self) {
        let Self { cloths, state, pool, .. } = self;
        let anchors = &state.anchor;
        for cloth in cloths {
            on_all(pool, cloth.stretch.groups_mut(), |group| group.anchor(anchors));
            on_all(pool, cloth.shear.groups_mut(), |group| group.anchor(anchors));
            on_all(pool, cloth.bend.groups_mut(), |group| group.anchor(anchors));
            on_all(pool, cloth.fold.groups_mut(), |group| group.anchor(anchors));
        }
    }
}

/// Does `work` on every lane group, in tasks of a thousand.
fn on_all<G: Copy + Send>(pool: &ThreadPool, groups: &mut [G], work: impl Fn(&mut G) + Sync) {
    let count = groups.len() as u32;
    let groups = DisjointSlice::new(groups);
    pool.parallel_for(count.div_ceil(1024) as usize, |task| {
        let from = task as u32 * 1024;
        // SAFETY: tasks have groups of their own.
        #[allow(unsafe_code)]
        let run = unsafe { groups.run(from..count.min(from + 1024)) };
        run.iter_mut().for_each(&work);
    });
}
