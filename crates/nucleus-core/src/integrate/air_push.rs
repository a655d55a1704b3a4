//! Pushed air: the motion of an object is wind for others (`airPushDistance`).
//!
//! At a distance d from its nearest point the air has a share (1 - d / D)² of that point's velocity relative to the
//! air, where D is the range. At the surface the air thus moves with the surface, and an object at rest slows the wind.
//! `airPushVorticity` blends that flow into the one around a moving ball: the dipole (3 n (n·u) - u) / 2 of potential
//! flow (Batchelor 1967, §2.9), which goes along with the motion u before and behind the object and back at its sides.
//! Maya's own falloffs are not published.

use nalgebra::Vector3;

use crate::contact::placed_surface::PlacedSurface;
use crate::input::object_fields::WindField;

/// The air around one object.
pub struct AirPush<'a> {
    /// The index of the cloth, on which its own air does not act.
    pub cloth: Option<usize>,
    surface: &'a PlacedSurface,
    /// By corner of the surface, in m/s.
    velocity: Vec<Vector3<f64>>,
    /// In metres.
    distance: f64,
    vorticity: f64,
}

impl<'a> AirPush<'a> {
    /// The air around a surface whose corners have these velocities.
    pub fn new(
        surface: &'a PlacedSurface,
        settings: &WindField,
        cloth: Option<usize>,
        velocity: Vec<Vector3<f64>>,
    ) -> Self {
        let (distance, vorticity) = (settings.push_distance, settings.push_vorticity.clamp(0.0, 1.0));
        Self { cloth, surface, velocity, distance, vorticity }
    }

    /// The wind at a place, from the wind without this object, in m/s; `place` in metres.
    pub fn blend(&self, wind: Vector3<f64>, place: Vector3<f64>) -> Vector3<f64> {
        let Some(nearest) = self.surface.nearest(place, self.distance) else { return wind };
        let along = nearest.mean(|corner| self.velocity[corner as usize]) - wind;
        let away = (place - nearest.point).try_normalize(0.0).unwrap_or(nearest.normal);
        let dipole = (away * (3.0 * away.dot(&along)) - along) / 2.0;
        let falloff = 1.0 - nearest.distance / self.distance;
        wind + (along + (dipole - along) * self.vorticity) * (falloff * falloff)
    }
}
