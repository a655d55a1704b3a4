//! Where scene units become metres, and nowhere else.
//!
//! A scene unit is `spaceScale` metres (N1.3-1). Positions and thicknesses are in scene units; gravity,
//! wind, masses and forces are in metres, kilograms and seconds already. In scene units things therefore
//! fall with gravity / `spaceScale`.

use nalgebra::Vector3;
use nucleus_core::Surface;

/// How long a scene unit is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Units {
    metres_per_unit: f64,
}

impl Units {
    /// From `spaceScale`, which is above zero.
    pub(super) fn new(space_scale: f64) -> Self {
        Self { metres_per_unit: space_scale }
    }

    /// A length in metres.
    pub(super) fn length(self, units: f64) -> f64 {
        units * self.metres_per_unit
    }

    /// A position in metres.
    pub(super) fn point(self, units: Vector3<f64>) -> Vector3<f64> {
        units * self.metres_per_unit
    }

    /// A position in scene units.
    pub(super) fn scene_point(self, metres: Vector3<f64>) -> Vector3<f64> {
        metres / self.metres_per_unit
    }

    /// A surface in metres.
    pub(super) fn surface(self, mut surface: Surface) -> Surface {
        for position in &mut surface.positions {
            *position = self.point(*position);
        }
        surface
    }

    /// Scene units in a metre.
    pub(super) fn per_metre(self) -> f64 {
        1.0 / self.metres_per_unit
    }
}
