//! Radial fields.

use super::field::FIELD;
use super::key::float;
use super::table::node_table;

node_table! {
    /// A field that pushes away from a point, or pulls towards it.
    RADIAL_FIELD = "radialField", inherits Some(&FIELD), hides [];
    "Field" {
        /// How it ends at its greatest distance: 0 fades out, 1 stops at once.
        RADIAL_TYPE: f64 = float("radialType", "typ", 0.0);
    }
}
