//! Drag fields.

use super::field::FIELD;
use super::key::{float, toggle, vector};
use super::table::node_table;

node_table! {
    /// A field that slows things down.
    DRAG_FIELD = "dragField", inherits Some(&FIELD), hides [];
    "Field" {
        /// Direction of the drag.
        DIRECTION: [f64; 3] = vector("direction", "d", [0.0, 0.0, 0.0], ["dx", "dy", "dz"]);
        /// Drags along that direction only.
        USE_DIRECTION: bool = toggle("useDirection", "ud", false);
        /// How much of the field's own motion is taken into account.
        INHERIT_VELOCITY: f64 = float("inheritVelocity", "iv", 0.0);
        /// Lessens the drag of a field that moves slowly.
        MOTION_ATTENUATION: f64 = float("motionAttenuation", "mna", 0.0);
        /// Lessens the drag on what moves slowly.
        SPEED_ATTENUATION: f64 = float("speedAttenuation", "spa", 0.0);
        /// The time it is evaluated for; driven by `time1.outTime`.
        CURRENT_TIME: f64 = float("currentTime", "cti", 0.0);
    }
}
