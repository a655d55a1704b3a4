//! The state: the columns that a frame changes.
//!
//! A position is a displacement, in the solver's scalar, from an `f64` anchor that moves to the point at the start of
//! each frame. A velocity is stored and corrected, never derived from large positions. With plain `f32` positions a
//! body 10 units up stops falling at 200 substeps a frame, because a step is smaller than the last bit of its height.

pub mod kinematics;

use crate::bytes::{HASH_SEED, hash_word};
use crate::constraints::pressure::Chamber;
use crate::math::{Real, Row4, sub};
use crate::model::ClothModel;
use crate::model::builder::{Cloth, point_masses};

/// The points of all cloths, in the solver's order; positions in world space.
#[derive(Debug, Clone)]
pub struct State<R> {
    /// Position at the start of the frame, in metres. Written when a frame begins.
    pub anchor: Vec<[f64; 3]>,
    /// Displacement from the anchor in metres, and inverse mass in 1/kg in this frame (0: pinned).
    pub displacement: Vec<Row4<R>>,
    /// Velocity in m/s.
    pub velocity: Vec<Row4<R>>,
    /// Displacement at the start of the time step, in metres; empty where no contact is possible.
    pub start: Vec<Row4<R>>,
    /// Displacement by depenetration from colliders in the time step, in metres: a motion without velocity. Empty where
    /// no contact is possible.
    pub depenetration_by_collider: Vec<Row4<R>>,
    /// Displacement by depenetration from cloth in the time step, in metres: a motion without velocity. The part that a
    /// collider takes back does become velocity, because cloth between the two carries the load. Empty where no contact
    /// is possible.
    pub depenetration_by_cloth: Vec<Row4<R>>,
    /// Length of the last time step in seconds.
    pub step_length: f64,
    /// Displacement before constraints and contacts, in metres. Written by prediction, read by the velocity update.
    pub predicted: Vec<Row4<R>>,
    /// Normal of unit length; empty where no cloth feels air. Written once per substep.
    pub normal: Vec<Row4<R>>,
    /// ∂V/∂x of the volume inside, in m²; empty where no cloth has pressure. Written and read in a pass.
    pub area: Vec<Row4<R>>,
    /// What gusts add to the wind, in m/s; empty while the wind is steady. Written once per substep.
    pub gust: Vec<Row4<R>>,
    /// How far the wind has carried the air since the start, in metres.
    pub wind_travel: [f64; 3],
    /// The gas in each chamber of each cloth that has pressure.
    pub chambers: Vec<Chamber>,
    /// The rotation of each shell of each cloth that keeps its shape, as a quaternion x, y, z, w.
    pub rotations: Vec<[f64; 4]>,
    /// Inverse mass in 1/kg of the unpinned point.
    pub inverse_mass: Vec<R>,
}

impl<R: Real> State<R> {
    /// Columns for all cloths, at the start that each cloth gives. Padding points have no mass.
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
            area: vec![Row4::ZERO; if models.iter().any(|model| model.pressure.is_on()) { rows } else { 0 }],
            gust: Vec::new(),
            wind_travel: [0.0; 3],
            chambers: Vec::new(),
            rotations: Vec::new(),
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
                // The mass of a sliver's point may vanish: its inverse stays finite in `f32`, and rounding never pins
                // it.
                state.inverse_mass[row] = R::from_f64((1.0 / masses[point]).clamp(1e-30, 1e30));
            }
        }
        state
    }

    /// The position of a point in metres, in world space.
    pub fn position(&self, row: u32) -> [f64; 3] {
        let (anchor, moved) = (self.anchor[row as usize], self.displacement[row as usize].0);
        std::array::from_fn(|axis| anchor[axis] + moved[axis].to_f64())
    }

    /// The velocity of a point in m/s, for observers: where contacts displaced the point without velocity, its motion
    /// in the last time step. Resting cloth has a stored velocity there that contacts cancel in every step.
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

    /// A hash of all positions and velocities: equal bits give equal hashes.
    pub fn hash(&self) -> u64 {
        let words = |row: &Row4<R>| row.xyz().map(R::to_bits);
        let anchors = self.anchor.iter().flatten().map(|x| x.to_bits());
        let moved = self.displacement.iter().flat_map(words);
        let fast = self.velocity.iter().flat_map(words);
        anchors.chain(moved).chain(fast).fold(HASH_SEED, hash_word)
    }
}
