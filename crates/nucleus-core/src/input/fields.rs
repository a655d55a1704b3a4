//! Force fields of the scene: their effect at a point, their range, and the objects that they act on. Metres,
//! kilograms, seconds; world space.

use nalgebra::{Matrix3, Vector3};

use crate::input::ClothId;
use crate::input::samples::FALLOFF_SAMPLES;

/// A force field in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Its effect.
    pub kind: FieldKind,
    /// Its range and falloff.
    pub reach: Reach,
    /// The objects that it acts on, each with a factor on the force.
    pub targets: Vec<(ClothId, f64)>,
}

/// The effect of a field at a point. Forces are in newtons, so light points accelerate more than heavy ones. On cloth whose
/// mass is per area they are newtons per square metre: its motion does not depend on the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FieldKind {
    /// The same acceleration everywhere, in m/s².
    Gravity {
        /// The acceleration.
        acceleration: Vector3<f64>,
    },
    /// The same force everywhere.
    Uniform {
        /// The force.
        force: Vector3<f64>,
    },
    /// A force away from the centre.
    Radial {
        /// The force; below 0 it attracts.
        force: f64,
    },
    /// Attraction to the centre, the same for light and heavy points.
    Newton {
        /// Acceleration in m/s² at a distance of a metre.
        magnitude: f64,
        /// None within this distance, in metres.
        min_distance: f64,
    },
    /// Resistance against motion.
    Drag {
        /// Force over speed in kg/s.
        magnitude: f64,
        /// Acts against motion along this direction only; of unit length.
        along: Option<Vector3<f64>>,
        /// Velocity of the medium in m/s.
        velocity: Vector3<f64>,
        /// Speed of a point in m/s at which the force is half of that; 0 is none.
        half_speed: f64,
    },
    /// Moving air, which takes points along.
    Air {
        /// Its velocity in m/s.
        velocity: Vector3<f64>,
        /// Share of the difference in velocity that a point makes up for in 1/24 s.
        rate: f64,
        /// Only accelerates, and only along its velocity.
        component_only: bool,
        /// Blows only into a cone about its direction: the cosine of half its angle.
        spread: Option<f64>,
    },
    /// Noise that is smooth in space.
    Turbulence {
        /// The largest force per axis.
        force: f64,
        /// The noise.
        noise: Noise,
    },
    /// A force about an axis.
    Vortex {
        /// The force.
        force: f64,
        /// The axis, of unit length.
        axis: Vector3<f64>,
    },
    /// Forces away from, along and around the axis of a volume.
    VolumeAxis(VolumeAxis),
}

/// Noise with octaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Waves per metre of the first octave, per axis.
    pub frequency: Vector3<f64>,
    /// Offset in waves.
    pub phase: Vector3<f64>,
    /// Octaves after the first.
    pub octaves: u32,
    /// Strength of each octave, as a share of the one before.
    pub ratio: f64,
}

/// The forces of a volume axis field, in newtons.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeAxis {
    /// Away from the centre.
    pub from_center: f64,
    /// Away from the axis.
    pub from_axis: f64,
    /// Along the axis.
    pub along_axis: f64,
    /// Around the axis.
    pub around_axis: f64,
    /// In a fixed direction.
    pub directional: Vector3<f64>,
    /// The axis, of unit length.
    pub axis: Vector3<f64>,
    /// The strength of its turbulence.
    pub turbulence: f64,
    /// Its turbulence.
    pub noise: Noise,
}

/// Where a field reaches.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    /// The centre in metres.
    pub center: Vector3<f64>,
    /// Metres per unit in which attenuation measures distance.
    pub unit: f64,
    /// Exponent of the falloff with distance; 0 is none.
    pub attenuation: f64,
    /// Distance in metres beyond which there is none; infinite for no bound.
    pub max_distance: f64,
    /// Factor from the centre (first) to the largest distance (last), evenly spaced.
    pub falloff: [f64; Self::SAMPLES],
    /// Acts inside of a volume only.
    pub volume: Option<Volume>,
    /// Without a largest distance, falls off from the centre or the axis of the volume to its edge.
    pub falls_off_in_volume: bool,
}

impl Reach {
    /// Samples of the falloff.
    pub const SAMPLES: usize = FALLOFF_SAMPLES;

    /// Everywhere the same.
    pub fn everywhere() -> Self {
        Self {
            center: Vector3::zeros(),
            unit: 1.0,
            attenuation: 0.0,
            max_distance: f64::INFINITY,
            falloff: [1.0; Self::SAMPLES],
            volume: None,
            falls_off_in_volume: false,
        }
    }
}

/// The volume that a field acts in. In its own space it reaches from -1 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volume {
    /// Its shape.
    pub shape: VolumeShape,
    /// From a vector in world space, in metres from the centre, to its own space.
    pub to_local: Matrix3<f64>,
    /// Its middle, from the centre of the field, in its own space.
    pub offset: Vector3<f64>,
    /// Radius of a torus' section.
    pub section: f64,
    /// How far round a round volume goes, in degrees, is kept as sine and cosine; `None` for all round.
    pub sweep: Option<[f64; 2]>,
    /// Acts outside of it instead.
    pub is_excluded: bool,
}

/// The shape of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VolumeShape {
    /// A cube.
    Cube,
    /// A ball.
    Sphere,
    /// A cylinder about y.
    Cylinder,
    /// A cone about y with its tip at the bottom.
    Cone,
    /// A torus about y.
    Torus,
}
