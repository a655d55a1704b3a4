//! Turbulence fields.

use super::Choice;
use super::field::FIELD;
use super::key::{choice, float, int};
use super::table::node_table;

node_table! {
    /// A field of noise.
    TURBULENCE_FIELD = "turbulenceField", inherits Some(&FIELD), hides [];
    "Field" {
        /// How fine the turbulence is.
        FREQUENCY: f64 = float("frequency", "frq", 1.0);
        /// Moves the pattern along x.
        PHASE_X: f64 = float("phaseX", "phx", 0.0);
        /// Moves the pattern along y.
        PHASE_Y: f64 = float("phaseY", "phy", 0.0);
        /// Moves the pattern along z.
        PHASE_Z: f64 = float("phaseZ", "phz", 0.0);
        /// How many finer patterns are added.
        NOISE_LEVEL: i64 = int("noiseLevel", "nslv", 0);
        /// How strong each is beside the one before.
        NOISE_RATIO: f64 = float("noiseRatio", "nsrt", 0.707);
        /// How smoothly values of the pattern run into each other.
        INTERPOLATION_TYPE: Choice = choice("interpolationType", "intr", 0, &[(0, "Linear"), (1, "Quadratic")]);
    }
}
