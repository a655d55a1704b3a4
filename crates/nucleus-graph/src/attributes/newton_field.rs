//! Newton fields.

use super::field::FIELD;
use super::key::{float, floats};
use super::table::node_table;

node_table! {
    /// A field that draws masses together.
    NEWTON_FIELD = "newtonField", inherits Some(&FIELD), hides [];
    "Field" {
        /// Nearer than this it does not act.
        MIN_DISTANCE: f64 = float("minDistance", "min", 0.0);
        /// Masses of its owner's points.
        OWNER_MASS_DATA: Vec<f64> = floats("ownerMassData", "omd");
    }
}
