//! The solver: a model, its state, and the step. (Skeleton: points fall freely.)

use nalgebra::Vector3;

use crate::{ClothId, ColliderId, FrameInput, ModelBuilder, Moment, StateView, StepObserver, StepReport};

/// A scalar the solver can work in: `f32` to be fast, `f64` for references.
pub trait Real: Copy + Send + Sync + 'static {}
impl Real for f32 {}
impl Real for f64 {}

/// One list of rows, or one pass over all points, and what a frame spends on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassCost {
    /// The pass, named after what it does: `stretch`, `bend`, `collide` ...
    pub name: &'static str,
    /// Rows in its list.
    pub rows: usize,
    /// Visits of the whole list in a frame.
    pub sweeps: f64,
}

/// Everything needed to advance a scene by a frame.
pub struct Solver<R: Real = f32> {
    builder: ModelBuilder,
    velocity: Vec<Vector3<f64>>,
    _scalar: std::marker::PhantomData<R>,
}

impl<R: Real> Solver<R> {
    /// Builds lists, trees and state. `threads` is the number of cores to use; it never changes a bit of the result.
    pub fn new(builder: ModelBuilder, _threads: usize) -> Self {
        let n = builder.cloths.iter().map(|c| c.surface.positions.len()).sum();
        Self { builder, velocity: vec![Vector3::zeros(); n], _scalar: std::marker::PhantomData }
    }

    /// Advances by one frame. Cannot fail: what could not be satisfied is counted in the report.
    pub fn step(&mut self, frame: &FrameInput, watch: &mut dyn StepObserver) -> StepReport {
        let h = frame.duration / f64::from(frame.substeps);
        for substep in 1..=frame.substeps {
            let mut k = 0;
            for cloth in &mut self.builder.cloths {
                for p in &mut cloth.surface.positions {
                    self.velocity[k] += frame.gravity * h;
                    *p += self.velocity[k] * h;
                    k += 1;
                }
            }
            watch.substep(Moment { substep, substeps: frame.substeps }, self);
        }
        StepReport::default()
    }

    /// The passes a frame consists of, for `info`.
    pub fn passes(&self, _frame: &FrameInput) -> Vec<PassCost> {
        Vec::new()
    }

    /// A fingerprint of positions and velocities: equal bits, equal hash.
    pub fn state_hash(&self) -> u64 {
        0
    }
}

impl<R: Real> StateView for Solver<R> {
    fn positions(&self, cloth: ClothId, unit: f64, out: &mut Vec<[f32; 3]>) {
        out.clear();
        let points = &self.builder.cloths[cloth.index()].surface.positions;
        out.extend(points.iter().map(|p| [p.x, p.y, p.z].map(|x| (x * unit) as f32)));
    }
    fn velocities(&self, cloth: ClothId, unit: f64, out: &mut Vec<[f32; 3]>) {
        self.positions(cloth, unit * 0.0, out);
    }
    fn collider_positions(&self, collider: ColliderId, unit: f64, out: &mut Vec<[f32; 3]>) {
        out.clear();
        let points = &self.builder.colliders[collider.index()].surface.positions;
        out.extend(points.iter().map(|p| [p.x, p.y, p.z].map(|x| (x * unit) as f32)));
    }
    fn collider_moved(&self, _collider: ColliderId) -> bool {
        false
    }
    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        self.builder.cloths[cloth.index()].surface.positions[point]
    }
}
