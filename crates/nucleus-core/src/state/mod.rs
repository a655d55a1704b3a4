//! The state: the columns that a frame changes.
//!
//! A position is a displacement, in the solver's scalar, from an `f64` anchor that moves to the point at the start of
//! each frame. A velocity is stored and corrected, never derived from large positions. With plain `f32` positions a
//! body 10 units above the origin stops falling at 200 substeps a frame, because a step is smaller than the last bit of
//! its height.

pub mod inflation;
pub mod kinematics;
pub mod rows;
pub mod start;

use std::ops::Range;

use nalgebra::Vector3;

use crate::bytes::{HASH_SEED, hash_word};
use crate::math::{Real, Row4, sub};
use crate::particles::population::Population;

use inflation::Inflation;

/// The points of all cloths, in the solver's order; positions in world space.
#[derive(Debug, Clone)]
pub struct State<R> {
    /// Position at the start of the frame, in metres. Written when a frame begins.
    pub anchor: Vec<[f64; 3]>,
    /// Displacement from the anchor in metres, and inverse mass in 1/kg in this frame (0: pinned).
    pub displacement: Vec<Row4<R>>,
    /// Velocity in m/s.
    pub velocity: Vec<Row4<R>>,
    /// Displacement at the start of the time step, in metres; empty where no contact is possible,
    /// or only that of free points.
    pub start: Vec<Row4<R>>,
    /// Displacement by depenetration in the time step, in metres: a motion without velocity, also where another contact
    /// reverses it. Empty where the scene has no contact.
    pub depenetration: Vec<Row4<R>>,
    /// The same where cloth bears the load of other cloth: what another contact reverses becomes velocity, or a stack would
    /// sink. Empty where the scene has no contact.
    pub bearing_depenetration: Vec<Row4<R>>,
    /// Points that `pushOut` has moved in the substep, and their velocities in m/s.
    pub pushed_out: Vec<(u32, [R; 3])>,
    /// Free points that contact has displaced without velocity in the time step, in order, and their motion in m/s.
    pub displaced: Vec<(u32, [R; 3])>,
    /// Length of the last time step in seconds.
    pub step_length: f64,
    /// Displacement before constraints and contacts, in metres; empty where all points are free. Written by prediction,
    /// read by the velocity update.
    pub predicted: Vec<Row4<R>>,
    /// Sums of corrections in metres; empty where every cloth corrects its links one after another. Written and read in
    /// a sweep.
    pub corrections: Vec<Row4<R>>,
    /// Normal of unit length; empty if air acts on no cloth. Written once per substep.
    pub normal: Vec<[R; 3]>,
    /// ∂V/∂x of the volume inside, in m²; empty where no cloth has pressure. Written and read in a pass.
    pub area: Vec<Row4<R>>,
    /// Other columns of that pass.
    pub inflation: Inflation<R>,
    /// What gusts, wind shadows and pushed air add to the wind, in m/s; empty where nothing does. Written once per
    /// substep.
    pub added_wind: Vec<Row4<R>>,
    /// Acceleration by fields in m/s²; empty without fields. Written once per frame, or per substep.
    pub field: Vec<Row4<R>>,
    /// Number of frames that have been solved; decides the direction of sweeps.
    pub frames: u64,
    /// How far the wind has carried the air since the start, in metres.
    pub wind_travel: [f64; 3],
    /// The gas in each chamber of each cloth that has pressure.
    pub chambers: Vec<Chamber>,
    /// The rotation of each shell of each cloth that keeps its shape, as a quaternion x, y, z, w.
    pub rotations: Vec<[f64; 4]>,
    /// Angular momentum of each part of a cloth before damping, if it is not pinned. Written and read in a pass.
    pub spins: Vec<Option<Vector3<f64>>>,
    /// Inverse mass in 1/kg of the unpinned point.
    pub inverse_mass: Vec<R>,
    /// The particles of each object in which particles are born and die.
    pub populations: Vec<Population>,
}

/// The inverse in 1/kg of a mass in kilograms. The mass of a sliver's point may vanish: its inverse stays finite in `f32`, and
/// rounding never pins a point.
pub fn inverse_mass_of<R: Real>(mass: f64) -> R {
    R::from_f64((1.0 / mass).clamp(1e-30, 1e30))
}

/// The gas in one chamber.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chamber {
    /// Volume at the start in m³; below zero for a mesh that is inside out.
    pub start_volume: f64,
    /// Volume at the end of the last time step in m³.
    pub volume: f64,
    /// Volume of its air at ambient pressure, in start volumes; below zero until the first frame sets it.
    pub amount: f64,
    /// Area of the holes where it is torn, in m².
    pub torn: f64,
}

impl<R: Real> State<R> {
    /// The particles of an object, by the index of its cloth; `None` where none are born or die.
    pub fn population_of(&self, cloth: usize) -> Option<&Population> {
        self.populations.iter().find(|population| population.cloth() == cloth)
    }

    /// The position of a point in metres, in world space.
    pub fn position(&self, row: u32) -> [f64; 3] {
        let (anchor, moved) = (self.anchor[row as usize], self.displacement[row as usize].0);
        std::array::from_fn(|axis| anchor[axis] + moved[axis].to_f64())
    }

    /// The velocity of a point in m/s, for observers: where contacts displaced the point without velocity, its motion
    /// in the last time step. Resting cloth has a stored velocity there that contacts cancel in every step.
    pub fn seen_velocity(&self, row: u32) -> [f64; 3] {
        match self.displaced.binary_search_by_key(&row, |&(row, _)| row) {
            Ok(at) => self.displaced[at].1.map(R::to_f64),
            Err(_) => self.velocity_or_motion(row as usize),
        }
    }

    /// [`seen_velocity`](Self::seen_velocity) of each point of a range.
    pub fn seen_velocities(&self, rows: Range<u32>) -> impl Iterator<Item = [f64; 3]> + '_ {
        let mut next = self.displaced.partition_point(|&(row, _)| row < rows.start);
        rows.map(move |row| match self.displaced.get(next) {
            Some(&(at, motion)) if at == row => {
                next += 1;
                motion.map(R::to_f64)
            }
            _ => self.velocity_or_motion(row as usize),
        })
    }

    /// The velocity of a point, or its motion where the columns of depenetration hold any.
    #[inline(always)]
    fn velocity_or_motion(&self, row: usize) -> [f64; 3] {
        let is_depenetrated =
            |column: &[Row4<R>]| column.get(row).is_some_and(|row| row.xyz() != [R::ZERO; 3]);
        if is_depenetrated(&self.depenetration) || is_depenetrated(&self.bearing_depenetration) {
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
