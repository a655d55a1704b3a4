//! Force fields of Maya's classic dynamics.

use std::borrow::Cow;

use super::key::{Plugged, choice, float, floats, int, node, plug, ramp, toggle, vector, vectors};
use super::kind::Data;
use super::node_type::node_table;
use super::scene_nodes::transform::TRANSFORM;
use super::value::{Choice, RampPoint};

use dyn_base::DYN_BASE;
use field::FIELD;

/// Attributes shared by emitters and fields.
pub mod dyn_base {
    use super::*;

    node_table! {
        /// Attributes shared by emitters and fields: an owner.
        DYN_BASE = "dynBase", inherits Some(&TRANSFORM), hides [];
        "Connections" {
            /// The owner.
            OWNER: Plugged = plug("owner", "ow", Data::Message).elsewhere("fields stand for themselves: none comes from the points of another object");
        }
        "Nucleus (open)" {
            /// The object that it acts on or emits into. A field acts on more through `outputForce` and their `inputForce`.
            TARGET: Plugged = node("target", "target", None).solved("nucleus_graph::graph").extension();
        }
        "Owner" {
            /// Out of use in Maya.
            FROM_WHERE: i64 = int("fromWhere", "fw", 0).unused();
            /// Out of use in Maya.
            SUBSET_ID: i64 = int("subsetId", "sid", -1).unused();
            /// Whether its position has an effect.
            POSITIONAL: bool = toggle("positional", "psl", false).output().elsewhere("fields stand for themselves: none comes from the points of another object");
            /// Centroid of the owner's points.
            OWNER_CENTROID: [f64; 3] = vector("ownerCentroid", "ocd", [0.0, 0.0, 0.0], ["ocx", "ocy", "ocz"]).elsewhere("fields stand for themselves: none comes from the points of another object");
            /// Positions of its owner's points.
            OWNER_POS_DATA: Vec<[f64; 3]> = vectors("ownerPosData", "opd").elsewhere("fields stand for themselves: none comes from the points of another object");
            /// Velocities of its owner's points.
            OWNER_VEL_DATA: Vec<[f64; 3]> = vectors("ownerVelData", "ovd").elsewhere("fields stand for themselves: none comes from the points of another object");
        }
    }
}

/// Attributes shared by all fields.
pub mod field {
    use super::*;

