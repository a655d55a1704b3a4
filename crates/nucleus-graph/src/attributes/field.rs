//! What all fields share.

use std::borrow::Cow;

use super::dyn_base::DYN_BASE;
use super::key::{choice, float, floats, plug, ramp, toggle, vector, vectors};
use super::table::node_table;
use super::{Choice, Data, Plugged, RampPoint};

node_table! {
    /// What all fields have: strength, reach, a volume. Not solved yet.
    FIELD = "field", inherits Some(&DYN_BASE), hides [];
    "Field" {
        /// How strong it is.
        MAGNITUDE: f64 = float("magnitude", "mag", 1.0);
        /// How fast it fades with distance: at 0 not at all.
        ATTENUATION: f64 = float("attenuation", "att", 0.0);
        /// It does not reach farther than this, if `useMaxDistance` is on.
        MAX_DISTANCE: f64 = float("maxDistance", "max", 0.0);
        /// Acts from each of its owner's points, not from their middle.
        APPLY_PER_VERTEX: bool = toggle("applyPerVertex", "apv", false);
        /// Whether its reach ends.
        USE_MAX_DISTANCE: bool = toggle("useMaxDistance", "umd", false);
        /// Their positions.
        INPUT_POSITIONS: Vec<[f64; 3]> = vectors("inputPositions", "inp");
        /// Their velocities.
        INPUT_VELOCITIES: Vec<[f64; 3]> = vectors("inputVelocities", "inv");
        /// Their masses.
        INPUT_MASS: Vec<f64> = floats("inputMass", "inm");
        /// Length of the time step.
        DELTA_TIME: f64 = float("deltaTime", "dt", 0.0);
        /// Volume that it acts in.
        VOLUME_SHAPE: Choice = choice("volumeShape", "vol", 0, &[(0, "None"), (1, "Cube"), (2, "Sphere"), (3, "Cylinder"), (4, "Cone"), (5, "Torus")]);
        /// Acts outside of that volume instead.
        VOLUME_EXCLUSION: bool = toggle("volumeExclusion", "vex", false);
        /// How far that volume is from the field.
        VOLUME_OFFSET: [f64; 3] = vector("volumeOffset", "vfo", [0.0, 0.0, 0.0], ["vox", "voy", "voz"]);
        /// Radius of a torus' section.
        SECTION_RADIUS: f64 = float("sectionRadius", "tsr", 0.5);
        /// How far round a round volume goes.
        VOLUME_SWEEP: f64 = float("volumeSweep", "vsw", 360.0);
        /// Strength over the distance up to `maxDistance`.
        FALLOFF_CURVE: Cow<'static, [RampPoint]> = ramp("falloffCurve", "fc", &[]);
    }
    "Connections" {
        /// Particles that it acts on.
        INPUT_DATA: Plugged = plug("inputData", "ind", Data::FieldData).multi();
        /// Forces that it adds to.
        INPUT_FORCE: Plugged = plug("inputForce", "inf", Data::Vectors).multi();
        /// Force on each particle.
        OUTPUT_FORCE: Plugged = plug("outputForce", "of", Data::Vectors).multi().output();
        /// Settings that differ by particle, of those it acts on.
        INPUT_PP_DATA: Plugged = plug("inputPPData", "ppda", Data::FieldSettings).multi();
        /// Settings that differ by particle, of its owner.
        OWNER_PP_DATA: Plugged = plug("ownerPPData", "oppd", Data::FieldSettings);
    }
}
