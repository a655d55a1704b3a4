//! Input mesh attract: attraction of points to their positions on the animated input mesh, and to its velocity.
//!
//! Each point is attached to its goal by a spring of a stiffness per mass, implicit in position, with a damper whose
//! share of critical damping is `inputAttractDamp`, implicit in velocity. `inputMotionDrag` is a damper alone: it works
//! without attraction. Classic: `inputMeshAttract` is the share of the way that a point goes in 1/24 s.

use nalgebra::Vector3;

use crate::input::frame::{COUNT_PERIOD, InputAttract, InputMesh};
use crate::math::Real;
use crate::model::ClothModel;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// Angular frequency in rad/s of a point about its goal for an `inputMeshAttract` of 1: 24 Hz.
const ATTRACT_RATE: f64 = 150.8;

/// One cloth and its input mesh in one time step.
pub struct Attraction<'a, R> {
    /// The cloth.
    pub cloth: &'a ClothModel<R>,
    /// Its input mesh.
    pub mesh: &'a InputMesh,
    /// The attributes.
    pub settings: InputAttract,
    /// Length of the frame in seconds.
    pub duration: f64,
    /// Length of the time step in seconds.
    pub h: f64,
}

impl<R: Real> Attraction<'_, R> {
    fn factor(&self, point: usize) -> f64 {
        self.cloth.attract.get(point).copied().unwrap_or(1.0)
    }

    /// Velocities take up those of the input mesh, before the points are moved.
    pub fn drag(&self, state: &mut State<R>, pool: &ThreadPool) {
        let InputAttract { strength, damp, motion_drag } = self.settings;
        let velocity = DisjointSlice::new(&mut state.velocity);
        let displacement = &state.displacement;
        self.for_points(pool, |row, point| {
            let attract = (strength * self.factor(point)).max(0.0);
            let rate =
                2.0 * damp.max(0.0) * ATTRACT_RATE * attract.sqrt() + motion_drag.max(0.0) / COUNT_PERIOD;
            let taken = R::from_f64(rate * self.h / (1.0 + rate * self.h));
            let goal = (self.mesh.end[point] - self.mesh.start[point]) / self.duration;
            if displacement[row as usize].0[3] > R::ZERO {
                // SAFETY: tasks have points of their own.
                #[allow(unsafe_code)]
                unsafe {
                    let mut v = velocity.get(row);
                    (0..3).for_each(|axis| v.0[axis] += (R::from_f64(goal[axis]) - v.0[axis]) * taken);
                    velocity.set(row, v);
                }
            }
        });
    }

    /// Draws the points to their goals at a share `time` of the frame; `share` of the way each, or as the spring says.
    pub fn pull(&self, state: &mut State<R>, time: f64, share: Option<f64>, pool: &ThreadPool) {
        let anchor = &state.anchor;
        let displacement = DisjointSlice::new(&mut state.displacement);
        self.for_points(pool, |row, point| {
            let factor = self.factor(point);
            let stiff =
                ATTRACT_RATE * ATTRACT_RATE * self.settings.strength.max(0.0) * factor * self.h * self.h;
            let taken = share.map_or(stiff / (1.0 + stiff), |share| (share * factor).clamp(0.0, 1.0));
            let (start, end) = (self.mesh.start[point], self.mesh.end[point]);
            let goal: Vector3<f64> = start + (end - start) * time - Vector3::from(anchor[row as usize]);
            // SAFETY: tasks have points of their own.
            #[allow(unsafe_code)]
            unsafe {
                let mut x = displacement.get(row);
                if x.0[3] > R::ZERO {
                    let taken = R::from_f64(taken);
                    (0..3).for_each(|axis| x.0[axis] += (R::from_f64(goal[axis]) - x.0[axis]) * taken);
                    displacement.set(row, x);
                }
            }
        });
    }

    fn for_points(&self, pool: &ThreadPool, work: impl Fn(u32, usize) + Sync) {
        let first = self.cloth.points().start;
        pool.parallel_for(self.cloth.blocks.len(), |block| {
            for row in self.cloth.blocks.range(block) {
                work(row, self.cloth.order.user((row - first) as usize));
            }
        });
    }
}
