//! What emitters and fields share.

use super::key::{int, node, plug, toggle, vector, vectors};
use super::table::node_table;
use super::transform::TRANSFORM;
use super::{Data, Plugged};

node_table! {
    /// What emitters and fields share: an owner.
    DYN_BASE = "dynBase", inherits Some(&TRANSFORM), hides [];
    "Connections" {
        /// The object it belongs to.
        OWNER: Plugged = plug("owner", "ow", Data::Message);
    }
    "Nucleus (open)" {
        /// The object it acts on, or emits into.
        TARGET: Plugged = node("target", "target", None).solved("nucleus_graph::graph").extension();
    }
    "Owner" {
        /// Out of use in Maya.
        FROM_WHERE: i64 = int("fromWhere", "fw", 0).unused();
        /// Out of use in Maya.
        SUBSET_ID: i64 = int("subsetId", "sid", -1).unused();
        /// Whether its place matters.
        POSITIONAL: bool = toggle("positional", "psl", false).output();
        /// Middle of its owner's points.
        OWNER_CENTROID: [f64; 3] = vector("ownerCentroid", "ocd", [0.0, 0.0, 0.0], ["ocx", "ocy", "ocz"]);
        /// Positions of its owner's points.
        OWNER_POS_DATA: Vec<[f64; 3]> = vectors("ownerPosData", "opd");
        /// Velocities of its owner's points.
        OWNER_VEL_DATA: Vec<[f64; 3]> = vectors("ownerVelData", "ovd");
    }
}
