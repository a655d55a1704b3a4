//! All that changes: copy it and you can go on from here.
//!
//! Positions are an `f32` displacement from an `f64` anchor that is set anew at each frame, and velocity is
//! kept and corrected, never taken from large positions. With plain `f32` positions a body 10 units up stops
//! falling at 200 substeps a frame, because a step is smaller than the last bit of its height.

pub mod checkpoint;
mod kinematics;

use crate::math::{Real, Row4, sub};
use crate::model::builder::Cloth;
use crate::model::{ClothModel, point_masses};

/// The points of all cloths, in the solver's places.
#[derive(Debug, Clone)]
pub struct State<R> {
    /// Where each point was at the start of the frame, in metres. Written when a frame begins.
    pub anchor: Vec<[f64; 3]>,
    /// Displacement from the anchor in metres, and the inverse mass in 1/kg that holds in this frame (0: pinned).
    pub displacement: Vec<Row4<R>>,
    /// Velocity in m/s.
    pub velocity: Vec<Row4<R>>,
    /// Displacement at the start of the time step; empty where nothing can be met.
    pub start: Vec<Row4<R>>,
    /// How far colliders led the point in the time step, in metres: a motion without velocity. Empty where nothing can be
    /// met.
    pub depenetration_by_collider: Vec<Row4<R>>,
    /// How far contacts with cloth led the point in the time step, in metres: as little a velocity, but what a collider takes
    /// back of it is one, for what is between the two has to bear the load. Empty where nothing can be met.
    pub depenetration_by_cloth: Vec<Row4<R>>,
    /// Length of the last time step in seconds.
    pub step_length: f64,
    /// Displacement before anything held the point. Written by predict, read by velocity.
    pub predicted: Vec<Row4<R>>,
    /// Normal of unit length; empty where no air is felt. Written once per substep.
    pub normal: Vec<Row4<R>>,
    /// Inverse mass in 1/kg of the point when it is free.
    pub inverse_mass: Vec<R>,
}

impl<R: Real> State<R> {
    /// Columns for all cloths, everything at rest where the meshes are. Stand-ins have no mass.
    pub fn new(cloths: &[Cloth], models: &[ClothModel<R>]) -> Self {
        let rows = models.last().map_or(0, |last| last.points().start + last.blocks.columns()) as usize;
        let air = models.iter().any(|model| !model.triangles.is_empty());
        let mut state = Self {
            anchor: vec![[0.0; 3]; rows],
            displacement: vec![Row4::ZERO; rows],
            velocity: vec![Row4::ZERO; rows],
            start: Vec::new(),
            depenetration_by_collider: Vec::new(),
            depenetration_by_cloth: Vec::new(),
            step_length: 0.0,
            predicted: vec![Row4::ZERO; rows],
            normal: vec![Row4::ZERO; if air { rows } else { 0 }],
            inverse_mass: vec![R::ZERO; rows],
        };
        for (cloth, model) in cloths.iter().zip(models) {
            let masses = point_masses(cloth);
            for (point, position) in cloth.positions().iter().enumerate() {
                let row = model.place(point) as usize;
                state.anchor[row] = (*position).into();
                if let Some(velocity) = cloth.start.velocities.get(point) {
                    state.velocity[row] = Row4::new((*velocity).into(), R::ZERO);
                }
                // The point of a sliver weighs next to nothing: still a number in `f32`, and never pinned by rounding.
                state.inverse_mass[row] = R::from_f64((1.0 / masses[point]).clamp(1e-30, 1e30));
            }
        }
        state
    }

    /// Where a point is, in metres.
    pub fn position(&self, row: u32) -> [f64; 3] {
        let (anchor, moved) = (self.anchor[row as usize], self.displacement[row as usize].0);
        std::array::from_fn(|axis| anchor[axis] + moved[axis].to_f64())
    }

    /// How fast a point moves, in m/s: its velocity, or how it moved in the last time step where contacts led it. What lies
    /// still has a velocity there that contacts undo in every step.
    pub fn seen_velocity(&self, row: u32) -> [f64; 3] {
        let row = row as usize;
        let is_depenetrated =
            |column: &[Row4<R>]| column.get(row).is_some_and(|row| row.xyz() != [R::ZERO; 3]);
        if is_depenetrated(&self.depenetration_by_collider) || is_depenetrated(&self.depenetration_by_cloth) {
            let moved = sub(self.displacement[row].xyz(), self.start[row].xyz());
            return moved.map(|x| x.to_f64() / self.step_length);
        }
        self.velocity[row].xyz().map(R::to_f64)
    }

    /// A fingerprint of all positions and velocities: equal bits, equal hash (FNV-1a over words).
    pub fn hash(&self) -> u64 {
        let words = |row: &Row4<R>| row.xyz().map(R::to_bits);
        let anchors = self.anchor.iter().flatten().map(|x| x.to_bits());
        let moved = self.displacement.iter().flat_map(words);
        let fast = self.velocity.iter().flat_map(words);
        anchors.chain(moved).chain(fast).fold(0xcbf2_9ce4_8422_2325, |hash, word| {
            (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23)
        })
    }
}
