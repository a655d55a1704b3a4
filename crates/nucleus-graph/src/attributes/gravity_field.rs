//! Gravity fields.

use super::field::FIELD;
use super::key::{float, vector};
use super::table::node_table;

node_table! {
    /// A field that pulls the same way everywhere.
    GRAVITY_FIELD = "gravityField", inherits Some(&FIELD), hides [];
    "Field" {
        /// How strong it is, in centimetres a second squared where a scene unit is a centimetre.
        MAGNITUDE: f64 = float("magnitude", "mag", 9.8);
        /// Where it pulls.
        DIRECTION: [f64; 3] = vector("direction", "d", [0.0, -1.0, 0.0], ["dx", "dy", "dz"]);
    }
}