    node_table! {
        /// Attributes shared by all fields: magnitude, range and volume.
        FIELD = "field", inherits Some(&DYN_BASE), hides [];
        "Field" {
            /// Strength of the field: a force per point; in the physical model, of cloth per unit of area. Of an airField, the speed of the air; of a newtonField, an acceleration; of a dragField, a resistance.
            MAGNITUDE: f64 = float("magnitude", "mag", 1.0).solved("nucleus_core::fields::reach");
            /// Falloff with distance; 0 is none.
            ATTENUATION: f64 = float("attenuation", "att", 0.0).solved("nucleus_core::fields::reach");
            /// Range of the field, if `useMaxDistance` is on.
            MAX_DISTANCE: f64 = float("maxDistance", "max", 0.0).solved("nucleus_core::fields::reach");
            /// Acts from each of the owner's points, not from their centroid.
            APPLY_PER_VERTEX: bool = toggle("applyPerVertex", "apv", false).elsewhere("fields stand for themselves: none comes from the points of another object");
            /// Whether `maxDistance` limits the range.
            USE_MAX_DISTANCE: bool = toggle("useMaxDistance", "umd", false).solved("nucleus_core::fields::reach");
            /// Their positions.
            INPUT_POSITIONS: Vec<[f64; 3]> = vectors("inputPositions", "inp").wiring("Maya's wiring: what it carries is read from the nodes directly");
            /// Their velocities.
            INPUT_VELOCITIES: Vec<[f64; 3]> = vectors("inputVelocities", "inv").wiring("Maya's wiring: what it carries is read from the nodes directly");
            /// Their masses.
            INPUT_MASS: Vec<f64> = floats("inputMass", "inm").wiring("Maya's wiring: what it carries is read from the nodes directly");
            /// Length of the time step.
            DELTA_TIME: f64 = float("deltaTime", "dt", 0.0).wiring("Maya's wiring: what it carries is read from the nodes directly");
            /// Shape of the volume that it acts in.
            VOLUME_SHAPE: Choice = choice("volumeShape", "vol", 0, &[(0, "None"), (1, "Cube"), (2, "Sphere"), (3, "Cylinder"), (4, "Cone"), (5, "Torus")]).solved("nucleus_core::fields::reach");
            /// Acts outside the volume instead.
            VOLUME_EXCLUSION: bool = toggle("volumeExclusion", "vex", false).solved("nucleus_core::fields::reach");
            /// Offset of the volume from the field.
            VOLUME_OFFSET: [f64; 3] = vector("volumeOffset", "vfo", [0.0, 0.0, 0.0], ["vox", "voy", "voz"]).solved("nucleus_core::fields::reach");
            /// Section radius of a torus.
            SECTION_RADIUS: f64 = float("sectionRadius", "tsr", 0.5).solved("nucleus_core::fields::reach");
            /// Sweep angle of a round volume.
            VOLUME_SWEEP: f64 = float("volumeSweep", "vsw", 360.0).solved("nucleus_core::fields::reach");
            /// Strength over the distance up to `maxDistance`.
            FALLOFF_CURVE: Cow<'static, [RampPoint]> = ramp("falloffCurve", "fc", &[]).solved("nucleus_core::fields::reach");
        }
        "Connections" {
            /// Particles that it acts on.
            INPUT_DATA: Plugged = plug("inputData", "ind", Data::FieldData).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
            /// Forces that it adds to.
            INPUT_FORCE: Plugged = plug("inputForce", "inf", Data::Vectors).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
            /// Force on each particle.
            OUTPUT_FORCE: Plugged = plug("outputForce", "of", Data::Vectors).multi().output().wiring("Maya's wiring: what it carries is read from the nodes directly");
            /// Settings per particle of the objects that it acts on.
            INPUT_PP_DATA: Plugged = plug("inputPPData", "ppda", Data::FieldSettings).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
            /// Settings per particle of the owner.
            OWNER_PP_DATA: Plugged = plug("ownerPPData", "oppd", Data::FieldSettings).elsewhere("fields stand for themselves: none comes from the points of another object");
        }
    }
}

/// Gravity fields.
pub mod gravity_field {
    use super::*;

    node_table! {
        /// A field of uniform acceleration.
        GRAVITY_FIELD = "gravityField", inherits Some(&FIELD), hides [];
        "Field" {
            /// Acceleration, in cm/s² where a scene unit is a centimetre.
            MAGNITUDE: f64 = float("magnitude", "mag", 9.8).solved("nucleus_core::fields::gravity");
            /// Direction of the acceleration.
            DIRECTION: [f64; 3] = vector("direction", "d", [0.0, -1.0, 0.0], ["dx", "dy", "dz"]).solved("nucleus_core::fields::gravity");
        }
    }
}

/// Turbulence fields.
pub mod turbulence_field {
    use super::*;

    node_table! {
        /// A field of noise.
        TURBULENCE_FIELD = "turbulenceField", inherits Some(&FIELD), hides [];
        "Field" {
            /// Spatial frequency of the noise.
            FREQUENCY: f64 = float("frequency", "frq", 1.0).solved("nucleus_core::fields::turbulence");
            /// Offset of the noise along x.
            PHASE_X: f64 = float("phaseX", "phx", 0.0).solved("nucleus_core::fields::turbulence");
            /// Offset of the noise along y.
            PHASE_Y: f64 = float("phaseY", "phy", 0.0).solved("nucleus_core::fields::turbulence");
            /// Offset of the noise along z.
            PHASE_Z: f64 = float("phaseZ", "phz", 0.0).solved("nucleus_core::fields::turbulence");
            /// Count of octaves added to the noise.
            NOISE_LEVEL: i64 = int("noiseLevel", "nslv", 0).solved("nucleus_core::fields::turbulence");
            /// Amplitude of each octave relative to the one before.
            NOISE_RATIO: f64 = float("noiseRatio", "nsrt", 0.707).solved("nucleus_core::fields::turbulence");
            /// Interpolation of the noise.
            INTERPOLATION_TYPE: Choice = choice("interpolationType", "intr", 0, &[(0, "Linear"), (1, "Quadratic")]).elsewhere("the noise is always smooth");
        }
    }
}

