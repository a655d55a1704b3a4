//! Volume axis fields.

use super::field::FIELD;
use super::key::{float, toggle, vector};
use super::table::node_table;

node_table! {
    /// A field of flows in and around a volume.
    VOLUME_AXIS_FIELD = "volumeAxisField", inherits Some(&FIELD), hides [];
    "Field" {
        /// Strongest at the edge of the volume instead of the middle.
        INVERT_ATTENUATION: bool = toggle("invertAttenuation", "ia", false);
        /// Push away from the middle.
        AWAY_FROM_CENTER: f64 = float("awayFromCenter", "afc", 1.0);
        /// Push away from the axis.
        AWAY_FROM_AXIS: f64 = float("awayFromAxis", "afa", 1.0);
        /// Push along the axis.
        ALONG_AXIS: f64 = float("alongAxis", "alx", 0.0);
        /// Push round the axis.
        AROUND_AXIS: f64 = float("aroundAxis", "arx", 0.0);
        /// Push along `direction`.
        DIRECTIONAL_SPEED: f64 = float("directionalSpeed", "drs", 0.0);
        /// A direction to push in.
        DIRECTION: [f64; 3] = vector("direction", "d", [1.0, 0.0, 0.0], ["dx", "dy", "dz"]);
        /// Whether Maya draws arrows.
        DISPLAY_SPEED: bool = toggle("displaySpeed", "dss", true);
        /// Strength of a turbulence that changes with time.
        TURBULENCE: f64 = float("turbulence", "trb", 0.0);
        /// How fast that turbulence changes.
        TURBULENCE_SPEED: f64 = float("turbulenceSpeed", "trs", 0.2);
        /// How fine that turbulence is.
        TURBULENCE_FREQUENCY: [f64; 3] = vector("turbulenceFrequency", "tf", [1.0, 1.0, 1.0], ["tfx", "tfy", "tfz"]);
        /// Moves the pattern of that turbulence.
        TURBULENCE_OFFSET: [f64; 3] = vector("turbulenceOffset", "to", [0.0, 0.0, 0.0], ["tox", "toy", "toz"]);
        /// Strength of a second turbulence, which is finer.
        DETAIL_TURBULENCE: f64 = float("detailTurbulence", "dtr", 0.0);
        /// The time of the turbulence.
        TIME: f64 = float("time", "tim", 0.0);
    }
}
