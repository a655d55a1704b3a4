//! The clock that everything is driven by. Made by the short form of a scene.

use super::key::plug;
use super::table::node_table;
use super::{Data, Plugged};

node_table! {
    /// The time of the scene.
    TIME = "time", inherits None, hides [];
    "Connections" {
        /// The current time.
        OUT_TIME: Plugged = plug("outTime", "o", Data::Number).output();
    }
}
