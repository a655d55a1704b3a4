//! Vortex fields.

use super::field::FIELD;
use super::key::vector;
use super::table::node_table;

node_table! {
    /// A field that turns things round an axis.
    VORTEX_FIELD = "vortexField", inherits Some(&FIELD), hides [];
    "Field" {
        /// The axis that it turns round.
        AXIS: [f64; 3] = vector("axis", "ax", [0.0, 0.0, 0.0], ["axx", "axy", "axz"]);
    }
}
