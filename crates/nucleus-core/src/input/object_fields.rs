//! Effects of objects at a distance: fields around their points, wind shadows, pushed air.

use crate::input::samples::FALLOFF_SAMPLES;

/// Force fields around the points of an object (`pointForceField`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointField {
    /// Acceleration of other objects' points at the radius, in m/s²; above 0 it repels.
    pub magnitude: f64,
    /// The same among the object's own points; above 0 it attracts (`selfAttract`).
    pub self_attract: f64,
    /// Radius of each point in metres, from which the distance counts.
    pub radius: f64,
    /// Range beyond the radius, in metres.
    pub distance: f64,
    /// Factor from the radius (first) to the distance (last), evenly spaced.
    pub falloff: [f64; FALLOFF_SAMPLES],
}

impl PointField {
    /// Whether it acts at all.
    pub fn is_on(&self) -> bool {
        (self.magnitude != 0.0 || self.self_attract != 0.0) && self.distance > 0.0
    }
}

/// Effect of a surface on the wind at other objects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindField {
    /// Length of its wind shadow in metres (`windShadowDistance`).
    pub shadow_distance: f64,
    /// Diffusion of wind into the shadow, 0 to 1 (`windShadowDiffusion`).
    pub shadow_diffusion: f64,
    /// Whether it casts the shadow on itself too (`windSelfShadow`).
    pub self_shadow: bool,
    /// Range of the air that it moves, in metres (`airPushDistance`).
    pub push_distance: f64,
    /// Share of that air that flows back around it, 0 to 1 (`airPushVorticity`).
    pub push_vorticity: f64,
}

impl WindField {
    /// None.
    pub const OFF: Self = Self {
        shadow_distance: 0.0,
        shadow_diffusion: 0.0,
        self_shadow: false,
        push_distance: 0.0,
        push_vorticity: 0.0,
    };

    /// Whether it casts a wind shadow.
    pub fn casts_shadow(&self) -> bool {
        self.shadow_distance > 0.0
    }

    /// Whether it pushes air.
    pub fn pushes_air(&self) -> bool {
        self.push_distance > 0.0
    }
}