/// Vortex fields.
pub mod vortex_field {
    use super::*;

    node_table! {
        /// A field that rotates objects about an axis.
        VORTEX_FIELD = "vortexField", inherits Some(&FIELD), hides [];
        "Field" {
            /// The axis of rotation.
            AXIS: [f64; 3] = vector("axis", "ax", [0.0, 0.0, 0.0], ["axx", "axy", "axz"]).solved("nucleus_core::fields::vortex");
        }
    }
}

/// Drag fields.
pub mod drag_field {
    use super::*;

    node_table! {
        /// A field that damps motion.
        DRAG_FIELD = "dragField", inherits Some(&FIELD), hides [];
        "Field" {
            /// Direction of the drag.
            DIRECTION: [f64; 3] = vector("direction", "d", [0.0, 0.0, 0.0], ["dx", "dy", "dz"]).solved("nucleus_core::fields::drag");
            /// Damps motion along `direction` only.
            USE_DIRECTION: bool = toggle("useDirection", "ud", false).solved("nucleus_core::fields::drag");
            /// Share of the field's velocity that the drag is relative to.
            INHERIT_VELOCITY: f64 = float("inheritVelocity", "iv", 0.0).solved("nucleus_core::fields::drag");
            /// Speed of the field in scene units per second at which half of the drag is left; at rest there is none.
            MOTION_ATTENUATION: f64 = float("motionAttenuation", "mna", 0.0).solved("nucleus_core::fields::drag");
            /// Speed of a point in scene units per second at which half of the drag is left; at rest there is none.
            SPEED_ATTENUATION: f64 = float("speedAttenuation", "spa", 0.0).solved("nucleus_core::fields::drag");
            /// Time of the evaluation; driven by `time1.outTime`.
            CURRENT_TIME: f64 = float("currentTime", "cti", 0.0).wiring("the clock of the nucleus counts");
        }
    }
}

/// Air fields.
pub mod air_field {
    use super::*;

    node_table! {
        /// A field of moving air.
        AIR_FIELD = "airField", inherits Some(&FIELD), hides [];
        "Field" {
            /// Direction of the air.
            DIRECTION: [f64; 3] = vector("direction", "d", [0.0, 0.0, 0.0], ["dx", "dy", "dz"]).solved("nucleus_core::fields::air");
            /// Rate at which the air takes points along: the share of the difference from its velocity that disappears in 1/24 s. At 0 it does nothing, and from 1 on points move with the air at once. The speed of the air is `magnitude`.
            SPEED: f64 = float("speed", "spd", 0.0).solved("nucleus_core::fields::air");
            /// Share of the field's velocity that is added.
            INHERIT_VELOCITY: f64 = float("inheritVelocity", "iv", 0.0).solved("nucleus_core::fields::air");
            /// Only accelerates objects, and only along `direction`.
            COMPONENT_ONLY: bool = toggle("componentOnly", "co", false).solved("nucleus_core::fields::air");
            /// Spread of the air; 1 is a half space.
            SPREAD: f64 = float("spread", "spr", 0.0).solved("nucleus_core::fields::air");
            /// Whether `spread` applies.
            ENABLE_SPREAD: bool = toggle("enableSpread", "es", false).solved("nucleus_core::fields::air");
            /// Rotates the direction with the field.
            INHERIT_ROTATION: bool = toggle("inheritRotation", "ir", false).solved("nucleus_core::fields::air");
        }
    }
}

/// Radial fields.
pub mod radial_field {
    use super::*;

    node_table! {
        /// A field that repels from a point, or attracts to it.
        RADIAL_FIELD = "radialField", inherits Some(&FIELD), hides [];
        "Field" {
            /// Falloff at the maximum distance: 0 is gradual, 1 is abrupt.
            RADIAL_TYPE: f64 = float("radialType", "typ", 0.0).solved("nucleus_graph::compile::fields");
        }
    }
}

/// Uniform fields.
pub mod uniform_field {
    use super::*;

