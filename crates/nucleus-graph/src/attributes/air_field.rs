//! Air fields.

use super::field::FIELD;
use super::key::{float, toggle, vector};
use super::table::node_table;

node_table! {
    /// A field that takes things along with moving air.
    AIR_FIELD = "airField", inherits Some(&FIELD), hides [];
    "Field" {
        /// Where the air blows to.
        DIRECTION: [f64; 3] = vector("direction", "d", [0.0, 0.0, 0.0], ["dx", "dy", "dz"]);
        /// How fast things are to move with the air.
        SPEED: f64 = float("speed", "spd", 0.0);
        /// How much of the field's own motion is added.
        INHERIT_VELOCITY: f64 = float("inheritVelocity", "iv", 0.0);
        /// Only speeds things up, and only along the air.
        COMPONENT_ONLY: bool = toggle("componentOnly", "co", false);
        /// How wide the air fans out: 1 is a half space.
        SPREAD: f64 = float("spread", "spr", 0.0);
        /// Whether it fans out.
        ENABLE_SPREAD: bool = toggle("enableSpread", "es", false);
        /// Turns the direction with the field.
        INHERIT_ROTATION: bool = toggle("inheritRotation", "ir", false);
    }
}
