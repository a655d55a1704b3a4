//! Uniform fields.

use super::field::FIELD;
use super::key::{float, vector};
use super::table::node_table;

node_table! {
    /// A field that pushes the same way everywhere.
    UNIFORM_FIELD = "uniformField", inherits Some(&FIELD), hides [];
    "Field" {
        /// Where it pushes.
        DIRECTION: [f64; 3] = vector("direction", "d", [0.0, 0.0, 0.0], ["dx", "dy", "dz"]);
        /// Out of use in Maya.
        INHERIT_FACTOR: f64 = float("inheritFactor", "inh", 0.0).unused();
    }
}
