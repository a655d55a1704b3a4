//! One time step of one liquid, and what it reads of the scene.

use nalgebra::Vector3;

use crate::contact::system::ContactSystem;
use crate::input::frame::{FrameInput, Liquid};
use crate::math::Real;
use crate::model::Model;
use crate::schedule::StepInterval;

use super::excess::Recovery;

/// Inputs of a liquid from the scene.
#[derive(Clone, Copy)]
pub struct LiquidScene<'a, R: Real> {
    /// The objects.
    pub model: &'a Model<R>,
    /// Colliders and the ground plane in motion.
    pub contact: &'a ContactSystem<R>,
    /// The attributes.
    pub frame: &'a FrameInput,
}

/// One time step of one liquid.
#[derive(Debug, Clone, Copy)]
pub struct LiquidStep {
    /// The liquid, a cloth by its index.
    pub cloth: usize,
    /// Its attributes.
    pub settings: Liquid,
    /// Where lengths are taken from, in metres.
    pub origin: Vector3<f64>,
    /// Inverse mass of its first particle in 1/kg.
    pub inverse_mass: f64,
    /// Its length in seconds.
    pub h: f64,
    /// How much of it is after the time step of the nucleus in which it starts, in seconds.
    pub ahead: f64,
    /// Start and end, as shares of the frame.
    pub span: StepInterval,
}

impl LiquidStep {
    /// How fast an excess of density goes.
    pub fn recovery(&self) -> Recovery {
        Recovery::new(self.h, self.settings.spacing)
    }
}
