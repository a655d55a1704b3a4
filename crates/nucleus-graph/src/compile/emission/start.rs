//! The start of a particle, and its speed.

use nalgebra::{Matrix3, Vector3};

use crate::attributes::point_emitter;
use crate::graph::{EvalContext, NodeId};

use super::random::Random;

type Vec3 = Vector3<f64>;

/// The start of a particle, in world space.
pub(super) struct Start {
    /// In scene units.
    pub(super) position: Vec3,
    /// In scene units per second.
    pub(super) velocity: Vec3,
    /// Velocity of the emitter there, in scene units per second.
    pub(super) carried: Vec3,
}

/// The speed of new particles.
#[derive(Debug, Clone, Copy)]
pub(super) struct Speed {
    speed: f64,
    range: f64,
}

impl Speed {
    pub(super) fn new(emitter: NodeId, moment: &EvalContext) -> Self {
        let get = |key| moment.get(emitter, key);
        Self { speed: get(&point_emitter::SPEED), range: get(&point_emitter::SPEED_RANDOM) }
    }

    /// Without a random part.
    #[cfg(test)]
    pub(super) fn constant(speed: f64) -> Self {
        Self { speed, range: 0.0 }
    }

    /// `speed` give or take half of `speedRandom`.
    pub(super) fn draw(&self, random: &mut Random) -> f64 {
        self.speed + self.range * (random.next() - 0.5)
    }
}

/// A vector about +z, turned so that +z points along an axis; zero without an axis.
pub(super) fn turned_to(axis: Vec3, vector: Vec3) -> Vec3 {
    let Some(z) = axis.try_normalize(0.0) else { return Vec3::zeros() };
    let aside = if z.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
    let x = aside.cross(&z).normalize();
    Matrix3::from_columns(&[x, z.cross(&x), z]) * vector
}