    node_table! {
        /// A field of uniform force.
        UNIFORM_FIELD = "uniformField", inherits Some(&FIELD), hides [];
        "Field" {
            /// Direction of the force.
            DIRECTION: [f64; 3] = vector("direction", "d", [0.0, 0.0, 0.0], ["dx", "dy", "dz"]).solved("nucleus_core::fields::uniform");
            /// Out of use in Maya.
            INHERIT_FACTOR: f64 = float("inheritFactor", "inh", 0.0).unused();
        }
    }
}

/// Volume axis fields.
pub mod volume_axis_field {
    use super::*;

    node_table! {
        /// A field of flow in and around a volume.
        VOLUME_AXIS_FIELD = "volumeAxisField", inherits Some(&FIELD), hides [];
        "Field" {
            /// Strongest at the edge of the volume, or at the largest distance, instead of the centre or the axis.
            INVERT_ATTENUATION: bool = toggle("invertAttenuation", "ia", false).solved("nucleus_graph::compile::fields");
            /// Force away from the centre of a cube or a sphere, and without a volume, as a multiple of `magnitude`.
            AWAY_FROM_CENTER: f64 = float("awayFromCenter", "afc", 1.0).solved("nucleus_core::fields::volume_axis");
            /// Force away from the axis of a cylinder, a cone or a torus, and without a volume, as a multiple of `magnitude`.
            AWAY_FROM_AXIS: f64 = float("awayFromAxis", "afa", 1.0).solved("nucleus_core::fields::volume_axis");
            /// Force along the axis, as a multiple of `magnitude`.
            ALONG_AXIS: f64 = float("alongAxis", "alx", 0.0).solved("nucleus_core::fields::volume_axis");
            /// Force around the axis, as a multiple of `magnitude`.
            AROUND_AXIS: f64 = float("aroundAxis", "arx", 0.0).solved("nucleus_core::fields::volume_axis");
            /// Force along `direction`, as a multiple of `magnitude`.
            DIRECTIONAL_SPEED: f64 = float("directionalSpeed", "drs", 0.0).solved("nucleus_core::fields::volume_axis");
            /// Direction of `directionalSpeed`.
            DIRECTION: [f64; 3] = vector("direction", "d", [1.0, 0.0, 0.0], ["dx", "dy", "dz"]).solved("nucleus_core::fields::volume_axis");
            /// Whether Maya draws arrows.
            DISPLAY_SPEED: bool = toggle("displaySpeed", "dss", true).elsewhere("only Maya's viewport draws it");
            /// Strength of a turbulence that varies with time.
            TURBULENCE: f64 = float("turbulence", "trb", 0.0).solved("nucleus_core::fields::volume_axis");
            /// Speed of the turbulence.
            TURBULENCE_SPEED: f64 = float("turbulenceSpeed", "trs", 0.2).solved("nucleus_core::fields::volume_axis");
            /// Spatial frequency of the turbulence.
            TURBULENCE_FREQUENCY: [f64; 3] = vector("turbulenceFrequency", "tf", [1.0, 1.0, 1.0], ["tfx", "tfy", "tfz"]).solved("nucleus_core::fields::volume_axis");
            /// Offset of the turbulence.
            TURBULENCE_OFFSET: [f64; 3] = vector("turbulenceOffset", "to", [0.0, 0.0, 0.0], ["tox", "toy", "toz"]).solved("nucleus_core::fields::volume_axis");
            /// Strength of a second turbulence of higher frequency.
            DETAIL_TURBULENCE: f64 = float("detailTurbulence", "dtr", 0.0).solved("nucleus_graph::compile::fields");
            /// The time of the turbulence.
            TIME: f64 = float("time", "tim", 0.0).wiring("the clock of the nucleus counts");
        }
    }
}

/// Newton fields.
pub mod newton_field {
    use super::*;

    node_table! {
        /// A field of gravitational attraction between masses.
        NEWTON_FIELD = "newtonField", inherits Some(&FIELD), hides [];
        "Field" {
            /// Distance from the field within which it does not act.
            MIN_DISTANCE: f64 = float("minDistance", "min", 0.0).solved("nucleus_core::fields::newton");
            /// Masses of the owner's points.
            OWNER_MASS_DATA: Vec<f64> = floats("ownerMassData", "omd").elsewhere("fields stand for themselves: none comes from the points of another object");
        }
    }
}
